// SPDX-License-Identifier: BSD-3-Clause
#include "scene/disc_columns.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "scene/data_lines.hpp"
#include "scene/limits.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

struct Row {
    DiscId id = 0;
    SizeAndMass body;
    BySideColumn<double> beside;
};

/// The line's numbers, with `id` if the line has no id; nothing if one is wrong (reported later).
std::optional<Row> row_of(const std::vector<std::string_view>& words,
                          const std::vector<DiscColumn>& columns, DiscId id) {
    if (words.size() != columns.size()) return std::nullopt;
    Row row{id, {}, {}};
    for (std::size_t k = 0; k < columns.size(); ++k) {
        if (columns[k] == DiscColumn::id) {
            const auto given = parse_id(words[k]);
            if (!given) return std::nullopt;
            row.id = *given;
        } else if (columns[k] >= DiscColumn::radius) {
            const auto number = parse_double(words[k]);
            if (!number || !column_problem(columns[k], *number).empty()) return std::nullopt;
            number_of(columns[k], row.body, row.beside) = *number;
        }
    }
    return row;
}

} // namespace

void add_species(std::vector<Species>& species, const Species& next) {
    if (!species.empty() && species.back().radius == next.radius &&
        species.back().mass == next.mass)
        species.back().count += next.count;
    else
        species.push_back(next);
}

void add_numbers(std::vector<NumberRun>& runs, std::uint64_t count, double number) {
    const DiscId end = (runs.empty() ? 0 : runs.back().end) + count;
    if (!runs.empty() && runs.back().number == number)
        runs.back().end = end;
    else
        runs.push_back({end, number});
}

bool has_column(const SceneParameters& scene, DiscColumn column) {
    return std::find(scene.disc_columns.begin(), scene.disc_columns.end(), column) !=
           scene.disc_columns.end();
}

bool has_columns_beside(const SceneParameters& scene) {
    return std::ranges::any_of(scene.disc_columns,
                               [](DiscColumn column) { return column >= DiscColumn::radius; });
}

bool lines_have_velocities(const SceneParameters& scene) {
    return !has_column(scene, DiscColumn::x) || has_column(scene, DiscColumn::vx);
}

double& number_of(DiscColumn column, SizeAndMass& body, BySideColumn<double>& beside) {
    return column == DiscColumn::radius ? body.radius
           : column == DiscColumn::mass ? body.mass
                                        : beside[side_column_of(column)];
}

const char* name_of(DiscColumn column) {
    constexpr std::array names = {"id", "x", "y", "vx", "vy", "radius", "mass"};
    return column < DiscColumn::first_side ? names[static_cast<std::size_t>(column)]
                                           : info_of(side_column_of(column)).name;
}

DiscColumns read_disc_columns(std::istream& stream, const SceneParameters& scene) {
    DiscColumns found;
    found.is_whole = false;
    std::vector<Row> rows;
    std::vector<std::string_view> words;
    const std::vector<DiscColumn> columns = columns_of_lines(scene);
    DataLines lines(stream, scene, 0);
    for (std::string_view line; lines.next(line);) {
        if (lines.reader().is_cut()) return found;
        split_words(line, columns.size(), words);
        const std::optional<Row> row = row_of(words, columns, rows.size());
        if (!row || rows.size() == scene.n_discs) return found;
        rows.push_back(*row);
    }
    if (lines.reader().has_failed() || lines.reader().is_endless() || rows.size() != scene.n_discs)
        return found;
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].id != i) return found;
    found.is_whole = true;
    for (const Row& row : rows) {
        if (has_column(scene, DiscColumn::radius))
            add_species(found.species, {1, row.body.radius, row.body.mass});
        for (const SideColumn column : given_side_columns)
            if (has_column(scene, disc_column_of(column)))
                add_numbers(found.numbers[column], 1, row.beside[column]);
    }
    return found;
}

} // namespace carrom
