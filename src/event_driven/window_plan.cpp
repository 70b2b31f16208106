// SPDX-License-Identifier: BSD-3-Clause
// Plans the next window of the event-driven engine: its length, its speed bound, and whether one
// run covers the whole box. Also tests whether growing discs jam in the window.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/jammed.hpp"
#include "engine/speed_survey.hpp"
#include "engine/window_choice.hpp"
#include "event_driven/event_driven_engine.hpp"

namespace carrom {

namespace {

/// A jam is reported if the largest speed rises by more than this factor between two syncs. Discs
/// that grow from a dilute gas to the densest liquid become only some 30 times as fast.
constexpr double jam_heating = 64;
/// Up to this number of discs, one block without a halo is fastest on one thread.
constexpr double most_discs_alone = 30000;
/// Largest number of stops in a window. More stops save little time, and each part takes memory.
constexpr std::int64_t most_stops = 256;

} // namespace

template <class Dynamics> BlockWindow EventDrivenEngine<Dynamics>::choose(double target) {
    const PhaseClock::Scope scope(phases_, Phase::wait);
    BlockWindow window;
    window.begin = time_;
    window.holds_begin = time_ == 0;
    window.speed_bound = speed_bound_until(target);
    this->refuse_long_flights(window.speed_bound);
    if (window.speed_bound > runaway_speed_) refuse_runaway(window.speed_bound);
    if (n_windows_ > 0) take_crowding(reduced_.counts.crowding);
    const BlockNeeds needs = block_needs(window.speed_bound);
    double longest = target - time_;
    if constexpr (Dynamics::is_periodic)
        longest = std::min(longest, longest_in_period(discs_.periods(), window.speed_bound));
    const PlannedWindow planned = policy_.plan(needs, collision_rate(needs), longest, target);
    choice_ = planned.choice;
    window.end = planned.end;
    return window;
}

/// Throws on every rank without communication, because all ranks plan the same windows.
template <class Dynamics> void EventDrivenEngine<Dynamics>::refuse_runaway(double speed) const {
    throw CollectiveError(fmt::format(
        "soon after step {:.9g} a disc flies {:.2g} a step, over 100,000 times as fast as anything "
        "at the start: surfaces that slide ('velocity' of a side or of effects.obstacles) give "
        "energy that nothing takes; try: a restitution or a tangential_restitution below 1 there, "
        "or effects.drag",
        (static_cast<double>(this->last_sync()) + time_) / static_cast<double>(this->micro_steps_),
        speed * static_cast<double>(this->micro_steps_)));
}

/// The largest speed at the window's start. After the first window the validation has already found
/// it for all ranks. **Collective.**
template <class Dynamics> double EventDrivenEngine<Dynamics>::largest_of_all() const {
    return is_largest_known_ ? reduced_.largest : communicator_.max(largest_speed_);
}

/// The speed bound of the next window. In a frame that falls, speeds grow until the window ends,
/// even for discs at rest on a floor. **Collective.**
template <class Dynamics>
double EventDrivenEngine<Dynamics>::speed_bound_until(double target) const {
    const double gained = dynamics_.speed_gained_at(policy_.soon(time_, target)) -
                          dynamics_.speed_gained_at(time_);
    return policy_.speed_bound(largest_of_all(), travel_speed_, gained);
}

/// Sets `first_speed_` at the start of a sync interval, if discs grow. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::record_first_speed() {
    const double per_micro_step = dynamics_.size_at(1) - dynamics_.size_at(0);
    if (!(per_micro_step > 0) || (time_ > 0 && n_windows_ > 0)) return;
    first_speed_ = std::max(largest_of_all(), dynamics_.diameter() * per_micro_step);
}

/// Whether growing discs have jammed: they become ever faster and collide ever more often, so that
/// the step would never end. The largest speed at any time of the window is used, so that the
/// result does not depend on how time and space are cut into windows and blocks.
template <class Dynamics> bool EventDrivenEngine<Dynamics>::are_jammed() const {
    if (first_speed_ == 0) return false;
    return std::ranges::any_of(blocks_, [&](const Block& block) {
        return block.outcome.largest_speed > jam_heating * first_speed_;
    });
}

/// Ends the run. The message names the step up to which the run is valid. It does not name the
/// event that revealed the jam, because that event depends on windows and threads. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::refuse_jam() const {
    const double safe = jam_watch_.safe_until();
    const double size = dynamics_.size_at(safe - static_cast<double>(this->last_sync()));
    throw Jammed(fmt::format("discs jam after step {:.6g}, at a packing fraction of {:.5g} (radii "
                             "{:.6g} times the first): they collide ever more often, because they "
                             "have no room to grow further",
                             safe / static_cast<double>(this->micro_steps_),
                             first_packing_ * size * size, size),
                 static_cast<std::int64_t>(safe));
}

/// Whether one run of the whole box is possible and fast. This is so on one rank, with few discs,
/// unless a test sets how blocks are cut.
template <class Dynamics> bool EventDrivenEngine<Dynamics>::can_run_alone() const {
    const auto n = static_cast<double>(discs_.n_total());
    const bool is_few = tuning_.threads == 1 ||
                        n < 2 * static_cast<double>(tuning_.discs_per_thread);
    return communicator_.size() == 1 && is_few && n <= most_discs_alone && !block_tuning_.halo &&
           !block_tuning_.block_side && !block_tuning_.cuts_by_work;
}

/// The arguments of the choice of the next window, except the numbers learned from past windows.
template <class Dynamics> BlockNeeds EventDrivenEngine<Dynamics>::block_needs(double speed_bound) {
    BlockNeeds needs;
    needs.box = dynamics_.box();
    needs.radius = dynamics_.radius() * dynamics_.size_at(time_) + dynamics_.slack();
    needs.equivalent_radius = equivalent_radius(levels_) * dynamics_.size_at(time_) +
                              dynamics_.slack();
    needs.n_discs = static_cast<double>(discs_.n_total());
    needs.speed_bound = speed_bound;
    needs.time = time_;
    needs.is_one_block = is_alone_;
    needs.goes_round_x = discs_.periods().x != 0;
    needs.goes_round_y = discs_.periods().y != 0;
    // a run of the whole box measures no crowding
    needs.crowding = is_alone_ ? 1 : mean_crowding_;
    return needs;
}

/// Collisions per disc and micro-step in the last window, or an estimate for the first window.
/// **Collective.**
template <class Dynamics>
double EventDrivenEngine<Dynamics>::collision_rate(const BlockNeeds& needs) const {
    if (n_windows_ > 0)
        return static_cast<double>(reduced_.counts.events) /
               (std::max(needs.n_discs, 1.0) * policy_.last_duration());
    const double largest = communicator_.max(largest_speed_);
    if (!(largest > 0)) return 0;
    return guessed_collision_rate(
        needs, survey_speeds(discs_.own(), largest, communicator_, tuning_.threads).mean());
}

/// Makes the window shorter, because a disc was faster than the bound. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::shorten() {
    double fastest = 0;
    for (const Block& block : blocks_) fastest = std::max(fastest, block.outcome.too_fast);
    window_ = shortened(window_, communicator_.max(fastest) * policy_.speed_allowance(),
                        dynamics_.diameter());
    std::erase_if(stops_, [this](double stop) { return stop >= window_.end; });
}

/// The latest time at which the next window may end, if the next stop is `target`.
template <class Dynamics> double EventDrivenEngine<Dynamics>::horizon(std::int64_t target) const {
    if (jam_watch_.is_on()) return std::min(time_of(target), jam_watch_.bin_end());
    return time_of(std::min(this->horizon_of(target), target + most_stops * this->stop_interval()));
}

/// Lists the stops inside the window, if the next one is `target`.
template <class Dynamics> void EventDrivenEngine<Dynamics>::list_stops(std::int64_t target) {
    stops_.clear();
    for (std::int64_t stop = target; time_of(stop) < window_.end; stop += this->stop_interval())
        stops_.push_back(time_of(stop));
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::end_at_first_stop() {
    window_.end = stops_.front();
    stops_.clear();
}

// These members are called from event_driven_engine.cpp, where the rest of the class is compiled.
#define CARROM_DEFINE(Dynamics)                                                                    \
    template BlockWindow EventDrivenEngine<Dynamics>::choose(double);                              \
    template void EventDrivenEngine<Dynamics>::record_first_speed();                               \
    template bool EventDrivenEngine<Dynamics>::are_jammed() const;                                 \
    template void EventDrivenEngine<Dynamics>::refuse_jam() const;                                 \
    template void EventDrivenEngine<Dynamics>::refuse_runaway(double) const;                       \
    template bool EventDrivenEngine<Dynamics>::can_run_alone() const;                              \
    template double EventDrivenEngine<Dynamics>::horizon(std::int64_t) const;                      \
    template void EventDrivenEngine<Dynamics>::list_stops(std::int64_t);                           \
    template void EventDrivenEngine<Dynamics>::end_at_first_stop();                                \
    template void EventDrivenEngine<Dynamics>::shorten();
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
