// SPDX-License-Identifier: BSD-3-Clause
// Small files of each kind for tests of damage, and correct checksums for damaged checkpoints.
#pragma once

#include <string>
#include <vector>

#include "io/checksums.hpp"
#include "io/trajectory.hpp"
#include "parallel/communicator.hpp"

namespace carrom::test {

/// All bytes of a file.
std::vector<char> bytes_of(const std::string& path);
/// Replaces the contents of the file.
void write_bytes(const std::string& path, const std::vector<char>& bytes);

/// Twelve rough discs at step 70 of a scene of the time-stepped method. **Collective.**
void write_sample_checkpoint(const std::string& path, const Communicator& world);

/// The layout of a sample trajectory: double precision with spins, or single precision.
/// The trajectory has three frames of twelve discs. Writing is **collective.**
TrajectoryLayout sample_layout(bool is_double);
void write_sample_trajectory(const std::string& path, bool is_double, const Communicator& world);

/// Writes a log of twenty collisions, with pairs and walls.
/// **Collective.**
void write_sample_log(const std::string& path, const Communicator& world);

/// Corrects the checksums of damaged copies of a checkpoint: HDF5's own for its metadata, and
/// those of Carrom. All keep their places in the file. Not collective.
class Forger {
public:
    explicit Forger(const std::string& whole);
    /// Writes `bytes`, with new checksums, to the file. Its length must stay the same.
    void write(const std::string& path, std::vector<char> bytes) const;

private:
    Checksums sums_;
    std::vector<ByteRange> metadata_; ///< each is followed by the 4 bytes of its checksum
};

} // namespace carrom::test
