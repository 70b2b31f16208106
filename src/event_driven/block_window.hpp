// SPDX-License-Identifier: BSD-3-Clause
// Chooses the length of a window of the event-driven method and the size of its blocks. It uses
// only numbers that are equal on all ranks. The choice affects the run's time, not its bits.
//
// In a long window more collisions share the cost of sorting and copying discs, but each disc has
// more possible partners. Large blocks have less halo for each disc; small blocks stay in the
// cache.
#pragma once

#include <limits>
#include <optional>

#include <carrom/box.hpp>

namespace carrom {

/// The arguments of the choice: lengths in the scene's unit, times in micro-steps.
struct BlockNeeds {
    Box box;
    double radius = 0; ///< radius of the largest disc
    double n_discs = 0;
    double speed_bound = 0;
    double collision_rate = 0; ///< collisions per disc and micro-step
    double time = 0;           ///< the window's start, since the last sync
    std::optional<int> halo;   ///< halo of a block's first run, in reaches, if a test has set it
    bool is_one_block = false; ///< true if one block contains all discs, however many
    int more_halo = 0;         ///< reaches that Caution adds to the halo
    /// Whether the halo continues beyond the sides of the box, because it contains images of discs
    bool goes_round_x = false, goes_round_y = false;
    /// Density around a disc relative to the mean density in the box, averaged over discs
    double crowding = 1;
    double n_threads = 0; ///< threads of all ranks together; 0 if each rank has one thread
    double rounds = 0;    ///< recent mean number of rounds of repeated block runs in a window
    double equivalent_radius = 0; ///< radius of equal discs with as many possible partners
};

struct BlockChoice {
    double duration = 0; ///< length of the window in micro-steps
    double reach = 0;
    int halo = 3;          ///< halo depth in reaches
    double block_side = 0; ///< side of a block, as a length; the engine rounds it to whole cells
    double own_discs = 1;  ///< number of own discs of a block, without its halo
};

/// Chooses the window with the lowest estimated cost per micro-step, at most `longest` micro-steps
/// long. If `wanted` is set, the duration is the smaller of `wanted` and `longest`.
BlockChoice choose_block_window(const BlockNeeds& needs, double longest,
                                std::optional<double> wanted);

/// Gives blocks larger halos if many block runs had to be repeated; if that is not enough, makes
/// windows shorter. Each collision changes later ones, and in a dense gas or a heap such a chain of
/// collisions spreads further in a window than the reach suggests.
class Caution {
public:
    /// Statistics of a window; times are relative to the time of its first block runs.
    struct Passed {
        double hits = 0;             ///< collisions per disc
        double repeated = 0;         ///< number of repeated block runs per block
        double waited = 0;           ///< time that ranks waited for the rank that repeats most
        double price_of_reach = 0.1; ///< extra time if halos were one reach deeper
    };
    void learn(const Passed& window);
    int more_halo() const { return more_halo_; }
    /// The largest number of collisions per disc that a window should have.
    double most_hits() const { return most_hits_; }

private:
    int more_halo_ = 0, n_calm_ = 0;
    /// Running means of the cost of repeated runs, and of the time that ranks waited for repeated
    /// runs of others
    double lately_ = 0, waited_lately_ = 0;
    double most_hits_ = std::numeric_limits<double>::infinity();
};

/// Estimates the collisions per disc and micro-step in a gas of this density and mean speed, for
/// the first window: Enskog's rate, with the contact value of Henderson (1975).
double guessed_collision_rate(const BlockNeeds& needs, double mean_speed);

} // namespace carrom
