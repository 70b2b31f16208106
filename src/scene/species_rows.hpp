// SPDX-License-Identifier: BSD-3-Clause
// The rows of `discs.species` as numbers, and their conversion to species.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// The indices of the numbers in a row of `discs.species`. A number that the scene leaves out is
/// NaN, except that mass and side columns have defaults.
namespace species_row {
inline constexpr std::size_t count = 0, radius = 1, mass = 2;
constexpr std::size_t of(SideColumn column) { return 3 + static_cast<std::size_t>(column); }
inline constexpr std::size_t region = 3 + n_given_columns; ///< index of the first of 4 coordinates
inline constexpr std::size_t packing = region + 4, share = packing + 1, share_of_area = share + 1;
} // namespace species_row

/// The value of a number that a row leaves out.
inline constexpr double not_given = std::numeric_limits<double>::quiet_NaN();
inline bool is_given(const Numbers& row, std::size_t place) { return !std::isnan(row[place]); }

Key species_key();

/// Whether discs have initial numbers that `discs.list` cannot contain, but `discs.species` can.
bool are_species_listed(const SceneParameters& scene);

/// Computes the counts of rows that give `packing` or a share instead, and the scene's species.
/// Reports rows without a count. Call it before all checks of species.
void fill_species_counts(const SceneDraft& draft);

/// The number of discs of this radius that cover the share `packing` of `area`, rounded.
double count_of_packing(double packing, double area, double radius);

} // namespace carrom
