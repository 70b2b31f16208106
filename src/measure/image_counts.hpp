// SPDX-License-Identifier: BSD-3-Clause
// Counts the box lengths that each disc has flown on beyond a periodic box, for
// displacements and for H5MD's `image`. A sync brings a disc back by whole lengths, and
// the engine notes that. Counts are kept by runs of ids (pieces.hpp). Price: 16 bytes a
// disc, and each disc that has been brought back is sent once whenever counts are read.
#pragma once

#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/stored_samples.hpp"
#include "parallel/communicator.hpp"
#include "parallel/pieces.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The own discs where they would be if no sync had brought them back since the last one.
DiscStates flown_on(const DiscSystem& system);

class ImageCounts {
public:
    /// Counts from 0 at the present step on. Both arguments must outlive this.
    ImageCounts(const Box& box, DiscSystem& system, const Communicator& ranks);
    ~ImageCounts();
    ImageCounts(const ImageCounts&) = delete;
    ImageCounts& operator=(const ImageCounts&) = delete;

    /// Goes on from members of stored places. **Collective.**
    void go_on(std::span<const FirstPlace> stored, double FirstPlace::* x, double FirstPlace::* y);

    /// Counts from 0 at the last sync on.
    void begin_anew();
    /// Adds box lengths by which own discs have been brought back other than by syncs.
    void add(std::span<const Crossing> crossings) {
        crossings_.insert(crossings_.end(), crossings.begin(), crossings.end());
    }

    /// The counts of this rank's run of ids at the last sync. To be called often,
    /// because crossings since the last call take memory. **Collective.**
    std::span<const DiscImage> counts();
    /// Writes the counts to members of places, which have the same ids or are none. **Collective.**
    void store(std::vector<FirstPlace>& places, double FirstPlace::* x, double FirstPlace::* y);
    /// The counts of this rank's run of ids at the present step. **Collective.**
    std::vector<DiscImage> now();

private:
    void add(std::vector<DiscImage>& counts, std::span<const Crossing> crossings) const;

    Box box_;
    DiscSystem& system_;
    const Communicator& ranks_;
    Pieces pieces_;
    std::vector<DiscImage> counts_;
    std::vector<Crossing> crossings_; ///< by own discs, not yet in `counts_`
};

} // namespace carrom
