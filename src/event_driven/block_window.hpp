// SPDX-License-Identifier: BSD-3-Clause
// How long a window of the event-driven method should be, how large its blocks. Pure arithmetic on
// numbers that all ranks know; the choice affects the run's time, not its bits.
//
// Long windows share the cost of sorting and copying discs, short ones look less far; large blocks
// have less halo, small ones stay in the cache.
#pragma once

#include <limits>
#include <optional>

#include <carrom/box.hpp>

namespace carrom {

/// What the choice depends on: lengths in the scene's unit, times in micro-steps.
struct BlockNeeds {
    Box box;
    double radius = 0; ///< the largest
    double n_discs = 0;
    double speed_bound = 0;
    double collision_rate = 0; ///< per disc and time
    double time = 0;           ///< since the last sync
    std::optional<int>
        halo; ///< reaches that blocks look beyond their own cells at first, if that is wanted
    bool is_one_block = false; ///< all discs in one block, whatever their number
    int more_halo = 0;         ///< reaches more than where few runs are repeated
    bool goes_round_x = false, goes_round_y = false; ///< a halo does not end with the box: it has
                                                     ///< images, if need be many of each disc
    double radius_to_look_for = 0; ///< of equal discs with as many others around them
};

struct BlockChoice {
    double duration = 0; ///< of the window
    double reach = 0;
    int halo = 3;          ///< in reaches
    double block_side = 0; ///< wanted
};

/// The best window of at most `longest`, or of `wanted` if that is set.
BlockChoice choose_block_window(const BlockNeeds& needs, double longest,
                                std::optional<double> wanted);

/// Learns from windows whose block runs had to be repeated. Changes spread by collisions: where
/// discs are dense, or lie in a heap, they go further in a window than its cells suggest. Then
/// blocks look further around, and if that is not enough windows are shorter.
class Caution {
public:
    /// Of a window: block runs that were repeated, as a share of its blocks, and its collisions per
    /// disc.
    void learn(double repeated, double hits);
    int more_halo() const { return more_halo_; }
    double most_hits() const {
        return most_hits_;
    } ///< collisions per disc that a window should have at most

private:
    int more_halo_ = 0, n_calm_ = 0;
    double lately_ = 0; ///< repeated, a mean that forgets
    double most_hits_ = std::numeric_limits<double>::infinity();
};

/// Collisions per disc and time in a gas of this density and mean speed, to begin with: Enskog's
/// rate, with the contact value of Henderson (1975).
double guessed_collision_rate(const BlockNeeds& needs, double mean_speed);

} // namespace carrom
