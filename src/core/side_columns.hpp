// SPDX-License-Identifier: BSD-3-Clause
// Numbers of discs beside their 64-byte states, in runs whose dynamics need them.
//
// Engines migrate, sort, exchange, speculate on and roll back whatever is present, and need not
// know its meaning. A new column takes a name and a line in the table below, and a line in
// `side_columns_of`. A run without a column has no memory and no work for it.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/disc.hpp"

namespace carrom {

enum class SideColumn : std::size_t { spin, n_columns };
inline constexpr auto n_side_columns = static_cast<std::size_t>(SideColumn::n_columns);

struct SideColumnInfo {
    const char* name;
    const char* unit;
};
inline constexpr std::array<SideColumnInfo, n_side_columns> side_column_table = {
    {{"spin", "angle per micro-step"}}};

/// The columns that are present, each along the same list of discs.
class SideColumns {
public:
    bool has(SideColumn column) const { return is_present_[place_of(column)]; }
    /// `values` that are left out are 0.
    void add(SideColumn column, std::vector<double> values = {}) {
        is_present_[place_of(column)] = true;
        (*this)[column] = std::move(values);
    }

    /// Empty where the column is not present.
    std::vector<double>& operator[](SideColumn column) { return values_[place_of(column)]; }
    const std::vector<double>& operator[](SideColumn column) const {
        return values_[place_of(column)];
    }

    /// Calls visit(column) for each that is present.
    template <class Visit> void for_each(const Visit& visit) const {
        for (std::size_t k = 0; k < n_side_columns; ++k)
            if (is_present_[k]) visit(static_cast<SideColumn>(k));
    }
    void resize(std::size_t n) {
        for_each([&](SideColumn column) { (*this)[column].resize(n, 0); });
    }

    /// Takes `places[i]` of `from`, which has the same columns, to place i.
    void gather(const SideColumns& from, std::span<const LocalIndex> places) {
        for_each([&](SideColumn column) {
            std::vector<double>& values = (*this)[column];
            values.resize(places.size());
            for (std::size_t i = 0; i < places.size(); ++i) values[i] = from[column][places[i]];
        });
    }
    /// Copies what stands at place `source` of `from`, which has the same columns.
    void copy(std::size_t target, const SideColumns& from, std::size_t source) {
        for_each([&](SideColumn column) { (*this)[column][target] = from[column][source]; });
    }

private:
    static constexpr std::size_t place_of(SideColumn column) {
        return static_cast<std::size_t>(column);
    }

    std::array<bool, n_side_columns> is_present_{};
    std::array<std::vector<double>, n_side_columns> values_;
};

/// Those that the dynamics need, empty.
template <class Dynamics> SideColumns side_columns_of() {
    SideColumns columns;
    if constexpr (Dynamics::has_spin) columns.add(SideColumn::spin);
    return columns;
}

} // namespace carrom
