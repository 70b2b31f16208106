// SPDX-License-Identifier: BSD-3-Clause
// Whoever wants to know of collisions as they happen, for example a measurement. Engines note
// events only where somebody follows them, so that other runs pay nothing.
#pragma once

#include <span>
#include <vector>

namespace carrom {

/// What is taken must not depend on the order of the events, because threads and ranks find them in
/// any order.
template <class Event> class EventFollower {
public:
    EventFollower() = default;
    virtual ~EventFollower() = default;
    EventFollower(const EventFollower&) = delete;
    EventFollower& operator=(const EventFollower&) = delete;

    /// Takes events of this rank.
    virtual void take(std::span<const Event> events) = 0;
};

/// The followers of events of one kind. They are given events soon after these have happened, so
/// that memory does not grow with their number.
template <class Event> class Followers {
public:
    void add(EventFollower<Event>& follower) { all_.push_back(&follower); }
    void forget(EventFollower<Event>& follower) { std::erase(all_, &follower); }
    bool are_any() const { return !all_.empty(); }

    void give(std::span<const Event> events) const {
        for (EventFollower<Event>* follower : all_) follower->take(events);
    }
    /// Room for an event that waits for `hand_over`, for engines that find events one by one.
    Event& note() { return noted_.emplace_back(); }
    void hand_over() {
        give(noted_);
        noted_.clear();
    }

private:
    std::vector<EventFollower<Event>*> all_;
    std::vector<Event> noted_;
};

} // namespace carrom
