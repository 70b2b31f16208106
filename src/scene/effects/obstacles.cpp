// SPDX-License-Identifier: BSD-3-Clause
// Fixed bodies in the box (dynamics/fixed_bodies.hpp), and boxes that are not rectangles
// (dynamics/container.hpp).
#include <cmath>

#include <fmt/format.h>

#include "core/box_text.hpp"
#include "dynamics/container.hpp"
#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/places.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

const Need some_obstacles{no_obstacles, has_fixed_bodies};

/// The largest coordinates and radii of arcs, in units of the box's longer edge. Larger ones would
/// lose precision.
constexpr double farthest_centre = 100;

/// Rows are circles [x, y, radius], or arcs [x, y, radius, from, to] between angles in degrees.
Key arcs_key() {
    Key key = named_key("effects.obstacles.arcs", "length, degrees",
                        "Circles without thickness, or parts of them, counterclockwise from one "
                        "angle to another; discs meet both faces and both ends.")
                  .by_default("none")
                  .with_rows({{"", "[x, y, radius] or [x, y, radius, from, to]", 3, 5}});
    key.get = [](const SceneParameters& s) {
        Values rows;
        for (const Arc& arc : s.effects.fixed_bodies.arcs) {
            Numbers row{arc.x, arc.y, arc.radius};
            if (arc.from != 0 || arc.to != 360) row.insert(row.end(), {arc.from, arc.to});
            rows.push_back({std::move(row)});
        }
        return Value{std::move(rows)};
    };
    key.set = [](SceneParameters& s, const Value& value) {
        s.effects.fixed_bodies.arcs.clear();
        for (const Value& row : std::get<Values>(value.data))
            if (const auto* n = std::get_if<Numbers>(&row.data)) {
                Arc arc{(*n)[0], (*n)[1], (*n)[2]};
                if (n->size() == 5) arc.from = (*n)[3], arc.to = (*n)[4];
                s.effects.fixed_bodies.arcs.push_back(arc);
            }
    };
    return key;
}

Key polygons_key() {
    Key key = named_key("effects.obstacles.polygons", "length",
                        "Closed lines of straight walls: corners one after the other; the last is "
                        "joined with the first.")
                  .by_default("none")
                  .with_rows({{"", "[x0, y0, x1, y1, x2, y2, ...]", 6, 2000}});
    key.get = [](const SceneParameters& s) {
        Values rows;
        for (const Polygon& polygon : s.effects.fixed_bodies.polygons) rows.push_back({polygon});
        return Value{std::move(rows)};
    };
    key.set = [](SceneParameters& s, const Value& value) {
        s.effects.fixed_bodies.polygons.clear();
        for (const Value& row : std::get<Values>(value.data))
            if (const auto* n = std::get_if<Numbers>(&row.data))
                s.effects.fixed_bodies.polygons.push_back(*n);
    };
    return key;
}

std::vector<Key> keys_of_obstacles() {
    return {
        key("box.shape", "",
            "What discs move in: the box, the largest circle in it, or two half circles joined by "
            "straight walls along the longer edge. Packing and pressure refer to its area, "
            "and keys of 'effects.obstacles' to its wall.",
            [](auto& s) -> auto& { return s.effects.fixed_bodies.shape; }),
        key("effects.obstacles.discs", "length", "Fixed discs; a radius of 0 is a point.",
            [](auto& s) -> auto& { return s.effects.fixed_bodies.discs; })
            .with_rows({{"", "[x, y, radius]", 3, 3}}),
        key("effects.obstacles.segments", "length",
            "Straight walls without thickness; discs meet both faces and both ends.",
            [](auto& s) -> auto& { return s.effects.fixed_bodies.segments; })
            .with_rows({{"", "[x0, y0, x1, y1]", 4, 4}}),
        arcs_key(),
        polygons_key(),
        key("effects.obstacles.restitution", "1",
            "Share of the normal velocity that is left, of all obstacles.",
            [](auto& s) -> auto& { return s.effects.fixed_bodies.restitution; })
            .within(Range{0, 1})
            .needs(some_obstacles),
    };
}

std::vector<Rule> rules_of_obstacles() {
    return {
        rule("obstacles", "drag and a force in flight at once",
             "contacts with bodies are found on straight lines and parabolas",
             {"effects.drag.rate"},
             [](const SceneParameters& s) {
                 return has_fixed_bodies(s) && s.effects.drag > 0 &&
                        s.effects.acceleration().is_on();
             }),
        rule("obstacles", "walls that move",
             "obstacles need walls at rest: a disc between the two would have no way out",
             {"effects.obstacles.discs", "effects.obstacles.segments", "effects.obstacles.arcs",
              "effects.obstacles.polygons"},
             [](const SceneParameters& s) {
                 return has_fixed_bodies(s) && !are_walls_at_rest(s.effects);
             }),
        rule("box.shape = \"round\" or \"stadium\"", "sides that are not plain walls",
             "discs never meet the sides there; 'effects.obstacles' has the keys of the wall",
             {"box.shape"},
             [](const SceneParameters& s) {
                 return s.effects.fixed_bodies.has_shape() && !s.effects.have_plain_boundaries();
             }),
        rule("box.shape = \"round\" or \"stadium\"", "\"wall_pressure\" or \"wall_exchange\"",
             "discs never meet the sides there; \"obstacle_forces\" has the wall's pressure, force "
             "and torque",
             {"box.shape"},
             [](const SceneParameters& s) {
                 return s.effects.fixed_bodies.has_shape() && s.measurements &&
                        (s.measurements->measures("wall_pressure") ||
                         s.measurements->measures("wall_exchange"));
             }),
        rule("obstacles", "discs.generator = \"triangular\" or \"legacy\"",
             "these generators know nothing of obstacles; insert discs at random, compress them, "
             "place them on a lattice, list them, or freeze some of them (discs.freeze)",
             {"discs.generator", "discs.packing", "discs.radius", "discs.species"},
             [](const SceneParameters& s) {
                 return s.effects.fixed_bodies.are_any() &&
                        (s.generator == Generator::triangular || s.generator == Generator::legacy);
             }),
    };
}

void check_arcs(const SceneDraft& draft) {
    const Box box = draft.scene.box;
    const double size = box.longest(), most = farthest_centre * size;
    const double period = draft.scene.effects.periods(box).shortest();
    draft.refuse_rows("effects.obstacles.arcs", [&](const Numbers& n, std::size_t) -> std::string {
        if (n.size() == 4) return "four numbers; an arc has an angle at either end";
        if (!(n[2] > 0x1p-30 * size && n[2] <= most))
            return fmt::format("the radius must be above {:.3g} and at most {:g}, not {}",
                               0x1p-30 * size, most, n[2]);
        if (!(std::fabs(n[0]) <= most && std::fabs(n[1]) <= most))
            return fmt::format("the centre {} must be within {:g} of the box's lower left corner",
                               shown_place(draft.scene, n[0], n[1]), most);
        if (n.size() == 5 && !(std::fabs(n[3]) <= 360 && n[4] > n[3] && n[4] - n[3] <= 360))
            return fmt::format("angles go up from the first, from -360 to 360, by at most 360 "
                               "degrees, not from {} to {}",
                               n[3], n[4]);
        if (!draft.scene.effects.are_periodic()) return {};
        if (!(n[0] >= 0 && n[0] <= box.x && n[1] >= 0 && n[1] <= box.y))
            return fmt::format("the centre {} is not in the periodic box",
                               shown_place(draft.scene, n[0], n[1]));
        if (!(n[2] + draft.scene.radius <= largest_in_period * period))
            return fmt::format("the radius must be at most {:g}, not {}: with a disc's it would "
                               "reach through a periodic box and into itself",
                               largest_in_period * period - draft.scene.radius, n[2]);
        return {};
    });
}

void check_shape(const SceneDraft& draft) {
    const Box& box = draft.scene.box;
    const BoxShape shape = draft.scene.effects.fixed_bodies.shape;
    if (shape == BoxShape::round && !box.is_square())
        draft.refuse({"box.shape"}, fmt::format("box.shape = \"round\" needs a square, not a box "
                                                "of {}; try: \"stadium\"",
                                                sides_text(box)));
    if (shape == BoxShape::stadium && box.longest() - box.shortest() < 0x1p-20 * box.longest())
        draft.refuse({"box.shape"}, "box.shape = \"stadium\" needs a box that is longer than it is "
                                    "high, or higher; try: \"round\"");
}

void check_obstacles(const SceneDraft& draft) {
    const Box box = draft.scene.box;
    const double size = box.longest(), radius = draft.scene.radius;
    const bool is_periodic = draft.scene.effects.are_periodic();
    const double period = draft.scene.effects.periods(box).shortest();
    const auto is_inside = [box](double x, double y) {
        return x >= 0 && x <= box.x && y >= 0 && y <= box.y;
    };
    draft.refuse_rows("effects.obstacles.discs", [&](const Numbers& n, std::size_t) -> std::string {
        if (!is_inside(n[0], n[1]))
            return fmt::format("the centre {} is not in the box{}",
                               shown_place(draft.scene, n[0], n[1]), corner_text(draft.scene));
        if (!(n[2] >= 0 && n[2] <= size))
            return fmt::format("the radius must be from 0 to {}, not {}", size, n[2]);
        if (is_periodic && !(n[2] + radius <= largest_in_period * period))
            return fmt::format("the radius must be at most {:g}, not {}: with a disc's it would "
                               "reach through a periodic box and into itself",
                               largest_in_period * period - radius, n[2]);
        return {};
    });
    const auto segment_problem = [&](double x0, double y0, double x1, double y1) -> std::string {
        if (!is_inside(x0, y0) || !is_inside(x1, y1))
            return fmt::format("the segment from {} to {} has an end outside the box{}",
                               shown_place(draft.scene, x0, y0), shown_place(draft.scene, x1, y1),
                               corner_text(draft.scene));
        const double length = std::hypot(x1 - x0, y1 - y0);
        if (!(length > 0x1p-30 * size))
            return fmt::format("a segment of length {}: a point is a fixed disc of radius 0",
                               length);
        return {};
    };
    draft.refuse_rows("effects.obstacles.segments", [&](const Numbers& n, std::size_t) {
        return segment_problem(n[0], n[1], n[2], n[3]);
    });
    draft.refuse_rows(
        "effects.obstacles.polygons", [&](const Numbers& n, std::size_t) -> std::string {
            if (n.size() % 2 != 0) return fmt::format("{} numbers are no pairs x, y", n.size());
            for (const Segment& edge : edges_of(n)) {
                std::string text = segment_problem(edge.x0, edge.y0, edge.x1, edge.y1);
                if (!text.empty()) return text;
            }
            return {};
        });
    check_arcs(draft);
    check_shape(draft);
}

std::string summary_of_obstacles(const Effects& effects) {
    const FixedBodyList& all = effects.fixed_bodies;
    if (!all.are_any()) return {};
    const auto counted = [](std::size_t n, const char* what) {
        return n == 0 ? std::string() : fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
    };
    std::string text;
    for (const std::string& part :
         {counted(all.discs.size(), "fixed disc"), counted(all.segments.size(), "segment"),
          counted(all.arcs.size(), "arc"), counted(all.polygons.size(), "polygon"),
          std::string(all.shape == BoxShape::round     ? "a round wall"
                      : all.shape == BoxShape::stadium ? "a stadium's wall"
                                                       : "")})
        if (!part.empty()) text += (text.empty() ? "" : " and ") + part;
    return text + (all.restitution < 1 ? fmt::format(" of restitution {:g}", all.restitution) : "");
}

} // namespace

namespace effects {

EffectDeclaration obstacles() {
    return {
        .tables = {{"effects.obstacles", "Bodies that stand fixed in the box."}},
        .keys = keys_of_obstacles(),
        .rules = rules_of_obstacles(),
        .check_room = check_obstacles,
        .summary = summary_of_obstacles,
        .allowance =
            [](const Effects& e) {
                return CheckAllowance{.collisions_take_energy = e.fixed_bodies.restitution < 1};
            },
        .lets_discs_rest = [](const Effects& e) { return e.fixed_bodies.restitution < 1; },
        .common_motion = [](const Effects& e,
                            Axis) { return CommonMotion{.is_stopped = e.fixed_bodies.are_any()}; }};
}

} // namespace effects

} // namespace carrom
