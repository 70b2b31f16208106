// SPDX-License-Identifier: BSD-3-Clause
// The ranges of numbers in a scene. Sizes and speeds stay within 2^+-250, so that no product of the
// method can overflow or underflow (docs/understanding/method.md, section 4.4). Lengths are at
// least 2^-230, because otherwise discriminants of near grazes would be denormal.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene_parameters.hpp"

namespace carrom {

inline constexpr double smallest_length = 0x1p-230;
inline constexpr double smallest_size = 0x1p-250; ///< the smallest speed other than 0
inline constexpr double largest_size = 0x1p+250;
/// The largest number of discs. Indices have 32 bits, and one value of an index means "none"
inline constexpr std::uint64_t largest_count = 0xFFFFFFFEu;
/// The largest number of steps or micro-steps; whole numbers up to it are exact in a double
inline constexpr std::int64_t largest_steps = std::int64_t{1} << 53;
/// Just above pi / (2 sqrt 3), the packing fraction of the densest lattice of equal discs
inline constexpr double largest_packing = 0.9069;
/// Random insertion slows down above this packing, and jams at about 0.54
inline constexpr double largest_random_packing = 0.5;
/// Most micro-steps between syncs in single precision, because floats up to 4096 resolve 1/2048
inline constexpr std::int64_t longest_single_sync = 4096;
inline constexpr double smallest_single_size = 0x1p-40,
                        largest_single_size = 0x1p+40; ///< floats can hold third powers of both
/// Largest ratio of the box's longer edge to the smallest radius r. Positions are then rounded by
/// about 1e-10 r, a hundredth of the tolerance for contacts with walls, 1e-8 r.
inline constexpr double largest_box_in_radii = 1e6;
inline constexpr double longest_drag = 4; ///< limit of drag's rate times the time between syncs
/// The most crossings of the box in a micro-step, so that collision times of a disc stay distinct
inline constexpr double most_crossings = 0x1p40;

/// The largest sum of the radii of a fixed body and a disc, in units of the period, so that a disc
/// touches only the nearest images of a body.
inline constexpr double largest_in_period = 0.99;

bool has_boundary(const Effects& effects, BoundaryKind kind);
bool are_pairs_lossy(const Effects& effects);
/// Whether discs may come to rest on each other, or on a wall, so that a contact time is needed.
bool lose_energy_or_fall(const Effects& effects);

/// What is wrong with a velocity component; empty if it is valid.
std::string velocity_problem(double component);

/// Why a speed is too high for the scene's box and method; empty if it is not, or if the box is 0.
std::string speed_problem(double speed, const SceneParameters& scene);

/// A warning if discs are so fast that the scene's speeds may have a wrong unit; otherwise empty.
/// `fastest`: the largest speed at the start. `later`: a speed that walls or effects give to discs.
std::string units_warning(double fastest, double later, const SceneParameters& scene);

/// What is wrong with a disc's radius, mass or number in a side column; empty if it is valid.
std::string column_problem(DiscColumn column, double number);

/// All problems with the velocity and position of a disc in an input; empty if there are none. With
/// its `radius` r, the centre must lie in [r, L-r] between walls, [-r, L+r] between open sides, and
/// [0, L] between periodic ones, within rounding. In an unknown box any finite centre is valid.
std::string disc_problem(const InputDisc& disc, const SceneParameters& scene, double radius);

} // namespace carrom
