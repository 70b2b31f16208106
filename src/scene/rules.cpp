// SPDX-License-Identifier: BSD-3-Clause
// The list of features that cannot be combined. The check and the page of conflicts use it.
#include <utility>

#include "scene/boundaries/boundary.hpp"
#include "scene/disc_columns.hpp"
#include "scene/quantity.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

std::vector<Rule> rules_of_methods() {
    return {
        rule("time.precision = \"single\"", "effects", "it is there for the accuracy study alone",
             {"time.precision"},
             [](const SceneParameters& s) {
                 return has_effects(s) && s.precision == Precision::single;
             }),
        rule("time.arithmetic = \"naive\"", "effects", "it is there for the accuracy study alone",
             {"time.arithmetic"},
             [](const SceneParameters& s) {
                 return has_effects(s) && s.arithmetic == Arithmetic::naive;
             }),
        rule("time.accuracy", "effects", "the pilot knows plain gases only", {"time.accuracy"},
             [](const SceneParameters& s) { return has_effects(s) && s.accuracy.has_value(); }),
    };
}

std::vector<Rule> rules_of_starts() {
    return {
        rule("discs.generator = \"legacy\"", "box.size = [Lx, Ly]",
             "the course program's box is a square", {"box.size"},
             [](const SceneParameters& s) {
                 return s.generator == Generator::legacy && !s.box.is_square();
             }),
        rule("discs.generator = \"triangular\"", "walls or open sides",
             "the lattice repeats itself beyond the sides; make all four periodic, or take "
             "discs.generator = \"lattice\"",
             {"discs.generator"},
             [](const SceneParameters& s) {
                 return s.generator == Generator::triangular && !is_periodic_all_round(s);
             }),
        rule("discs.velocities = \"reversed\"", "drawn velocities", "it turns listed ones round",
             {"discs.velocities"},
             [](const SceneParameters& s) {
                 return s.velocities == VelocityKind::reversed &&
                        (s.generator != Generator::file || s.draws_velocities);
             }),
    };
}

/// Makes the rule that frames cannot contain a column that discs do not have.
template <std::size_t k> Rule rule_of_column() {
    return rule(side_column_table[k].shown, "discs without it", side_column_table[k].needs,
                {"output.trajectory.fields"}, [](const SceneParameters& s) {
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
             [](const SceneParameters& s) {
                 return s.trajectory && s.trajectory->has_image && !s.effects.are_periodic();
             }),
        rule("masses in discs.columns", "columns without radii", "a species has both",
             {"discs.columns"},
             [](const SceneParameters& s) {
                 return has_column(s, DiscColumn::mass) && !has_column(s, DiscColumn::radius);
             }),
    };
}

} // namespace

const std::vector<Rule>& rules() {
    static const std::vector<Rule> all = [] {
        std::vector<Rule> list = rules_of_methods();
        for (const auto& part :
             {rules_of_starts(), rules_of_machine(), rules_of_outputs(), rules_of_quantities(),
              rules_of_columns(std::make_index_sequence<n_side_columns>())})
            list.insert(list.end(), part.begin(), part.end());
        for (const BoundaryDeclaration& kind : all_boundaries())
            list.insert(list.end(), kind.rules.begin(), kind.rules.end());
        for (const EffectDeclaration& effect : all_effects())
            list.insert(list.end(), effect.rules.begin(), effect.rules.end());
        return list;
    }();
    return all;
}

} // namespace carrom
