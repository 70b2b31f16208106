// SPDX-License-Identifier: BSD-3-Clause
#include "scene/boundaries/boundary.hpp"

#include <algorithm>

#include "core/errors.hpp"
#include "dynamics/surface_table.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

const BoundaryDeclaration& declaration_of(BoundaryKind kind) {
    const auto found = std::ranges::find(all_boundaries(), kind, &BoundaryDeclaration::kind);
    ensure(found != all_boundaries().end(),
           "a kind of side is missing in the list of src/scene/CMakeLists.txt");
    return *found;
}

std::string_view word_of(BoundaryKind kind) {
    return boundary_words[static_cast<std::size_t>(kind)];
}

/// The text is static, because keys contain views of it.
const std::string& help_of_kinds() {
    static const std::string text = [] {
        std::string all;
        for (const BoundaryDeclaration& one : all_boundaries())
            all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", word_of(one.kind), one.help);
        return all + '.';
    }();
    return text;
}

} // namespace

std::vector<Key> keys_of_boundaries() {
    std::vector<Key> all;
    for (std::size_t side = 0; side < boundary_names.size(); ++side) {
        all.push_back(key(side_key(side, "kind"), "", help_of_kinds(),
                          [side](auto& s) -> auto& { return s.effects.boundaries[side].kind; })
                          .advises({{"lees-edwards", "\"sheared\", at bottom and top"},
                                    {"shear", "\"sheared\", at bottom and top"},
                                    {"pbc", "\"periodic\""},
                                    {"reflecting", "\"wall\""},
                                    {"reflective", "\"wall\""},
                                    {"rough", "\"wall\" with a tangential_restitution above -1"},
                                    {"absorbing", "\"open\""}}));
        all.push_back(
            key(side_key(side, "restitution"), "1",
                "Share of the normal velocity that is left after a collision.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].restitution; })
                .within({0, 1})
                .needs(side_reflects(side)));
        for (const BoundaryDeclaration& one : all_boundaries())
            if (one.keys_of_side)
                for (Key& more : one.keys_of_side(side)) all.push_back(std::move(more));
    }
    return all;
}

std::string summary_of_boundaries(const Effects& effects) {
    std::string text;
    for (std::size_t k = 0; k < boundary_names.size(); ++k) {
        const Boundary& side = effects.boundaries[k];
        if (side.kind == BoundaryKind::wall && side.restitution == 1) continue;
        text += (text.empty() ? "" : "; ") +
                declaration_of(side.kind).summary(side, boundary_names[k]);
    }
    return text;
}

CheckAllowance allowance_of_boundaries(const Effects& effects) {
    CheckAllowance all;
    for (const Boundary& side : effects.boundaries) {
        all.collisions_take_energy |= side.restitution < 1;
        if (const auto allowance = declaration_of(side.kind).allowance)
            all.walls_give_energy |= allowance(side).walls_give_energy;
    }
    return all;
}

bool do_sides_take_growing_discs(const Effects& effects) {
    for (std::size_t side = 0; side < effects.boundaries.size(); ++side)
        if (!declaration_of(effects.boundaries[side].kind).takes_growing_discs ||
            does_rub(effects, side))
            return false;
    return true;
}

bool are_walls_at_rest(const Effects& effects) {
    return std::ranges::all_of(effects.boundaries, [](const Boundary& side) {
        return declaration_of(side.kind).is_at_rest;
    });
}

bool do_sides_let_discs_rest(const Effects& effects) {
    return std::ranges::any_of(effects.boundaries, [](const Boundary& side) {
        return declaration_of(side.kind).lets_discs_rest;
    });
}

std::string side_key(std::size_t side, std::string_view name) {
    return fmt::format("box.{}.{}", boundary_names[side], name);
}

Need side_reflects(std::size_t side) {
    std::string words;
    for (const BoundaryDeclaration& one : all_boundaries())
        if (one.has_restitution)
            words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", word_of(one.kind));
    if (const auto last = words.rfind(", "); last != std::string::npos)
        words.replace(last, 2, " or ");
    return {fmt::format("without {} = {}", side_key(side, "kind"), words),
            [side](const SceneParameters& s) {
                return declaration_of(s.effects.boundaries[side].kind).has_restitution;
            }};
}

Need side_needs(std::size_t side, BoundaryKind kind) {
    return {
        fmt::format("without {} = \"{}\"", side_key(side, "kind"), word_of(kind)),
        [side, kind](const SceneParameters& s) { return s.effects.boundaries[side].kind == kind; }};
}

std::string loss_text(const Boundary& side) {
    return side.restitution < 1 ? fmt::format(" of restitution {:g}", side.restitution) : "";
}

bool has_room(const SceneParameters& scene, double width, double height) {
    const double covered = scene.packing() * scene.box.x * scene.box.y;
    const bool is_full = scene.effects.contact.kind != ContactKind::none &&
                         covered > largest_packing * width * height;
    return std::min(width, height) >= 2 * scene.radius * (1 + 1e-6) && !is_full;
}

} // namespace carrom
