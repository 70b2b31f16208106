// SPDX-License-Identifier: BSD-3-Clause
// An interval of time that one search covers: several whole micro-steps, or a part of one
// micro-step if discs are fast.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "dynamics/pair_contact.hpp"

namespace carrom {

/// The number of a disc's state: 0 at the window's start, n + 1 after the window's micro-step n,
/// counted from 0. A comparison reads one byte for each disc instead of a cache line.
using WindowState = std::uint8_t;
inline constexpr int longest_window = 254; ///< longest window in micro-steps

/// Micro-steps are counted from the last sync. The ends of a part are times within the micro-step;
/// the end of a part is exactly the beginning of the next one.
struct Window {
    int first_micro = 0;
    int n_micro = 1;
    double part_begin = 0; ///< beginning of the part; 0 unless the micro-step is divided
    double part_end = 1;   ///< the last part of a micro-step includes its end

    CARROM_DEVICE bool is_last_part() const { return part_end == 1; }
    CARROM_DEVICE bool is_part() const { return part_begin > 0 || part_end < 1; }
    CARROM_DEVICE int end_micro() const { return first_micro + n_micro; }
    CARROM_DEVICE WindowState state_after(int m) const {
        return static_cast<WindowState>(m - first_micro + 1);
    }
    CARROM_DEVICE double begin() const { return first_micro + part_begin; }
    CARROM_DEVICE double duration() const { return n_micro > 1 ? n_micro : part_end - part_begin; }
    /// Strips and cells are made for the positions at this time. If it is the middle of the window,
    /// no disc moves further from this position than it flies in half the window. This fails for
    /// discs that fly on after a collision, so a window of several micro-steps uses its start.
    CARROM_DEVICE double anchor() const {
        return n_micro > 1 ? first_micro : first_micro + (part_begin + part_end) / 2;
    }
    CARROM_DEVICE bool holds(double in_step_time) const {
        return in_step_time >= part_begin && (in_step_time < part_end || is_last_part());
    }
};

/// Time of a contact within micro-step m.
template <class Real> CARROM_DEVICE Real in_step_time(const PairContact<Real>& contact, int m) {
    return (contact.base - static_cast<Real>(m)) + contact.delay;
}

/// The first micro-step of [from, to) that has this contact as a candidate (0 <= t <= 1), or `to`.
template <class Real>
[[gnu::always_inline]] CARROM_DEVICE inline int first_micro_step(const PairContact<Real>& contact,
                                                                 int from, int to) {
    const double time = contact.base + contact.delay;
    if (!(time < to + 1.0)) return to;
    const int guess = static_cast<int>(time);
    for (int m = std::max(from, guess - 1); m <= guess + 1 && m < to; ++m) {
        const Real t = in_step_time(contact, m);
        if (t >= 0 && t <= 1) return m;
    }
    return to;
}

} // namespace carrom
