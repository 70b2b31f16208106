// SPDX-License-Identifier: BSD-3-Clause
// The key `discs.species`.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scene/disc_columns.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/species_rows.hpp"

namespace carrom {

namespace {

/// Appends `count` discs with the region of the row `n`. Extends the last run if it has the same
/// region.
void add_region(std::vector<RegionRun>& runs, std::uint64_t count, const Numbers& n) {
    const double* const r = &n[species_row::region];
    std::optional<StartRegion> region;
    if (!std::isnan(r[0])) region = StartRegion{r[0], r[1], r[2], r[3]};
    const DiscId end = (runs.empty() ? 0 : runs.back().end) + count;
    if (!runs.empty() && runs.back().region == region)
        runs.back().end = end;
    else
        runs.push_back({end, region});
}

/// Stores the rows that have a count. The other counts are computed later (species_counts.cpp), and
/// then all rows are stored again.
void set_species(SceneParameters& scene, const Value& value) {
    FirstNumbers numbers;
    std::vector<RegionRun> regions;
    std::vector<SpeciesRow>& rows = scene.effects.contact.rows;
    scene.effects.species.clear();
    rows.clear();
    std::size_t number = 0;
    for (const Value& row : std::get<Values>(value.data)) {
        const std::size_t row_number = number++;
        if (row.is_nothing()) continue;
        const Numbers& n = std::get<Numbers>(row.data);
        scene.has_shares |= !std::isnan(n[species_row::share]) ||
                            !std::isnan(n[species_row::share_of_area]);
        if (!(n[0] >= 1 && n[0] <= static_cast<double>(largest_count))) continue;
        const auto count = static_cast<std::uint64_t>(n[0]);
        add_species(scene.effects.species, {count, n[1], n[2]});
        for (const SideColumn column : given_side_columns)
            add_numbers(numbers[column], count, n[species_row::of(column)]);
        add_region(regions, count, n);
        rows.push_back({(rows.empty() ? 0 : rows.back().end) + count, row_number});
    }
    scene.regions.clear();
    if (std::ranges::any_of(regions, [](const RegionRun& run) { return run.region.has_value(); }))
        scene.regions = regions;
    for (const SideColumn column : given_side_columns) {
        const std::vector<NumberRun>& runs = numbers[column];
        if (runs.size() > 1 || (runs.size() == 1 && runs[0].number != 0))
            scene.first_numbers[column] = runs;
    }
}

/// Splits species into rows for output. A row ends where a number, region or row of input changes.
class SpeciesRows {
public:
    explicit SpeciesRows(const SceneParameters& scene)
        : scene_(scene), region_(scene.regions.begin()), row_(scene.effects.contact.rows.begin()) {
        for (const SideColumn column : given_side_columns)
            if (!has_column(scene, disc_column_of(column)))
                numbers_[column] = scene.first_numbers[column];
    }

    /// The row for the next discs of the species, from id `first` on. If the row ends before the
    /// id `end`, lowers `end` to the end of the row.
    Numbers next(const Species& one, DiscId first, DiscId& end) {
        Numbers row(species_row::share_of_area + 1, not_given);
        row[species_row::radius] = one.radius;
        row[species_row::mass] = one.mass;
        for (const SideColumn column : given_side_columns) {
            const std::vector<NumberRun>& runs = numbers_[column];
            std::size_t& run = next_[column];
            while (run < runs.size() && runs[run].end <= first) ++run;
            if (run < runs.size()) end = std::min(end, runs[run].end);
            row[species_row::of(column)] = run < runs.size() ? runs[run].number : 0;
        }
        while (row_ != scene_.effects.contact.rows.end() && row_->end <= first) ++row_;
        if (row_ != scene_.effects.contact.rows.end()) end = std::min(end, row_->end);
        if (!scene_.groups.empty()) return row; // groups have the counts and regions
        while (region_ != scene_.regions.end() && region_->end <= first) ++region_;
        if (region_ != scene_.regions.end()) {
            end = std::min(end, region_->end);
            if (const auto& r = region_->region)
                std::ranges::copy(std::array{r->x_low, r->y_low, r->x_high, r->y_high},
                                  row.begin() + species_row::region);
        }
        row[species_row::count] = static_cast<double>(end - first);
        return row;
    }

private:
    const SceneParameters& scene_;
    FirstNumbers numbers_;
    BySideColumn<std::size_t> next_; // index in the runs of each column
    std::vector<RegionRun>::const_iterator region_;
    std::vector<SpeciesRow>::const_iterator row_;
};

Value get_species(const SceneParameters& scene) {
    const auto& species = scene.effects.species;
    if (species.empty() || scene.sizes || has_column(scene, DiscColumn::radius) ||
        (!scene.listed_discs.empty() && !are_species_listed(scene)))
        return {};
    SpeciesRows of_species(scene);
    Values rows;
    DiscId first = 0;
    for (const Species& one : species) {
        for (const DiscId last = first + one.count; first < last;) {
            DiscId end = last;
            rows.push_back({of_species.next(one, first, end)});
            first = end;
        }
    }
    return {std::move(rows)};
}

} // namespace

bool are_species_listed(const SceneParameters& scene) {
    return std::any_of(
        given_side_columns.begin(), given_side_columns.end(), [&](SideColumn column) {
            return column != SideColumn::spin && !scene.first_numbers[column].empty();
        });
}

Key species_key() {
    std::vector<Field> fields = {
        {"count", "", 1, 1, not_given}, {"radius", ""}, {"mass", "", 1, 1, 1.0}};
    for (const SideColumn column : given_side_columns)
        fields.push_back({info_of(column).name, "", 1, 1, 0.0});
    fields.push_back({"region", "[x0, y0, x1, y1]", 4, 4, not_given});
    for (const std::string_view name : {"packing", "share", "share_of_area"})
        fields.push_back({name, "", 1, 1, not_given});
    Key key = named_key("discs.species", "discs, length, mass, 1/step, radians, length, 1, 1, 1",
                        "Species of discs in the order of ids, in place of one radius. In place of "
                        "a count: the packing in the region, or shares of all discs or of the area "
                        "that they cover, which sum to 1.")
                  .by_default("none")
                  .needs({"with discs.generator = \"legacy\"",
                          [](const SceneParameters& s) { return s.generator != Generator::legacy; },
                          true})
                  .formerly("discs.classes")
                  .with_rows(fields);
    key.get = get_species;
    key.set = set_species;
    key.compare = [](const SceneParameters& a, const SceneParameters& b) {
        const auto name_rows = [](const Effects& effects) {
            return !effects.contact.pairs.empty() || effects.surface_contacts.is_on();
        };
        return a.effects.species == b.effects.species && a.regions == b.regions &&
               ((!name_rows(a.effects) && !name_rows(b.effects)) ||
                a.effects.contact.rows == b.effects.contact.rows);
    };
    return key;
}

} // namespace carrom
