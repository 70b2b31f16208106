// SPDX-License-Identifier: BSD-3-Clause
// Which features do not go together. The check and the reference's table both come from here.
#include <utility>

#include "scene/disc_columns.hpp"
#include "scene/key.hpp"
#include "scene/limits.hpp"
#include "scene/quantity.hpp"

namespace carrom {

namespace {

bool is_time_stepped(const Scene& s) { return s.method == Method::time_stepped; }
bool is_rough(const Scene& s) { return s.effects.contact.kind == ContactKind::rough; }
bool has_species(const Scene& s) { return !s.effects.species.empty(); }
bool has_open(const Scene& s) { return s.effects.have_open_boundaries(); }
bool has_moving(const Scene& s) { return has_boundary(s.effects, BoundaryKind::moving); }
bool has_oscillating(const Scene& s) { return has_boundary(s.effects, BoundaryKind::oscillating); }
bool has_obstacles(const Scene& s) { return s.effects.obstacles.are_any(); }
bool has_growth(const Scene& s) { return s.effects.growth != 0; }
bool is_periodic_all_round(const Scene& s) {
    return s.effects.is_periodic_x() && s.effects.is_periodic_y();
}

using Keys = std::vector<std::string_view>;
using Predicate = bool (*)(const Scene&);

Rule rule(std::string_view one, std::string_view other, std::string_view why, const Keys& keys,
          Predicate is_broken) {
    return {one, other, why, keys, {}, is_broken};
}
Rule rule(std::string_view one, std::string_view other, std::string_view why, BoundaryKind side,
          Predicate is_broken) {
    return {one, other, why, {}, side, is_broken};
}

std::vector<Rule> rules_of_methods() {
    return {
        rule("a moving wall", "time.method = \"time-stepped\"",
             "walls are at rest there; take time.method = \"event-driven\"", BoundaryKind::moving,
             [](const Scene& s) { return has_moving(s) && is_time_stepped(s); }),
        rule("an oscillating wall", "time.method = \"time-stepped\"",
             "walls are at rest there; take time.method = \"event-driven\"",
             BoundaryKind::oscillating,
             [](const Scene& s) { return has_oscillating(s) && is_time_stepped(s); }),
        rule("gravity", "time.method = \"time-stepped\"",
             "discs fly straight there; take time.method = \"event-driven\"",
             {"effects.gravity.y", "effects.gravity.x"},
             [](const Scene& s) { return s.effects.gravity.is_any() && is_time_stepped(s); }),
        rule("drag", "time.method = \"time-stepped\"",
             "discs keep their speed there; take time.method = \"event-driven\"",
             {"effects.drag.rate"},
             [](const Scene& s) { return s.effects.drag != 0 && is_time_stepped(s); }),
        rule(
            "time.precision = \"single\"", "effects", "it is there for the accuracy study alone",
            {"time.precision"},
            [](const Scene& s) { return s.effects.are_any() && s.precision == Precision::single; }),
        rule("time.arithmetic = \"naive\"", "effects", "it is there for the accuracy study alone",
             {"time.arithmetic"},
             [](const Scene& s) {
                 return s.effects.are_any() && s.arithmetic == Arithmetic::naive;
             }),
        rule("time.accuracy", "effects", "the pilot knows plain gases only", {"time.accuracy"},
             [](const Scene& s) { return s.effects.are_any() && s.accuracy.has_value(); }),
    };
}

std::vector<Rule> rules_of_oscillations() {
    return {
        rule("an oscillating wall", "obstacles", "this version does not have both",
             BoundaryKind::oscillating,
             [](const Scene& s) { return has_oscillating(s) && has_obstacles(s); }),
        rule("an oscillating wall", "drag", "contacts are found on straight lines and parabolas",
             BoundaryKind::oscillating,
             [](const Scene& s) { return has_oscillating(s) && s.effects.drag != 0; }),
        rule("an open side", "an oscillating wall", "this version does not have both",
             BoundaryKind::open, [](const Scene& s) { return has_oscillating(s) && has_open(s); }),
    };
}

std::vector<Rule> rules_of_effects() {
    return {
        rule("drag", "rough discs", "spins would need a drag of their own", {"effects.drag.rate"},
             [](const Scene& s) { return s.effects.drag != 0 && is_rough(s); }),
        rule("obstacles", "drag and gravity at once",
             "contacts with bodies are found on straight lines and parabolas",
             {"effects.drag.rate"},
             [](const Scene& s) {
                 return has_obstacles(s) && s.effects.drag > 0 && s.effects.gravity.is_any();
             }),
        rule("a moving wall", "obstacles", "this version does not have both", BoundaryKind::moving,
             [](const Scene& s) { return has_moving(s) && has_obstacles(s); }),
        rule("an open side", "a moving wall", "this version does not have both", BoundaryKind::open,
             [](const Scene& s) { return has_moving(s) && has_open(s); }),
        rule("a periodic side", "an open side", "this version does not have both",
             BoundaryKind::periodic,
             [](const Scene& s) { return s.effects.are_periodic() && has_open(s); }),
        rule("a periodic side", "walls or an open side opposite (left, right)",
             "box.left.kind and box.right.kind must both be \"periodic\", or neither",
             {"box.left.kind", "box.right.kind"},
             [](const Scene& s) {
                 const auto& sides = s.effects.boundaries;
                 return (sides[0].kind == BoundaryKind::periodic) !=
                        (sides[1].kind == BoundaryKind::periodic);
             }),
        rule("a periodic side", "walls or an open side opposite (bottom, top)",
             "box.bottom.kind and box.top.kind must both be \"periodic\", or neither",
             {"box.bottom.kind", "box.top.kind"},
             [](const Scene& s) {
                 const auto& sides = s.effects.boundaries;
                 return (sides[2].kind == BoundaryKind::periodic) !=
                        (sides[3].kind == BoundaryKind::periodic);
             }),
        rule("gravity along x", "periodic sides left and right",
             "discs would fall for ever, unless rough walls or drag stop them: not in this version",
             {"effects.gravity.x"},
             [](const Scene& s) { return s.effects.gravity.x != 0 && s.effects.is_periodic_x(); }),
        rule("gravity along y", "periodic sides bottom and top",
             "discs would fall for ever, unless rough walls or drag stop them: not in this version",
             {"effects.gravity.y"},
             [](const Scene& s) { return s.effects.gravity.y != 0 && s.effects.is_periodic_y(); }),
        rule("several species", "effects.contact.kind = \"none\"",
             "this version does not have both", {"effects.contact.kind"},
             [](const Scene& s) {
                 return has_species(s) && s.effects.contact.kind == ContactKind::none;
             }),
    };
}

/// Sides whose images move.
std::vector<Rule> rules_of_shear() {
    return {
        rule("a sheared side", "another kind of side opposite",
             "box.bottom.kind and box.top.kind must both be \"sheared\", or neither",
             {"box.bottom.kind", "box.top.kind"},
             [](const Scene& s) {
                 const auto& sides = s.effects.boundaries;
                 return (sides[2].kind == BoundaryKind::sheared) !=
                        (sides[3].kind == BoundaryKind::sheared);
             }),
        rule("sheared sides left or right", "a flow along x",
             "the flow is along x and grows with y; make bottom and top sheared",
             {"box.left.kind", "box.right.kind"},
             [](const Scene& s) {
                 const auto& sides = s.effects.boundaries;
                 return sides[0].kind == BoundaryKind::sheared ||
                        sides[1].kind == BoundaryKind::sheared;
             }),
        rule("sheared sides", "walls or open sides left and right",
             "the flow goes through them; make box.left.kind and box.right.kind \"periodic\"",
             {"box.left.kind", "box.right.kind"},
             [](const Scene& s) { return s.effects.are_sheared() && !s.effects.is_periodic_x(); }),
        rule("sheared sides", "drag or obstacles",
             "both stand still, and the flow has no place where it does",
             {"effects.drag.rate", "effects.obstacles.discs", "effects.obstacles.segments"},
             [](const Scene& s) {
                 return s.effects.are_sheared() && (s.effects.drag != 0 || has_obstacles(s));
             }),
        rule("sheared sides", "growing discs", "this version does not have both",
             {"effects.growth.rate"},
             [](const Scene& s) { return s.effects.are_sheared() && has_growth(s); }),
        rule("sheared sides", "\"image\"", "images move: whole numbers do not say where they are",
             {"output.trajectory.fields"},
             [](const Scene& s) {
                 return s.trajectory && s.trajectory->has_image && s.effects.are_sheared();
             }),
    };
}

std::vector<Rule> rules_of_starts() {
    return {
        rule("discs.generator = \"legacy\"", "box.size = [Lx, Ly]",
             "the course program's box is a square", {"box.size"},
             [](const Scene& s) { return s.generator == Generator::legacy && !s.box.is_square(); }),
        rule("discs.generator = \"triangular\"", "walls or open sides",
             "the lattice repeats itself beyond the sides; make all four periodic, or take "
             "discs.generator = \"lattice\"",
             {"discs.generator"},
             [](const Scene& s) {
                 return s.generator == Generator::triangular && !is_periodic_all_round(s);
             }),
        rule("obstacles",
             "discs.generator = \"lattice\", \"triangular\", \"compressed\" or \"legacy\"",
             "these generators know nothing of obstacles; insert discs at random (at a packing "
             "fraction that allows it), or list them",
             {"discs.generator", "discs.packing", "discs.radius", "discs.species"},
             [](const Scene& s) {
                 return has_obstacles(s) &&
                        (s.generator == Generator::lattice ||
                         s.generator == Generator::triangular ||
                         s.generator == Generator::compressed || s.generator == Generator::legacy);
             }),
    };
}

std::vector<Rule> rules_of_growth() {
    return {
        rule("growing discs", "time.method = \"time-stepped\"",
             "radii stay there; take time.method = \"event-driven\"", {"effects.growth.rate"},
             [](const Scene& s) { return has_growth(s) && is_time_stepped(s); }),
        rule("growing discs", "rough discs, or effects.contact.kind = \"none\"",
             "this version does not have both", {"effects.growth.rate"},
             [](const Scene& s) {
                 return has_growth(s) &&
                        (is_rough(s) || s.effects.contact.kind == ContactKind::none);
             }),
        rule("growing discs", "gravity, drag or obstacles", "this version does not have both",
             {"effects.growth.rate"},
             [](const Scene& s) {
                 return has_growth(s) &&
                        (s.effects.gravity.is_any() || s.effects.drag != 0 || has_obstacles(s));
             }),
        rule("growing discs", "a thermal, a moving, an oscillating or an open side",
             "this version does not have both", {"effects.growth.rate"},
             [](const Scene& s) {
                 return has_growth(s) && (has_moving(s) || has_oscillating(s) || has_open(s) ||
                                          has_boundary(s.effects, BoundaryKind::thermal));
             }),
    };
}

/// Frames have no numbers that discs do not have.
template <std::size_t k> Rule rule_of_column() {
    return rule(side_column_table[k].shown, "discs without it", side_column_table[k].needs,
                {"output.trajectory.fields"}, [](const Scene& s) {
                    return s.trajectory && s.trajectory->columns.flags[k] &&
                           !side_columns_of(s).flags[k];
                });
}
template <std::size_t... k> std::vector<Rule> rules_of_columns(std::index_sequence<k...>) {
    return {rule_of_column<k>()...};
}

std::vector<Rule> rules_of_outputs() {
    return {
        rule("\"image\"", "a box between walls", "it counts flights through periodic sides",
             {"output.trajectory.fields"},
             [](const Scene& s) {
                 return s.trajectory && s.trajectory->has_image && !s.effects.are_periodic();
             }),
        rule("spins in discs.columns", "discs that are not rough",
             "spins have no meaning without effects.contact.kind = \"rough\"", {"discs.columns"},
             [](const Scene& s) {
                 return has_column(s, disc_column_of(SideColumn::spin)) && !is_rough(s);
             }),
        rule("masses in discs.columns", "columns without radii", "a species has both",
             {"discs.columns"},
             [](const Scene& s) {
                 return has_column(s, DiscColumn::mass) && !has_column(s, DiscColumn::radius);
             }),
    };
}

} // namespace

const std::vector<Rule>& rules() {
    static const std::vector<Rule> all = [] {
        std::vector<Rule> list = rules_of_methods();
        for (const auto& part :
             {rules_of_effects(), rules_of_shear(), rules_of_oscillations(), rules_of_growth(),
              rules_of_starts(), rules_of_outputs(), rules_of_quantities(),
              rules_of_columns(std::make_index_sequence<n_side_columns>())})
            list.insert(list.end(), part.begin(), part.end());
        return list;
    }();
    return all;
}

} // namespace carrom
