// SPDX-License-Identifier: BSD-3-Clause
#include "measure/pair_reach.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace carrom {

Key bins_key() {
    return bins_setting.integer("1", "Bins of each table of distances, velocities or places.")
        .within({1, 10000});
}

Key largest_distance_key() {
    return largest_distance_setting
        .number("length", "Reach of g(r) and of g6(r); at most half the box of centres.",
                "5 diameters")
        .within({.low = 0, .excludes_low = true});
}

void check_largest_distance(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const Extent end = extent_of_lines(scene.effects, scene.box, static_cast<double>(scene.steps),
                                       1);
    const double shortest = scene.effects.barostat.shortest_side();
    const double wide = shortest * std::min(scene.box.x, end.x_high - end.x_low);
    const double high = shortest * std::min(scene.box.y, end.y_high - end.y_low);
    const double margin = 2 * scene.radius;
    const double largest = std::min(wide - (scene.effects.is_periodic_x() ? 0 : margin),
                                    high - (scene.effects.is_periodic_y() ? 0 : margin)) /
                           2;
    const std::string name(largest_distance_setting.name);
    if (!scene.measurements->is_given(name))
        scene.measurements->derive(name, std::min(10 * scene.radius, largest));
    const double distance = largest_distance_setting.of(*scene.measurements);
    if (distance <= largest && distance > 0) return;
    draft.refuse({largest_distance_setting.key_name(), quantities_key},
                 fmt::format("distances of pairs cannot reach {:g}: half the width of the box "
                             "that centres of discs have is {:g}",
                             distance, largest));
}

void keep_largest_distance(KeptNumbers& kept, const MeasuredRun& run, double& distance) {
    if (run.output.is_given(largest_distance_setting.name)) return kept.same(distance);
    const double asked = distance;
    kept(distance);
    if (!kept.is_restored() || distance <= asked) return;
    throw InputError({{"[output.measurements]", 0,
                       fmt::format("the checkpoint's radial distribution reaches {:g}, and walls "
                                   "that come in until the last step leave room for {:g}: "
                                   "run to an earlier step, or begin anew with "
                                   "output.measurements.from_step = {}",
                                   distance, asked, run.system.step())}});
}

} // namespace carrom
