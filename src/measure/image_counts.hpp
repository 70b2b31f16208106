// SPDX-License-Identifier: BSD-3-Clause
// Counts how many box lengths each disc has moved through periodic sides, for displacements and for
// H5MD's `image`. A sync moves a disc back into the box by whole lengths, which the engine records.
// Each rank stores the counts of a range of ids (pieces.hpp). Memory: 16 bytes a disc. Each call of
// `counts` sends all crossings since the previous call to the ranks that store their counts.
#pragma once

#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/stored_samples.hpp"
#include "parallel/communicator.hpp"
#include "parallel/pieces.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// This rank's discs. Discs that have crossed a periodic side since the last sync have positions
/// outside the box.
DiscStates flown_on(const DiscSystem& system);

class ImageCounts {
public:
    /// Starts with counts of 0 at the present step. `system` and `ranks` must outlive this object.
    ImageCounts(DiscSystem& system, const Communicator& ranks);
    ~ImageCounts();
    ImageCounts(const ImageCounts&) = delete;
    ImageCounts& operator=(const ImageCounts&) = delete;

    /// Restores the counts from the members `x` and `y` of `stored`. **Collective.**
    void go_on(std::span<const FirstPlace> stored, double FirstPlace::* x, double FirstPlace::* y);

    /// Sets the counts of all discs at the last sync to 0.
    void begin_anew();
    /// Adds crossings of this rank's discs that the engine has not recorded itself.
    void add(std::span<const Crossing> crossings) {
        crossings_.insert(crossings_.end(), crossings.begin(), crossings.end());
    }

    /// The counts of this rank's range of ids at the last sync. Call it often, because crossings
    /// since the previous call are kept in memory. **Collective.**
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
    std::vector<Crossing> crossings_; ///< crossings of this rank's discs that `counts_` lacks
};

} // namespace carrom
