// SPDX-License-Identifier: BSD-3-Clause
// Places in the coordinates of users (`box.origin`) and in those of the computation, which count
// from the lower left corner of the box. Scenes, texts, messages and tables have the former; states
// and the raw data of files have the latter, so that no bit of a run depends on the origin.
//
// The keys say which of their numbers are places: by `place_along`, or by the names that the form
// of their rows has. A number of a user becomes one of the computation where its key is taken, and
// nowhere else.
//
// A sum rounds, by half a unit in the last place of the larger coordinate at most. To and fro it
// rounds once: ((u + v) - v) + v = u + v and so on (D. E. Knuth, The Art of Computer Programming,
// vol. 2, section 4.2.2, theorem D).
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/key.hpp"

namespace carrom {

/// The axis of a row's number of this place, or of a key's only one; nothing if it is no place.
std::optional<Axis> axis_of(const Key& key, std::size_t number);
bool has_places(const Key& key);

/// Adds to all places of a checked value.
void move_places(const Key& key, Value& value, double dx, double dy);

/// Sets the origin of a scene whose box is known, and may be 0 if it is wrong.
void find_origin(SceneParameters& scene);

/// The shortest decimal that reads back as this coordinate of the computation.
std::string shown_coordinate(double place, double origin);
/// "(1.5, -2)".
std::string shown_place(const SceneParameters& scene, double x, double y);
/// ", whose lower left corner is at (-5, -5)"; empty if it is at (0, 0).
std::string corner_text(const SceneParameters& scene);

} // namespace carrom
