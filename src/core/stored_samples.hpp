// SPDX-License-Identifier: BSD-3-Clause
// What a checkpoint keeps of a run's averages and of the measurements that its scene asks for:
// plain numbers, made and read by Sampler.
#pragma once

#include <cstdint>
#include <vector>

#include "core/disc_state.hpp"

namespace carrom {

/// Where a disc was when sampling, or a window of it, began.
struct FirstPlace {
    DiscId id = 0;
    double x = 0, y = 0;
    double lengths_x = 0, lengths_y = 0; ///< in a periodic box: by how many box lengths
                                         ///< it has been brought back since then
    double vx = 0, vy = 0;               ///< at that time, per step
    double image_x = 0, image_y = 0;     ///< this count since the scene's start
};

/// How many box lengths a disc has flown on beyond a periodic box since the scene's start.
struct DiscImage {
    DiscId id = 0;
    std::int32_t x = 0, y = 0;
};
inline constexpr std::int32_t most_images = 1 << 30;

struct StoredSamples {
    std::vector<std::int64_t> averages; ///< equal on all ranks; empty before the first block
    std::vector<std::int64_t> watched;  ///< equal on all ranks; empty if no order is watched
    std::vector<std::int64_t> sums;     ///< equal on all ranks; empty if nothing is measured
    std::vector<std::int64_t> stop;    ///< equal on all ranks; empty if no pressure may end the run
    std::vector<std::int64_t> effects; ///< StoredState::kept_by_effects, which comes along
    bool have_first_places = false;    ///< equal on all ranks
    bool have_lengths = false;         ///< equal on all ranks
    bool have_velocities = false;      ///< equal on all ranks
    bool have_images = false;          ///< equal on all ranks; for the images of a trajectory
    /// A run of ids without gaps. To be written, these are the discs of this rank's
    /// pieces (pieces.hpp); as read, those of its slab (slabs.hpp).
    std::vector<FirstPlace> first_places;
};

} // namespace carrom
