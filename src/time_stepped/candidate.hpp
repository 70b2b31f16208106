// SPDX-License-Identifier: BSD-3-Clause
// A possible collision, and the total order of such collisions.
//
// A candidate refers to its discs by their indices in this rank's arrays. Their ids are read only
// to break ties.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "core/disc_state.hpp"
#include "core/raw_vector.hpp"
#include "time_stepped/window.hpp"

namespace carrom {

/// The value of q if the candidate is a collision with a wall.
inline constexpr LocalIndex wall_index = std::numeric_limits<LocalIndex>::max();

struct Candidate {
    double time = 0;                  ///< time within its micro-step, in [0, 1]
    LocalIndex p = 0, q = wall_index; ///< p has the lower id

    CARROM_DEVICE bool is_wall() const { return q == wall_index; }
};
static_assert(sizeof(Candidate) == 16);
using Candidates = RawVector<Candidate>;

/// Orders by time, then id of P, then wall before pair, then id of Q: exactly, without a tolerance.
class TotalOrder {
public:
    CARROM_DEVICE explicit TotalOrder(std::span<const DiscState> discs) : discs_(discs) {}

    CARROM_DEVICE bool operator()(const Candidate& a, const Candidate& b) const {
        if (a.time != b.time) return a.time < b.time;
        if (a.p != b.p && discs_[a.p].id != discs_[b.p].id)
            // Ids may be equal, because both discs may be images of one disc.
            return discs_[a.p].id < discs_[b.p].id;
        if (a.is_wall() || b.is_wall()) return a.is_wall() && !b.is_wall();
        return discs_[a.q].id < discs_[b.q].id;
    }

private:
    std::span<const DiscState> discs_;
};

/// Whether neither disc has collided since the prediction. `seen` is the largest number of a state
/// (window.hpp) that any disc had at the prediction. `states` has the present number for each disc.
inline bool is_current(const Candidate& candidate, WindowState seen,
                       std::span<const WindowState> states) {
    return states[candidate.p] <= seen && (candidate.is_wall() || states[candidate.q] <= seen);
}

} // namespace carrom
