// SPDX-License-Identifier: BSD-3-Clause
#include "scene/frozen_discs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/disc_columns.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/rule_parts.hpp"
#include "scene/start_region.hpp"
#include "scene/toml_text.hpp"

namespace carrom {

namespace {

constexpr std::string_view setting_of_frozen = "discs.frozen=";

/// The number of frozen discs with an id below `end`.
std::uint64_t n_below(const std::vector<FrozenDisc>& frozen, DiscId end) {
    return static_cast<std::uint64_t>(
        std::ranges::lower_bound(frozen, static_cast<double>(end), {}, &FrozenDisc::id) -
        frozen.begin());
}

/// Removes the frozen discs from runs of consecutive ids, and the runs that become empty.
template <class Run> void shorten(std::vector<Run>& runs, const std::vector<FrozenDisc>& frozen) {
    for (Run& run : runs) run.end -= n_below(frozen, run.end);
    DiscId begin = 0;
    std::erase_if(runs,
                  [&begin](const Run& run) { return std::exchange(begin, run.end) == run.end; });
}

/// Subtracts the frozen discs from the counts of species or groups, which are in order of id.
template <class Part>
void subtract(std::vector<Part>& parts, const std::vector<FrozenDisc>& frozen) {
    DiscId begin = 0;
    for (Part& part : parts) {
        const DiscId end = begin + part.count;
        part.count -= n_below(frozen, end) - n_below(frozen, begin);
        begin = end;
    }
}

void apply(SceneParameters& scene, bool has_others_alone) {
    const std::vector<FrozenDisc>& frozen = scene.frozen;
    std::vector<Species>& species = scene.effects.species;
    scene.n_discs -= frozen.size();
    if (!has_others_alone) subtract(species, frozen);
    std::erase_if(species, [](const Species& one) { return one.count == 0; });
    subtract(scene.groups, frozen);
    shorten(scene.regions, frozen);
    shorten(scene.effects.contact.rows, frozen);
    for (std::vector<NumberRun>& runs : scene.first_numbers.values) shorten(runs, frozen);
    if (!species.empty()) scene.radius = std::ranges::max(species, {}, &Species::radius).radius;
    for (const FrozenDisc& disc : frozen)
        scene.effects.fixed_bodies.discs.push_back({disc.x, disc.y, disc.radius});
}

const Need freezing{"without 'discs.freeze' or a group with freeze = true",
                    [](const SceneParameters& s) { return s.freezes(); }};

} // namespace

std::string problem_of_frozen(const SceneParameters& scene, const std::vector<FrozenDisc>& frozen) {
    if (frozen.empty())
        return "no disc begins in a region of 'discs.freeze'; move it, or leave the key out";
    if (frozen.size() >= scene.n_discs)
        return fmt::format("all {} discs are frozen by 'discs.freeze' or their groups, and none "
                           "would move",
                           scene.n_discs);
    const double period = scene.effects.periods(scene.box).shortest();
    const double widest = std::ranges::max(frozen, {}, &FrozenDisc::radius).radius + scene.radius;
    if (scene.effects.are_periodic() && !(widest <= largest_in_period * period))
        return fmt::format("a frozen disc of radius {:g} would reach through a periodic box and "
                           "into itself; take a larger box",
                           widest - scene.radius);
    return {};
}

void set_frozen(SceneParameters& scene, std::vector<FrozenDisc> frozen, bool has_others_alone) {
    scene.frozen = std::move(frozen);
    std::string text = fmt::format("{}[", setting_of_frozen);
    for (const FrozenDisc& disc : scene.frozen)
        text += fmt::format("{}[{}, {}, {}, {}]", text.back() == '[' ? "" : ", ", disc.id, disc.x,
                            disc.y, disc.radius);
    scene.overrides.push_back(text + ']');
    apply(scene, has_others_alone);
}

bool is_of_frozen(std::string_view setting) { return setting.starts_with(setting_of_frozen); }

std::vector<Key> keys_of_freezing() {
    return {
        key("discs.freeze", "length",
            "Regions. Discs that begin with their centres in one of them do not move: they become "
            "obstacles. The others get the ids 0 to n - 1, in their order.",
            [](auto& s) -> auto& { return s.freeze; })
            .by_default("none")
            .needs({"with discs.generator = \"legacy\"",
                    [](const SceneParameters& s) { return s.generator != Generator::legacy; },
                    true})
            .with_rows({{"", "[x0, y0, x1, y1]", 4, 4}}),
        key("discs.frozen", "1, length",
            "The discs that froze, with their distances from the left side and the bottom. The "
            "program writes it, so that checkpoints know them.",
            [](auto& s) -> auto& { return s.frozen; })
            .by_default("found as the run begins")
            .needs(freezing)
            .not_physical()
            .with_rows({{"", "[id, from_left, from_bottom, radius]", 4, 4}}),
    };
}

void check_freezing(const SceneDraft& draft) {
    draft.refuse_rows("discs.freeze", [](const Numbers& n, std::size_t) {
        return n[0] <= n[2] && n[1] <= n[3] ? ""
                                            : "it must be [x0, y0, x1, y1] with x0 <= x1 and "
                                              "y0 <= y1";
    });
}

void take_frozen(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (scene.frozen.empty() || !draft.problems.empty() || scene.n_discs == 0) return;
    double last = -1;
    draft.refuse_rows("discs.frozen", [&](const Numbers& n, std::size_t) {
        const bool is_id = n[0] > std::exchange(last, n[0]) && n[0] == std::floor(n[0]) &&
                           n[0] < static_cast<double>(scene.n_discs);
        if (!is_id) return "ids must be of discs of the scene, and rise";
        return std::isfinite(n[1]) && std::isfinite(n[2]) && n[3] > 0 && n[3] < scene.box.longest()
                   ? ""
                   : "a place and a radius are needed";
    });
    const std::string text = problem_of_frozen(scene, scene.frozen);
    if (draft.problems.empty() && !text.empty()) draft.refuse({"discs.frozen"}, text);
    if (draft.problems.empty())
        apply(scene, draft.columns && has_column(scene, DiscColumn::radius));
}

} // namespace carrom
