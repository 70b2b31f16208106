// SPDX-License-Identifier: BSD-3-Clause
#include "scene/limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scene/boundaries/boundary.hpp"
#include "scene/effects/effect.hpp"
#include "scene/places.hpp"

namespace carrom {

bool has_boundary(const Effects& effects, BoundaryKind kind) {
    return std::any_of(effects.boundaries.begin(), effects.boundaries.end(),
                       [kind](const Boundary& side) { return side.kind == kind; });
}

bool are_pairs_lossy(const Effects& effects) {
    return effects.contact.kind == ContactKind::restitution ||
           effects.contact.kind == ContactKind::rough;
}

bool lose_energy_or_fall(const Effects& effects) {
    const auto is_lossy = [&effects](const Boundary& side) {
        return side.restitution < 1 ||
               (effects.drag > 0 && side.speed != 0); // drag presses discs against a moving wall
    };
    return std::any_of(effects.boundaries.begin(), effects.boundaries.end(), is_lossy) ||
           do_sides_let_discs_rest(effects) ||
           std::ranges::any_of(all_effects(), [&effects](const EffectDeclaration& one) {
               return one.lets_discs_rest && one.lets_discs_rest(effects);
           });
}

std::string velocity_problem(double component) {
    const double size = std::fabs(component);
    if (!std::isfinite(component))
        return fmt::format("the velocity {} is not a finite number", component);
    if (size > largest_size)
        return fmt::format("the velocity {} is too large (at most 2^250)", component);
    if (size != 0 && size < smallest_size)
        return fmt::format("the velocity {} is too small (0, or at least 2^-250)", component);
    return {};
}

std::string speed_problem(double speed, const SceneParameters& scene) {
    const double most = most_crossings * scene.box.shortest() *
                        static_cast<double>(scene.micro_steps);
    if (scene.method != Method::event_driven || !(std::fabs(speed) > most) || most == 0) return {};
    if (std::fabs(speed) > largest_size) return {}; // velocity_problem reports it
    return fmt::format("the speed {} crosses the box more than 2^40 times in a micro-step; take "
                       "more time.micro_steps, or at most {:g}",
                       speed, most);
}

std::string units_warning(double fastest, double later, const SceneParameters& scene) {
    constexpr double most_diameters = 1000;
    const double diameters = std::max(fastest, later) / (2 * scene.radius);
    if (!(diameters > most_diameters) || scene.are_points) return {};
    return fmt::format("{} {:.3g} diameters in a step, which may take very long; "
                       "speeds are lengths per step: try some of about a diameter, {:g}",
                       fastest >= later ? "the fastest disc flies"
                                        : "walls or effects make discs fly",
                       diameters, 2 * scene.radius);
}

std::string column_problem(DiscColumn column, double number) {
    constexpr double smallest_mass = 0x1p-100, largest_mass = 0x1p100;
    const auto is_within = [number](double low, double high) {
        return number >= low && number <= high;
    };
    if (column == DiscColumn::radius)
        return is_within(smallest_length, largest_size)
                   ? ""
                   : fmt::format("the radius must be from 2^-230 to 2^250, not {}", number);
    if (column == DiscColumn::mass)
        return is_within(smallest_mass, largest_mass)
                   ? ""
                   : fmt::format("the mass must be from 2^-100 to 2^100, not {}", number);
    return is_within(-largest_size, largest_size)
               ? ""
               : fmt::format("the {} must be finite and at most 2^250, not {}",
                             info_of(side_column_of(column)).name, number);
}

namespace {

/// The range of the centres of discs of one radius along an axis.
struct Room {
    double low = 0, high = 0;
};

/// The bounds of centres, widened by 2^-52 L, because L - r is rounded here and in the program that
/// wrote the input. Discs depart when their centres are a radius beyond an open side.
Room room_along(Axis axis, const SceneParameters& scene, double radius) {
    const bool is_x = axis == Axis::x;
    const Extent walls = extent_at(scene.effects, scene.box, 0); // at time 0: walls may oscillate
    const double length = along(axis, scene.box), slack = 0x1p-52 * length;
    if (is_x ? scene.effects.is_periodic_x() : scene.effects.is_periodic_y()) return {0, length};
    const auto inwards = [&](std::size_t side) {
        return scene.effects.boundaries[side].kind == BoundaryKind::open ? -radius : radius;
    };
    const std::size_t low = is_x ? 0 : 2;
    return {(is_x ? walls.x_low : walls.y_low) + inwards(low) - slack,
            ((is_x ? walls.x_high : walls.y_high) - inwards(low + 1)) + slack};
}

/// Describes in a message where the centres of discs of this radius may be.
std::string room_text(const SceneParameters& scene, double radius) {
    const Box& box = scene.box;
    const bool have_open = scene.effects.have_open_boundaries();
    if (have_open || scene.origin.is_on()) {
        const Room x = room_along(Axis::x, scene, radius), y = room_along(Axis::y, scene, radius);
        const Origin& o = scene.origin;
        return fmt::format(
            "centres lie between {:.15g} and {:.15g} along x, {:.15g} and {:.15g} along y{}",
            x.low - o.x, x.high - o.x, y.low - o.y, y.high - o.y,
            have_open ? fmt::format(", and up to r = {} beyond open sides", radius) : "");
    }
    const std::string room = box.is_square()
                                 ? fmt::format("L - r = {}", box.x - radius)
                                 : fmt::format("Lx - r = {} along x, Ly - r = {} along y",
                                               box.x - radius, box.y - radius);
    const std::string periods = box.is_square() ? fmt::format("L = {}", box.x)
                                                : fmt::format("Lx = {}, Ly = {}", box.x, box.y);
    return fmt::format("centres lie between r = {} and {}{}", radius, room,
                       scene.effects.are_periodic() ? ", between periodic sides 0 and " + periods
                                                    : "");
}

/// Advice if a disc of `discs.from` overlaps a closed side, because the side may have been open in
/// that run, and the disc was crossing it; empty if the disc overlaps no closed side.
std::string hint_of_sides(const InputDisc& disc, const SceneParameters& scene, double radius) {
    if (scene.discs_from.empty()) return "";
    const std::array<double, 4> beyond = {-disc.x, disc.x - scene.box.x, -disc.y,
                                          disc.y - scene.box.y};
    std::string settings;
    for (std::size_t side = 0; side < beyond.size(); ++side) {
        const BoundaryKind kind = scene.effects.boundaries[side].kind;
        if (kind == BoundaryKind::open || kind == BoundaryKind::periodic ||
            std::abs(beyond[side]) >= radius)
            continue;
        settings += fmt::format("{}box.{}.kind = \"open\"", settings.empty() ? "" : " and ",
                                boundary_names[side]);
    }
    if (settings.empty()) return "";
    return fmt::format("; if it is halfway through an open side, set {}", settings);
}

} // namespace

std::string disc_problem(const InputDisc& disc, const SceneParameters& scene, double radius) {
    std::string all;
    const auto add = [&all](const std::string& text) {
        if (!text.empty()) all += (all.empty() ? "" : "; ") + text;
    };
    const Box& box = scene.box;
    bool is_finite = true, is_inside = true;
    for (const auto& [centre, axis] : {std::pair(disc.x, Axis::x), std::pair(disc.y, Axis::y)}) {
        const auto [low, high] = room_along(axis, scene, radius);
        if (!std::isfinite(centre))
            add(fmt::format("the position {} is not a finite number", centre));
        is_finite = is_finite && std::isfinite(centre);
        is_inside = is_inside && centre >= low && centre <= high;
    }
    const bool is_box_known = box != Box();
    if (is_finite && !is_inside && is_box_known)
        add(fmt::format("disc {} at {} is not inside the box: {}{}{}", disc.id,
                        shown_place(scene, disc.x, disc.y), room_text(scene, radius),
                        hint_of_sides(disc, scene, radius),
                        has_boundary(scene.effects, BoundaryKind::oscillating)
                            ? ", and before oscillating walls where these are at step 0"
                            : ""));
    for (const double component : {disc.vx, disc.vy}) {
        add(velocity_problem(component));
        add(speed_problem(component, scene));
    }
    return all;
}

} // namespace carrom
