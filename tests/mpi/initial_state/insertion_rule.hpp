// SPDX-License-Identifier: BSD-3-Clause
// A plain implementation of random insertion, without ranks, grids or batches, for comparison.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "core/random_numbers.hpp"
#include "lattices/lattice.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct BoxOfRule {
    double length, period_x, period_y;

    explicit BoxOfRule(const SceneParameters& scene)
        : length(scene.box.x), period_x(scene.effects.is_periodic_x() ? length : 0),
          period_y(scene.effects.is_periodic_y() ? length : 0) {}

    double place(double r, double period, double number) const {
        return period > 0 ? length * number : r + ((length - r) - r) * number;
    }
    bool overlap(Point a, Point b, double distance) const {
        double nearest = INFINITY;
        for (const double dx : {-period_x, 0.0, period_x})
            for (const double dy : {-period_y, 0.0, period_y})
                nearest = std::min(nearest, (a.x + dx - b.x) * (a.x + dx - b.x) +
                                                (a.y + dy - b.y) * (a.y + dy - b.y));
        return nearest < distance * distance;
    }
};

/// Random insertion with all pairs, round after round, the largest discs first. Periodic sides have
/// all images. After 10000 rounds without a placed disc it starts again, with other numbers.
inline std::vector<Point> places_by_the_rule(const SceneParameters& scene, std::uint64_t start) {
    const BoxOfRule box(scene);
    std::vector<double> radii; // radius of each disc
    for (const Species& one : scene.effects.species)
        radii.insert(radii.end(), one.count, one.radius);
    radii.resize(scene.n_discs, scene.radius);
    std::vector<Point> places(scene.n_discs), proposals(scene.n_discs);
    std::vector<int> placed_in(scene.n_discs, -1);
    const std::set<double> all_radii(radii.begin(), radii.end());
    for (auto radius = all_radii.rbegin(); radius != all_radii.rend(); ++radius) {
        // discs that have a place got it before round 1
        for (int& round : placed_in) round = round >= 0 ? 0 : -1;
        int last_round = 0; // last round in which a disc was placed
        const auto n_waiting = [&] {
            std::size_t n = 0;
            for (DiscId id = 0; id < scene.n_discs; ++id)
                n += radii[id] == *radius && placed_in[id] < 0;
            return n;
        };
        for (int round = 1; n_waiting() > 0; ++round) {
            if (round - last_round > 10000) return places_by_the_rule(scene, start + 1);
            const auto proposes = [&](DiscId id) {
                return radii[id] == *radius && (placed_in[id] < 0 || placed_in[id] == round);
            };
            for (DiscId id = 0; id < scene.n_discs; ++id) {
                if (!proposes(id)) continue;
                const auto words = random_words(scene.seed, Purpose::position, id,
                                                static_cast<std::uint64_t>(round - 1), start);
                proposals[id] = {box.place(*radius, box.period_x, unit_number(words[0])),
                                 box.place(*radius, box.period_y, unit_number(words[1]))};
            }
            for (DiscId id = 0; id < scene.n_discs; ++id) {
                if (!proposes(id)) continue;
                bool is_refused = false;
                for (DiscId other = 0; other < scene.n_discs && !is_refused; ++other) {
                    const double distance = radii[id] + radii[other];
                    if (placed_in[other] >= 0 && placed_in[other] < round)
                        is_refused = box.overlap(proposals[id], places[other], distance);
                    else if (other < id && proposes(other))
                        is_refused = box.overlap(proposals[id], proposals[other], distance);
                }
                if (is_refused) continue;
                placed_in[id] = last_round = round;
                places[id] = proposals[id];
            }
        }
    }
    return places;
}

} // namespace carrom
