// SPDX-License-Identifier: BSD-3-Clause
#include "scene/start_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/box_text.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/places.hpp"

namespace carrom {

namespace {

/// The number, largest radius and covered area of the discs that start in one region.
struct Crowd {
    std::uint64_t count = 0;
    double largest = 0, area = 0;
};

/// Adds the discs with the ids `first` to `end` - 1.
void add_discs(Crowd& crowd, const SceneParameters& scene, DiscId first, DiscId end) {
    const auto add = [&crowd](double radius, std::uint64_t n) {
        crowd.count += n;
        crowd.largest = std::max(crowd.largest, radius);
        crowd.area += static_cast<double>(n) * std::numbers::pi * radius * radius;
    };
    if (scene.effects.species.empty()) add(scene.radius, end - first);
    DiscId begin = 0;
    for (const Species& one : scene.effects.species) {
        const DiscId low = std::max(begin, first), high = std::min(begin + one.count, end);
        if (low < high) add(one.radius, high - low);
        begin += one.count;
    }
}

/// The discs of each start region. Species with equal regions are counted together.
std::vector<std::pair<StartRegion, Crowd>> crowds_of(const SceneParameters& scene) {
    std::vector<RegionRun> runs = scene.regions;
    if (runs.empty()) runs.push_back({scene.n_discs, scene.region});
    std::vector<std::pair<StartRegion, Crowd>> crowds;
    std::map<std::array<double, 4>, std::size_t> known;
    DiscId first = 0;
    for (const RegionRun& run : runs) {
        if (const auto region = run.region ? run.region : scene.region) {
            const auto& [x_low, y_low, x_high, y_high] = *region;
            const auto [at, is_new] = known.try_emplace({x_low, y_low, x_high, y_high},
                                                        crowds.size());
            if (is_new) crowds.push_back({*region, {}});
            add_discs(crowds[at->second].second, scene, first, run.end);
        }
        first = run.end;
    }
    return crowds;
}

std::string text_of(const SceneParameters& scene, const StartRegion& r) {
    const Origin& o = scene.origin;
    return fmt::format("[{:g}, {:g}, {:g}, {:g}]", r.x_low - o.x, r.y_low - o.y, r.x_high - o.x,
                       r.y_high - o.y);
}

std::string problem_of(const SceneParameters& scene, const StartRegion& r, const Crowd& crowd) {
    const std::string text = problem_of_region(scene, r, crowd.largest);
    return text.empty() ? problem_of_crowd(r, crowd.count, crowd.area) : text;
}

} // namespace

std::string problem_of_region(const SceneParameters& scene, const StartRegion& r,
                              double largest_radius) {
    const auto is_within = [](double low, double high, double length) {
        return low >= 0 && low < high && high <= length;
    };
    if (!is_within(r.x_low, r.x_high, scene.box.x) || !is_within(r.y_low, r.y_high, scene.box.y))
        return fmt::format(
            "must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1, inside a box of {}{}",
            sides_text(scene.box), corner_text(scene));
    const double width = r.x_high - r.x_low, height = r.y_high - r.y_low;
    if (std::min(width, height) >= 2 * largest_radius) return {};
    return fmt::format("is narrower than a disc of radius {:g}, which begins there whole",
                       largest_radius);
}

std::string problem_of_crowd(const StartRegion& r, std::uint64_t count, double area) {
    const double packing = area / ((r.x_high - r.x_low) * (r.y_high - r.y_low));
    if (packing <= largest_random_packing * (1 + 1e-12)) return {};
    return fmt::format("would be covered to {:.4g} by {} discs, and random places are found up to "
                       "{}; take a larger region or fewer discs",
                       packing, count, largest_random_packing);
}

std::optional<StartRegion> region_of(const SceneParameters& scene, DiscId id) {
    const auto run = std::ranges::upper_bound(scene.regions, id, {}, &RegionRun::end);
    if (run != scene.regions.end() && run->region) return run->region;
    return scene.region;
}

bool has_regions(const SceneParameters& scene) { return scene.region || !scene.regions.empty(); }

Key region_key() {
    Key key = named_key("discs.region", "length",
                        "Rectangle in which discs begin at random, whole; a species may have its "
                        "own.")
                  .by_default("the box")
                  .needs({"without discs.generator = \"random\"",
                          [](const SceneParameters& s) { return s.generator == Generator::random; },
                          true})
                  .with_rows({{"", "[x0, y0, x1, y1]", 4, 4}});
    key.is_one_row = true;
    key.get = [](const SceneParameters& s) {
        if (!s.region) return Value{};
        const StartRegion& r = *s.region;
        return Value{Values{Value{Numbers{r.x_low, r.y_low, r.x_high, r.y_high}}}};
    };
    key.set = [](SceneParameters& s, const Value& value) {
        for (const Value& row : std::get<Values>(value.data))
            if (const auto* n = std::get_if<Numbers>(&row.data))
                s.region = StartRegion{(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
    };
    return key;
}

void check_regions(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    // Groups are left out, because they have their own checks
    if (!has_regions(scene) || !scene.groups.empty()) return;
    if (!scene.regions.empty() && scene.generator != Generator::random)
        return draft.refuse({"discs.species"}, "a region of a species has no meaning without "
                                               "discs.generator = \"random\"");
    for (const auto& [region, crowd] : crowds_of(scene)) {
        const std::string text = problem_of(scene, region, crowd);
        if (!text.empty())
            draft.refuse({scene.regions.empty() || region == scene.region ? "discs.region"
                                                                          : "discs.species"},
                         fmt::format("the region {} {}", text_of(scene, region), text));
    }
}

} // namespace carrom
