// SPDX-License-Identifier: BSD-3-Clause
#include "scene/disc_columns.hpp"

#include <algorithm>
#include <optional>

#include "scene/limits.hpp"
#include "scene/line_reader.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

struct Row {
    DiscId id = 0;
    SizeAndMass body;
    BySideColumn<double> beside;
};

/// The numbers in a line of `5 + columns.size()` words; nothing if DiscReader would refuse it.
std::optional<Row> row_of(const std::vector<std::string_view>& words,
                          const std::vector<DiscColumn>& columns) {
    if (words.size() != 5 + columns.size()) return std::nullopt;
    Row row;
    const auto id = parse_id(words[0]);
    if (!id) return std::nullopt;
    row.id = *id;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        const auto number = parse_double(words[5 + k]);
        if (!number || !column_problem(columns[k], *number).empty()) return std::nullopt;
        number_of(columns[k], row.body, row.beside) = *number;
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

double& number_of(DiscColumn column, SizeAndMass& body, BySideColumn<double>& beside) {
    return column == DiscColumn::radius ? body.radius
           : column == DiscColumn::mass ? body.mass
                                        : beside[side_column_of(column)];
}

const char* name_of(DiscColumn column) {
    return column == DiscColumn::radius ? "radius"
           : column == DiscColumn::mass ? "mass"
                                        : info_of(side_column_of(column)).name;
}

DiscColumns read_disc_columns(std::istream& stream, const SceneParameters& scene) {
    DiscColumns found;
    found.is_whole = false;
    std::vector<Row> rows;
    std::vector<std::string_view> words;
    LineReader lines(stream, 0);
    for (std::string_view line; lines.next(line);) {
        if (lines.is_cut()) return found;
        if (lines.line_number() == 1 && line.starts_with(byte_order_mark))
            line.remove_prefix(byte_order_mark.size());
        if (trimmed(line).empty()) continue;
        split_words(line, 5 + scene.disc_columns.size(), words);
        const std::optional<Row> row = row_of(words, scene.disc_columns);
        if (!row || rows.size() == scene.n_discs) return found;
        rows.push_back(*row);
    }
    if (lines.has_failed() || lines.is_endless() || rows.size() != scene.n_discs) return found;
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].id != i) return found;
    found.is_whole = true;
    for (const Row& row : rows) {
        if (has_column(scene, DiscColumn::radius))
            add_species(found.species, {1, row.body.radius, row.body.mass});
        for (const SideColumn column : all_side_columns)
            if (has_column(scene, disc_column_of(column)))
                add_numbers(found.numbers[column], 1, row.beside[column]);
    }
    return found;
}

} // namespace carrom
