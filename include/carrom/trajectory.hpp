// SPDX-License-Identifier: BSD-3-Clause
// Files of discs: writing a trajectory as a simulation moves forward, and reading trajectories and
// checkpoints frame by frame. docs/reference/formats.md has the formats.
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

/// The data of each disc in a trajectory. Positions are always there.
struct TrajectoryFields {
    bool velocities = true;
    bool spins = false;           ///< spins of rough discs
    bool collisions = false;      ///< counters of wall and pair collisions
    bool directions = false;      ///< directions of active discs
    bool single_precision = true; ///< 4 bytes a number instead of 8
};

/// Writes one H5MD file, which can be read while it grows. Frames pass through rank 0.
class TrajectoryWriter {
public:
    /// Makes a new file without frames, which replaces any other of that name. The simulation must
    /// outlive the writer. Throws CollectiveError (code 4) if the file cannot be written. All calls
    /// are **collective**.
    TrajectoryWriter(const Simulation& simulation, const std::string& path,
                     const TrajectoryFields& fields = {});

    /// Continues a file of the same run, cut back to frames up to the simulation's present step, or
    /// makes a new one if there is none. Throws CollectiveError (code 2) if the file has other
    /// fields or belongs to another run. **Collective.**
    static TrajectoryWriter going_on(const Simulation& simulation, const std::string& path,
                                     const TrajectoryFields& fields = {});

    TrajectoryWriter(TrajectoryWriter&&) noexcept;
    ~TrajectoryWriter();

    /// Adds the present step and brings it to disk, so that a crash after this call does not damage
    /// the file. Throws CollectiveError (code 4) if that fails; earlier frames stay undamaged.
    /// **Collective.**
    void append();

    /// Describes all frames in an XDMF file beside the trajectory, for ParaView and VisIt. Call it
    /// after the last frame. **Collective.**
    void describe();

private:
    struct State;
    explicit TrajectoryWriter(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

/// Reads a trajectory, or a checkpoint as a file of one frame.
class FrameReader {
public:
    /// Opens the file on every rank. Throws InputError if it is neither a trajectory nor a
    /// checkpoint, CollectiveError (code 2) if it is damaged. **Collective.**
    FrameReader(const Session& session, const std::string& path);
    FrameReader(FrameReader&&) noexcept;
    ~FrameReader();

    const std::vector<std::int64_t>& steps() const; ///< steps of the frames, in their order
    std::uint64_t n_discs() const;
    Box box() const;                ///< a box that holds the discs of all frames
    std::string state_hash() const; ///< hash of a checkpoint's state; empty for a trajectory

    /// The discs of a frame, by id, or those of ids from `begin` to `end` - 1. Places are those of
    /// the scene (`box.origin`). Numbers that the file does not have are 0. `frame` counts from 0.
    /// Throws InputError if there is no such frame or disc, or if reading fails. Not collective.
    std::vector<Disc> read(std::size_t frame) const;
    std::vector<Disc> read(std::size_t frame, std::uint64_t begin, std::uint64_t end) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace carrom
