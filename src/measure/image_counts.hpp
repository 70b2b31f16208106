// SPDX-License-Identifier: BSD-3-Clause
// Counts how many box lengths each disc has moved through periodic sides, for displacements and for
// H5MD's `image`. A sync moves a disc back into the box by whole lengths, which the engine records.
// Each rank stores the counts of a range of ids (pieces.hpp). Cost: 16 bytes a disc; each reading
// of counts sends every crossing since the last reading once.
#pragma once

#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/stored_samples.hpp"
#include "parallel/communicator.hpp"
#include "parallel/pieces.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// This rank's discs; a disc that crossed a periodic side since the last sync is outside of it.
DiscStates flown_on(const DiscSystem& system);

class ImageCounts {
public:
    /// Starts with counts of 0 at the present step. `system` and `ranks` must outlive this.
    ImageCounts(DiscSystem& system, const Communicator& ranks);
    ~ImageCounts();
    ImageCounts(const ImageCounts&) = delete;
    ImageCounts& operator=(const ImageCounts&) = delete;

    /// Restores the counts from `stored` places; the last two arguments are the members of
    /// FirstPlace that contain them. **Collective.**
    void go_on(std::span<const FirstPlace> stored, double FirstPlace::* x, double FirstPlace::* y);

    /// Sets all counts to 0, as of the last sync.
    void begin_anew();
    /// Adds crossings of this rank's discs that no sync has recorded.
    void add(std::span<const Crossing> crossings) {
        crossings_.insert(crossings_.end(), crossings.begin(), crossings.end());
    }

    /// The counts of this rank's range of ids at the last sync. Call it often, because all
    /// crossings since the last call are in memory. **Collective.**
    std::span<const DiscImage> counts();
    /// Copies the counts into the members `x` and `y` of `places`, which has the same ids or is
    /// empty. **Collective.**
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
