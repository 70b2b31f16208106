// SPDX-License-Identifier: BSD-3-Clause
// A description of a trajectory in XDMF 2, with which VTK (ParaView, VisIt) opens its segments
// without a copy. It refers to the segments, because some versions of VTK have an HDF5 without
// virtual datasets.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "io/segments.hpp"
#include "io/trajectory.hpp"

namespace carrom {

/// Writes trajectory.xdmf beside trajectory.h5, as a whole or not at all. The file takes some 1 KB
/// for each frame. Throws FileError.
void write_xdmf(const std::string& path, const TrajectoryLayout& layout,
                std::span<const FileSegment> segments, std::span<const std::int64_t> steps);

} // namespace carrom
