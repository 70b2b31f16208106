// SPDX-License-Identifier: BSD-3-Clause
// Which features do not go together. The check and the reference's table both come from here.
#include <utility>

#include "scene/disc_columns.hpp"
#include "scene/effects/effect.hpp"
#include "scene/quantity.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

std::vector<Rule> rules_of_methods() {
    return {
        rule("a moving wall", "time.method = \"time-stepped\"",
             "walls are at rest there; take time.method = \"event-driven\"", BoundaryKind::moving,
             [](const Scene& s) { return has_moving(s) && is_time_stepped(s); }),
        rule("an oscillating wall", "time.method = \"time-stepped\"",
             "walls are at rest there; take time.method = \"event-driven\"",
             BoundaryKind::oscillating,
             [](const Scene& s) { return has_oscillating(s) && is_time_stepped(s); }),
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
        rule("several species", "effects.contact.kind = \"none\"",
             "this version does not have both", {"effects.contact.kind"},
             [](const Scene& s) {
                 return has_species(s) && s.effects.contact.kind == ContactKind::none;
             }),
    };
}

/// Sides whose images move.
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
             {rules_of_effects(), rules_of_oscillations(), rules_of_starts(), rules_of_outputs(),
              rules_of_quantities(), rules_of_columns(std::make_index_sequence<n_side_columns>())})
            list.insert(list.end(), part.begin(), part.end());
        for (const EffectDeclaration& effect : all_effects())
            list.insert(list.end(), effect.rules.begin(), effect.rules.end());
        return list;
    }();
    return all;
}

} // namespace carrom
