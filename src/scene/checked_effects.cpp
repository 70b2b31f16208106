// SPDX-License-Identifier: BSD-3-Clause
#include "scene/checked_effects.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "dynamics/drag.hpp"
#include "dynamics/fall.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

/// Rate times the time between syncs.
constexpr double longest_drag = 4;
/// Of a fixed disc's radius and that of a disc, over the box: a disc touches the nearest images of
/// a body at most.
constexpr double largest_in_period = 0.99;

/// Refuses `key` where it is set, for want of what would make use of it.
void refuse_without(const Check& check, std::string_view key, std::string_view needed) {
    if (const Setting* setting = check.settings.find(key))
        check.refuse(*setting, fmt::format("'{}' has no meaning without {}", key, needed));
}

std::optional<double> number_within(const Check& check, std::string_view key, double low,
                                    double high) {
    const auto number = finite_number(check, key);
    if (!number || (*number >= low && *number <= high)) return number;
    check.refuse(*check.settings.find(key),
                 fmt::format("'{}' must be from {} to {}, not {}", key, low, high, *number));
    return std::nullopt;
}

/// Between syncs a disc is as good as touched by the sync: a contact time as long would leave no
/// dissipation at all.
void fill_contact_time(const Check& check) {
    constexpr std::string_view key = "effects.contact.contact_time";
    ContactEffect& contact = check.scene.effects.contact;
    const double longest = static_cast<double>(check.scene.sync_every) /
                           static_cast<double>(check.scene.micro_steps) / 4;
    contact.contact_time = std::min(contact.contact_time, longest);
    const auto time = finite_number(check, key);
    if (!time) return;
    contact.contact_time = *time;
    if (!(*time > 0 && *time <= longest))
        check.refuse(*check.settings.find(key),
                     fmt::format("'{}' must be greater than 0 and at most {} steps, a quarter of "
                                 "the time between syncs ('time.sync_every'), not {}",
                                 key, longest, *time));
}

void fill_roughness(const Check& check) {
    ContactEffect& contact = check.scene.effects.contact;
    if (contact.kind != ContactKind::rough) {
        for (const std::string_view key :
             {"effects.contact.tangential_restitution", "effects.contact.friction",
              "effects.contact.moment_of_inertia"})
            refuse_without(check, key, "effects.contact.kind = \"rough\"");
        return;
    }
    check.refuse_missing("effects.contact.tangential_restitution",
                         "of surfaces that stick, from -1 (smooth) to 1 (perfectly rough)");
    if (const auto share = number_within(check, "effects.contact.tangential_restitution", -1, 1))
        contact.tangential_restitution = *share;
    if (const auto friction = number_within(check, "effects.contact.friction", 0, 1e6))
        contact.friction = *friction;
    if (const auto inertia = number_within(check, "effects.contact.moment_of_inertia", 1e-6, 1))
        contact.inertia = *inertia;
}

void fill_contact(const Check& check) {
    static constexpr Choices<ContactKind, 4> kinds = {{{"elastic", ContactKind::elastic},
                                                       {"none", ContactKind::none},
                                                       {"restitution", ContactKind::restitution},
                                                       {"rough", ContactKind::rough}}};
    ContactEffect& contact = check.scene.effects.contact;
    if (const auto kind = choice(check, "effects.contact.kind", kinds)) contact.kind = *kind;
    fill_roughness(check);
    if (contact.kind != ContactKind::restitution && contact.kind != ContactKind::rough) {
        refuse_without(check, "effects.contact.restitution",
                       "effects.contact.kind = \"restitution\" or \"rough\"");
        return;
    }
    check.refuse_missing("effects.contact.restitution",
                         "what is left of the normal relative velocity of two discs, from 0 to 1");
    if (const auto restitution = number_within(check, "effects.contact.restitution", 0, 1))
        contact.restitution = *restitution;
}

void fill_side(const Check& check, std::size_t number) {
    static constexpr Choices<BoundaryKind, 5> kinds = {{{"wall", BoundaryKind::fixed},
                                                        {"thermal", BoundaryKind::thermal},
                                                        {"moving", BoundaryKind::moving},
                                                        {"open", BoundaryKind::open},
                                                        {"periodic", BoundaryKind::periodic}}};
    Boundary& side = check.scene.effects.boundaries[number];
    const std::string table = std::string("box.") + boundary_names[number];
    if (const auto kind = choice(check, table + ".kind", kinds)) side.kind = *kind;
    const bool is_thermal = side.kind == BoundaryKind::thermal,
               is_moving = side.kind == BoundaryKind::moving;
    if (is_thermal)
        refuse_without(check, table + ".restitution",
                       table + ".kind = \"wall\" or \"moving\": what leaves a thermal wall has "
                               "forgotten how it came");
    else if (side.kind == BoundaryKind::open)
        refuse_without(check, table + ".restitution",
                       table +
                           ".kind = \"wall\" or \"moving\": nothing comes back from an open side");
    else if (side.kind == BoundaryKind::periodic)
        refuse_without(check, table + ".restitution",
                       "a wall: discs that leave by a periodic side come in by the opposite one, "
                       "as they were");
    else if (const auto restitution = number_within(check, table + ".restitution", 0, 1))
        side.restitution = *restitution;

    if (!is_thermal)
        refuse_without(check, table + ".temperature", table + ".kind = \"thermal\"");
    else
        check.refuse_missing(table + ".temperature", "kT of the wall, a velocity per step squared");
    if (const auto temperature = finite_number(check, table + ".temperature");
        temperature && is_thermal) {
        side.temperature = *temperature;
        if (!(*temperature >= 1e-60 && *temperature <= 1e60))
            check.refuse(*check.settings.find(table + ".temperature"),
                         fmt::format("'{}.temperature' must be from 1e-60 to 1e60, not {}", table,
                                     *temperature));
    }
    if (!is_moving)
        refuse_without(check, table + ".speed", table + ".kind = \"moving\"");
    else
        check.refuse_missing(table + ".speed", "of the wall along +x or +y, per step");
    if (const auto speed = finite_number(check, table + ".speed"); speed && is_moving)
        side.speed = *speed;
    if (is_moving && check.scene.method == Method::time_stepped)
        check.refuse(
            *check.settings.find(table + ".kind"),
            "a moving wall needs time.method = \"all\": the time-stepped method has walls at rest");
}

/// What boxes with periodic sides go without.
void check_beside_periodic_boundaries(const Check& check) {
    const Effects& effects = check.scene.effects;
    if (!effects.are_periodic()) return;
    const Setting& kind = *check.settings.find(
        std::string("box.") + boundary_names[effects.is_periodic_x() ? 0 : 2] + ".kind");
    const auto refuse = [&](std::string_view other) {
        check.refuse(kind,
                     fmt::format("this version has no periodic sides together with {}", other));
    };
    if (effects.have_open_boundaries()) refuse("open sides");
}

/// Sides are periodic in pairs.
void check_periodic_boundaries(const Check& check) {
    const auto& boundaries = check.scene.effects.boundaries;
    for (const std::size_t low : {0u, 2u}) {
        const bool is_low = boundaries[low].kind == BoundaryKind::periodic,
                   is_high = boundaries[low + 1].kind == BoundaryKind::periodic;
        if (is_low == is_high) continue;
        const std::size_t periodic = is_low ? low : low + 1, other = is_low ? low + 1 : low;
        check.refuse(*check.settings.find(std::string("box.") + boundary_names[periodic] + ".kind"),
                     fmt::format("what leaves by a periodic side comes in by the opposite one: "
                                 "box.{}.kind must be \"periodic\" too, or neither",
                                 boundary_names[other]));
    }
}

void fill_gravity(const Check& check) {
    Gravity& gravity = check.scene.effects.gravity;
    if (const auto x = finite_number(check, "effects.gravity.x")) gravity.x = *x;
    if (const auto y = finite_number(check, "effects.gravity.y")) gravity.y = *y;
    for (const auto& [key, g, is_periodic] :
         {std::tuple("effects.gravity.x", gravity.x, check.scene.effects.is_periodic_x()),
          {"effects.gravity.y", gravity.y, check.scene.effects.is_periodic_y()}}) {
        if (g != 0 && is_periodic)
            check.refuse(*check.settings.find(key), "gravity along an axis with periodic sides: "
                                                    "discs would fall for ever, faster and faster");
    }
    if (!gravity.is_any() || check.scene.method == Method::event_driven) return;
    const Setting* setting = check.settings.find(gravity.y != 0 ? "effects.gravity.y"
                                                                : "effects.gravity.x");
    check.refuse(
        *setting,
        "gravity needs time.method = \"all\": in the time-stepped method discs fly straight");
}

void fill_drag(const Check& check) {
    constexpr std::string_view key = "effects.drag.rate";
    Effects& effects = check.scene.effects;
    const auto rate = finite_number(check, key);
    if (!rate) return;
    const Setting& setting = *check.settings.find(key);
    const double interval = static_cast<double>(check.scene.sync_every) /
                            static_cast<double>(check.scene.micro_steps);
    if (*rate < 0)
        check.refuse(setting, fmt::format("'{}' must not be negative", key));
    else
        effects.drag = *rate;
    if (effects.drag == 0) return;
    if (check.scene.method == Method::time_stepped)
        check.refuse(
            setting,
            "drag needs time.method = \"all\": in the time-stepped method discs keep their speed");
    if (effects.drag * interval > longest_drag)
        check.refuse(setting,
                     fmt::format("'{}' = {} leaves less than a fiftieth of a velocity from sync to "
                                 "sync: {:g} at most, or a smaller time.sync_every",
                                 key, *rate, longest_drag / interval));
    if (effects.contact.kind == ContactKind::rough)
        check.refuse(setting, "this version has no drag together with rough discs");
}

void fill_thermal(const Check& check) {
    Effects& effects = check.scene.effects;
    const bool is_any = std::any_of(
        effects.boundaries.begin(), effects.boundaries.end(),
        [](const Boundary& side) { return side.kind == BoundaryKind::thermal; });
    if (!is_any) refuse_without(check, "effects.thermal.seed", "a side of kind = \"thermal\"");
    if (const auto seed = whole_number(check, "effects.thermal.seed", 0, INT64_MAX))
        effects.thermal_seed = static_cast<std::uint64_t>(*seed);
}

/// Calls what(row) for the rows of a list that are what they should be.
template <class What>
void for_each_row(const Check& check, std::string_view key, const What& what) {
    const Setting* list = check.settings.find(key);
    if (!list) return;
    for (const Row& row : std::get<std::vector<Row>>(list->value))
        if (!row.numbers.empty()) what(row);
}

void fill_obstacles(const Check& check) {
    ObstacleList& obstacles = check.scene.effects.obstacles;
    for_each_row(check, "effects.obstacles.discs", [&obstacles](const Row& row) {
        obstacles.discs.push_back({row.numbers[0], row.numbers[1], row.numbers[2]});
    });
    for_each_row(check, "effects.obstacles.segments", [&obstacles](const Row& row) {
        obstacles.segments.push_back(
            {row.numbers[0], row.numbers[1], row.numbers[2], row.numbers[3]});
    });
    constexpr std::string_view key = "effects.obstacles.restitution";
    if (!obstacles.are_any())
        return refuse_without(check, key,
                              "'effects.obstacles.discs' or 'effects.obstacles.segments'");
    if (const auto restitution = number_within(check, key, 0, 1))
        obstacles.restitution = *restitution;
    if (check.scene.effects.gravity.is_any() && check.scene.effects.drag > 0)
        check.refuse(*check.settings.find("effects.drag.rate"),
                     "this version has no obstacles together with both drag and gravity: it finds "
                     "contacts with bodies on straight lines and parabolas");
    for (std::size_t side = 0; side < 4; ++side)
        if (check.scene.effects.boundaries[side].kind == BoundaryKind::moving)
            check.refuse(*check.settings.find(std::string("box.") + boundary_names[side] + ".kind"),
                         "this version has no moving walls together with obstacles");
}

bool lose_energy_or_fall(const Effects& effects) {
    const bool is_lossy = std::any_of(
        effects.boundaries.begin(), effects.boundaries.end(), [&effects](const Boundary& side) {
            return side.restitution < 1 ||
                   (effects.drag > 0 &&
                    side.speed != 0); // drag presses discs against a wall that pushes them
        });
    return is_lossy || effects.contact.kind == ContactKind::restitution ||
           effects.contact.kind == ContactKind::rough || effects.gravity.is_any() ||
           effects.obstacles.restitution < 1;
}

void check_open_boundaries(const Check& check) {
    const auto& boundaries = check.scene.effects.boundaries;
    const auto has = [&boundaries](BoundaryKind kind) {
        return std::any_of(boundaries.begin(), boundaries.end(),
                           [kind](const Boundary& side) { return side.kind == kind; });
    };
    for (std::size_t side = 0; side < boundaries.size() && has(BoundaryKind::moving); ++side)
        if (boundaries[side].kind == BoundaryKind::open)
            check.refuse(*check.settings.find(std::string("box.") + boundary_names[side] + ".kind"),
                         "this version has no open sides together with moving walls");
}

/// The falling frame must not leave the box far behind: its coordinates would be coarser than the
/// box's.
void check_fall(const Check& check) {
    const Scene& scene = check.scene;
    const auto time = static_cast<double>(scene.sync_every) /
                      static_cast<double>(scene.micro_steps);
    const double drag = scene.effects.drag;
    if (drag * time > longest_drag) return; // refused already
    const double fall = drag > 0 ? dragged_fall(drag, drag_clock(drag, time)) : 0.5 * time * time;
    for (const auto& [key, g] : {std::pair("effects.gravity.x", scene.effects.gravity.x),
                                 {"effects.gravity.y", scene.effects.gravity.y}}) {
        if (std::fabs(g) * fall <= 0.5 * scene.box_size) continue;
        const double longest = std::floor(std::sqrt(scene.box_size / std::fabs(g)) *
                                          static_cast<double>(scene.micro_steps));
        check.refuse(
            *check.settings.find(key),
            fmt::format(
                "'{}' = {} makes discs fall further than half the box from sync to sync; {}", key,
                g,
                longest >= 1 ? fmt::format("time.sync_every = {} or less will do", longest)
                             : "take more time.micro_steps"));
    }
}

void refuse_rows(const Check& check, std::string_view key,
                 const std::function<std::string(const std::vector<double>&)>& fault) {
    std::size_t number = 0;
    for_each_row(check, key, [&](const Row& row) {
        const std::string text = fault(row.numbers);
        ++number;
        if (!text.empty())
            add_problem(check.problems, row.place,
                        fmt::format("row {} of '{}': {}", number, key, text));
    });
}

void check_obstacles(const Check& check) {
    const double size = check.scene.box_size, radius = check.scene.radius;
    const bool is_periodic = check.scene.effects.are_periodic();
    const Generator generator = check.scene.generator;
    if (check.scene.effects.obstacles.are_any() &&
        (generator == Generator::lattice || generator == Generator::legacy)) {
        const Setting* setting = check.settings.find("discs.generator");
        for (const std::string_view key : {"discs.packing", "discs.radius"})
            if (!setting) setting = check.settings.find(key);
        check.refuse(*setting,
                     "a lattice and the legacy generator know nothing of obstacles; insert discs "
                     "at random (at a packing that allows it), or list them");
    }
    const auto is_inside = [size](double x, double y) {
        return x >= 0 && x <= size && y >= 0 && y <= size;
    };
    refuse_rows(check, "effects.obstacles.discs", [&](const std::vector<double>& n) -> std::string {
        if (!is_inside(n[0], n[1]))
            return fmt::format("the centre ({}, {}) is not in the box", n[0], n[1]);
        if (!(n[2] >= 0 && n[2] <= size))
            return fmt::format("the radius must be from 0 to {}, not {}", size, n[2]);
        if (is_periodic && !(n[2] + radius <= largest_in_period * size))
            return fmt::format("the radius must be at most {:g}, not {}: with a disc's it would "
                               "reach through a periodic box and into itself",
                               largest_in_period * size - radius, n[2]);
        return {};
    });
    refuse_rows(check, "effects.obstacles.segments",
                [&](const std::vector<double>& n) -> std::string {
                    if (!is_inside(n[0], n[1]) || !is_inside(n[2], n[3]))
                        return fmt::format(
                            "the segment from ({}, {}) to ({}, {}) has an end outside the box",
                            n[0], n[1], n[2], n[3]);
                    const double length = std::hypot(n[2] - n[0], n[3] - n[1]);
                    if (!(length > 0x1p-30 * size))
                        return fmt::format(
                            "a segment of length {}: a point is a fixed disc of radius 0", length);
                    return {};
                });
}

void check_moving_walls(const Check& check) {
    const Scene& scene = check.scene;
    const auto& boundaries = scene.effects.boundaries;
    const auto refuse = [&check](std::size_t side, const std::string& text) {
        check.refuse(*check.settings.find(std::string("box.") + boundary_names[side] + ".speed"),
                     text);
    };
    for (const std::size_t low : {0u, 2u})
        if (boundaries[low].speed < 0)
            refuse(low, fmt::format("the {} wall would leave the box; let the {} one move out",
                                    boundary_names[low], boundary_names[low + 1]));
    if (scene.effects.are_periodic() && scene.box_size < 4 * scene.radius * (1 + 1e-6)) {
        const std::size_t side = scene.effects.is_periodic_x() ? 0 : 2;
        check.refuse(
            *check.settings.find(std::string("box.") + boundary_names[side] + ".kind"),
            fmt::format("a box of side {} is too small to be periodic: up to two diameters ({}) a "
                        "disc could touch another one on both sides at once",
                        scene.box_size, 4 * scene.radius));
    }
    const Extent end = extent_at(scene.effects, scene.box_size, static_cast<double>(scene.steps));
    const double width = end.x_high - end.x_low, height = end.y_high - end.y_low;
    const double largest = std::max(end.x_high, end.y_high),
                 covered = scene.packing() * scene.box_size * scene.box_size;
    const bool is_full = scene.effects.contact.kind != ContactKind::none &&
                         covered > largest_packing * width * height;
    for (std::size_t side = 0; side < boundaries.size(); ++side) {
        if (boundaries[side].speed == 0) continue;
        if (std::min(width, height) < 2 * scene.radius * (1 + 1e-6) || is_full)
            refuse(side,
                   fmt::format("after {} steps the box would be {} by {}: too small for its discs",
                               scene.steps, width, height));
        else if (largest > 2 * scene.box_size)
            refuse(side,
                   fmt::format(
                       "after {} steps the box would be more than twice as long as at the start",
                       scene.steps));
        break;
    }
}

} // namespace

void fill_effects(const Check& check) {
    fill_contact(check);
    for (std::size_t side = 0; side < 4; ++side) fill_side(check, side);
    check_periodic_boundaries(check);
    fill_gravity(check);
    fill_drag(check);
    fill_thermal(check);
    fill_obstacles(check);
    check_beside_periodic_boundaries(check);
    const Effects& effects = check.scene.effects;
    if (lose_energy_or_fall(effects))
        fill_contact_time(check);
    else
        refuse_without(check, "effects.contact.contact_time",
                       "discs, walls or obstacles of restitution, or gravity");
    if (!effects.are_any()) return;
    const bool are_mixed = !effects.species.empty();
    if (are_mixed && effects.contact.kind == ContactKind::none)
        check.refuse(*check.settings.find("effects.contact.kind"),
                     "this version has no discs of several classes that pass through each other");
    for (const std::string_view key : {"time.precision", "time.arithmetic", "time.accuracy"}) {
        const Setting* setting = check.settings.find(key);
        const bool is_default = setting && std::holds_alternative<std::string>(setting->value) &&
                                check.scene.precision == Precision::double_ &&
                                check.scene.arithmetic == Arithmetic::stable;
        if (setting && !is_default)
            check.refuse(
                *setting,
                fmt::format("'{}' is for scenes without effects, and this one has some", key));
    }
}

void check_room_for_effects(const Check& check) {
    check_fall(check);
    check_open_boundaries(check);
    check_moving_walls(check);
    check_obstacles(check);
}

} // namespace carrom
