// SPDX-License-Identifier: BSD-3-Clause
// The rows of `discs.species` as numbers, and how they become species.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// Where the numbers of a row stand. A number that the scene does not give is NaN, except a mass
/// and those beside the state.
namespace species_row {
inline constexpr std::size_t count = 0, radius = 1, mass = 2;
constexpr std::size_t of(SideColumn column) { return 3 + static_cast<std::size_t>(column); }
inline constexpr std::size_t region = 3 + n_side_columns; ///< four numbers
inline constexpr std::size_t packing = region + 4, share = packing + 1, share_of_area = share + 1;
} // namespace species_row

/// In rows of species and groups, where the scene gives no number.
inline constexpr double not_given = std::numeric_limits<double>::quiet_NaN();
inline bool is_given(const Numbers& row, std::size_t place) { return !std::isnan(row[place]); }

Key species_key();

/// Whether columns that a list cannot hold are written in `discs.species`.
bool are_species_listed(const SceneParameters& scene);

/// Rows that say how much of the box or of the discs is theirs, by `packing` or by a share, get the
/// counts that follow, and the scene its species. Refuses rows of which no count follows. Comes
/// before all checks of species.
void fill_species_counts(const SceneDraft& draft);

/// The number of discs of radius r that cover `packing` of the area, to the nearest.
double count_of_packing(double packing, double area, double radius);

} // namespace carrom
