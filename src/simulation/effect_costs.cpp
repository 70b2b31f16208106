// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/simulation/effect_costs.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "carrom/effects/obstacles.hpp"
#include "law_of_scene.hpp"

namespace carrom {

namespace {

constexpr std::size_t most_discs = 256;
constexpr int n_rounds = 40, n_tries = 5;

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

struct Nanoseconds {
    double wall = 0, pair = 0;
};

/// The least of some tries, of each call of `work(disc)`.
template <class Work> double nanoseconds_of(std::span<const Disc> discs, const Work& work) {
    using Clock = std::chrono::steady_clock;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < n_tries; ++k) {
        double sum = 0;
        const auto start = Clock::now();
        for (int round = 0; round < n_rounds; ++round)
            for (std::size_t i = 0; i < discs.size(); ++i) sum += work(discs[i], discs[(i + 1) % discs.size()]);
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        volatile double kept = sum; // so that the work is done
        static_cast<void>(kept);
        least = std::min(least, 1e9 * seconds / (n_rounds * static_cast<double>(discs.size())));
    }
    return least;
}

template <class Law> Nanoseconds measure(const Law& law, CollisionRule rule, std::span<const Disc> discs) {
    Nanoseconds found;
    if (rule == CollisionRule::one) {
        found.wall = nanoseconds_of(discs, [&](const Disc& before, const Disc&) {
            Disc disc = before;
            const double t = law.wall_time(disc, 0);
            // Where there is nothing to bounce off, sides bear being asked, obstacles do not.
            if (t != Law::never || !law.has_obstacles()) law.bounce(disc, 0, std::min(t, 1.0));
            return disc.vx + disc.vy;
        });
        found.pair = nanoseconds_of(discs, [&](const Disc& first, const Disc& second) {
            Disc p = first, q = second;
            double p_spin = 0, q_spin = 0;
            if constexpr (Law::has_spin) law.collide(p, q, 0, 1, p_spin, q_spin);
            else law.collide(p, q, 0, 1);
            return p.vx + q.vy + p_spin + q_spin;
        });
        return found;
    }
    const auto look_for_obstacle = [&](const Disc& disc) { // after each collision of any kind
        if constexpr (Law::may_have_obstacles)
            if (law.has_obstacles()) return law.first_obstacle(disc, {disc.tau, disc.tau + 1, true, ObstacleContact::no_body}).time;
        return 0.0;
    };
    found.wall = nanoseconds_of(discs, [&](const Disc& before, const Disc&) {
        Disc disc = before;
        const double x = law.x_wall_time(disc), y = law.y_wall_time(disc);
        if (x < y) law.bounce_x_at(disc, x);
        else if (y < std::numeric_limits<double>::infinity()) law.bounce_y_at(disc, y);
        return std::min(disc.vx + disc.vy, look_for_obstacle(disc));
    });
    found.pair = nanoseconds_of(discs, [&](const Disc& first, const Disc& second) {
        Disc p = first, q = second;
        double p_spin = 0, q_spin = 0;
        if constexpr (Law::has_spin) law.collide_at(p, q, std::max(p.tau, q.tau), p_spin, q_spin);
        else law.collide_at(p, q, std::max(p.tau, q.tau));
        return p.vx + q.vy + p_spin + q_spin + std::min(1.0, look_for_obstacle(p)) + std::min(1.0, look_for_obstacle(q));
    });
    return found;
}

Nanoseconds measure(const Scene& scene, std::span<const Disc> discs) {
    return with_law_of(scene, [&]<class Law>() { return measure(law_of<Law>(scene), scene.rule, discs); });
}

} // namespace

std::vector<EffectCost> effect_costs(const Scene& scene, std::span<const Disc> discs) {
    discs = discs.first(std::min(discs.size(), most_discs));
    Scene small;
    small.box_size = scene.box_size;
    small.radius = scene.radius;
    small.micro_steps = scene.micro_steps;
    small.rule = scene.rule;
    const Nanoseconds plain = discs.empty() ? Nanoseconds{} : measure(small, discs);
    std::vector<EffectCost> costs;
    for (const Effects& one : single_effects(scene.effects)) {
        small.effects = one;
        const Nanoseconds with = discs.empty() ? Nanoseconds{} : measure(small, discs);
        EffectCost& cost = costs.emplace_back();
        cost.name = description(one);
        cost.nanoseconds_per_wall = with.wall - plain.wall;
        cost.nanoseconds_per_pair = with.pair - plain.pair;
        if (one.contact.kind == ContactKind::rough) cost.bytes_per_disc = sizeof(double); // the spin
        if (one.classes.size() > 8) cost.bytes_per_disc = 16; // what the law keeps of each disc (disc_classes.hpp), on each rank
    }
    return costs;
}

double time_share(const EffectCost& cost, std::uint64_t wall_collisions, std::uint64_t pair_collisions, double seconds) {
    const double nanoseconds = cost.nanoseconds_per_wall * static_cast<double>(wall_collisions) + cost.nanoseconds_per_pair * static_cast<double>(pair_collisions);
    return seconds > 0 ? std::clamp(nanoseconds / (1e9 * seconds), 0.0, 1.0) : 0;
}

} // namespace carrom
