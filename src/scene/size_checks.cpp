// SPDX-License-Identifier: BSD-3-Clause
#include "scene/size_checks.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "scene/limits.hpp"
#include "scene/size_distribution.hpp"

namespace carrom {

namespace {

constexpr std::array<std::string_view, 6> not_with_sizes = {
    "discs.radius", "discs.species", "discs.groups", "discs.list", "discs.columns", "discs.file"};

/// Why the limits of a distribution contain no radii, or too few of them; empty if they are valid.
std::string problem_of_limits(const SizeDistribution& sizes) {
    const auto [smallest, largest] = size_limits(sizes);
    if (!(smallest > 0 && smallest <= largest))
        return fmt::format("radii from {:.4g} to {:.4g} times the mean: the smallest must be "
                           "positive and not above the largest; set discs.radius.smallest, or a "
                           "smaller polydispersity",
                           smallest, largest);
    const double share = share_within_limits(sizes);
    if (share >= smallest_share) return {};
    return fmt::format("radii from {:.10g} to {:.10g} times the mean hold {:.2g} of a distribution "
                       "of polydispersity {:g}, and must hold at least {:g} of it; try: "
                       "discs.radius.smallest below 1, the mean, and discs.radius.largest above",
                       smallest, largest, share, sizes.polydispersity, smallest_share);
}

} // namespace

void check_rivals_of_sizes(const SceneDraft& draft) {
    if (!draft.scene.sizes) return;
    for (const std::string_view other : not_with_sizes)
        if (draft.settings.has(other))
            draft.refuse(
                {other},
                fmt::format("'{}' has no meaning where radii follow a distribution", other));
}

bool check_distribution(const SceneDraft& draft) {
    const SizeDistribution& sizes = *draft.scene.sizes;
    for (const std::string_view part :
         {"distribution", "polydispersity", "mean", "smallest", "largest", "mass"})
        if (const Setting* one = draft.settings.find(fmt::format("discs.radius.{}", part));
            one && one->is_wrong)
            return false;
    const bool is_alone = std::ranges::none_of(
        not_with_sizes, [&](std::string_view other) { return draft.settings.has(other); });
    const bool has_mean = draft.settings.has("discs.radius.mean"),
               has_packing = draft.settings.has("discs.packing");
    if (!has_mean && !has_packing)
        draft.refuse({}, "'discs.radius.mean' is missing, or 'discs.packing', which gives it");
    if (!is_alone || has_mean == has_packing) return false;
    const std::string text = problem_of_limits(sizes);
    if (text.empty()) return true;
    draft.refuse({"discs.radius.smallest", "discs.radius.largest", "discs.radius.polydispersity"},
                 text);
    return false;
}

} // namespace carrom
