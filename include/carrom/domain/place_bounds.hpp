// SPDX-License-Identifier: BSD-3-Clause
// Which discs of a rank may be near the ends of its strip, without a look at each: where along x every thousand in a row
// were some time ago, and how far they can have moved since. A rank's discs lie nearly in the order of their cells, column
// by column, so nearly all thousands are far from both ends. Price: a pass over all discs each time they are put in order.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "carrom/core/disc.hpp"

namespace carrom {

/// Places begin .. end - 1 of a list of discs.
struct PlaceRange {
    std::size_t begin = 0, end = 0;
};

class PlaceBounds {
public:
    /// Looks at all discs, where they are at `time`.
    void survey(std::span<const Disc> discs, double time);
    bool are_known() const { return are_known_; }
    /// The discs are in another order now.
    void forget() { are_known_ = false; }

    /// No disc has moved by more than this since the last survey or call.
    void widen(double distance) { moved_ += distance; }
    /// There is another disc at `place` now.
    void replace(std::size_t place);
    /// Only the first `n_places` hold the discs that they held; others may come behind them.
    void truncate(std::size_t n_places);

    /// Ranges of the first `n_places`, ascending, that hold every disc outside of low <= x < high; many others, too.
    std::vector<PlaceRange> outside(double low, double high, std::size_t n_places) const;

private:
    static constexpr std::size_t in_a_row = 1024;
    struct Bounds {
        double low, high;
    };

    bool are_known_ = false;
    double moved_ = 0;
    std::vector<Bounds> bounds_; ///< of each thousand places; beyond its end nothing is known
};

} // namespace carrom
