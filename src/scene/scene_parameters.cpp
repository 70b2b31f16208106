// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/angle.hpp"
#include "dynamics/container.hpp"
#include "scene/disc_columns.hpp"

namespace carrom {

double SceneParameters::area() const { return area_of(effects.fixed_bodies, box); }

double radius_of_packing(const SceneParameters& scene, double packing) {
    return std::sqrt(scene.area()) *
           std::sqrt(packing / (static_cast<double>(scene.n_discs) * std::numbers::pi));
}

double SceneParameters::packing() const {
    const double share = effects.fixed_bodies.has_shape() ? area() / box.area() : 1;
    if (!effects.species.empty()) {
        double sum = 0;
        for (const Species& one : effects.species)
            sum += static_cast<double>(one.count) * std::numbers::pi * (one.radius / box.x) *
                   (one.radius / box.y);
        return sum / share;
    }
    return static_cast<double>(n_discs) * std::numbers::pi * (radius / box.x) * (radius / box.y) /
           share;
}

void choose_fields(TrajectoryOutput& trajectory, const SceneParameters& scene) {
    trajectory.columns = side_columns_of(scene);
    trajectory.has_image = scene.effects.are_periodic() && !scene.effects.are_sheared();
}

bool has_first_numbers(const SceneParameters& scene, SideColumn column) {
    return !scene.first_numbers[column].empty() ||
           (column == SideColumn::direction && scene.effects.activity.is_on());
}

double first_number(const SceneParameters& scene, SideColumn column, DiscId id) {
    const std::vector<NumberRun>& runs = scene.first_numbers[column];
    if (runs.empty() && has_first_numbers(scene, column))
        return random_angle({scene.effects.activity.seed, Purpose::direction, id});
    const auto run = std::upper_bound(
        runs.begin(), runs.end(), id,
        [](DiscId wanted, const NumberRun& one) { return wanted < one.end; });
    return run == runs.end() ? 0 : run->number;
}

SideColumnSet side_columns_of(const SceneParameters& scene) {
    SideColumnSet columns = side_columns_of(scene.effects);
    for (const SideColumn column : all_side_columns) {
        const bool is_given = !scene.first_numbers[column].empty() ||
                              has_column(scene, disc_column_of(column));
        if (is_given && !info_of(column).is_of_dynamics) columns.add(column);
    }
    return columns;
}

std::string discs_path(const SceneParameters& scene) {
    const std::string& name = scene.discs_from.empty() ? scene.discs_file : scene.discs_from;
    return (std::filesystem::path(scene.name).parent_path() / name).string();
}

} // namespace carrom
