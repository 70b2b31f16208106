// SPDX-License-Identifier: BSD-3-Clause
// Side columns: numbers that some runs need for each disc in addition to its 64-byte state.
//
// Engines send, sort and roll back all columns that a run has, whatever their meaning. Scenes,
// checkpoints, restarts and recordings use the table below. A new column needs a name and a line in
// the table. If effects need the column, add a line to the function `side_columns_of` of
// dynamics/effects.hpp; if collisions change it, add a line to the last function of this file. A
// run without the column uses no memory and no time for it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/disc_state.hpp"

namespace carrom {

enum class SideColumn : std::size_t { spin, direction, swapped_radius, n_columns };
inline constexpr auto n_side_columns = static_cast<std::size_t>(SideColumn::n_columns);

struct SideColumnInfo {
    const char* name;  ///< name in checkpoints, and in scenes that give initial values
    const char* shown; ///< the column's name in recordings, tables and the fields of a trajectory
    bool is_rate;      ///< whether it is a rate, stored per micro-step
    /// If true, the effects of a run determine whether it has the column. If false, a run has the
    /// column if its scene gives initial values.
    bool is_of_dynamics;
    bool is_given;     ///< whether scenes may give initial values; such columns come first
    const char* needs; ///< error message if initial values are given in a run without this column
};
inline constexpr std::array<SideColumnInfo, n_side_columns> side_column_table = {
    {{"spin", "angular_velocity", true, true, true,
      "it needs discs that turn, effects.contact.kind = \"rough\""},
     {"direction", "direction", false, true, true,
      "it needs discs that propel themselves, effects.activity"},
     {"swapped_radius", "swapped_radius", false, true, false,
      "it needs discs that exchange their radii, effects.swap"}}};

constexpr const SideColumnInfo& info_of(SideColumn column) {
    return side_column_table[static_cast<std::size_t>(column)];
}

inline constexpr std::array<SideColumn, n_side_columns> all_side_columns = [] {
    std::array<SideColumn, n_side_columns> all{};
    for (std::size_t k = 0; k < n_side_columns; ++k) all[k] = static_cast<SideColumn>(k);
    return all;
}();

/// Number of columns for which scenes may give initial values
inline constexpr std::size_t n_given_columns = static_cast<std::size_t>(
    std::count_if(side_column_table.begin(), side_column_table.end(),
                  [](const SideColumnInfo& info) { return info.is_given; }));
inline constexpr std::array<SideColumn, n_given_columns> given_side_columns = [] {
    std::array<SideColumn, n_given_columns> given{};
    for (std::size_t k = 0; k < n_given_columns; ++k) given[k] = static_cast<SideColumn>(k);
    return given;
}();

/// One value for each column.
template <class T> struct BySideColumn {
    std::array<T, n_side_columns> values{};

    T& operator[](SideColumn column) { return values[static_cast<std::size_t>(column)]; }
    const T& operator[](SideColumn column) const {
        return values[static_cast<std::size_t>(column)];
    }
    friend bool operator==(const BySideColumn&, const BySideColumn&) = default;
};

/// A subset of the columns.
struct SideColumnSet {
    std::array<bool, n_side_columns> flags{};

    bool has(SideColumn column) const { return flags[static_cast<std::size_t>(column)]; }
    void add(SideColumn column) { flags[static_cast<std::size_t>(column)] = true; }
    /// Calls visit(column) for each column of the set.
    template <class Visit> void for_each(const Visit& visit) const {
        for (std::size_t k = 0; k < n_side_columns; ++k)
            if (flags[k]) visit(static_cast<SideColumn>(k));
    }
    friend bool operator==(const SideColumnSet&, const SideColumnSet&) = default;
};

/// For each column a view of its values for a list of discs; empty if the column is absent.
using SideSpans = BySideColumn<std::span<const double>>;

/// The columns of a run. Each has one number for each disc of a list, in the order of this list.
class SideColumns {
public:
    SideColumns() = default;
    /// Copies the columns that have numbers; empty columns become absent.
    explicit SideColumns(const SideSpans& spans) {
        for (std::size_t k = 0; k < n_side_columns; ++k)
            if (!spans.values[k].empty())
                add(static_cast<SideColumn>(k), {spans.values[k].begin(), spans.values[k].end()});
    }

    const SideColumnSet& present() const { return present_; }
    bool has(SideColumn column) const { return present_.has(column); }
    /// Adds a column. Without `values` it is empty, and `resize` then fills it with zeros.
    void add(SideColumn column, std::vector<double> values = {}) {
        present_.add(column);
        (*this)[column] = std::move(values);
    }
    SideSpans spans() const {
        SideSpans spans;
        for_each([&](SideColumn column) { spans[column] = (*this)[column]; });
        return spans;
    }

    /// The numbers of a column; empty if the column is absent.
    std::vector<double>& operator[](SideColumn column) { return values_[place_of(column)]; }
    const std::vector<double>& operator[](SideColumn column) const {
        return values_[place_of(column)];
    }

    /// Calls visit(column) for each column that is present.
    template <class Visit> void for_each(const Visit& visit) const { present_.for_each(visit); }
    void resize(std::size_t n) {
        for_each([&](SideColumn column) { (*this)[column].resize(n, 0); });
    }

    /// Copies the numbers at `places[i]` of `from` to place i, for each i. `from` must have all of
    /// these columns and may have more.
    void gather(const SideColumns& from, std::span<const LocalIndex> places) {
        for_each([&](SideColumn column) {
            std::vector<double>& values = (*this)[column];
            values.resize(places.size());
            for (std::size_t i = 0; i < places.size(); ++i) values[i] = from[column][places[i]];
        });
    }
    /// Copies the numbers at place `source` of `from` to place `target`. `from` has no columns that
    /// are absent here.
    void copy(std::size_t target, const SideColumns& from, std::size_t source) {
        from.for_each([&](SideColumn column) { (*this)[column][target] = from[column][source]; });
    }

private:
    static constexpr std::size_t place_of(SideColumn column) {
        return static_cast<std::size_t>(column);
    }

    SideColumnSet present_;
    std::array<std::vector<double>, n_side_columns> values_;
};

/// Empty columns for the values that collisions change under these dynamics.
template <class Dynamics> SideColumns side_columns_of(const Dynamics& dynamics) {
    SideColumns columns;
    if (dynamics.has_spin()) columns.add(SideColumn::spin);
    return columns;
}

} // namespace carrom
