// SPDX-License-Identifier: BSD-3-Clause
// The discs of a step as lines of text, in order of id: `step id x y vx vy`. On the last step a
// line also has the disc's numbers of pair and wall collisions.
//
// Each rank sorts its own discs by id and sends them to rank 0 in slabs of consecutive ids. Cost:
// each rank sorts indices (4 bytes a disc) and sends its discs; rank 0 needs 0.8 us a line.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parallel/communicator.hpp"
#include "run/files/data_output.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The numbers in a line, in the scene's units.
struct DiscLine {
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;
    std::uint64_t pair_collisions = 0, wall_collisions = 0;
};

/// Appends one line. `digits` is the number of decimals, except that 17 means 17 significant
/// digits, from which a reader gets the same bits.
void append_line(fmt::memory_buffer& text, std::int64_t step, const DiscLine& line, int digits,
                 bool with_counters);

class DiscLines {
public:
    static constexpr std::uint64_t default_slab = 1 << 16;

    /// Writes to the file `path`, or to standard output if it is empty. `ranks` must outlive this.
    DiscLines(const SceneParameters& scene, const std::string& path, int digits,
              const Communicator& ranks, std::uint64_t slab = default_slab);

    /// Lines of `last_step` include numbers of collisions; lines of later steps are not written.
    void end_at(std::int64_t last_step) { last_step_ = last_step; }

    /// The next step after `step` whose lines must be written; at most the last step.
    std::int64_t next_due(std::int64_t step) const;

    bool is_due(std::int64_t step) const;

    /// Writes the lines of the present step. If that fails every rank throws. **Collective.**
    void write(const DiscSystem& system);

    /// Call it after the last step. Every rank throws unless all lines have been written.
    /// **Collective.**
    void close();

private:
    void agree_on_failure() const;
    void write_slab(std::uint64_t begin, std::uint64_t end, std::int64_t step,
                    const std::vector<DiscLine>& mine);

    const Communicator& ranks_;
    TextOutput wanted_;
    std::int64_t last_step_;
    std::uint64_t n_discs_;
    int digits_;
    std::uint64_t slab_;
    Origin origin_;
    DataOutput output_;
};

} // namespace carrom
