// SPDX-License-Identifier: BSD-3-Clause
// A wall from which discs bounce off as if they came from a gas of the wall's temperature.
#include <cmath>

#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

const Need any_thermal_side{"without a side of kind = \"thermal\"", [](const SceneParameters& s) {
                                return has_boundary(s.effects, BoundaryKind::thermal);
                            }};

std::vector<Key> keys_of_thermal_side(std::size_t side) {
    return {key(side_key(side, "temperature"), "length^2/step^2",
                "kT of a thermal wall, for discs of mass 1.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].temperature; })
                .within({1e-60, 1e60})
                .needs(side_needs(side, BoundaryKind::thermal))
                .required()};
}

void check_thermal_walls(const SceneDraft& draft) {
    for (std::size_t side = 0; side < boundary_names.size(); ++side) {
        const std::string key = side_key(side, "temperature");
        const double speed = std::sqrt(draft.scene.effects.boundaries[side].temperature);
        if (const std::string text = speed_problem(speed, draft.scene); !text.empty())
            draft.refuse({key}, fmt::format("'{}': {}", key, text));
    }
}

} // namespace

namespace boundaries {

BoundaryDeclaration thermal() {
    return {
        .kind = BoundaryKind::thermal,
        .help = "discs leave as if from a gas",
        .keys_of_side = keys_of_thermal_side,
        .tables = {{"effects.thermal", "Thermal walls."}},
        .keys = {key("effects.thermal.seed", "1", "Seed of the random numbers of thermal walls.",
                     [](auto& s) -> auto& { return s.effects.thermal_seed; })
                     .within({.low = 0})
                     .needs(any_thermal_side)
                     .seed()},
        .check_room = check_thermal_walls,
        .summary =
            [](const Boundary& side, std::string_view name) {
                return fmt::format("{} wall of temperature {:g}", name, side.temperature);
            },
        .allowance = [](const Boundary&) { return CheckAllowance{.walls_give_energy = true}; }};
}

} // namespace boundaries

} // namespace carrom
