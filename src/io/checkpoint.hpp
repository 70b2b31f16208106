// SPDX-License-Identifier: BSD-3-Clause
// A run's state at the end of a step, in one HDF5 file from which any number of ranks can go on
// with the same bits.
//
// Discs stand in the order of their ids, so the file does not show which ranks wrote it. The stored
// state is in /carrom/discs, column by column, to the bit. What the run is stands in /carrom/run.
// The same discs as other programs expect them are in /particles/discs (H5MD; positions at the time
// of the step, in single precision). Checksums of all bytes are in /carrom/checksums
// (checksums.hpp).
//
// Rank 0 makes the file and takes its room on disk. Then each rank writes its share of the ids
// through HDF5 and MPI-IO, and reads it so. Price: 80 bytes a disc to disk, and a disc is sent once
// if it is another rank's; 8 bytes a disc of memory, in collective transfers 80 more. A column
// beside the states takes 8 bytes a disc on disk and 24 of memory.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <carrom/box.hpp>

#include "core/disc.hpp"
#include "core/frame.hpp"
#include "core/side_columns.hpp"
#include "core/stored_samples.hpp"
#include "dynamics/species.hpp"
#include "io/recorded_system.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// What a checkpoint says of its run. Texts are the scene's own, to read it again with.
struct CheckpointHeader {
    std::string program_version;
    std::string scene_name, scene_text, scene_overrides; ///< overrides: one `key=value` a line
    std::int64_t scene_lines_before_discs = 0;
    std::int64_t scene_discs_follow = 0;

    double box_size = 0, radius = 0; ///< box_size: along x
    double box_height = 0;           ///< along y; in the file only where it is another one
    std::string method;              ///< "time-stepped" or "event-driven"
    std::int64_t micro_steps = 1, sync_every = 1;

    std::int64_t step = 0, micro_steps_done = 0;
    std::uint64_t n_discs = 0;
    std::uint64_t wall_collisions = 0,
                  pair_collisions = 0; ///< sums of the discs' counters; a pair counts once
    std::string state_hash;
    Frame frame; ///< that the discs' coordinates are in; in the file only where it moves
    std::vector<Species>
        species; ///< where a file of discs had them, for the scene's text has not; else empty
    SideColumnSet columns; ///< what discs have beside their states; the state hash covers it
    RecordedSystem shown;  ///< what other programs see. Not read.

    Box box() const { return {box_size, box_height}; }
    void set_box(const Box& box) { box_size = box.x, box_height = box.y; }

    /// Micro-steps since the last sync, or what the frame's clock makes of them: the time that the
    /// discs' own times belong to.
    double clock() const {
        return frame.is_moving ? frame.clock : static_cast<double>(micro_steps_done % sync_every);
    }
};

/// Says in words how the run `there` differs from the present one; nothing where it does not.
/// Called on rank 0.
using DifferenceFrom = std::function<std::string(const CheckpointHeader& there)>;

/// How the numbers of discs come to disk.
struct WriteSettings {
    int n_threads = 1;          ///< of a rank, that pack; one more writes
    bool is_collective = false; ///< MPI-IO chooses ranks that write for all (aggregators)
};

/// Writes `discs`, in any distribution, as a whole file or not at all: beside its place first,
/// brought to disk, then renamed. `columns` run along the discs where the header has
/// some. The header's counters and its hash are filled in here. If it fails on any rank every rank
/// throws CollectiveError, code 4, and an older file of that name is as it was. **Collective.**
void write_checkpoint(const std::string& path, CheckpointHeader header, std::span<const Disc> discs,
                      const Communicator& communicator, const WriteSettings& settings = {},
                      const StoredSamples& samples = {}, const SideSpans& columns = {});

struct Checkpoint {
    CheckpointHeader header;
    std::vector<Disc> discs; ///< this rank's share of the ids, see slabs.hpp
    SideColumns columns;     ///< along the discs
    StoredSamples samples;
};

/// Reads a checkpoint. If it is damaged in any way, of version 0.1, or none, every rank throws
/// CollectiveError, code 2, with the reason after the path. **Collective.**
Checkpoint read_checkpoint(const std::string& path, const Communicator& communicator);

/// The header of a checkpoint whose bytes have their checksums: all are read. Throws like
/// `read_checkpoint` where it is damaged or cannot be read at all. None of other files of ours,
/// which are not checked. **Collective.**
std::optional<CheckpointHeader> check_damage(const std::string& path,
                                             const Communicator& communicator);

} // namespace carrom
