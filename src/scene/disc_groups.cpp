// SPDX-License-Identifier: BSD-3-Clause
#include "scene/disc_groups.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/species_rows.hpp"

namespace carrom {

namespace {

/// Limits the number of groups, because initial speeds of each group need sums over all ranks
constexpr std::size_t most_groups = 1000;

/// The indices of the numbers in a row of `discs.groups`.
constexpr std::size_t at_count = 0, at_packing = 1, at_species = 2, at_temperature = 3,
                      at_speed = 4, at_region = 5, at_generator = 9, at_freeze = 10;
constexpr std::array generators = {Generator::random, Generator::lattice, Generator::compressed};

std::optional<double> number_at(const Numbers& row, std::size_t place) {
    return is_given(row, place) ? std::optional(row[place]) : std::nullopt;
}

} // namespace

DiscGroup group_of(const Numbers& n) {
    DiscGroup group;
    if (n[at_count] >= 1 && n[at_count] <= static_cast<double>(largest_count))
        group.count = static_cast<std::uint64_t>(n[at_count]);
    // The row's species may be wrong, because it has not been checked yet
    const double species = n[at_species];
    if (species >= 1 && species <= static_cast<double>(largest_count))
        group.species = static_cast<std::size_t>(species) - 1;
    group.temperature = number_at(n, at_temperature);
    group.speed = number_at(n, at_speed);
    if (is_given(n, at_region))
        group.region = StartRegion{n[at_region], n[at_region + 1], n[at_region + 2],
                                   n[at_region + 3]};
    group.generator = generators[static_cast<std::size_t>(n[at_generator])];
    group.is_frozen = n[at_freeze] != 0;
    return group;
}

namespace {

Numbers row_of(const DiscGroup& group) {
    Numbers row(at_freeze + 1, not_given);
    row[at_count] = static_cast<double>(group.count);
    row[at_species] = static_cast<double>(group.species + 1);
    if (group.temperature) row[at_temperature] = *group.temperature;
    if (group.speed) row[at_speed] = *group.speed;
    if (const auto& r = group.region)
        std::ranges::copy(std::array{r->x_low, r->y_low, r->x_high, r->y_high},
                          row.begin() + at_region);
    row[at_generator] = static_cast<double>(std::ranges::find(generators, group.generator) -
                                            generators.begin());
    row[at_freeze] = group.is_frozen ? 1 : 0;
    return row;
}

/// Stores rows that have a count. Other counts are computed later; then all rows are stored again.
void set_groups(SceneParameters& scene, const Value& value) {
    scene.groups.clear();
    for (const Value& row : std::get<Values>(value.data))
        if (const auto* numbers = std::get_if<Numbers>(&row.data))
            if (const DiscGroup group = group_of(*numbers); group.count > 0)
                scene.groups.push_back(group);
    std::ranges::stable_sort(scene.groups, {}, &DiscGroup::species);
}

Value get_groups(const SceneParameters& scene) {
    if (scene.groups.empty()) return {};
    Values rows;
    for (const DiscGroup& group : scene.groups) rows.push_back({row_of(group)});
    return {std::move(rows)};
}

/// Keys that rows of `discs.species` cannot have if the scene has `discs.groups`.
constexpr std::array<std::pair<std::string_view, std::size_t>, 5> given_by_groups = {
    {{"count", species_row::count},
     {"packing", species_row::packing},
     {"share", species_row::share},
     {"share_of_area", species_row::share_of_area},
     {"region", species_row::region}}};

/// Computes the missing counts in rows of `discs.groups` and `discs.species`.
class GroupCounts {
public:
    explicit GroupCounts(const SceneDraft& draft)
        : draft_(draft), groups_(draft.settings.find_to_complete("discs.groups")),
          species_(draft.settings.find_to_complete("discs.species")), rows_(rows_of(groups_)),
          rows_of_species_(rows_of(species_)) {}

    void fill() {
        const std::size_t n_problems = draft_.problems.size();
        bool is_known = !groups_->is_wrong && !(species_ && species_->is_wrong);
        refuse_rows();
        is_known = is_known && draft_.problems.size() == n_problems && fill_counts();
        if (is_known && species_) is_known = fill_species();
        if (is_known) {
            find_key("discs.groups")->set(draft_.scene, groups_->value);
            if (species_) find_key("discs.species")->set(draft_.scene, species_->value);
            fill_regions();
        } else {
            draft_.scene.groups.clear();
            draft_.scene.effects.species.clear();
            groups_->is_wrong = true;
            if (species_) species_->is_wrong = true;
        }
    }

private:
    static std::vector<Numbers*> rows_of(Setting* setting) {
        std::vector<Numbers*> rows;
        auto* const values = setting ? std::get_if<Values>(&setting->value.data) : nullptr;
        if (!values) return rows;
        for (Value& row : *values)
            if (auto* numbers = std::get_if<Numbers>(&row.data)) rows.push_back(numbers);
        return rows;
    }

    void refuse_rows() {
        if (rows_.size() > most_groups)
            draft_.refuse({"discs.groups"}, fmt::format("'discs.groups' has {} groups; at most {} "
                                                        "are possible",
                                                        rows_.size(), most_groups));
        draft_.refuse_rows("discs.groups",
                           [&](const Numbers& row, std::size_t) { return problem_of(row); });
        draft_.refuse_rows("discs.species", [](const Numbers& row, std::size_t) -> std::string {
            for (const auto& [name, place] : given_by_groups)
                if (is_given(row, place))
                    return fmt::format("its {} is that of its groups; leave it out here, or take "
                                       "species without 'discs.groups'",
                                       name);
            return column_problem(DiscColumn::radius, row[species_row::radius]);
        });
    }
    std::string problem_of(const Numbers& row) const {
        const double n_species = species_ ? static_cast<double>(rows_of_species_.size()) : 1;
        const double species = row[at_species];
        if (!(species >= 1 && species <= n_species && species == std::floor(species)))
            return fmt::format("its species must be a row of 'discs.species', from 1 to {}, not "
                               "{}{}",
                               n_species, species,
                               species_ ? "" : "; without that key all discs are alike");
        if (is_given(row, at_count) == is_given(row, at_packing))
            return is_given(row, at_count) ? "count and packing exclude each other"
                                           : "it needs count or packing";
        const double count = row[at_count];
        if (is_given(row, at_count) &&
            !(count >= 1 && count <= static_cast<double>(largest_count) &&
              count == std::floor(count)))
            return fmt::format("its count must be a whole number from 1 to {}, not {}",
                               largest_count, count);
        if (is_given(row, at_packing) && !(row[at_packing] > 0 && row[at_packing] <= 1))
            return fmt::format("its packing must be greater than 0 and at most 1, not {}",
                               row[at_packing]);
        return {};
    }
    double radius_of(const Numbers& row) const {
        return species_ ? (*rows_of_species_[static_cast<std::size_t>(row[at_species]) -
                                             1])[species_row::radius]
                        : draft_.scene.radius;
    }

    bool fill_counts() {
        if (draft_.scene.box == Box()) return false; // reported already
        for (Numbers* row : rows_) {
            if (!is_given(*row, at_packing)) continue;
            const StartRegion r = region_of(draft_.scene, group_of(*row));
            const double area = is_given(*row, at_region)
                                    ? (r.x_high - r.x_low) * (r.y_high - r.y_low)
                                    : draft_.scene.area();
            if (draft_.scene.are_points)
                draft_.refuse({"discs.groups"}, "points cover nothing, so that no number of discs "
                                                "follows from packing; give a count");
            if (!(radius_of(*row) > 0)) return false; // reported already
            (*row)[at_count] = count_of_packing((*row)[at_packing], area, radius_of(*row));
        }
        const std::size_t n_problems = draft_.problems.size();
        draft_.refuse_rows("discs.groups", [](const Numbers& row, std::size_t) -> std::string {
            if (row[at_count] >= 1 && row[at_count] <= static_cast<double>(largest_count))
                return {};
            return fmt::format("its packing gives {} discs in its region; from 1 to {} are "
                               "possible",
                               row[at_count], largest_count);
        });
        return draft_.problems.size() == n_problems;
    }

    /// The count of a species is the sum over its groups.
    bool fill_species() {
        std::vector<double> counts(rows_of_species_.size());
        for (const Numbers* row : rows_)
            counts[static_cast<std::size_t>((*row)[at_species]) - 1] += (*row)[at_count];
        const std::size_t n_problems = draft_.problems.size();
        draft_.refuse_rows("discs.species", [&](const Numbers&, std::size_t k) {
            return counts[k] > 0 ? std::string()
                                 : fmt::format("no row of 'discs.groups' has discs of it; add one "
                                               "with species = {}, or leave the species out",
                                               k + 1);
        });
        if (draft_.problems.size() > n_problems) return false;
        for (std::size_t k = 0; k < counts.size(); ++k)
            (*rows_of_species_[k])[species_row::count] = counts[k];
        return true;
    }

    void fill_regions() {
        SceneParameters& scene = draft_.scene;
        if (std::ranges::none_of(scene.groups, [](const DiscGroup& g) { return !!g.region; }))
            return;
        scene.regions.clear();
        DiscId end = 0;
        for (const DiscGroup& group : scene.groups)
            scene.regions.push_back({end += group.count, group.region});
    }

    const SceneDraft& draft_;
    Setting* groups_;
    Setting* species_;
    std::vector<Numbers*> rows_, rows_of_species_;
};

} // namespace

StartRegion region_of(const SceneParameters& scene, const DiscGroup& group) {
    return group.region.value_or(StartRegion{0, 0, scene.box.x, scene.box.y});
}

Key groups_key() {
    Key key = named_key(
                  "discs.groups", "discs, 1, 1, mass length^2/step^2, length/step, length, 1, 1",
                  "Groups of discs that begin in ways of their own: discs of one species, a row of "
                  "'discs.species', in a region, as many as the count or the packing there. Ids "
                  "count by species, then by group.")
                  .by_default("none")
                  .excludes({"discs.count", "discs.packing", "discs.generator", "discs.region",
                             "discs.list", "discs.file", "discs.from"})
                  .with_rows({{"count", "", 1, 1, not_given},
                              {"packing", "", 1, 1, not_given},
                              {"species", "", 1, 1, 1.0},
                              {"temperature", "", 1, 1, not_given},
                              {"speed", "", 1, 1, not_given},
                              {"region", "[x0, y0, x1, y1]", 4, 4, not_given},
                              {"generator", "", 1, 1, 0.0, {"random", "lattice", "compressed"}},
                              {"freeze", "", 1, 1, 0.0, {"false", "true"}}});
    key.get = get_groups;
    key.set = set_groups;
    key.compare = [](const SceneParameters& a, const SceneParameters& b) {
        return a.groups == b.groups;
    };
    return key;
}

void fill_groups(const SceneDraft& draft) {
    const Setting* groups = draft.settings.find("discs.groups");
    if (groups && std::holds_alternative<Values>(groups->value.data)) GroupCounts(draft).fill();
}

} // namespace carrom
