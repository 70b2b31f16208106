// SPDX-License-Identifier: BSD-3-Clause
// The averages and measurements of a run that a checkpoint stores: plain numbers, written and read
// by Sampler.
#pragma once

#include <cstdint>
#include <vector>

#include "core/disc_state.hpp"

namespace carrom {

/// The position of a disc when sampling, or one of its windows, began.
struct FirstPlace {
    DiscId id = 0;
    double x = 0, y = 0;
    /// Box lengths by which the disc has been brought back into a periodic box since then
    double lengths_x = 0, lengths_y = 0;
    double vx = 0, vy = 0; ///< velocity per step, when sampling or the window began
    /// Box lengths by which the disc had been brought back before then, since the scene's start
    double image_x = 0, image_y = 0;
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
    std::vector<std::int64_t> stop; ///< equal on all ranks; empty if no pressure may end the run
    /// Values that effects keep, stored with the samples (StoredState::kept_by_effects)
    std::vector<std::int64_t> effects;
    bool have_first_places = false; ///< equal on all ranks
    bool have_lengths = false;      ///< equal on all ranks
    bool have_velocities = false;   ///< equal on all ranks
    bool have_images = false;       ///< equal on all ranks; for the images of a trajectory
    /// Discs with consecutive ids. For writing, they are the discs of this rank's pieces
    /// (pieces.hpp). After reading, they are those of its slab (slabs.hpp).
    std::vector<FirstPlace> first_places;
};

} // namespace carrom
