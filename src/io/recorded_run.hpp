// SPDX-License-Identifier: BSD-3-Clause
// Which run a recording is of, so that no other one goes on with it: its scene's text, as
// checkpoints have it.
#pragma once

#include "io/checkpoint.hpp"
#include "io/hdf5.hpp"

namespace carrom {

/// Writes /carrom/scene, and the classes of discs that a file had; nothing where `run` has no text.
/// Throws FileError.
void write_recorded_run(hid_t file, const CheckpointHeader& run);

/// Throws FileError where the file says of which run it is and `difference_from` knows a
/// difference. Older versions' say nothing.
void check_recorded_run(hid_t file, const DifferenceFrom& difference_from);

} // namespace carrom
