// SPDX-License-Identifier: BSD-3-Clause
// How many box lengths each disc has flown on beyond a periodic box: for displacements, and for
// H5MD's `image`. A sync brings a disc back by whole lengths, and the engine notes that. Counts are
// kept by runs of ids (pieces.hpp). Price: 16 bytes a disc, and each disc that has been brought
// back is sent once whenever counts are asked for.
#pragma once

#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/stored_samples.hpp"
#include "parallel/communicator.hpp"
#include "parallel/pieces.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

/// The own discs where they would be had nothing brought them back since the last sync.
std::vector<Disc> flown_on(const Simulation& simulation);

class ImageCounts {
public:
    /// From 0 at the present step on. Both must outlive this.
    ImageCounts(const Box& box, Simulation& simulation, const Communicator& ranks);
    ~ImageCounts() { simulation_.forget_crossings_in(crossings_); }
    ImageCounts(const ImageCounts&) = delete;
    ImageCounts& operator=(const ImageCounts&) = delete;

    /// Goes on with what members of stored places say. **Collective.**
    void go_on(std::span<const FirstPlace> stored, double FirstPlace::* x, double FirstPlace::* y);

    /// From 0 at the last sync on.
    void begin_anew();

    /// As of the last sync, of this rank's run of ids. To be called often: what has been noted
    /// since the last call takes memory. **Collective.**
    std::span<const DiscImage> counts();
    /// Puts them into members of places, which are of the same ids or none. **Collective.**
    void store(std::vector<FirstPlace>& places, double FirstPlace::* x, double FirstPlace::* y);
    /// The same as of the present step. **Collective.**
    std::vector<DiscImage> now();

private:
    void add(std::vector<DiscImage>& counts, std::span<const Crossing> crossings) const;

    Box box_;
    Simulation& simulation_;
    const Communicator& ranks_;
    Pieces pieces_;
    std::vector<DiscImage> counts_;
    std::vector<Crossing> crossings_; ///< of own discs, not yet in `counts_`
};

} // namespace carrom
