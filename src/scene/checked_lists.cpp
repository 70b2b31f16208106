// SPDX-License-Identifier: BSD-3-Clause
// Checks of the columns that `discs.list` and files of discs have.
#include "scene/data_lines.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

namespace {

constexpr std::string_view no_velocity =
    "no velocity; try: discs.temperature or discs.speed, which "
    "draw velocities of listed discs";

} // namespace

void check_rows_of_list(const SceneDraft& draft) {
    draft.refuse_rows("discs.list", [&](const Numbers& n, std::size_t) -> std::string {
        if (n.size() == 3) return "three numbers; it takes [x, y] or [x, y, vx, vy]";
        if (n.size() == 2 && !draft.scene.draws_velocities) return std::string(no_velocity);
        return {};
    });
}

void check_columns(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    const auto has = [&scene](DiscColumn column) { return has_column(scene, column); };
    const std::initializer_list<std::string_view> keys = {"discs.columns", "discs.file"};
    const bool are_all = has(DiscColumn::x) && has(DiscColumn::y);
    const bool names_any = std::ranges::any_of(
        scene.disc_columns, [](DiscColumn column) { return column < DiscColumn::radius; });
    if (names_any && !are_all)
        draft.refuse(keys, "'discs.columns' names no x or no y; it names all columns of a line, or "
                           "those behind 'id x y vx vy' alone");
    else if (has(DiscColumn::vx) != has(DiscColumn::vy))
        draft.refuse(keys, "'discs.columns' names one of vx and vy, and needs both or neither");
    else if (names_any && !lines_have_velocities(scene) && !scene.draws_velocities)
        draft.refuse({"discs.file"}, fmt::format("lines of '{}' have {}",
                                                 names_of(scene.disc_columns), no_velocity));
}

} // namespace carrom
