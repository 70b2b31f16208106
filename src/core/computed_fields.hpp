// SPDX-License-Identifier: BSD-3-Clause
// Values for each disc that trajectories can contain but states do not store, because they are
// computed from neighbouring discs. Scenes, trajectories and readers of files use the table below.
// A new field needs a line in this table, and code in `computed_numbers`
// (simulation/disc_order.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace carrom {

struct ComputedField {
    const char* name;                   ///< name in scenes and in the trajectory
    std::array<const char*, 2> columns; ///< column names in tables; the second may be null
    bool is_count;                      ///< whether its values are integers

    constexpr std::size_t width() const { return columns[1] ? 2 : 1; }
};
inline constexpr std::array<ComputedField, 2> computed_field_table = {
    {{"psi6", {"psi6_real", "psi6_imaginary"}, false},
     {"neighbours", {"neighbours", nullptr}, true}}};

/// For each field of the table, in order, whether a trajectory contains the field.
using ComputedFieldSet = std::array<bool, computed_field_table.size()>;

inline constexpr std::size_t n_computed_numbers = [] {
    std::size_t n = 0;
    for (const ComputedField& field : computed_field_table) n += field.width();
    return n;
}();
/// The values of all fields for one disc, in the order of the table.
using ComputedNumbers = std::array<double, n_computed_numbers>;

} // namespace carrom
