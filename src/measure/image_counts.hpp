// SPDX-License-Identifier: BSD-3-Clause
// Counts how many box lengths each disc has moved through periodic sides, for displacements and for
// H5MD's `image`. A sync moves a disc back into the box by whole lengths, which the engine records.
// Each rank stores the counts of a range of ids (pieces.hpp). Cost: 16 bytes a disc, and at each
// reading of counts every disc that was moved back since the last reading is sent once.
#pragma once

#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/stored_samples.hpp"
#include "parallel/communicator.hpp"
#include "parallel/pieces.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// This rank's discs, at positions beyond the periodic sides they crossed since the last sync.
DiscStates flown_on(const DiscSystem& system);

class ImageCounts {
public:
    /// Counts from 0, from the present step on. `system` and `ranks` must outlive this.
    ImageCounts(DiscSystem& system, const Communicator& ranks);
    ~ImageCounts();
    ImageCounts(const ImageCounts&) = delete;
    ImageCounts& operator=(const ImageCounts&) = delete;

    /// Restores the counts from `stored` places; the last two arguments are the members of
    /// FirstPlace that contain them. **Collective.**
    void go_on(std::span<const FirstPlace> stored, double FirstPlace::* x, double FirstPlace::* y);

    /// Counts from 0, from the last sync on.
    void begin_anew();
    /// Adds the box lengths by which own discs were moved back into the box other than at syncs.
    void add(std::span<const Crossing> crossings) {
        crossings_.insert(crossings_.end(), crossings.begin(), crossings.end());
    }

    /// The counts of this rank's range of ids at the last sync. Call it often, because all
    /// crossings since the last call are in memory. **Collective.**
    std::span<const DiscImage> counts();
    /// Copies the counts into members of `places`, which has the same ids or is empty.
    /// **Collective.**
    void store(std::vector<FirstPlace>& places, double FirstPlace::* x, double FirstPlace::* y);
    /// The counts of this rank's range of ids at the present step. **Collective.**
    std::vector<DiscImage> now();

private:
    void add(std::vector<DiscImage>& counts, std::span<const Crossing> crossings) const;

    DiscSystem& system_;
    const Communicator& ranks_;
    Pieces pieces_;
    std::vector<DiscImage> counts_;
    std::vector<Crossing> crossings_; ///< crossings of own discs that are not in `counts_` yet
};

} // namespace carrom
