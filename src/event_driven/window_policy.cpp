// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/window_policy.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

namespace {

/// From one window to the next, the expected collision rate falls at most to this share of its
/// value. Just after random insertion, discs collide only half as often as a little later, and
/// windows planned for the lower rate would be too long.
constexpr double rate_kept = 0.9;
/// From one window to the next, the speed bound falls at most to this share of its value.
constexpr double bound_kept = 0.99;
constexpr double weight_of_last = 0.1; ///< weight of the last window in the running mean of rounds

} // namespace

double WindowPolicy::soon(double time, double target) const {
    return std::min(time + 2 * last_duration_, target);
}

double WindowPolicy::speed_bound(double largest, double last_bound, double gained) const {
    const double now = largest * setting_.speed_allowance;
    return std::max(now, bound_kept * last_bound) + gained;
}

PlannedWindow WindowPolicy::plan(BlockNeeds needs, double collision_rate, double longest,
                                 double target) {
    learn(collision_rate, needs);
    const double left = target - needs.time;
    longest = std::min(left, longest);
    if (!setting_.duration) longest = std::min(longest, caution_.most_hits() / rate_to_expect_);
    PlannedWindow window;
    window.choice = choose_block_window(needs, longest, setting_.duration);
    // The remaining windows up to the target have equal lengths; the last one ends exactly there.
    const double n_windows = std::ceil(left / window.choice.duration * (1 - 1e-9));
    window.end = n_windows > 1 ? needs.time + left / n_windows : target;
    if (!(window.end > needs.time) || window.end > target)
        window.end = std::nextafter(needs.time, 2 * target);
    return window;
}

/// Updates the running means with the last window, and copies the learned numbers to `needs`.
void WindowPolicy::learn(double collision_rate, BlockNeeds& needs) {
    collision_rate_ = collision_rate;
    rate_to_expect_ = std::max(collision_rate, rate_kept * rate_to_expect_);
    caution_.learn(
        {collision_rate * last_duration_, last_.repeated, last_.waited, last_.price_of_reach});
    needs.collision_rate = rate_to_expect_;
    needs.halo = setting_.halo;
    needs.n_threads = setting_.n_threads;
    needs.rounds = rounds_lately_;
    needs.more_halo = caution_.more_halo();
    rounds_lately_ += weight_of_last * (n_rounds_ - rounds_lately_);
    last_.repeated = last_.waited = n_rounds_ = 0;
}

void WindowPolicy::note(const Rollback& rollback) {
    last_.repeated += rollback.repeated;
    last_.waited += rollback.waited;
    last_.price_of_reach = rollback.price_of_reach;
    n_rounds_ += 1;
}

BlockWindow shortened(BlockWindow window, double speed_bound, double diameter) {
    const double share = window.speed_bound / speed_bound;
    const double duration = share > 0x1p-200 ? window.duration() * share
                                             : std::min(window.duration(), diameter / speed_bound);
    window.end = std::max(window.begin + duration, std::nextafter(window.begin, window.end));
    window.speed_bound = speed_bound;
    return window;
}

} // namespace carrom
