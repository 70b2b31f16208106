// SPDX-License-Identifier: BSD-3-Clause
// Chooses how long a window of the event-driven method is and how large its blocks are. The choice
// is pure arithmetic on numbers that all ranks know. It affects the run's time, not its bits.
//
// A long window shares the cost of sorting and copying discs among more collisions, but a disc then
// has more possible partners. Large blocks have less halo for each disc, small blocks stay in the
// cache.
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
    std::optional<int> halo;   ///< halo of a block's first run, in reaches, if a test has set it
    bool is_one_block = false; ///< all discs in one block, whatever their number
    int more_halo = 0;         ///< reaches that Caution adds to the halo
    bool goes_round_x = false, goes_round_y = false; ///< the halo does not end with the box, but
                                                     ///< goes on with images of the discs
    double crowding = 1;  ///< how many times denser it is around a disc than in the mean of the box
    double n_threads = 0; ///< of all ranks together; 0 if each rank has one thread
    double rounds = 0;    ///< of blocks that run again, for each window, as of late
    double equivalent_radius = 0; ///< radius of equal discs that have as many others near them
};

struct BlockChoice {
    double duration = 0; ///< length of the window in micro-steps
    double reach = 0;
    int halo = 3;          ///< in reaches
    double block_side = 0; ///< the engine rounds it to whole cells
    double own_discs = 1;  ///< of a block, not those of its halo
};

/// The best window of at most `longest`, or of `wanted` if that is set.
BlockChoice choose_block_window(const BlockNeeds& needs, double longest,
                                std::optional<double> wanted);

/// Learns from windows whose block runs had to be repeated. One collision changes the next, and in
/// a dense gas or a heap such a chain leads further in a window than the reach suggests. Then
/// blocks get a larger halo. If that is not enough, windows become shorter.
class Caution {
public:
    /// A window has passed. All times are shares of that of its first runs.
    struct Passed {
        double hits = 0;             ///< collisions per disc
        double repeated = 0;         ///< block runs that were repeated, over the number of blocks
        double waited = 0;           ///< the time that others waited for the rank that repeats most
        double price_of_reach = 0.1; ///< what one more reach of halo costs
    };
    void learn(const Passed& window);
    int more_halo() const { return more_halo_; }
    /// The largest number of collisions per disc that a window should have.
    double most_hits() const { return most_hits_; }

private:
    int more_halo_ = 0, n_calm_ = 0;
    /// Means of what repeated runs cost, and of what others waited for them. Older windows count
    /// less and less.
    double lately_ = 0, waited_lately_ = 0;
    double most_hits_ = std::numeric_limits<double>::infinity();
};

/// Estimates the collisions per disc and time in a gas of this density and mean speed, for the
/// first window: Enskog's rate, with the contact value of Henderson (1975).
double guessed_collision_rate(const BlockNeeds& needs, double mean_speed);

} // namespace carrom
