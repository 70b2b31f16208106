// SPDX-License-Identifier: BSD-3-Clause
#include "state_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "carrom/effects/drag.hpp"
#include "carrom/effects/plain_law.hpp"
#include "carrom/parallel/exchange.hpp"
#include "carrom/parallel/slabs.hpp"
#include "measurements.hpp"
#include "near_pairs.hpp"
#include "shared_energy.hpp"

namespace carrom {

namespace {

constexpr double energy_bound = 1e-12;
constexpr double motion_bound = 1e-13; // of speeds, by falling and by slowing down, from sync to sync
constexpr double energy_bound_per_collision = 32 * 0x1p-53;

/// One disc's part in a collision, for the rank that keeps its record.
struct Part {
    DiscId disc = 0;
    std::int64_t end_of_micro_step = 0;
    std::uint64_t is_wall = 0;
};

bool is_finite(const Disc& disc) {
    return std::isfinite(disc.x) && std::isfinite(disc.y) && std::isfinite(disc.vx) && std::isfinite(disc.vy) && std::isfinite(disc.tau);
}

double squared_speed(const Disc& disc) { return disc.vx * disc.vx + disc.vy * disc.vy; }

/// The bits as they are stored where the box's coordinates are the discs' own.
Disc as_seen(const Disc& disc, const Frame& frame, double time, double micro_steps_since_sync) {
    if (!frame.is_moving) return disc;
    Disc seen = frame.in_box(disc, time);
    seen.tau = micro_steps_since_sync;
    if (frame.period_x != 0 || frame.period_y != 0) set_image(seen, {});
    return seen;
}

double beyond(double low, double place, double high) { return std::max(low - place, place - high); }

} // namespace

StateCheck::StateCheck(const Scene& scene, std::span<const Disc> own, std::int64_t micro_steps_done, const Communicator& communicator,
                       const Frame& frame, double time)
    : scene_(scene), effects_(per_micro_step(scene.effects, static_cast<double>(scene.micro_steps))), communicator_(communicator), first_id_(slab_begin(communicator.rank(), scene.n_discs, communicator.size())),
      micro_steps_done_(micro_steps_done), micro_steps_before_(micro_steps_done),
      tolerance_(PlainLaw(scene.box_size, scene.radius).tolerance()) {
    may_lose_energy_ = effects_.contact.kind == ContactKind::restitution || effects_.obstacles.restitution < 1 || (effects_.gravity.is_any() && effects_.drag != 0);
    for (const Side& side : effects_.sides) {
        may_lose_energy_ = may_lose_energy_ || side.restitution < 1;
        walls_give_energy_ = walls_give_energy_ || side.kind == SideKind::thermal || side.speed != 0;
    }
    if (effects_.obstacles.are_any()) obstacles_.emplace(scene.box_size, scene.radius, effects_);
    known_.resize(slab_begin(communicator.rank() + 1, scene.n_discs, communicator.size()) - first_id_);
    for (Known& known : known_) known.free_from = micro_steps_done;
    fail_if_found(first_not_finite(own), {});
    fail_if_found(take_records(own, frame, time), {});
    before_ = known_;
    double square = 0;
    for (const Disc& disc : own) square = std::max(square, squared_speed(disc));
    fastest_ = std::sqrt(communicator_.max(square)) * std::sqrt(static_cast<double>(scene.n_discs));
    energy_ = energy_of(own);
}

void StateCheck::look(const Settled& now, std::int64_t micro_steps_done, Log log) {
    before_ = known_;
    micro_steps_before_ = std::exchange(micro_steps_done_, micro_steps_done);
    const std::span<const Disc> own = now.population.discs.first(now.population.n_own);
    fail_if_found(first_not_finite(own), log);
    fail_if_found(take_records(own, now.frame, now.time), log);
    note_speeds();
    take_log(log);
    fail_if_found(first_out_of_place(now), log);
    fail_if_found(first_in_obstacle(now), log);
    fail_if_found(first_wrong_count(), log);
    fail_if_found(first_other_motion(), log);
    fail_if_found(first_overlap(now), log);
    fail_if_found(first_other_energy(own, log), log);
}

StateCheck::Finding StateCheck::first_not_finite(std::span<const Disc> own) const {
    for (const Disc& disc : own) {
        if (!is_finite(disc)) return {Invariant::finite, communicator_.rank(), 1, disc.id};
    }
    return {};
}

/// Brings every disc to the rank that keeps its record. `value` of a finding: how many ranks, or places, own the disc.
StateCheck::Finding StateCheck::take_records(std::span<const Disc> own, const Frame& frame, double time) {
    std::vector<std::vector<Disc>> out(static_cast<std::size_t>(communicator_.size()));
    Finding finding;
    for (const Disc& disc : own) {
        if (disc.id < scene_.n_discs) out[static_cast<std::size_t>(slab_of_disc(disc.id))].push_back(disc);
        else finding = {Invariant::owned_once, communicator_.rank(), 1, disc.id, 0, 1, 0};
    }
    const Received<Disc> in = send_to_owners(communicator_, out);
    std::vector<int> n_owners(known_.size(), 0);
    for (Known& known : known_) known.walls = known.pairs = 0;
    for (std::size_t k = 0; k < in.n_senders(); ++k) {
        for (const Disc& disc : in.from(k)) {
            const std::size_t i = disc.id - first_id_;
            ++n_owners[i];
            known_[i].disc = as_seen(disc, frame, time, static_cast<double>(micro_steps_done_ % scene_.sync_every));
            known_[i].owner = static_cast<int>(k);
        }
    }
    for (std::size_t i = 0; i < known_.size() && finding.is_found == 0; ++i) {
        if (n_owners[i] != 1) finding = {Invariant::owned_once, known_[i].owner, 1, first_id_ + i, 0, static_cast<double>(n_owners[i]), 1};
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
            out[static_cast<std::size_t>(slab_of_disc(id))].push_back({id, collision.micro_step + 1, is_wall ? 1u : 0u});
            if (is_wall) break;
        }
    }
    for (const Part& part : send_to_owners(communicator_, out).items) {
        Known& known = known_[part.disc - first_id_];
        ++(part.is_wall == 1 ? known.walls : known.pairs);
        known.free_from = std::max(known.free_from, part.end_of_micro_step);
    }
    n_pair_collisions_ += communicator_.sum(n_pairs);
}

StateCheck::Finding StateCheck::first_out_of_place(const Settled& now) const {
    const GridFrame& frame = now.grid->frame();
    const double allowed = scene_.effects.are_any() ? blur(64) : blur(4);
    const Extent box = extent_at(effects_, scene_.box_size, static_cast<double>(micro_steps_done_));
    std::optional<Finding> first;
    const auto add = [&](Invariant invariant, DiscId id, double value, double bound) {
        if (!first || invariant < first->invariant) first = Finding{invariant, communicator_.rank(), 1, id, 0, value, bound};
    };
    const bool is_filed = now.grid->is_valid(now.population.discs.size());
    for (std::size_t i = 0; i < now.population.n_own; ++i) {
        const Disc& disc = now.population.discs[i];
        const double x = now.periods.x_of(disc, now.time), y = now.periods.y_of(disc, now.time);
        const Disc seen = now.frame.in_box(disc, now.time);
        // Between periodic sides it is the image's centre that is in the box.
        const double outside = std::max(now.periods.x != 0 ? beyond(0, x, now.periods.x) : scene_.radius + beyond(box.x_low, seen.x, box.x_high),
                                        now.periods.y != 0 ? beyond(0, y, now.periods.y) : scene_.radius + beyond(box.y_low, seen.y, box.y_high));
        if (outside > allowed) add(Invariant::in_box, disc.id, outside, allowed);
        if (now.strips->owner(x) != communicator_.rank()) add(Invariant::in_strip, disc.id, now.strips->owner(x), 0);
        const auto index = static_cast<LocalIndex>(i);
        if (!is_filed || now.grid->column_of(index) != frame.column_of(x) || now.grid->row_of(index) != frame.row_of(y))
            add(Invariant::in_cell, disc.id, 0, 0);
    }
    return first.value_or(Finding{});
}

/// Under both rules: what would run into an obstacle within a micro-step stops there. `partner` says which one it is.
StateCheck::Finding StateCheck::first_in_obstacle(const Settled& now) const {
    if (!obstacles_) return {};
    const double bound = 2 * tolerance_ + blur(64);
    for (const Disc& disc : now.population.discs.first(now.population.n_own)) {
        const Disc seen = now.frame.in_box(disc, now.time);
        const auto overlap = obstacles_->deepest_overlap(seen.x, seen.y, scene_.radius, bound);
        if (overlap.body != ObstacleContact::no_body) return {Invariant::clear, communicator_.rank(), 1, disc.id, overlap.body, overlap.depth, bound};
    }
    return {};
}

StateCheck::Finding StateCheck::first_wrong_count() const {
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Known &now = known_[i], &then = before_[i];
        const auto walls = static_cast<double>(now.disc.wall_collisions - then.disc.wall_collisions);
        const auto pairs = static_cast<double>(now.disc.pair_collisions - then.disc.pair_collisions);
        // `partner` says which of the two counters it is.
        if (walls != static_cast<double>(now.walls))
            return {Invariant::counters, now.owner, 1, first_id_ + i, 0, walls, static_cast<double>(now.walls)};
        if (pairs != static_cast<double>(now.pairs))
            return {Invariant::counters, now.owner, 1, first_id_ + i, 1, pairs, static_cast<double>(now.pairs)};
    }
    return {};
}

StateCheck::Finding StateCheck::first_other_motion() const {
    const bool is_free = !effects_.gravity.is_any() && effects_.drag == 0; // velocities are rewritten by nothing then
    const double left = slowing(), time = effects_.drag == 0 ? stretch() : drag_clock(effects_.drag, stretch());
    const double gained = std::hypot(effects_.gravity.x, effects_.gravity.y) * (time + static_cast<double>(scene_.sync_every));
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Known& now = known_[i];
        const Disc &disc = now.disc, &then = before_[i].disc;
        if (now.walls + now.pairs > 0) continue;
        const double wx = disc.vx - (then.vx * left + effects_.gravity.x * time), wy = disc.vy - (then.vy * left + effects_.gravity.y * time);
        const double bound = is_free ? 0 : motion_bound * (1 + n_syncs_since(micro_steps_before_)) * (std::sqrt(squared_speed(then)) + gained);
        if (!(std::fabs(wx) <= bound && std::fabs(wy) <= bound))
            return {Invariant::motion, now.owner, 1, first_id_ + i, 0, std::hypot(wx, wy), bound};
    }
    return {};
}

StateCheck::Finding StateCheck::first_overlap(const Settled& now) const {
    if (effects_.contact.kind == ContactKind::none) return {}; // they pass through each other
    const bool is_one = scene_.rule == CollisionRule::one;
    const double bound = (is_one ? 1 : 2) * tolerance_ + blur(64);
    std::vector<Suspect> suspects;
    visit_near_pairs(*now.grid, [&](LocalIndex a, LocalIndex b) {
        if (now.population.discs[b].id < now.population.discs[a].id) std::swap(a, b);
        if (a >= now.population.n_own) return; // the rank of the lower id judges the pair
        Disc p = now.population.discs[a], q = now.population.discs[b];
        if (now.periods.are_any()) q.x += now.periods.x_between(p, q), q.y += now.periods.y_between(p, q);
        for (Disc* disc : {&p, &q}) PlainLaw::advance(*disc, now.time);
        const double depth = 2 * scene_.radius - std::hypot(q.x - p.x, q.y - p.y);
        if (depth > bound) suspects.push_back({p, q, depth, bound, 0, communicator_.rank()});
    });
    if (is_one) return first_unexplained(std::move(suspects));
    Finding first;
    for (const Suspect& s : suspects) {
        const Finding next{Invariant::overlap, s.owner, 1, s.p.id, s.q.id, s.depth, bound};
        if (first.is_found == 0 || std::pair(next.disc, next.partner) < std::pair(first.disc, first.partner)) first = next;
    }
    return first;
}

/// The ranks that keep the records of both discs are asked, one after the other, when the disc last had a collision.
StateCheck::Finding StateCheck::first_unexplained(std::vector<Suspect> suspects) const {
    for (const bool is_first : {true, false}) {
        std::vector<std::vector<Suspect>> out(static_cast<std::size_t>(communicator_.size()));
        for (const Suspect& suspect : suspects)
            out[static_cast<std::size_t>(slab_of_disc((is_first ? suspect.p : suspect.q).id))].push_back(suspect);
        suspects = std::move(send_to_owners(communicator_, out).items);
        for (Suspect& suspect : suspects) {
            const std::int64_t free_from = known_[(is_first ? suspect.p : suspect.q).id - first_id_].free_from;
            suspect.free_from = is_first ? free_from : std::max(free_from, suspect.free_from);
        }
    }
    Finding first;
    for (const Suspect& s : suspects) {
        const auto back = static_cast<double>(s.free_from - micro_steps_done_);
        const double dx = (s.q.x - s.p.x) + (s.q.vx - s.p.vx) * back, dy = (s.q.y - s.p.y) + (s.q.vy - s.p.vy) * back;
        const double gap = std::hypot(dx, dy) - 2 * scene_.radius;
        if (gap <= blur(8 * (1 + n_syncs_since(s.free_from)))) continue; // they were not apart yet, or their contact falls on that time
        const Finding next{Invariant::overlap, s.owner, 1, s.p.id, s.q.id, s.depth, s.bound};
        if (first.is_found == 0 || std::pair(next.disc, next.partner) < std::pair(first.disc, first.partner)) first = next;
    }
    return first;
}

StateCheck::Finding StateCheck::first_other_energy(std::span<const Disc> own, Log log) {
    std::vector<SharedEnergy> mine, all;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        if (known_[i].walls + known_[i].pairs == 0) continue;
        mine.push_back(shared_energy_of(i));
    }
    std::vector<std::pair<DiscId, DiscId>> pairs;
    stream_to_root(communicator_, mine, [&](std::span<const SharedEnergy> some) { all.insert(all.end(), some.begin(), some.end()); }, 10000);
    stream_to_root(communicator_, log, [&](Log some) {
        for (const Collision& c : some) {
            if (c.q != Collision::wall) pairs.emplace_back(c.p, c.q);
        }
    }, 10000);
    Finding finding;
    if (communicator_.is_root()) {
        if (const auto worst = worst_energy_change(all, pairs, may_lose_energy_)) finding = {Invariant::energy, 0, 1, worst->disc, 0, worst->share, worst->bound};
    }
    const Finding of_all = first_other_total(own, mine);
    if (finding.is_found == 0) finding = of_all;
    if (finding.is_found == 1) finding.rank = -1; // known to the rank that keeps the record
    return finding;
}

/// Of all discs together, since the check began; since the last look where effects take or give energy. **Collective.**
StateCheck::Finding StateCheck::first_other_total(std::span<const Disc> own, const std::vector<SharedEnergy>& mine) {
    if (walls_give_energy_) return {};
    const double n = static_cast<double>(scene_.n_discs);
    const double bound = energy_bound + energy_bound_per_collision * (2 * static_cast<double>(n_pair_collisions_) / n);
    const double energy = energy_of(own);
    double expected = energy_, scale = energy_, allowed = bound * energy_;
    if (scene_.effects.are_any()) {
        double gain = 0; // of few discs, if any: rounding has no say
        for (const Known& known : known_) gain += resting_gain(known);
        const double k = static_cast<double>(scene_.micro_steps);
        const double fall = std::fabs(effects_.gravity.x) + std::fabs(effects_.gravity.y);
        expected = energy_ * energy_left();
        scale = energy_ + n * k * k * fall * scene_.box_size;
        allowed = bound * scale + n * k * k * communicator_.max(gain);
        energy_ = energy;
    }
    const double drift = may_lose_energy_ ? energy - expected : std::fabs(energy - expected);
    if (!(scale > 0) || drift <= allowed) return {};
    // Nobody in particular: the lowest disc that collided.
    return {Invariant::energy, 0, known_.empty() ? 0 : 1, mine.empty() ? first_id_ : mine.front().disc, 0, drift / scale, allowed / scale};
}

/// A disc's energy before and after, with what effects explain taken out.
SharedEnergy StateCheck::shared_energy_of(std::size_t i) const {
    const Known& known = known_[i];
    SharedEnergy energy = {first_id_ + i, twice_energy(before_[i].disc) * energy_left(), twice_energy(known.disc)};
    energy.allowance = resting_gain(known);
    if (effects_.drag != 0) energy.allowance += energy_bound * energy.before;
    if (walls_give_energy_ && known.walls > 0) energy.allowance = std::numeric_limits<double>::infinity();
    return energy;
}

/// Under gravity with that of height, counted from far enough below that roundings of places are small against it.
double StateCheck::twice_energy(const Disc& seen) const {
    const double square = squared_speed(seen);
    if (!effects_.gravity.is_any()) return square;
    const double clock = seen.tau; // as it was seen
    const auto height = [this](double place, double pull) { return (pull < 0 ? place : -place) + 2 * scene_.box_size; };
    return square + 2 * (std::fabs(effects_.gravity.x) * height(seen.x_at(clock), effects_.gravity.x) +
                         std::fabs(effects_.gravity.y) * height(seen.y_at(clock), effects_.gravity.y));
}

/// The guard of discs at rest: one that is pulled to a wall leaves it with half of what gravity gives in a contact time, at least.
double StateCheck::resting_gain(const Known& known) const {
    const double leaving = 0.5 * std::max(std::fabs(effects_.gravity.x), std::fabs(effects_.gravity.y)) * effects_.contact.contact_time;
    return 1.01 * leaving * leaving * static_cast<double>(known.walls);
}

/// Of the energy, but for what collisions take; under gravity drag takes an amount that depends on the flight, and this is at most what is left.
double StateCheck::energy_left() const { return effects_.gravity.is_any() ? 1 : slowing() * slowing(); }

double StateCheck::slowing() const { return effects_.drag == 0 ? 1 : std::exp(-effects_.drag * stretch()); }

double StateCheck::n_syncs_since(std::int64_t micro_step) const {
    return static_cast<double>(micro_steps_done_ / scene_.sync_every - micro_step / scene_.sync_every);
}

/// Where effects make discs faster, what is known of the fastest grows with them. **Collective.**
void StateCheck::note_speeds() {
    if (!scene_.effects.are_any()) return;
    double square = 0;
    for (const Known& known : known_) square = std::max(square, squared_speed(known.disc));
    fastest_ = std::max(fastest_, std::sqrt(communicator_.max(square)));
}

/// In the scene's units; with effects as the box sees the discs, height included.
double StateCheck::energy_of(std::span<const Disc> own) const {
    Totals totals;
    totals.n_discs = scene_.n_discs;
    std::vector<Disc> seen;
    if (scene_.effects.are_any()) {
        for (const Known& known : known_) seen.push_back(known.disc);
        own = seen;
    }
    measure_motion(own, nullptr, static_cast<double>(scene_.micro_steps), communicator_, totals);
    if (effects_.gravity.is_any()) measure_height(own, nullptr, scene_.effects.gravity, scene_.box_size, communicator_, totals);
    return totals.kinetic_energy + totals.potential_energy;
}

int StateCheck::slab_of_disc(DiscId id) const { return slab_of(id, scene_.n_discs, communicator_.size()); }

double StateCheck::blur(double n_ulps) const {
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    const double time = ulp * static_cast<double>(scene_.sync_every); // the rounding of a time just before a sync
    return n_ulps * ulp * scene_.box_size + 2 * fastest_ * time;
}

} // namespace carrom
