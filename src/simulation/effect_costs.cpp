// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/simulation/effect_costs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <time.h>

#include "carrom/effects/obstacles.hpp"
#include "carrom/scene/lattice.hpp"
#include "carrom/simulation/initial_state.hpp"
#include "carrom/simulation/simulation.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t fewest_discs = 500, most_discs = 16000;
constexpr int n_rounds = 5; ///< that count; one goes before

/// The effects one by one. What a new effect is called, and what of it stands alone, is a line here.
std::vector<Effects> single_effects(const Effects& all) {
    std::vector<Effects> singles;
    const auto add = [&singles](auto&& set) { set(singles.emplace_back()); };
    if (all.contact.kind != ContactKind::elastic) add([&](Effects& one) { one.contact = all.contact; });
    for (std::size_t k = 0; k < all.sides.size(); ++k)
        if (!all.sides[k].is_plain() && all.sides[k].kind != SideKind::periodic)
            add([&](Effects& one) {
                one.sides[k] = all.sides[k];
                one.thermal_seed = all.thermal_seed;
            });
    for (const std::size_t low : {0u, 2u}) // one side alone is not periodic
        if (all.sides[low].kind == SideKind::periodic)
            add([&](Effects& one) {
                one.sides[low] = all.sides[low];
                one.sides[low + 1] = all.sides[low + 1];
            });
    if (all.gravity.is_any()) add([&](Effects& one) { one.gravity = all.gravity; });
    if (!all.classes.empty()) add([&](Effects& one) { one.classes = all.classes; });
    if (all.obstacles.are_any()) add([&](Effects& one) { one.obstacles = all.obstacles; });
    if (all.drag != 0) add([&](Effects& one) { one.drag = all.drag; });
    return singles;
}

/// Two scenes of as many discs, as dense and as fast; the same discs in the same places unless they are of several sizes.
struct Sample {
    Scene with, without;
    std::vector<InputDisc> discs, discs_without;
    std::int64_t steps = 1; ///< of a round
    double scale = 1;       ///< its box over the scene's
};

double extra_bytes(const Effects& one) {
    if (one.contact.kind == ContactKind::rough) return sizeof(double); // the spin
    return one.classes.size() > 8 ? 16 : 0;                            // what the law keeps of each disc (disc_classes.hpp), on each rank
}

/// Whether there are single sides and nothing else.
bool is_at_sides(const Effects& one) { return !one.have_plain_sides() && !one.are_periodic(); }

/// As many of each class as there are among `n` discs of `n_all`, ids in the same order.
std::vector<DiscClass> thinned(const std::vector<DiscClass>& classes, std::uint64_t n, std::uint64_t n_all) {
    std::vector<DiscClass> fewer;
    std::uint64_t n_seen = 0, n_taken = 0;
    for (const DiscClass& one : classes) {
        n_seen += one.count;
        const auto n_due = static_cast<std::uint64_t>(static_cast<double>(n) * (static_cast<double>(n_seen) / static_cast<double>(n_all)) + 0.5);
        if (n_due > n_taken) fewer.push_back({n_due - n_taken, one.radius, one.mass});
        n_taken = std::max(n_taken, n_due);
    }
    return fewer;
}

/// The obstacles whose centres lie in one of the squares of side `size` that fit into the box, moved to the origin: those of
/// the square that has most nearly as many as the mean.
ObstacleList part_of(const ObstacleList& all, double box_size, double size) {
    const auto n_squares = static_cast<std::size_t>(std::max(1.0, std::floor(box_size / size * (1 + 1e-9))));
    std::vector<ObstacleList> parts(n_squares * n_squares);
    const auto square = [&](double x, double y) {
        const auto row = [&](double at) { return static_cast<std::size_t>(std::clamp(at / size, 0.0, static_cast<double>(n_squares - 1))); };
        return row(x) * n_squares + row(y);
    };
    const auto x_of = [&](std::size_t k) { return static_cast<double>(k / n_squares) * size; };
    const auto y_of = [&](std::size_t k) { return static_cast<double>(k % n_squares) * size; };
    for (const FixedDisc& disc : all.discs) {
        const std::size_t k = square(disc.x, disc.y);
        parts[k].discs.push_back({disc.x - x_of(k), disc.y - y_of(k), disc.radius});
    }
    for (const Segment& line : all.segments) {
        const std::size_t k = square((line.x0 + line.x1) / 2, (line.y0 + line.y1) / 2);
        parts[k].segments.push_back({line.x0 - x_of(k), line.y0 - y_of(k), line.x1 - x_of(k), line.y1 - y_of(k)});
    }
    const auto count = [](const ObstacleList& part) { return static_cast<double>(part.discs.size() + part.segments.size()); };
    const double mean = count(all) / static_cast<double>(parts.size());
    ObstacleList typical = *std::min_element(parts.begin(), parts.end(), [&](const ObstacleList& a, const ObstacleList& b) {
        return std::fabs(count(a) - mean) < std::fabs(count(b) - mean);
    });
    typical.restitution = all.restitution;
    return typical;
}

/// Discs that are clear of all obstacles, numbered anew.
void keep_clear(const Scene& scene, std::vector<InputDisc>& discs) {
    const Obstacles obstacles(scene.box_size, scene.radius, scene.effects);
    std::erase_if(discs, [&](const InputDisc& disc) { return obstacles.deepest_overlap(disc.x, disc.y, scene.radius, 0).body != ObstacleContact::no_body; });
    for (std::size_t i = 0; i < discs.size(); ++i) discs[i].id = i;
}

/// Root mean square of velocities per step.
double speed_of(const Scene& scene, double kinetic_energy) {
    double mass = scene.effects.classes.empty() ? static_cast<double>(scene.n_discs) : 0;
    for (const DiscClass& one : scene.effects.classes) mass += static_cast<double>(one.count) * one.mass;
    return std::sqrt(2 * kinetic_energy / mass);
}

/// What the discs and gravity need of a box from sync to sync: it is not to be crossed thousands of times (core/image.hpp), nor fallen through.
bool has_room(const Scene& part) {
    const double time = static_cast<double>(part.sync_every) / static_cast<double>(part.micro_steps);
    const double fall = 0.5 * std::hypot(part.effects.gravity.x, part.effects.gravity.y) * time * time;
    return part.speed * time < 500 * part.box_size && fall <= 0.5 * part.box_size;
}

/// Whether discs of one size fit on a lattice, and those of several can be inserted at random for sure.
bool has_places(const Scene& part) {
    constexpr double random_packing = 0.4;
    if (part.generator == Generator::lattice) return widest_lattice(part.n_discs, part.box_size, part.radius).has_value();
    return part.packing() < random_packing && part.box_size > 6 * part.radius;
}

/// Nothing where the scene does not allow a small one.
std::optional<Sample> sample_of(const Scene& scene, const Effects& one, const CostsOfRun& run, double disc_steps, const Communicator& alone) {
    Sample sample;
    const auto wanted = static_cast<std::uint64_t>(std::clamp(disc_steps / 4, static_cast<double>(fewest_discs), static_cast<double>(most_discs)));
    Scene& part = sample.with;
    part.name = scene.name;
    part.n_discs = std::min(scene.n_discs, wanted);
    sample.scale = std::sqrt(static_cast<double>(part.n_discs) / static_cast<double>(scene.n_discs));
    part.box_size = scene.box_size * sample.scale;
    part.radius = scene.radius;
    part.generator = Generator::lattice;
    part.speed = speed_of(scene, run.kinetic_energy);
    part.rule = scene.rule;
    part.micro_steps = scene.micro_steps;
    part.sync_every = scene.sync_every;
    part.effects = one;
    sample.steps = std::max<std::int64_t>(1, static_cast<std::int64_t>(disc_steps / static_cast<double>(part.n_discs)));
    part.steps = sample.steps * (n_rounds + 1);
    if (!has_room(part)) return {};
    if (!one.classes.empty()) {
        part.effects.classes = thinned(one.classes, part.n_discs, scene.n_discs);
        part.generator = Generator::random;
    }
    if (one.obstacles.are_any()) {
        part.effects.obstacles = part_of(one.obstacles, scene.box_size, part.box_size);
        if (!part.effects.obstacles.are_any()) return {}; // few and far between
    }
    while (!has_places(part)) part.box_size *= 1.02;
    for (Side& side : part.effects.sides) { // a wall does not get far in so few steps
        const double farthest = 0.05 * part.box_size / static_cast<double>(part.steps);
        side.speed = std::clamp(side.speed, -farthest, farthest);
    }
    sample.discs = initial_state(part, nullptr, alone);
    if (one.obstacles.are_any()) keep_clear(part, sample.discs);
    if (sample.discs.empty()) return {};
    part.n_discs = sample.discs.size();
    sample.without = part;
    sample.without.effects = {};
    sample.discs_without = sample.discs;
    if (!one.classes.empty()) { // as many equal discs that cover as much
        sample.without.radius = part.box_size * std::sqrt(part.packing() / (std::numbers::pi * static_cast<double>(part.n_discs)));
        sample.without.generator = Generator::lattice;
        sample.discs_without = initial_state(sample.without, nullptr, alone);
    }
    return sample;
}

/// Of this thread: what other programs take is not in it.
double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_to(Simulation& simulation, std::int64_t step) {
    const double begin = thread_seconds();
    while (simulation.step() < step) simulation.advance_towards(step);
    return thread_seconds() - begin;
}

/// Median of the rounds' ratios.
double ratio_of_times(const Sample& sample, const Communicator& alone) {
    Simulation with(sample.with, sample.discs, alone, {}), without(sample.without, sample.discs_without, alone, {});
    std::array<double, n_rounds> ratios{};
    for (int round = 0; round <= n_rounds; ++round) {
        const std::int64_t step = (round + 1) * sample.steps;
        const double seconds = seconds_to(with, step), plain_seconds = seconds_to(without, step);
        if (round > 0) ratios[static_cast<std::size_t>(round - 1)] = seconds / std::max(plain_seconds, 1e-9);
    }
    std::sort(ratios.begin(), ratios.end());
    return ratios[n_rounds / 2];
}

std::optional<double> time_ratio(const Scene& scene, const Effects& one, const CostsOfRun& run, double budget, const Communicator& alone) {
    const double disc_steps = budget / (2 * (n_rounds + 1) * run.seconds_per_disc_step);
    if (disc_steps < 0.1 * static_cast<double>(std::min(scene.n_discs, fewest_discs))) return {};
    const auto sample = sample_of(scene, one, run, disc_steps, alone);
    if (!sample) return {};
    const double ratio = ratio_of_times(*sample, alone);
    return is_at_sides(one) ? 1 + (ratio - 1) * sample->scale : ratio;
}

} // namespace

std::vector<EffectCost> effect_costs(const Scene& scene, const CostsOfRun& run) {
    const Communicator alone = Communicator::of_this_rank();
    const std::vector<Effects> singles = single_effects(scene.effects);
    std::vector<EffectCost> costs;
    double whole = 1;
    for (const Effects& one : singles) {
        EffectCost& cost = costs.emplace_back();
        cost.name = description(one);
        cost.time_ratio = time_ratio(scene, one, run, run.budget / static_cast<double>(singles.size()), alone);
        cost.time_share = std::max(0.0, cost.time_ratio.value_or(1) - 1);
        cost.bytes_per_disc = extra_bytes(one);
        whole += cost.time_share;
    }
    for (EffectCost& cost : costs) cost.time_share /= whole;
    return costs;
}

} // namespace carrom
