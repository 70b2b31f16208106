// SPDX-License-Identifier: BSD-3-Clause
// Checks the motion and energy of single discs between collisions, the energy of groups of discs
// that a step's collisions link, and the energy of all discs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "check/shared_energy.hpp"
#include "check/state_check.hpp"
#include "dynamics/contact_guard.hpp"
#include "dynamics/falling_frame.hpp"
#include "engine/state_sums.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

/// Relative bounds of the errors of speeds and energies.
constexpr double motion_bound = 1e-13;
constexpr double energy_bound = 1e-12;
constexpr double energy_bound_per_collision = 32 * 0x1p-53;

} // namespace

Finding StateCheck::find_velocity_change() const {
    if (were_rewritten()) return {};
    const bool is_free = effects_.are_flights_free(); // flights without effects keep velocities
    const FallingFrame flight(effects_);
    const double time = flight.clock_at(stretch()), left = flight.slowing_at(time);
    const Acceleration& pull = flight.acceleration();
    const double gained = pull.largest() * (time + static_cast<double>(scene_.sync_every));
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Known& now = known_[i];
        const DiscState &disc = now.disc, &then = before_[i].disc;
        if (was_outside(i)) continue;
        if (now.pairs == 0 && !(surfaces_rub_ && now.walls > 0) &&
            now.spin != before_[i].spin) // `partner` is 1 if the spin has changed
            return {Invariant::motion,
                    now.owner,
                    first_id_ + i,
                    std::fabs(now.spin - before_[i].spin),
                    0,
                    1};
        if (now.walls + now.pairs > 0) continue;
        const double seam = effects_.periods(scene_.box).speed;
        double wx = disc.vx - (then.vx * left + pull.x * time + swayed_[0].speed);
        const double wy = disc.vy - (then.vy * left + pull.y * time + swayed_[1].speed);
        if (seam != 0) // a disc that has crossed the seam has its image's velocity
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
    // The owner is unknown here, because the ranks that keep the records check the energy.
    if (finding.is_found == 1) finding.rank = -1;
    return finding;
}

/// Compares the energy of all discs with the energy at the check's start, or at the last check if
/// effects take or give energy. **Collective.**
Finding StateCheck::first_other_total(std::span<const DiscState> own,
                                      const std::vector<SharedEnergy>& mine) {
    if (walls_give_energy_ || surfaces_give_energy_) return {};
    // Energy that effects gave at a sync changes until the check: an acceleration that varies in
    // time moves the frame in which it was measured, and drag removes a part of it.
    if (acts_at_syncs_ && (effects_.acceleration().sways() || FallingFrame(effects_).slows()))
        return {};
    const double n = static_cast<double>(scene_.n_discs);
    const double bound = energy_bound + energy_bound_per_collision *
                                            (2 * static_cast<double>(n_pair_collisions_) / n);
    const bool sways = effects_.acceleration().sways();
    const double energy = energy_of(own, sways);
    double expected = energy_, scale = energy_, allowed = bound * energy_;
    if (scene_.effects.are_any()) {
        double gain = 0; // a plain sum is accurate enough, because few discs add to it
        for (const Known& known : known_) gain += resting_gain(known);
        const double k = static_cast<double>(scene_.micro_steps);
        expected = energy_ * energy_left();
        double of_rounds = 0;
        for (std::size_t i = 0; i < known_.size(); ++i) of_rounds += energy_of_way(i);
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
                total_mass_ * (k * k * largest_energy_of_place() + energy_of_flow());
        allowed = bound * scale + n * k * k * communicator_.max(gain) + k * k * work_of_walls();
        energy_ = sways ? energy_of(own) : energy;
    }
    if (have_open_sides_ && have_any_moved()) return {};
    const double drift = may_lose_energy_ ? energy - expected : std::fabs(energy - expected);
    if (!(scale > 0) || drift <= allowed || known_.empty() || std::isinf(expected)) return {};
    // No single disc is the cause. Each rank names the first disc that collided, or its first disc.
    return {Invariant::energy, 0, mine.empty() ? first_id_ : mine.front().disc, drift / scale,
            allowed / scale};
}

/// Whether any disc has departed or returned since the last inspection. **Collective.**
bool StateCheck::have_any_moved() const {
    bool is_any = false;
    for (std::size_t i = 0; i < known_.size(); ++i)
        is_any = is_any || known_[i].departures > 0 || returns_of(i) > 0;
    return communicator_.any(is_any);
}

/// Twice a disc's energy before and after the step, and twice the change that effects can explain.
SharedEnergy StateCheck::shared_energy_of(std::size_t i) const {
    const Known& known = known_[i];
    SharedEnergy energy = {first_id_ + i,
                           twice_energy(before_[i].disc, before_[i].spin) * energy_left(),
                           twice_energy(in_swaying_frame(known.disc), known.spin)};
    energy.allowance = resting_gain(known) + 2 * work_of_walls(known);
    energy.before += 2 * energy_of_way(i);
    if (surfaces_give_energy_) { // work of growing surfaces is exact except for rounding
        energy.before += 2 * known.work;
        energy.allowance += 2 * known.work * blur(64) / species_.of(energy.disc).radius;
    }
    if (fixed_bodies_.are_any() || surfaces_rub_)
        energy.n_reflections = static_cast<double>(known.walls);
    if (FallingFrame(effects_).slows()) energy.allowance += energy_bound * energy.before;
    if ((walls_give_energy_ && known.walls > 0) || may_have_met_seam(i) || were_rewritten() ||
        was_outside(i))
        energy.allowance = std::numeric_limits<double>::infinity();
    return energy;
}

/// Whether a disc may have met an image beyond the seam of sheared sides, or crossed the seam. In
/// a collision an image gives energy to the disc, and a crossing changes the disc's velocity. So
/// this disc's energy is not checked, but the total energy is (first_other_total). Collisions
/// during a step may make a disc up to four times as fast as the fastest disc at the step's start
/// or end.
bool StateCheck::may_have_met_seam(std::size_t i) const {
    if (!effects_.are_sheared()) return false;
    const double near = 4 * fastest_up_ * stretch() + 2 * scene_.radius;
    const auto is_near = [&](double y) { return y < near || y > scene_.box.y - near; };
    return is_near(before_[i].disc.y) || is_near(known_[i].disc.y);
}

double StateCheck::work_of(const Collision& collision) const {
    if (!surfaces_give_energy_) return 0;
    const double radii = species_.of(collision.p).radius +
                         (collision.q == Collision::wall ? 0 : species_.of(collision.q).radius);
    return work_in_collision(effects_, collision.impulse / static_cast<double>(scene_.micro_steps),
                             radii);
}

/// Updates the bounds of speeds, and the motion of the falling frame since the last inspection.
/// Does nothing in scenes without effects. **Collective.**
void StateCheck::record_speeds() {
    if (!scene_.effects.are_any()) return;
    swayed_ = Sway::between(effects_.acceleration(), static_cast<double>(micro_steps_before_),
                            static_cast<double>(micro_steps_done_));
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

/// The largest potential energy of a mass of 1 in the box, without effects that act only at syncs.
double StateCheck::largest_energy_of_place() const {
    double sum = 0;
    for (const OtherEnergy& energy : energies_)
        if (energy.largest) sum += energy.largest(effects_, scene_.box);
    return sum;
}

/// The energy of a mass of 1 at the speed of images beyond the seam of sheared sides. Rounding
/// errors of crossings are relative to this energy, however slow discs are.
double StateCheck::energy_of_flow() const {
    const double speed = effects_.are_sheared() ? scene_.effects.shear * scene_.box.y : 0;
    return speed * speed / 2;
}

double StateCheck::other_energy(const DiscState& seen, double spin) const {
    double sum = 0;
    for (const OtherEnergy& energy : energies_)
        sum += energy.of_disc({seen.x, seen.y, seen.vx, seen.vy, spin, species_.of(seen.id)},
                              effects_, scene_.box);
    return sum;
}

/// Twice a disc's energy. A constant is added to the potential energy, so that bounds relative to
/// the result also allow for rounding errors of the potential energy.
double StateCheck::twice_energy(const DiscState& seen, double spin) const {
    const double mass = mass_of(seen.id);
    return mass * squared_speed_of(seen) +
           2 * (other_energy(seen, spin) + 2 * mass * largest_energy_of_place());
}

DiscState StateCheck::in_swaying_frame(const DiscState& seen) const {
    if (!effects_.acceleration().sways() || seen.has_departed()) return seen;
    DiscState disc = seen;
    disc.x -= swayed_[0].way, disc.y -= swayed_[1].way;
    disc.vx -= swayed_[0].speed, disc.vy -= swayed_[1].speed;
    return disc;
}

/// Energy that a disc gained from effects on its path, except through its potential energy, plus
/// the jump of the potential energy at periodic sides. If the disc moves less than a quarter of the
/// box between two inspections, the number of crossings is known; else the result is infinite.
double StateCheck::energy_of_way(std::size_t i) const {
    if (!depends_on_x_ && !depends_on_y_) return 0;
    const DiscState &then = before_[i].disc, &now = known_[i].disc;
    const Periods periods = effects_.periods(scene_.box);
    DiscState unwrapped = now;
    bool is_known = true;
    const auto unwrap = [&](double period, double from, double& to, double v, double w) {
        if (period == 0) return;
        is_known = is_known && std::max(std::fabs(v), std::fabs(w)) * stretch() <= period / 4;
        to += period * std::round((from + (v + w) / 2 * stretch() - to) / period);
    };
    if (depends_on_x_) unwrap(periods.x, then.x, unwrapped.x, then.vx, now.vx);
    if (depends_on_y_) unwrap(periods.y, then.y, unwrapped.y, then.vy, now.vy);
    if (!is_known) return std::numeric_limits<double>::infinity();
    return other_energy(now, 0) - other_energy(unwrapped, 0) +
           work_on_way(effects_, {unwrapped.x - then.x, unwrapped.y - then.y, species_.of(now.id)});
}

/// Twice the energy that a disc may gain by leaving walls with ContactGuard::least_departure. Along
/// the inner face of an arc the curved path adds to the acceleration that presses the disc to it.
double StateCheck::resting_gain(const Known& known) const {
    const Acceleration g = effects_.acceleration();
    const SizeAndMass& body = species_.of(known.disc.id);
    double pull = std::max(g.largest_x(), g.largest_y()) + wall_pull_;
    const double room = tightest_arc_ - body.radius * size_at(micro_steps_done_);
    if (may_lose_energy_ && room > 0)
        pull += 2 * (known.disc.vx * known.disc.vx + known.disc.vy * known.disc.vy) / room;
    const double leaving = ContactGuard(effects_, body.radius).least_departure(pull, body.radius);
    return 1.01 * body.mass * leaving * leaving * static_cast<double>(known.walls);
}

/// The largest energy that vibrating walls may have given to or taken from a disc. A disc that
/// arrives with v and leaves with v' gains m (v' - v) (v' + v) / 2. Relative to the wall it gets no
/// faster, so the gain is at most impulse times wall speed. For discs that rest on a wall
/// resting_gain is added.
double StateCheck::work_of_walls(const Known& known) const {
    return 1.01 * speed_of_walls() * known.wall_impulse / static_cast<double>(scene_.micro_steps);
}

/// The largest speed of walls per micro-step. In a frame that falls with a varying acceleration all
/// walls move.
double StateCheck::speed_of_walls() const {
    const Acceleration g = effects_.acceleration();
    if (!g.sways()) return wall_speed_;
    const double amplitude = std::hypot(g.amplitude_x, g.amplitude_y);
    return wall_speed_ + amplitude * std::min(stretch(), g.period / std::numbers::pi);
}

/// The sum of the work of walls over the discs of all ranks. **Collective.**
double StateCheck::work_of_walls() const {
    if (speed_of_walls() == 0) return 0;
    double work = 0;
    for (const Known& known : known_) work += work_of_walls(known);
    double sum = 0;
    for (const double part : communicator_.all_gather(work)) sum += part;
    return sum;
}

double StateCheck::energy_left() const { return energy_left_by(effects_, stretch()); }

/// The total energy, in the scene's units. With effects it uses discs in the box's coordinates.
double StateCheck::energy_of(std::span<const DiscState> own, bool in_swaying_frame) const {
    Totals totals;
    totals.n_discs = scene_.n_discs;
    DiscStates seen;
    std::vector<double> spins;
    if (scene_.effects.are_any()) {
        for (const Known& known : known_) {
            seen.push_back(in_swaying_frame ? this->in_swaying_frame(known.disc) : known.disc);
            spins.push_back(known.spin);
        }
        // With sheared sides a sync changes stored velocities, and the engine has summed this
        // change of energy. So the stored states are used here.
        if (!effects_.are_sheared()) own = seen;
    }
    const SpeciesTable* const species_table = effects_.species.empty() ? nullptr : &species_;
    const auto unit = static_cast<double>(scene_.micro_steps);
    measure_motion(own, species_table, unit, communicator_, 1, totals);
    measure_other_energies(energies_, seen, spins, species_, {scene_.effects, scene_.box, unit},
                           communicator_, totals);
    return totals.energy();
}

} // namespace carrom
