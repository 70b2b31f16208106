// SPDX-License-Identifier: BSD-3-Clause
// The state of averages and measurements, as the plain numbers that a checkpoint stores. Sampler
// produces these numbers and restores its state from them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/disc_state.hpp"

namespace carrom {

/// The position of a disc at the start of sampling, or of a time window of the sampler.
struct FirstPlace {
    DiscId id = 0;
    double x = 0, y = 0;
    /// Box lengths by which periodic sides have shifted the disc since that start
    double lengths_x = 0, lengths_y = 0;
    double vx = 0, vy = 0; ///< lengths per step, at the start of sampling or of the window
    /// Box lengths by which periodic sides have shifted the disc since the scene's start
    double image_x = 0, image_y = 0;
};

/// Box lengths by which periodic sides have shifted a disc since the count of images began.
struct DiscImage {
    DiscId id = 0;
    std::int32_t x = 0, y = 0;
};
inline constexpr std::int32_t most_images = 1 << 30;

struct StoredSamples {
    std::vector<std::int64_t> averages; ///< equal on all ranks; empty before averaging begins
    std::vector<std::int64_t> watched;  ///< equal on all ranks; empty if OrderWatch samples nothing
    std::vector<std::int64_t> sums;     ///< equal on all ranks; empty if nothing is measured
    std::vector<std::int64_t> stop; ///< equal on all ranks; empty if no pressure can end the run
    /// Values that effects keep; stored with the samples (StoredState::kept_by_effects)
    std::vector<std::int64_t> effects;
    bool have_first_places = false; ///< whether `first_places` has x and y; equal on all ranks
    bool have_lengths = false;      ///< whether it has lengths_x and lengths_y; equal on all ranks
    bool have_velocities = false;   ///< whether it has vx and vy; equal on all ranks
    bool have_images = false;       ///< whether it has image_x and image_y; equal on all ranks
    /// Discs with consecutive ids. When written, they are the discs of this rank's pieces
    /// (pieces.hpp); when read, the discs of its slab (slabs.hpp).
    std::vector<FirstPlace> first_places;
};

} // namespace carrom
