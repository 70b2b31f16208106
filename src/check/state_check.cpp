// SPDX-License-Identifier: BSD-3-Clause
#include "check/state_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "dynamics/arithmetic.hpp"
#include "dynamics/surface_table.hpp"
#include "engine/near_pairs.hpp"
#include "parallel/exchange.hpp"
#include "parallel/slabs.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

/// A collision of one disc, as sent to the rank that keeps the disc's record.
struct Part {
    DiscId disc = 0;
    std::int64_t end_of_micro_step = 0;
    std::uint64_t is_wall = 0;
    double impulse = 0; ///< impulse of a collision with a wall; 0 for a departure
    double work = 0;    ///< energy from growing surfaces, 0 for the higher id of a pair
};

bool is_finite(const DiscState& disc) {
    return std::isfinite(disc.x) && std::isfinite(disc.y) && std::isfinite(disc.vx) &&
           std::isfinite(disc.vy) && std::isfinite(disc.tau);
}

/// The disc in the box's coordinates; the stored state itself if states have no moving frame.
DiscState as_seen(const DiscState& disc, const Frame& frame, double time,
                  double micro_steps_since_sync) {
    if (!frame.is_moving || disc.has_departed()) return disc;
    DiscState seen = frame.in_box(disc, time);
    seen.tau = micro_steps_since_sync;
    if (frame.periods.are_any()) set_image(seen, {});
    return seen;
}

} // namespace

StateCheck::StateCheck(const SceneParameters& scene, const SpeciesTable& species,
                       std::span<const DiscState> own, std::int64_t micro_steps_done,
                       const Communicator& communicator, const Frame& frame, double time,
                       std::span<const double> spins, double energy_given)
    : scene_(scene), effects_(per_micro_step(scene)),
      fixed_bodies_(scene.box, scene.radius, effects_), species_(species), box_(scene.box),
      box_before_(scene.box), communicator_(communicator),
      first_id_(slab_begin(communicator.rank(), scene.n_discs, communicator.size())),
      micro_steps_done_(micro_steps_done), micro_steps_before_(micro_steps_done),
      tolerance_(StableArithmetic::tolerance(scene.box, 2 * scene.radius)) {
    const CheckAllowance allowance = allowance_of(scene.effects);
    may_lose_energy_ = allowance.collisions_take_energy;
    walls_give_energy_ = allowance.walls_give_energy;
    surfaces_give_energy_ = allowance.surfaces_give_energy;
    for (const OtherEnergy& energy : other_energies_of(effects_))
        if (!energy.is_of_syncs) energies_.push_back(energy);
    const auto depends = [&](double x, double y) {
        DiscState at_corner, away;
        away.x = x, away.y = y;
        return other_energy(away, 0) != other_energy(at_corner, 0) ||
               work_on_way(effects_, {x, y, {}}) != 0;
    };
    depends_on_x_ = depends(scene.box.x, 0);
    depends_on_y_ = depends(0, scene.box.y);
    for (const Arc& arc : all_arcs(effects_.fixed_bodies, scene.box))
        tightest_arc_ = std::min(tightest_arc_, arc.radius);
    acts_at_syncs_ = allowance.acts_at_syncs;
    acts_before_flights_ = allowance.acts_before_flights;
    energy_given_ = energy_given;
    wall_speed_ = largest_wall_speed(effects_);
    wall_pull_ = largest_wall_pull(effects_);
    have_open_sides_ = effects_.have_open_boundaries();
    for (const Boundary& side : effects_.boundaries)
        have_inlets_ = have_inlets_ || side.inlet.is_on();
    for (std::size_t k = 0; k < SurfaceContacts::n_surfaces; ++k)
        surfaces_rub_ = surfaces_rub_ || does_rub(effects_, k);
    known_.resize(slab_of_rank(communicator.rank(), scene.n_discs, communicator.size()).size());
    for (Known& known : known_) known.free_from = micro_steps_done;
    total_mass_ = effects_.species.empty() ? static_cast<double>(scene.n_discs) : 0;
    for (const Species& one : effects_.species) {
        total_mass_ += static_cast<double>(one.count) * one.mass;
        smallest_mass_ = std::min(smallest_mass_, one.mass);
    }
    fail_if_found(first_not_finite(own, spins), {});
    fail_if_found(take_records(own, spins, {}, frame, time), {});
    before_ = known_;
    double square = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const double turning = spins.empty() ? 0 : species_.of(own[i].id).radius * spins[i];
        square = std::max(
            square, mass_of(own[i].id) / smallest_mass_ *
                        (squared_speed_of(own[i]) + effects_.contact.inertia * turning * turning));
    }
    fastest_ = std::sqrt(communicator_.max(square)) *
                   std::sqrt(static_cast<double>(scene.n_discs)) +
               wall_speed_;
    energy_ = energy_of(own);
}

void StateCheck::inspect(const LocalView& now, std::int64_t micro_steps_done, Log log,
                         const CheckedColumns& columns, double work_of_images,
                         double energy_given) {
    const std::span<const double> spins = columns.spins;
    work_of_images_ = work_of_images;
    energy_given_before_ = std::exchange(energy_given_, energy_given);
    size_before_ = std::exchange(size_, now.size);
    box_before_ = box_;
    if (now.periods.x != 0) box_.x = now.periods.x; // an effect may change the sides
    if (now.periods.y != 0) box_.y = now.periods.y;
    before_ = known_;
    micro_steps_before_ = std::exchange(micro_steps_done_, micro_steps_done);
    const std::span<const DiscState> own = now.population.discs.first(now.population.n_own);
    fail_if_found(first_not_finite(own, spins), log);
    fail_if_found(take_records(own, spins, columns.departed, now.frame, now.time), log);
    fail_if_found(first_other_radius(own, columns.swapped_radii), log);
    record_speeds();
    const std::int64_t last_sync = micro_steps_done_ / scene_.sync_every * scene_.sync_every;
    for (std::size_t i = 0; i < known_.size(); ++i)
        // The straight flight began at the sync that changed the velocity or let the disc in.
        if (were_rewritten() || (before_[i].disc.has_departed() && !known_[i].disc.has_departed()))
            known_[i].free_from = std::max(known_[i].free_from, last_sync);
    take_log(log);
    fail_if_found(first_out_of_place(now), log);
    fail_if_found(first_wrong_departure(), log);
    fail_if_found(first_in_fixed_body(now), log);
    fail_if_found(first_wrong_count(), log);
    fail_if_found(find_velocity_change(), log);
    fail_if_found(first_overlap(now), log);
    fail_if_found(first_other_energy(own, log), log);
}

void StateCheck::fail_if_found(const Finding& mine, Log log) {
    Finding first;
    for (const Finding& finding : communicator_.all_gather(mine)) {
        if (finding.is_found == 0) continue;
        const auto key = [](const Finding& f) {
            return std::tuple(f.invariant, f.disc, f.partner);
        };
        if (first.is_found == 0 || key(finding) < key(first)) first = finding;
    }
    if (first.is_found == 0) return;
    if (first.rank < 0) {
        const int keeper = slab_of_disc(first.disc);
        if (keeper == communicator_.rank()) first.rank = known_[first.disc - first_id_].owner;
        communicator_.broadcast(first.rank, keeper);
    }
    const std::int64_t step = micro_steps_done_ / scene_.micro_steps;
    std::vector<InputDisc> discs;
    std::vector<double> spins, radii;
    if (first.disc < scene_.n_discs)
        for (const SceneDisc& each :
             discs_around(first, discs_before(), slab_of_disc(first.disc), log,
                          scene_.effects.periods(box_before_), communicator_)) {
            discs.push_back(each.disc);
            if (effects_.have_spins()) spins.push_back(each.spin);
            if (effects_.swap.is_on()) radii.push_back(species_.of(each.disc.id).radius);
        }
    const std::string body = first.invariant == Invariant::clear
                                 ? fixed_bodies_.name_of(static_cast<std::uint32_t>(first.partner))
                                 : "";
    throw CheckFailure(text_of(first, scene_, body, step), first.invariant, step, first.disc,
                       first.rank, std::move(discs), std::move(spins), std::move(radii));
}

/// The walls at the last check; walls with constant speed are put where they were at step 0.
Extent StateCheck::walls_before() const {
    Effects effects = effects_;
    for (Boundary& side : effects.boundaries) side.speed = 0;
    return extent_at(effects, box_before_, static_cast<double>(micro_steps_before_));
}

/// The discs in the box at the last check, in scene units, from this rank's slab of ids.
std::vector<SceneDisc> StateCheck::discs_before() const {
    const auto clock = static_cast<double>(micro_steps_before_ % scene_.sync_every);
    const auto unit = static_cast<double>(scene_.micro_steps);
    const Periods periods = scene_.effects.periods(box_before_);
    const Extent walls = walls_before();
    std::vector<SceneDisc> discs;
    for (const Known& known : before_) {
        if (known.disc.has_departed()) continue;
        DiscState disc = known.disc;
        const double radius = species_.of(disc.id).radius * size_at(micro_steps_before_);
        StableArithmetic::advance(disc, clock);
        periods.wrap(disc, clock);
        if (periods.x == 0)
            disc.x = std::clamp(disc.x, walls.x_low + radius, walls.x_high - radius);
        if (periods.y == 0)
            disc.y = std::clamp(disc.y, walls.y_low + radius, walls.y_high - radius);
        discs.push_back(
            {{disc.id, disc.x, disc.y, disc.vx * unit, disc.vy * unit}, known.spin * unit});
    }
    return discs;
}

Finding StateCheck::first_not_finite(std::span<const DiscState> own,
                                     std::span<const double> spins) const {
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (!is_finite(own[i]) || !std::isfinite(spins.empty() ? 0 : spins[i]))
            return {Invariant::finite, communicator_.rank(), own[i].id};
    }
    return {};
}

Finding StateCheck::first_other_radius(std::span<const DiscState> own,
                                       std::span<const double> swapped_radii) const {
    if (swapped_radii.empty()) return {};
    for (std::size_t i = 0; i < own.size(); ++i)
        if (const double radius = species_.of(own[i].id).radius; swapped_radii[i] != radius)
            return {Invariant::radius, communicator_.rank(), own[i].id, swapped_radii[i], radius};
    return {};
}

/// Sends every disc to the rank that keeps its record. Finds the first disc that is not owned by
/// exactly one rank; the finding's `value` is the number of owners.
Finding StateCheck::take_records(std::span<const DiscState> own, std::span<const double> spins,
                                 std::span<const DiscState> departed, const Frame& frame,
                                 double time) {
    std::vector<std::vector<DiscState>> out(static_cast<std::size_t>(communicator_.size()));
    std::vector<std::vector<double>> spins_out(out.size());
    Finding finding;
    const auto send = [&](const DiscState& disc, double spin) {
        if (disc.id >= scene_.n_discs) {
            finding = {Invariant::owned_once, communicator_.rank(), disc.id, 1};
            return;
        }
        const auto keeper = static_cast<std::size_t>(slab_of_disc(disc.id));
        out[keeper].push_back(disc);
        if (effects_.have_spins()) spins_out[keeper].push_back(spin);
    };
    for (std::size_t i = 0; i < own.size(); ++i) send(own[i], spins.empty() ? 0 : spins[i]);
    for (const DiscState& disc : departed) send(disc, 0);
    const Received<DiscState> in = send_to_owners(communicator_, out);
    if (effects_.have_spins()) {
        const Received<double> spins_in = send_to_owners(communicator_, spins_out);
        for (std::size_t i = 0; i < spins_in.items.size(); ++i)
            known_[in.items[i].id - first_id_].spin = spins_in.items[i];
    }
    std::vector<int> n_owners(known_.size(), 0);
    for (Known& known : known_) {
        known.walls = known.pairs = known.departures = 0;
        known.wall_impulse = known.work = 0;
    }
    for (std::size_t k = 0; k < in.n_senders(); ++k) {
        for (const DiscState& disc : in.from(k)) {
            const std::size_t i = disc.id - first_id_;
            ++n_owners[i];
            known_[i].disc = as_seen(disc, frame, time,
                                     static_cast<double>(micro_steps_done_ % scene_.sync_every));
            known_[i].owner = static_cast<int>(k);
        }
    }
    for (std::size_t i = 0; i < known_.size() && finding.is_found == 0; ++i) {
        if (n_owners[i] != 1)
            finding = {Invariant::owned_once, known_[i].owner, first_id_ + i,
                       static_cast<double>(n_owners[i]), 1};
    }
    return finding;
}

void StateCheck::take_log(Log log) {
    std::vector<std::vector<Part>> out(static_cast<std::size_t>(communicator_.size()));
    std::uint64_t n_pairs = 0;
    for (const Collision& collision : log) {
        const bool is_wall = collision.q == Collision::wall;
        n_pairs += is_wall ? 0 : 1;
        for (const DiscId id : {collision.p, is_wall ? collision.p : collision.q}) {
            ensure(id < scene_.n_discs, "the log of collisions names a disc that does not exist");
            out[static_cast<std::size_t>(slab_of_disc(id))].push_back(
                {id, collision.micro_step + 1, is_wall ? 1u : 0u, is_wall ? collision.impulse : 0,
                 id == collision.p ? work_of(collision) : 0});
            if (is_wall) break;
        }
    }
    for (const Part& part : send_to_owners(communicator_, out).items) {
        Known& known = known_[part.disc - first_id_];
        ++(part.is_wall == 1 ? known.walls : known.pairs);
        if (have_open_sides_ && part.is_wall == 1 && part.impulse == 0) ++known.departures;
        known.wall_impulse += part.impulse;
        known.work += part.work;
        known.free_from = std::max(known.free_from, part.end_of_micro_step);
    }
    n_pair_collisions_ += communicator_.sum(n_pairs);
}

Finding StateCheck::first_wrong_count() const {
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Known &now = known_[i], &then = before_[i];
        const auto walls = static_cast<double>(now.disc.wall_collisions -
                                               then.disc.wall_collisions),
                   pairs = static_cast<double>(now.disc.pair_collisions -
                                               then.disc.pair_collisions),
                   had_walls = static_cast<double>(now.walls),
                   had_pairs = static_cast<double>(now.pairs);
        // `partner` is 0 for wall collisions, 1 for pair collisions
        if (walls != had_walls)
            return {Invariant::counters, now.owner, first_id_ + i, walls, had_walls, 0};
        if (pairs != had_pairs)
            return {Invariant::counters, now.owner, first_id_ + i, pairs, had_pairs, 1};
    }
    return {};
}

/// Keeps the overlapping pair with the lowest ids as the finding.
void StateCheck::keep_lowest(Finding& first, const Suspect& s) {
    if (first.is_found == 0 || std::pair(s.p.id, s.q.id) < std::pair(first.disc, first.partner))
        first = {Invariant::overlap, s.owner, s.p.id, s.depth, s.bound, s.q.id};
}

Finding StateCheck::first_overlap(const LocalView& now) const {
    if (effects_.contact.kind == ContactKind::none) return {}; // discs pass through each other
    const bool is_one = scene_.method == Method::time_stepped;
    const double bound = (is_one ? 1 : 2) * tolerance_ + blur(64);
    std::vector<Suspect> suspects;
    visit_near_pairs(*now.grid, [&](LocalIndex a, LocalIndex b) {
        if (now.population.discs[b].id < now.population.discs[a].id) std::swap(a, b);
        if (a >= now.population.n_own) return; // the owner of the lower id tests the pair
        DiscState p = now.population.discs[a], q = now.population.discs[b];
        for (DiscState* disc : {&p, &q}) StableArithmetic::advance(*disc, now.time);
        const Shift shift = now.periods.between(p, q, now.time);
        q.x += shift.x, q.y += shift.y, q.vx += shift.vx;
        const double depth = diameter_of(p, q) - std::hypot(q.x - p.x, q.y - p.y);
        if (depth > bound) suspects.push_back({p, q, depth, bound, 0, communicator_.rank()});
    });
    if (is_one) return first_unexplained(std::move(suspects));
    Finding first;
    for (const Suspect& s : suspects) keep_lowest(first, s);
    return first;
}

/// Fetches, from the ranks that keep the records, the time since which each disc has been free.
/// Drops pairs whose overlap the time-stepped method allows, and returns the remaining pair with
/// the lowest ids.
Finding StateCheck::first_unexplained(std::vector<Suspect> suspects) const {
    for (const bool is_first : {true, false}) {
        std::vector<std::vector<Suspect>> out(static_cast<std::size_t>(communicator_.size()));
        for (const Suspect& suspect : suspects)
            out[static_cast<std::size_t>(slab_of_disc((is_first ? suspect.p : suspect.q).id))]
                .push_back(suspect);
        suspects = std::move(send_to_owners(communicator_, out).items);
        for (Suspect& suspect : suspects) {
            const std::int64_t free_from =
                known_[(is_first ? suspect.p : suspect.q).id - first_id_].free_from;
            suspect.free_from = is_first ? free_from : std::max(free_from, suspect.free_from);
        }
    }
    Finding first;
    for (const Suspect& s : suspects) {
        const auto back = static_cast<double>(s.free_from - micro_steps_done_);
        const double dx = (s.q.x - s.p.x) + (s.q.vx - s.p.vx) * back,
                     dy = (s.q.y - s.p.y) + (s.q.vy - s.p.vy) * back;
        const double gap = std::hypot(dx, dy) - diameter_of(s.p, s.q);
        if (gap <= blur(8 * (1 + n_syncs_since(s.free_from))))
            continue; // the pair overlapped or touched when both discs became free
        keep_lowest(first, s);
    }
    return first;
}

int StateCheck::slab_of_disc(DiscId id) const {
    return slab_of(id, scene_.n_discs, communicator_.size());
}

double StateCheck::blur(double n_ulps) const {
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    const double time = ulp * static_cast<double>(
                                  scene_.sync_every); // rounding error of a time just before a sync
    return n_ulps * ulp * box_.longest() + 2 * fastest_ * time;
}

} // namespace carrom
