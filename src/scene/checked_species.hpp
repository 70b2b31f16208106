// SPDX-License-Identifier: BSD-3-Clause
// Discs of several radii and masses, and those that turn at the start: `[[discs.species]]`, more
// numbers in each row of `discs.list`, or `discs.columns` of the file of discs.
#pragma once

#include "scene/check.hpp"

namespace carrom {

/// Fills in `scene.disc_columns` and `scene.effects.classes`, which stay empty where nothing names
/// them, and refuses what does not go with them.
void fill_species(const Check& check);

/// Fills in `scene.spins`, once the contact is known.
void fill_first_spins(const Check& check);

/// What gave the classes, or null.
const Setting* species_setting(const Check& check);

/// Whether they are in a file that has not been read, or has wrong lines.
bool are_species_unknown(const Check& check);

} // namespace carrom
