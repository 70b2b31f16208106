// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/effect_costs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <time.h>

#include "dynamics/obstacles.hpp"
#include "initial_state/initial_state.hpp"
#include "scene/lattice.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t fewest_discs = 500, most_discs = 16000;
constexpr int n_rounds = 5; ///< that count; one goes before
constexpr double meetings_in_sample =
    2; ///< of a disc, so that its effect does not change what the gas is like
constexpr std::int64_t no_last_step = std::int64_t{1} << 40;

/// The effects one by one. What a new effect is called, and what of it stands alone, is a line
/// here.
std::vector<Effects> single_effects(const Effects& all) {
    std::vector<Effects> singles;
    const auto add = [&](auto&& set) {
        Effects& one = singles.emplace_back();
        one.contact.contact_time =
            all.contact.contact_time; // the guard of walls, obstacles and gravity too
        set(one);
    };
    if (all.contact.kind != ContactKind::elastic)
        add([&](Effects& one) { one.contact = all.contact; });
    for (std::size_t k = 0; k < all.boundaries.size(); ++k)
        if (!all.boundaries[k].is_plain() && all.boundaries[k].kind != BoundaryKind::periodic)
            add([&](Effects& one) {
                one.boundaries[k] = all.boundaries[k];
                one.thermal_seed = all.thermal_seed;
            });
    for (const std::size_t low : {0u, 2u}) // one side alone is not periodic
        if (all.boundaries[low].kind == BoundaryKind::periodic)
            add([&](Effects& one) {
                one.boundaries[low] = all.boundaries[low];
                one.boundaries[low + 1] = all.boundaries[low + 1];
            });
    if (all.gravity.is_any()) add([&](Effects& one) { one.gravity = all.gravity; });
    if (!all.species.empty()) add([&](Effects& one) { one.species = all.species; });
    if (all.obstacles.are_any()) add([&](Effects& one) { one.obstacles = all.obstacles; });
    if (all.drag != 0) add([&](Effects& one) { one.drag = all.drag; });
    return singles;
}

/// Two scenes of as many discs, as dense and as fast; the same discs in the same places unless they
/// are of several sizes.
struct Sample {
    Scene with, without;
    std::vector<InputDisc> discs, discs_without;
    double share = 1; ///< what the effect costs a disc of the scene, of what it costs one of these
    std::int64_t longest_round = 1; ///< in steps
};

double extra_bytes(const Effects& one) {
    if (one.contact.kind == ContactKind::rough) return sizeof(double); // the spin
    return one.species.size() > 8
               ? 16
               : 0; // what the law keeps of each disc (disc_classes.hpp), on each rank
}

/// Whether there are single sides and nothing else.
bool is_at_sides(const Effects& one) { return !one.have_plain_boundaries() && !one.are_periodic(); }

/// As many of each class as there are among `n` discs of `n_all`, ids in the same order.
std::vector<Species> thinned(const std::vector<Species>& species, std::uint64_t n,
                             std::uint64_t n_all) {
    std::vector<Species> fewer;
    std::uint64_t n_seen = 0, n_taken = 0;
    for (const Species& one : species) {
        n_seen += one.count;
        const auto n_due = static_cast<std::uint64_t>(
            static_cast<double>(n) * (static_cast<double>(n_seen) / static_cast<double>(n_all)) +
            0.5);
        if (n_due > n_taken) fewer.push_back({n_due - n_taken, one.radius, one.mass});
        n_taken = std::max(n_taken, n_due);
    }
    return fewer;
}

double count(const ObstacleList& list) {
    return static_cast<double>(list.discs.size() + list.segments.size());
}

double largest_size(const ObstacleList& list) {
    double largest = 0;
    for (const FixedDisc& disc : list.discs) largest = std::max(largest, 2 * disc.radius);
    for (const Segment& line : list.segments)
        largest = std::max(largest, std::hypot(line.x1 - line.x0, line.y1 - line.y0));
    return largest;
}

/// The obstacles whose centres lie in one of the squares of side `size` that fit into the box,
/// moved to the origin: those of the square that has most nearly as many as the mean, and some.
ObstacleList part_of(const ObstacleList& all, double box_size, double size) {
    const auto n_squares = static_cast<std::size_t>(
        std::max(1.0, std::floor(box_size / size * (1 + 1e-9))));
    std::vector<ObstacleList> parts(n_squares * n_squares);
    const auto square = [&](double x, double y) {
        const auto row = [&](double at) {
            return static_cast<std::size_t>(
                std::clamp(at / size, 0.0, static_cast<double>(n_squares - 1)));
        };
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
        parts[k].segments.push_back(
            {line.x0 - x_of(k), line.y0 - y_of(k), line.x1 - x_of(k), line.y1 - y_of(k)});
    }
    const double mean = count(all) / static_cast<double>(parts.size());
    const auto is_better = [mean](const ObstacleList& a, const ObstacleList& b) {
        return a.are_any() &&
               (!b.are_any() || std::fabs(count(a) - mean) < std::fabs(count(b) - mean));
    };
    ObstacleList typical = *std::min_element(parts.begin(), parts.end(), is_better);
    typical.restitution = all.restitution;
    return typical;
}

/// Discs that are clear of all obstacles, numbered anew.
void keep_clear(const Scene& scene, std::vector<InputDisc>& discs) {
    const Obstacles obstacles(scene.box_size, scene.radius, scene.effects);
    std::erase_if(discs, [&](const InputDisc& disc) {
        return obstacles.deepest_overlap(disc.x, disc.y, scene.radius, 0).body !=
               ObstacleContact::no_body;
    });
    for (std::size_t i = 0; i < discs.size(); ++i) discs[i].id = i;
}

/// Root mean square of velocities per step, of discs in the box.
double speed_of(const Scene& scene, const CostsOfRun& run) {
    double mass = scene.effects.species.empty() ? static_cast<double>(scene.n_discs) : 0;
    for (const Species& one : scene.effects.species)
        mass += static_cast<double>(one.count) * one.mass;
    return std::sqrt(
        2 * run.kinetic_energy /
        (mass * (static_cast<double>(run.n_discs) / static_cast<double>(scene.n_discs))));
}

/// About how often a disc meets others, walls and obstacles in a step: Enskog's rate for equal
/// discs, and free paths.
double meetings_per_step(const Scene& scene, const CostsOfRun& run, double speed) {
    const double area = scene.box_size * scene.box_size,
                 density = static_cast<double>(run.n_discs) / area;
    const double packing = std::min(scene.packing(), 0.9),
                 chi = (1 - 7 * packing / 16) / ((1 - packing) * (1 - packing));
    double width = 4 / scene.box_size + 4 * scene.radius * density * chi;
    for (const FixedDisc& disc : scene.effects.obstacles.discs)
        width += 2 * (disc.radius + scene.radius) / area;
    for (const Segment& line : scene.effects.obstacles.segments)
        width += std::hypot(line.x1 - line.x0, line.y1 - line.y0) / area;
    return 1.25 * speed * width;
}

/// A sample's steps are micro-steps, in the event-driven method so short that discs seldom meet
/// anything in one.
double steps_in_one(const Scene& scene, const CostsOfRun& run) {
    const auto k = static_cast<double>(scene.micro_steps);
    if (scene.method == Method::time_stepped) return k;
    const double too_often = meetings_per_step(scene, run, speed_of(scene, run)) / k /
                             (meetings_in_sample / (4 * (n_rounds + 1)));
    return too_often > 1 ? k * std::exp2(std::ceil(std::log2(too_often))) : k;
}

/// What the discs and gravity need of a box from sync to sync: it is not to be crossed thousands of
/// times (core/image.hpp), nor fallen through.
bool has_room(const Scene& part) {
    const auto time = static_cast<double>(part.sync_every);
    const double fall = 0.5 * std::hypot(part.effects.gravity.x, part.effects.gravity.y) * time *
                        time;
    return part.speed * time < 500 * part.box_size && fall <= 0.5 * part.box_size;
}

/// Whether discs of one size fit on a lattice, and those of several can be inserted at random for
/// sure.
bool has_places(const Scene& part) {
    constexpr double random_packing = 0.4;
    if (part.generator == Generator::lattice)
        return widest_lattice(part.n_discs, part.box_size, part.radius).has_value();
    return part.packing() < random_packing && part.box_size > 6 * part.radius;
}

/// As many as there is time for, or at least as many as an obstacle needs room among.
std::uint64_t discs_in_sample(const Scene& scene, const Effects& one, const CostsOfRun& run,
                              double disc_steps) {
    const auto wanted = static_cast<std::uint64_t>(
        std::clamp(disc_steps, static_cast<double>(fewest_discs), static_cast<double>(most_discs)));
    const double width = scene.box_size *
                         std::sqrt(static_cast<double>(wanted) / static_cast<double>(run.n_discs));
    return std::min(run.n_discs, largest_size(one.obstacles) > 0.25 * width ? most_discs : wanted);
}

/// A box of a side `scale` times the scene's, as dense and as fast, with one of its effects. Its
/// discs have no places yet.
Scene part_of(const Scene& scene, const Effects& one, const CostsOfRun& run, std::uint64_t n_discs,
              double scale) {
    const double n_steps = steps_in_one(scene, run);
    Scene part;
    part.name = scene.name;
    part.n_discs = n_discs;
    part.box_size = scene.box_size * scale;
    part.radius = scene.radius;
    part.generator = one.species.empty() ? Generator::lattice : Generator::random;
    part.speed = speed_of(scene, run) / n_steps;
    part.method = scene.method;
    part.sync_every = static_cast<std::int64_t>(std::min(
        static_cast<double>(scene.sync_every) * (n_steps / static_cast<double>(scene.micro_steps)),
        0x1p30));
    part.steps = no_last_step;
    part.effects = per_micro_step(one, n_steps);
    if (!one.species.empty()) part.effects.species = thinned(one.species, n_discs, scene.n_discs);
    if (one.obstacles.are_any())
        part.effects.obstacles = part_of(one.obstacles, scene.box_size, part.box_size);
    return part;
}

/// Steps in which neither collisions nor gravity change much.
std::int64_t longest_round(const Scene& part, double meetings) {
    const double pull = std::hypot(part.effects.gravity.x, part.effects.gravity.y),
                 far = 0.05 * part.box_size;
    const double steps = std::min(meetings_in_sample / meetings, std::sqrt(2 * far / pull)) /
                         (n_rounds + 1);
    return static_cast<std::int64_t>(std::clamp(steps, 1.0, 1000.0));
}

/// As many discs that cover as much, of one size and without effects.
Scene without_effects(const Scene& part) {
    Scene plain = part;
    plain.effects = {};
    if (part.effects.species.empty()) return plain;
    plain.generator = Generator::lattice;
    plain.radius = part.box_size * std::sqrt(part.packing() / (std::numbers::pi *
                                                               static_cast<double>(part.n_discs)));
    return plain;
}

/// Nothing where the scene does not allow a small one.
std::optional<Sample> sample_of(const Scene& scene, const Effects& one, const CostsOfRun& run,
                                double disc_steps, const Communicator& alone) {
    const std::uint64_t n_discs = discs_in_sample(scene, one, run, disc_steps);
    const double scale = std::sqrt(static_cast<double>(n_discs) / static_cast<double>(run.n_discs));
    Sample sample;
    Scene& part = sample.with = part_of(scene, one, run, n_discs, scale);
    if (!has_room(part)) return {};
    sample.longest_round = longest_round(part, meetings_per_step(scene, run, part.speed));
    if (is_at_sides(one)) sample.share = scale;
    if (one.obstacles.are_any())
        sample.share = count(one.obstacles) * scale * scale / count(part.effects.obstacles);
    while (!has_places(part)) part.box_size *= 1.02;
    for (Boundary& side : part.effects.boundaries) { // a wall does not get far in so few steps
        const double farthest = 0.05 * part.box_size /
                                static_cast<double>((n_rounds + 1) * sample.longest_round);
        side.speed = std::clamp(side.speed, -farthest, farthest);
    }
    sample.discs = initial_state(part, nullptr, alone);
    if (one.obstacles.are_any()) keep_clear(part, sample.discs);
    if (sample.discs.empty()) return {};
    part.n_discs = sample.discs.size();
    sample.without = without_effects(part);
    sample.discs_without = one.species.empty() ? sample.discs
                                               : initial_state(sample.without, nullptr, alone);
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

/// What samples have taken so far.
struct Timings {
    double spent = 0;           ///< seconds
    std::vector<double> ratios; ///< of rounds
};

/// Runs both scenes from their start. False if some steps take longer than `budget`, seconds, or
/// all rounds several times that.
bool add_rounds(const Sample& sample, double budget, const Communicator& alone, Timings& timings) {
    Simulation with(sample.with, sample.discs, alone, {}),
        without(sample.without, sample.discs_without, alone, {});
    const double begin = timings.spent;
    std::int64_t steps = 0; // as many as fit: a round is a sixth of the time
    do {
        steps = std::max<std::int64_t>(1, 2 * steps);
        timings.spent += seconds_to(with, steps) + seconds_to(without, steps);
        if (timings.spent - begin > budget) return false;
    } while (timings.spent - begin < budget / (2 * (n_rounds + 1)) &&
             2 * steps <= sample.longest_round);
    for (int round = 1; round <= n_rounds; ++round) {
        if (timings.spent > 3 * budget) return false;
        const std::int64_t step = (round + 1) * steps;
        const double seconds = seconds_to(with, step), plain_seconds = seconds_to(without, step);
        timings.ratios.push_back(seconds / std::max(plain_seconds, 1e-9));
        timings.spent += seconds + plain_seconds;
    }
    return true;
}

/// Median of the rounds' ratios, of as many rounds as fit; nothing where those of one sample do
/// not.
std::optional<double> ratio_of_times(const Sample& sample, double budget,
                                     const Communicator& alone) {
    constexpr std::size_t most_rounds = 20 * n_rounds;
    Timings timings;
    while (add_rounds(sample, budget, alone, timings) && timings.spent < budget &&
           timings.ratios.size() < most_rounds) {
    }
    std::vector<double>& ratios = timings.ratios;
    if (ratios.size() < n_rounds) return {};
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
}

std::optional<double> time_ratio(const Scene& scene, const Effects& one, const CostsOfRun& run,
                                 double budget, const Communicator& alone) {
    constexpr double least_seconds = 1e-7; // of a disc and step
    const double seconds = std::max(least_seconds,
                                    run.seconds_per_disc_step / steps_in_one(scene, run));
    const double disc_steps = budget / (2 * (n_rounds + 1) * seconds);
    if (run.n_discs == 0 ||
        disc_steps < 0.1 * static_cast<double>(std::min(run.n_discs, fewest_discs)))
        return {};
    const auto sample = sample_of(scene, one, run, disc_steps, alone);
    if (!sample) return {};
    const auto ratio = ratio_of_times(*sample, budget, alone);
    if (!ratio) return {};
    return 1 + (*ratio - 1) * sample->share;
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
        cost.time_ratio = time_ratio(scene, one, run,
                                     run.budget / static_cast<double>(singles.size()), alone);
        cost.time_share = std::max(0.0, cost.time_ratio.value_or(1) - 1);
        cost.bytes_per_disc = extra_bytes(one);
        whole += cost.time_share;
    }
    for (EffectCost& cost : costs) cost.time_share /= whole;
    return costs;
}

} // namespace carrom
