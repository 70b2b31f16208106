// SPDX-License-Identifier: BSD-3-Clause
// Checks of motion and energy: of a disc between its collisions, of discs that a
// step's collisions link, and of all discs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "check/shared_energy.hpp"
#include "check/state_check.hpp"
#include "dynamics/contact_guard.hpp"
#include "dynamics/drag.hpp"
#include "engine/state_sums.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

/// Relative bounds on speeds that falling and slowing down change from sync to sync.
constexpr double motion_bound = 1e-13;
constexpr double energy_bound = 1e-12;
constexpr double energy_bound_per_collision = 32 * 0x1p-53;

} // namespace

Finding StateCheck::first_other_motion() const {
    if (were_rewritten()) return {};
    const bool is_free = !effects_.gravity.is_any() &&
                         effects_.drag == 0; // nothing rewrites velocities then
    const double left = slowing(),
                 time = effects_.drag == 0 ? stretch() : drag_clock(effects_.drag, stretch());
    const double gained = std::hypot(effects_.gravity.x, effects_.gravity.y) *
                          (time + static_cast<double>(scene_.sync_every));
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Known& now = known_[i];
        const DiscState &disc = now.disc, &then = before_[i].disc;
        if (now.pairs == 0 && !(surfaces_rub_ && now.walls > 0) &&
            now.spin != before_[i].spin) // `partner` says that it is the spin
            return {Invariant::motion,
                    now.owner,
                    first_id_ + i,
                    std::fabs(now.spin - before_[i].spin),
                    0,
                    1};
        if (now.walls + now.pairs > 0) continue;
        const double seam = effects_.periods(scene_.box).speed;
        double wx = disc.vx - (then.vx * left + effects_.gravity.x * time);
        const double wy = disc.vy - (then.vy * left + effects_.gravity.y * time);
        if (seam != 0) // a disc is shown with the velocity of its image in the box
            wx += seam * std::round((then.y + then.vy * time - disc.y) / scene_.box.y);
        const double bound = seam != 0 ? motion_bound *
                                             (std::sqrt(squared_speed_of(then)) + std::fabs(seam))
                             : is_free ? 0
                                       : motion_bound * (1 + n_syncs_since(micro_steps_before_)) *
                                             (std::sqrt(squared_speed_of(then)) + gained);
        if (!(std::fabs(wx) <= bound && std::fabs(wy) <= bound))
            return {Invariant::motion, now.owner, first_id_ + i, std::hypot(wx, wy), bound};
    }
    return {};
}

Finding StateCheck::first_other_energy(std::span<const DiscState> own, Log log) {
    std::vector<SharedEnergy> mine, all;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        if (known_[i].walls + known_[i].pairs == 0) continue;
        mine.push_back(shared_energy_of(i));
    }
    std::vector<std::pair<DiscId, DiscId>> pairs;
    stream_to_root(
        communicator_, mine,
        [&](std::span<const SharedEnergy> some) {
            all.insert(all.end(), some.begin(), some.end());
        },
        10000);
    stream_to_root(
        communicator_, log,
        [&](Log some) {
            for (const Collision& c : some) {
                if (c.q != Collision::wall) pairs.emplace_back(c.p, c.q);
            }
        },
        10000);
    Finding finding;
    if (communicator_.is_root()) {
        if (const auto worst = worst_energy_change(all, pairs, may_lose_energy_))
            finding = {Invariant::energy, 0, worst->disc, worst->share, worst->bound};
    }
    const Finding of_all = first_other_total(own, mine);
    if (finding.is_found == 0) finding = of_all;
    if (finding.is_found == 1) finding.rank = -1; // the rank that keeps the record found it
    return finding;
}

/// Checks all discs together since the check began; since the last check if effects
/// take or give energy. **Collective.**
Finding StateCheck::first_other_total(std::span<const DiscState> own,
                                      const std::vector<SharedEnergy>& mine) {
    if (walls_give_energy_ || effects_.growth != 0) return {};
    const double n = static_cast<double>(scene_.n_discs);
    const double bound = energy_bound + energy_bound_per_collision *
                                            (2 * static_cast<double>(n_pair_collisions_) / n);
    const double energy = energy_of(own);
    double expected = energy_, scale = energy_, allowed = bound * energy_;
    if (scene_.effects.are_any()) {
        double gain = 0; // few discs add to it, so rounding does not matter
        for (const Known& known : known_) gain += resting_gain(known);
        const double k = static_cast<double>(scene_.micro_steps);
        const double fall = std::fabs(effects_.gravity.x) + std::fabs(effects_.gravity.y);
        expected = energy_ * energy_left();
        double of_rounds = 0;
        for (std::size_t i = 0; i < known_.size(); ++i) of_rounds += energy_of_rounds(i);
        for (const double part : communicator_.all_gather(of_rounds)) expected += k * k * part;
        if (effects_.are_sheared())
            for (const double work : communicator_.all_gather(work_of_images_))
                expected += k * k * work;
        if (were_rewritten()) {
            double given = 0;
            for (const double part : communicator_.all_gather(energy_given_ - energy_given_before_))
                given += part;
            expected += k * k * given;
        }
        scale = (were_rewritten() ? std::max(energy_, energy) : energy_) +
                total_mass_ * k * k * fall * scene_.box.longest();
        allowed = bound * scale + n * k * k * communicator_.max(gain) + k * k * work_of_walls();
        energy_ = energy;
    }
    const double drift = may_lose_energy_ ? energy - expected : std::fabs(energy - expected);
    if (!(scale > 0) || drift <= allowed || known_.empty() || std::isinf(expected)) return {};
    // Nobody in particular: the lowest disc that collided.
    return {Invariant::energy, 0, mine.empty() ? first_id_ : mine.front().disc, drift / scale,
            allowed / scale};
}

/// A disc's energy before and after, without what effects explain.
SharedEnergy StateCheck::shared_energy_of(std::size_t i) const {
    const Known& known = known_[i];
    SharedEnergy energy = {first_id_ + i, twice_energy(before_[i]) * energy_left(),
                           twice_energy(known)};
    energy.allowance = resting_gain(known) + 2 * work_of_walls(known);
    energy.before += 2 * energy_of_rounds(i);
    if (effects_.growth != 0) { // surfaces are where they should be but for rounding
        energy.before += 2 * known.work;
        energy.allowance += 2 * known.work * blur(64) / species_.of(energy.disc).radius;
    }
    if (obstacles_ || surfaces_rub_) energy.n_reflections = static_cast<double>(known.walls);
    if (effects_.drag != 0) energy.allowance += energy_bound * energy.before;
    if ((walls_give_energy_ && known.walls > 0) || may_have_met_seam(i) || were_rewritten())
        energy.allowance = std::numeric_limits<double>::infinity();
    return energy;
}

/// Images beyond the seam give energy to discs that collide with them, and discs that come through
/// it are shown with another velocity. What all discs get together is checked (first_other_total);
/// what each gets is not. Collisions may make a disc faster for a part of a step: four times as
/// fast as any is at its ends.
bool StateCheck::may_have_met_seam(std::size_t i) const {
    if (!effects_.are_sheared()) return false;
    const double near = 4 * fastest_up_ * stretch() + 2 * scene_.radius;
    const auto is_near = [&](double y) { return y < near || y > scene_.box.y - near; };
    return is_near(before_[i].disc.y) || is_near(known_[i].disc.y);
}

/// Distances of surfaces grow at a constant rate.
double StateCheck::work_of(const Collision& collision) const {
    if (effects_.growth == 0) return 0;
    const double radii = species_.of(collision.p).radius +
                         (collision.q == Collision::wall ? 0 : species_.of(collision.q).radius);
    return collision.impulse / static_cast<double>(scene_.micro_steps) * (effects_.growth * radii);
}

/// Where effects make discs faster, what is known of the fastest grows with them. **Collective.**
void StateCheck::note_speeds() {
    if (!scene_.effects.are_any()) return;
    double square = 0;
    for (const Known& known : known_) square = std::max(square, squared_speed_of(known.disc));
    if (effects_.are_sheared()) {
        double up = 0;
        for (const std::vector<Known>* inspected : {&before_, &known_})
            for (const Known& known : *inspected) up = std::max(up, std::fabs(known.disc.vy));
        fastest_up_ = communicator_.max(up);
    }
    fastest_ = std::max(fastest_, std::sqrt(communicator_.max(square)) + wall_speed_);
}

/// With potential energy under gravity, counted from far enough below that the
/// rounding of places is small against it.
double StateCheck::twice_energy(const Known& known) const {
    const DiscState& seen = known.disc;
    const SizeAndMass& body = species_.of(seen.id);
    const double turning = body.radius * known.spin,
                 square = squared_speed_of(seen) + effects_.contact.inertia * turning * turning;
    if (!effects_.gravity.is_any()) return body.mass * square;
    const double clock = seen.tau; // the disc's own time
    const auto height = [this](double place, double pull) {
        return (pull < 0 ? place : -place) + 2 * scene_.box.longest();
    };
    return body.mass *
           (square +
            2 * (std::fabs(effects_.gravity.x) * height(seen.x_at(clock), effects_.gravity.x) +
                 std::fabs(effects_.gravity.y) * height(seen.y_at(clock), effects_.gravity.y)));
}

/// Under gravity along periodic sides: what a disc's height, counted in the box, has gained where
/// it went round. That a disc flies less than a quarter of the box between two inspections tells
/// how often it did; otherwise nothing is known, and the number is infinite.
double StateCheck::energy_of_rounds(std::size_t i) const {
    const DiscState &then = before_[i].disc, &now = known_[i].disc;
    const Periods periods = effects_.periods(scene_.box);
    double energy = 0;
    const auto add = [&](double g, double period, double from, double to, double v, double w) {
        if (g == 0 || period == 0) return;
        const double gone = (v + w) / 2 * stretch();
        if (std::max(std::fabs(v), std::fabs(w)) * stretch() > period / 4)
            energy = std::numeric_limits<double>::infinity();
        else
            energy += g * period * std::round((from + gone - to) / period);
    };
    add(effects_.gravity.x, periods.x, then.x, now.x, then.vx, now.vx);
    add(effects_.gravity.y, periods.y, then.y, now.y, then.vy, now.vy);
    return mass_of(now.id) * energy;
}

/// A disc that is pulled to a wall leaves it with a least speed (ContactGuard::least_departure).
double StateCheck::resting_gain(const Known& known) const {
    const double pull = std::max(std::fabs(effects_.gravity.x), std::fabs(effects_.gravity.y));
    const SizeAndMass& body = species_.of(known.disc.id);
    const double leaving =
        ContactGuard(effects_, body.radius).least_departure(pull + wall_pull_, body.radius);
    return 1.01 * body.mass * leaving * leaving * static_cast<double>(known.walls);
}

/// The most that oscillating walls have given, or taken. A disc that comes with v and
/// leaves with v' gets m (v' - v) (v' + v) / 2. Seen from the wall it leaves no faster
/// than it came, so this is the impulse times the wall's speed, less what the
/// restitution takes. The guard of discs at rest is in resting_gain.
double StateCheck::work_of_walls(const Known& known) const {
    return 1.01 * wall_speed_ * known.wall_impulse / static_cast<double>(scene_.micro_steps);
}

/// Summed over all discs. **Collective.**
double StateCheck::work_of_walls() const {
    if (wall_speed_ == 0) return 0;
    double work = 0;
    for (const Known& known : known_) work += work_of_walls(known);
    double sum = 0;
    for (const double part : communicator_.all_gather(work)) sum += part;
    return sum;
}

double StateCheck::slowing() const {
    return effects_.drag == 0 ? 1 : std::exp(-effects_.drag * stretch());
}

/// The share of energy that drag leaves. Under gravity the loss depends on the flight,
/// and this is the most that is left.
double StateCheck::energy_left() const {
    return effects_.gravity.is_any() ? 1 : slowing() * slowing();
}

/// In the scene's units. With effects the discs are as the box sees them, with potential energy.
double StateCheck::energy_of(std::span<const DiscState> own) const {
    Totals totals;
    totals.n_discs = scene_.n_discs;
    DiscStates seen;
    std::vector<double> spins;
    if (scene_.effects.are_any()) {
        for (const Known& known : known_) {
            seen.push_back(known.disc);
            spins.push_back(known.spin);
        }
        // Between sheared sides a sync changes stored states, and the engine knows the difference.
        if (!effects_.are_sheared()) own = seen;
    }
    const SpeciesTable* const species_table = effects_.species.empty() ? nullptr : &species_;
    const auto unit = static_cast<double>(scene_.micro_steps);
    measure_motion(own, species_table, unit, communicator_, totals);
    if (effects_.have_spins())
        measure_rotation(seen, spins, species_, effects_.contact.inertia, unit, communicator_,
                         totals);
    if (effects_.gravity.is_any())
        measure_height(own, species_table, scene_.effects.gravity, scene_.box, communicator_,
                       totals);
    return totals.kinetic_energy + totals.rotational_energy + totals.potential_energy;
}

} // namespace carrom
