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

/// What a trajectory holds of each disc. Positions are always there.
struct TrajectoryFields {
    bool velocities = true;
    bool spins = false;           ///< of rough discs only
    bool collisions = false;      ///< both counters
    bool directions = false;      ///< of active discs only
    bool single_precision = true; ///< 4 bytes a number, else 8
};

/// Writes one H5MD file, which can be read while it grows. Frames pass through rank 0.
class TrajectoryWriter {
public:
    /// Begins a new file, in the place of any other; it has no frame yet. The simulation must
    /// outlive this. Throws CollectiveError (code 4) where the file cannot be written. All calls
    /// are **collective**.
    TrajectoryWriter(const Simulation& simulation, const std::string& path,
                     const TrajectoryFields& fields = {});

    /// Goes on with a file of the same run, cut back to frames up to the simulation's present step.
    /// Begins a new one where there is none. Throws CollectiveError (code 2) where the file has
    /// other fields or is of another run. **Collective.**
    static TrajectoryWriter going_on(const Simulation& simulation, const std::string& path,
                                     const TrajectoryFields& fields = {});

    TrajectoryWriter(TrajectoryWriter&&) noexcept;
    ~TrajectoryWriter();

    /// Adds the present step and brings it to disk: after this the file is whole whatever happens.
    /// Throws CollectiveError (code 4) where that fails; frames before are as they were.
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

/// Reads a trajectory, or a checkpoint: that is a file of one frame.
class FrameReader {
public:
    /// Opens the file on every rank. Throws InputError where it is none of these, CollectiveError
    /// (code 2) where it is damaged. **Collective.**
    FrameReader(const Session& session, const std::string& path);
    FrameReader(FrameReader&&) noexcept;
    ~FrameReader();

    const std::vector<std::int64_t>& steps() const; ///< of the frames; their number is its size
    std::uint64_t n_discs() const;
    Box box() const;                ///< that holds all frames
    std::string state_hash() const; ///< of a checkpoint; else empty

    /// The discs of a frame, by id, or those of ids from `begin` to `end` - 1. Places are those of
    /// the scene (`box.origin`). Numbers that the file does not have are 0. `frame` counts from 0.
    /// Throws InputError where there is no such frame or disc, or where reading fails. Not
    /// collective.
    std::vector<Disc> read(std::size_t frame) const;
    std::vector<Disc> read(std::size_t frame, std::uint64_t begin, std::uint64_t end) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace carrom
