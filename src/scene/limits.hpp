// SPDX-License-Identifier: BSD-3-Clause
// What numbers a scene may hold. Sizes and speeds stay within 2^+-250, so that no product the
// method takes of them can overflow or vanish (docs/understanding/method.md, section 4.4); lengths
// above 2^-230, below which discriminants of near grazes are denormal.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.hpp"

namespace carrom {

inline constexpr double smallest_length = 0x1p-230;
inline constexpr double smallest_size = 0x1p-250; ///< of a speed
inline constexpr double largest_size = 0x1p+250;
inline constexpr std::uint64_t largest_count =
    0xFFFFFFFEu; ///< 32-bit places in arrays, one of them meaning "none"
inline constexpr std::int64_t largest_steps = std::int64_t{1}
                                              << 53; ///< step numbers are exact in a double
inline constexpr double largest_packing =
    0.9069; ///< just above pi / (2 sqrt 3), the densest packing of the plane
inline constexpr double largest_random_packing = 0.5; ///< random insertion stalls at about 0.54
inline constexpr std::int64_t longest_single_sync =
    4096; ///< a float then knows 1/2048 of a micro-step
inline constexpr double smallest_single_size = 0x1p-40,
                        largest_single_size = 0x1p+40; ///< their fourth powers are floats
inline constexpr double largest_box_in_radii =
    1e6; ///< beyond, the wall band 1e-8 r drowns in the rounding of L
inline constexpr double longest_drag = 4; ///< rate of drag times the time between syncs
inline constexpr double most_crossings =
    0x1p40; ///< of the box in a micro-step; beyond, times of collisions are all the same number

bool has_boundary(const Effects& effects, BoundaryKind kind);
bool are_pairs_lossy(const Effects& effects);
/// Whether discs may come to rest on each other, or on a wall, so that a contact time is needed.
bool lose_energy_or_fall(const Effects& effects);

/// What is wrong with a velocity component, or empty.
std::string velocity_problem(double component);

/// The same for a speed in this scene, which knows the box and the method; the box may be 0.
std::string speed_problem(double speed, const Scene& scene);

/// What is wrong with a disc's radius, mass or number of a column beside its state, or empty.
std::string column_problem(DiscColumn column, double number);

/// All that is wrong with a disc that an input lists, or empty: a centre outside [r, L-r], r its
/// `radius` (by more than the rounding of L), or a velocity out of range. Any centre will do where
/// the scene has no right box.
std::string disc_problem(const InputDisc& disc, const Scene& scene, double radius);

} // namespace carrom
