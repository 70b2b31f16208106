// SPDX-License-Identifier: BSD-3-Clause
// Numbers of discs that frames of a trajectory may have and no state stores, because they are
// computed from the discs around. Scenes, trajectories and their readers use the table below. A new
// field takes a line there, and its computation in `computed_numbers` (simulation/disc_order.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace carrom {

struct ComputedField {
    const char* name;                   ///< in scenes, and in the trajectory
    std::array<const char*, 2> columns; ///< names of its numbers in tables; null: there is but one
    bool is_count;                      ///< whether it is a whole number

    constexpr std::size_t width() const { return columns[1] ? 2 : 1; }
};
inline constexpr std::array<ComputedField, 2> computed_field_table = {
    {{"psi6", {"psi6_real", "psi6_imaginary"}, false},
     {"neighbours", {"neighbours", nullptr}, true}}};

/// Which fields are wanted, in the order of the table.
using ComputedFieldSet = std::array<bool, computed_field_table.size()>;

inline constexpr std::size_t n_computed_numbers = [] {
    std::size_t n = 0;
    for (const ComputedField& field : computed_field_table) n += field.width();
    return n;
}();
/// The numbers of all fields of one disc, in the order of the table.
using ComputedNumbers = std::array<double, n_computed_numbers>;

} // namespace carrom
