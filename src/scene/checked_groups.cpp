// SPDX-License-Identifier: BSD-3-Clause
// The checks of `discs.groups` that need the radii and masses of their discs.
#include <cmath>
#include <numbers>

#include "core/box_text.hpp"
#include "lattices/lattice.hpp"
#include "scene/disc_groups.hpp"
#include "scene/limits.hpp"
#include "scene/species_rows.hpp"
#include "scene/start_region.hpp"

namespace carrom {

namespace {

bool do_overlap(const StartRegion& a, const StartRegion& b) {
    return a.x_low < b.x_high && b.x_low < a.x_high && a.y_low < b.y_high && b.y_low < a.y_high;
}

/// Checks rows of `discs.groups` with the radii and masses in the rows of `discs.species`.
class GroupCheck {
public:
    explicit GroupCheck(const SceneDraft& draft) : scene_(draft.scene) {
        draft.for_each_row("discs.groups", [this](const Numbers& row, std::size_t, const Place&) {
            groups_.push_back(group_of(row));
        });
        if (const Setting* species = draft.settings.find("discs.species"))
            for (const Value& row : std::get<Values>(species->value.data)) {
                const Numbers& n = std::get<Numbers>(row.data);
                bodies_.push_back({n[species_row::radius], n[species_row::mass]});
            }
        else
            bodies_.push_back({scene_.radius, 1});
    }

    std::string problem_of(std::size_t k) const {
        const SizeAndMass& body = bodies_[groups_[k].species];
        for (std::string text : {problem_of_place(groups_[k], body), problem_of_rivals(k),
                                 problem_of_speed(groups_[k], body)})
            if (!text.empty()) return text;
        return {};
    }

private:
    std::string problem_of_place(const DiscGroup& group, const SizeAndMass& body) const {
        const StartRegion r = region_of(scene_, group);
        const std::string text = problem_of_region(scene_, r, body.radius);
        if (!text.empty()) return "its region " + text;
        const double area = static_cast<double>(group.count) * std::numbers::pi * body.radius *
                            body.radius;
        const Box box(r.x_high - r.x_low, r.y_high - r.y_low);
        if (group.generator == Generator::random) {
            const std::string crowd = problem_of_crowd(r, group.count, area);
            return crowd.empty() ? crowd
                                 : "its region " + crowd + ", or generator = \"compressed\"";
        }
        if (group.generator == Generator::lattice && !widest_lattice(group.count, box, body.radius))
            return fmt::format("no lattice of {} discs of radius {:g} fits its region of {}; try: "
                               "generator = \"compressed\", or fewer discs",
                               group.count, body.radius, sides_text(box));
        if (area <= largest_packing * box.area()) return {};
        return fmt::format("{} discs of radius {:g} would cover {:.4g} of its region, and no "
                           "packing covers more than {}",
                           group.count, body.radius, area / box.area(), largest_packing);
    }
    /// If regions of groups overlap, at most one of these groups may be a lattice or compressed,
    /// because only random insertion finds room between discs that are already there.
    std::string problem_of_rivals(std::size_t k) const {
        if (groups_[k].generator == Generator::random) return {};
        for (std::size_t i = 0; i < k; ++i)
            if (groups_[i].generator != Generator::random &&
                do_overlap(region_of(scene_, groups_[i]), region_of(scene_, groups_[k])))
                return fmt::format("its region overlaps that of row {}, and only discs with "
                                   "generator = \"random\" find places among others",
                                   i + 1);
        return {};
    }
    std::string problem_of_speed(const DiscGroup& group, const SizeAndMass& body) const {
        if (group.temperature && group.speed) return "temperature and speed exclude each other";
        double speed = group.speed.value_or(0);
        if (group.temperature) speed = std::sqrt(2 * (*group.temperature / body.mass));
        const bool is_zero = group.temperature == 0.0 || group.speed == 0.0;
        if ((!group.temperature && !group.speed) || is_zero) return {};
        if (!column_problem(DiscColumn::mass, body.mass).empty()) return {}; // reported already
        if (!(speed >= smallest_size && speed <= 0x1p-8 * largest_size))
            return fmt::format("its {} must be 0, or give speeds from 2^-250 to 2^242, not {}",
                               group.speed ? "speed" : "temperature",
                               group.speed.value_or(group.temperature.value_or(0)));
        return speed_problem(speed, scene_);
    }

    const SceneParameters& scene_;
    std::vector<DiscGroup> groups_;
    std::vector<SizeAndMass> bodies_;
};

} // namespace

void check_groups(const SceneDraft& draft) {
    if (draft.scene.groups.empty()) return;
    const GroupCheck check(draft);
    draft.refuse_rows("discs.groups",
                      [&](const Numbers&, std::size_t k) { return check.problem_of(k); });
}

} // namespace carrom
