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

/// The followers of events of one kind, and the events that they have not been given yet.
template <class Event> class Followers {
public:
    void add(EventFollower<Event>& follower) { all_.push_back(&follower); }
    void forget(EventFollower<Event>& follower) { std::erase(all_, &follower); }
    /// Where events are noted; null if nobody follows them.
    std::vector<Event>* place() { return all_.empty() ? nullptr : &events_; }
    void hand_over() {
        for (EventFollower<Event>* follower : all_) follower->take(events_);
        events_.clear();
    }

private:
    std::vector<EventFollower<Event>*> all_;
    std::vector<Event> events_;
};

} // namespace carrom
