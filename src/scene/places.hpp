// SPDX-License-Identifier: BSD-3-Clause
// Places (positions) in users' coordinates, which begin at `box.origin`, and internal ones, which
// begin at the lower left corner of the box. Scenes, texts, messages and tables use the former.
// States and files of raw data use the latter, so that no bit of a run depends on the
// origin.
//
// A key declares which of its numbers are places: by `place_along`, or by the names in the form of
// its rows. Values of keys are converted just before the scene stores them, and back for output.
//
// The conversion is a sum, rounded by at most half a unit in the last place of the result. After
// one conversion back and forth, further ones change nothing: (((u + v) - v) + v) - v = (u + v) - v
// in rounded sums (D. E. Knuth, The Art of Computer Programming, vol. 2, section 4.2.2, theorem D).
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/key.hpp"

namespace carrom {

/// The axis of the number with index `number` in a row of the key, or of the key's only number
/// (index 0); nothing if it is not a place.
std::optional<Axis> axis_of(const Key& key, std::size_t number);
bool has_places(const Key& key);

/// Adds dx or dy to all coordinates in the value of `key`, whose form must have been checked.
void move_places(const Key& key, Value& value, double dx, double dy);

/// Sets the coordinates of an origin that is given as "centre"; they are 0 if the box is not valid.
void find_origin(SceneParameters& scene);

/// The shortest decimal of `place` in users' coordinates from which it can be read back exactly.
std::string shown_coordinate(double place, double origin);
/// Text such as "(1.5, -2)", in users' coordinates.
std::string shown_place(const SceneParameters& scene, double x, double y);
/// Text such as ", whose lower left corner is at (-5, -5)"; empty if the corner is at (0, 0).
std::string corner_text(const SceneParameters& scene);

} // namespace carrom
