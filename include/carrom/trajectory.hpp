// SPDX-License-Identifier: BSD-3-Clause
// Writes trajectories while a simulation runs, and reads trajectories and checkpoints frame by
// frame. docs/reference/formats.md describes the files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <carrom/box.hpp>
#include <carrom/disc.hpp>
#include <carrom/session.hpp>
#include <carrom/simulation.hpp>

namespace carrom {

/// The data of each disc in a trajectory. Positions are always included.
struct TrajectoryFields {
    bool velocities = true;
    bool spins = false;           ///< spins of rough discs
    bool collisions = false;      ///< counters of wall and pair collisions
    bool directions = false;      ///< directions of active discs
    bool single_precision = true; ///< 4 bytes a number instead of 8
};

/// Writes an H5MD file, which can be read during the run. Rank 0 writes all frames.
class TrajectoryWriter {
public:
    /// Makes a new file without frames, which replaces any file of that name. The simulation must
    /// outlive the writer. Throws CollectiveError (code 4) if the file cannot be written. All
    /// members are **collective**.
    TrajectoryWriter(const Simulation& simulation, const std::string& path,
                     const TrajectoryFields& fields = {});

    /// Continues the file of the same run, after removing frames later than the simulation's
    /// present step; makes a new file if there is none. Throws CollectiveError (code 2) if the file
    /// has other fields or belongs to another run. **Collective.**
    static TrajectoryWriter going_on(const Simulation& simulation, const std::string& path,
                                     const TrajectoryFields& fields = {});

    TrajectoryWriter(TrajectoryWriter&&) noexcept;
    ~TrajectoryWriter();

    /// Adds a frame of the present step and writes it to disk, so that a crash after this call does
    /// not damage the file. Throws CollectiveError (code 4) if writing fails; earlier frames stay
    /// undamaged. **Collective.**
    void append();

    /// Describes all frames in an XDMF file beside the trajectory, for ParaView and VisIt. Call it
    /// after the last frame. **Collective.**
    void describe();

private:
    struct State;
    explicit TrajectoryWriter(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

/// Reads the frames of a trajectory; a checkpoint counts as a file of one frame.
class FrameReader {
public:
    /// Opens the file on every rank. Throws InputError if it is neither a trajectory nor a
    /// checkpoint, CollectiveError (code 2) if it is damaged. **Collective.**
    FrameReader(const Session& session, const std::string& path);
    FrameReader(FrameReader&&) noexcept;
    ~FrameReader();

    const std::vector<std::int64_t>& steps() const; ///< step of each frame, in the order of frames
    std::uint64_t n_discs() const;
    Box box() const;                ///< largest width and height of the boxes of all frames
    std::string state_hash() const; ///< hash of a checkpoint's state; empty for a trajectory

    /// The discs of a frame in order of id: all of them, or ids `begin` to `end` - 1. Positions are
    /// in the scene's coordinates (`box.origin`). Numbers that the file lacks are 0. `frame` counts
    /// from 0. Throws InputError if there is no such frame or disc, or if reading fails. Not
    /// collective.
    std::vector<Disc> read(std::size_t frame) const;
    std::vector<Disc> read(std::size_t frame, std::uint64_t begin, std::uint64_t end) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace carrom
