// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/effects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "dynamics/oscillation.hpp"

namespace carrom {

bool Effects::have_plain_boundaries() const {
    for (std::size_t side = 0; side < boundaries.size(); ++side)
        if (!boundaries[side].is_plain() || !surface_contacts.rows[side].empty()) return false;
    return true;
}

bool Effects::have_open_boundaries() const {
    return std::any_of(boundaries.begin(), boundaries.end(),
                       [](const Boundary& side) { return side.kind == BoundaryKind::open; });
}

SideColumnSet side_columns_of(const Effects& effects) {
    SideColumnSet columns;
    if (effects.have_spins()) columns.add(SideColumn::spin);
    if (effects.activity.is_on()) columns.add(SideColumn::direction);
    if (effects.swap.is_on()) columns.add(SideColumn::swapped_radius);
    return columns;
}

std::string description(const std::vector<Species>& species) {
    constexpr std::size_t most_named = 4;
    if (species.size() > most_named) {
        Species least = species.front(), most = least;
        for (const Species& one : species) {
            least = {0, std::min(least.radius, one.radius), std::min(least.mass, one.mass)};
            most = {0, std::max(most.radius, one.radius), std::max(most.mass, one.mass)};
        }
        return fmt::format("discs of {} species, radii {:g} to {:g}, masses {:g} to {:g}",
                           species.size(), least.radius, most.radius, least.mass, most.mass);
    }
    std::string text;
    for (const Species& one : species)
        text += fmt::format("{}{} disc{} of radius {:g} and mass {:g}", text.empty() ? "" : ", ",
                            one.count, one.count == 1 ? "" : "s", one.radius, one.mass);
    return text;
}

Extent extent_at(const Effects& effects, const Box& size, double time) {
    Extent box = extent_of_lines(effects, size, time);
    const auto move = [&](std::size_t side, double& line) {
        const Boundary& boundary = effects.boundaries[side];
        if (boundary.kind == BoundaryKind::oscillating)
            line += oscillation_at(boundary, time).place;
    };
    move(0, box.x_low);
    move(1, box.x_high);
    move(2, box.y_low);
    move(3, box.y_high);
    return box;
}

Extent extent_of_lines(const Effects& effects, const Box& box, double time,
                       double amplitudes_inwards) {
    const auto low = [&](const Boundary& side) {
        return side.speed * time + amplitudes_inwards * side.amplitude;
    };
    const auto high = [&](const Boundary& side, double length) {
        return length + side.speed * time - amplitudes_inwards * side.amplitude;
    };
    const auto& boundaries = effects.boundaries;
    return {low(boundaries[0]), high(boundaries[1], box.x), low(boundaries[2]),
            high(boundaries[3], box.y)};
}

double largest_wall_speed(const Effects& effects) {
    double speed = 0;
    for (const Boundary& side : effects.boundaries)
        speed = std::max(speed, 2 * std::numbers::pi * side.amplitude / side.period);
    return speed;
}

double largest_wall_pull(const Effects& effects) {
    double pull = 0;
    for (const Boundary& side : effects.boundaries) {
        const double rate = 2 * std::numbers::pi / side.period;
        pull = std::max(pull, side.amplitude * (rate * rate));
    }
    return pull;
}

} // namespace carrom
