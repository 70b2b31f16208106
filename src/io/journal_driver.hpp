// SPDX-License-Identifier: BSD-3-Clause
// HDF5's way to the disk (a virtual file driver) for files under an UndoJournal: plain reads and
// writes of one process.
#pragma once

#include "io/hdf5.hpp"
#include "io/undo_journal.hpp"

namespace carrom {

/// Access properties for a file whose old bytes go to `journal`, which must outlive the open file.
h5::Properties journalled_access(UndoJournal& journal);

} // namespace carrom
