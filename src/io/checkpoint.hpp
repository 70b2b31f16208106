// SPDX-License-Identifier: BSD-3-Clause
// A run's state at the end of a step, in one HDF5 file from which any number of ranks can continue
// with the same bits.
//
// Discs are in order of id, so the file does not depend on the number of ranks that wrote it.
// /carrom/discs has the exact stored state, column by column, and /carrom/run the description of
// the run. /particles/discs has the same discs in the form that other programs read (H5MD;
// positions at the time of the step, in single precision). /carrom/checksums has checksums of all
// bytes (checksums.hpp).
//
// Rank 0 makes the file and reserves its space on disk. Then each rank writes ranges of ids, either
// on its own at offsets that HDF5 reports, or together with all others through MPI-IO. Every rank
// reads its range through MPI-IO. Cost for each disc: 80 bytes on disk; 8 bytes of memory, 80 more
// for collective transfers; it is sent once if another rank writes it. A side column adds 8 bytes
// on disk, 24 of memory.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <carrom/box.hpp>

#include "core/disc_state.hpp"
#include "core/frame.hpp"
#include "core/side_columns.hpp"
#include "core/stored_samples.hpp"
#include "dynamics/species.hpp"
#include "io/recorded_system.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// The description of the run in a checkpoint. It contains the scene's text, from which a restart
/// reads the scene again.
struct CheckpointHeader {
    std::string program_version;
    /// scene_overrides: lines of the form `key=value`
    std::string scene_name, scene_text, scene_overrides;
    std::int64_t scene_lines_before_discs = 0;
    std::int64_t scene_discs_follow = 0;

    double box_size = 0, radius = 0; ///< box_size: edge along x
    double box_height = 0;           ///< edge along y; in the file only if it differs from box_size
    std::string method;              ///< "time-stepped" or "event-driven"
    std::int64_t micro_steps = 1, sync_every = 1;

    std::int64_t step = 0, micro_steps_done = 0;
    std::uint64_t n_discs = 0;
    std::uint64_t wall_collisions = 0,
                  /// Sums of the discs' counters; a collision of a pair counts once
        pair_collisions = 0;
    std::string state_hash;
    Frame frame; ///< frame of reference of the coordinates; in the file only if it moves
    std::vector<Species> species; ///< stored only if species come from a file of discs: the
                                  ///< scene's text does not contain them
    SideColumnSet columns;        ///< columns in addition to the states; part of the state hash
    RecordedSystem shown;         ///< H5MD metadata to write; a restart does not read it

    Box box() const { return {box_size, box_height}; }
    void set_box(const Box& box) { box_size = box.x, box_height = box.y; }

    /// The time on the clock of the discs' own times: micro-steps since the last sync, or the clock
    /// of a moving frame.
    double clock() const {
        return frame.is_moving ? frame.clock : static_cast<double>(micro_steps_done % sync_every);
    }
};

/// Describes the difference between the run `there`, which an existing file describes, and the
/// present run; empty if there is none. Called on rank 0.
using DifferenceFrom = std::function<std::string(const CheckpointHeader& there)>;

/// Settings for writing the data of discs.
struct WriteSettings {
    int n_threads = 1;          ///< additional threads, which convert discs to bytes
    bool is_collective = false; ///< whether MPI-IO chooses ranks that write for all (aggregators)
};

/// Writes `discs`, in any distribution over ranks, completely or not at all: the file is written
/// under another name, synced to disk and renamed. `columns`, if the header has any, are in the
/// order of `discs`. Computes the header's counters and hash itself. If any rank fails, every rank
/// throws CollectiveError, exit code 4, and an older file of that name is unchanged.
/// **Collective.**
void write_checkpoint(const std::string& path, CheckpointHeader header,
                      std::span<const DiscState> discs, const Communicator& communicator,
                      const WriteSettings& settings = {}, const StoredSamples& samples = {},
                      const SideSpans& columns = {});

struct Checkpoint {
    CheckpointHeader header;
    DiscStates discs;    ///< discs whose ids are in this rank's slab (slabs.hpp)
    SideColumns columns; ///< further columns of these discs (core/side_columns.hpp)
    StoredSamples samples;
};

/// Reads a checkpoint. If the file is damaged, of version 0.1, or not a checkpoint, every rank
/// throws CollectiveError (exit code 2); its text is the path, then the reason. **Collective.**
Checkpoint read_checkpoint(const std::string& path, const Communicator& communicator);

/// Reads all bytes of a checkpoint and compares them with its checksums; returns its header. Throws
/// like `read_checkpoint` if it is damaged or cannot be read. Returns nothing for other files of
/// Carrom, which are not checked. **Collective.**
std::optional<CheckpointHeader> check_damage(const std::string& path,
                                             const Communicator& communicator);

} // namespace carrom
