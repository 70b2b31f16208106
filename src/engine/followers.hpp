// SPDX-License-Identifier: BSD-3-Clause
// Passes collisions, as they happen, to measurements and other followers. Engines record events
// only if there is a follower, so that other runs lose no time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace carrom {

/// A receiver of events. Its result must not depend on the order of the events, because threads and
/// ranks find events in any order.
template <class Event> class EventFollower {
public:
    EventFollower() = default;
    virtual ~EventFollower() = default;
    EventFollower(const EventFollower&) = delete;
    EventFollower& operator=(const EventFollower&) = delete;

    /// Receives events of this rank.
    virtual void take(std::span<const Event> events) = 0;
};

/// Recorded events that followers have not received yet. Memory is reused without initialization,
/// because initializing an event, as a vector does, takes a third of the time of recording it.
template <class Event> class NotedEvents {
public:
    bool has_room() const { return n_ < n_rooms_; }
    void grow() {
        n_rooms_ = 2 * n_rooms_ + 16;
        room_.resize(n_rooms_);
    }
    /// Memory for one more event; `has_room` must be true. The memory contains old values, so all
    /// members must be written.
    Event& add() { return room_[n_++]; }
    void clear() { n_ = 0; }
    std::span<const Event> all() const { return std::span(room_).first(n_); }

private:
    std::vector<Event> room_;
    std::size_t n_ = 0, n_rooms_ = 0; ///< `n_rooms_` is room_.size(), stored to save a division
};

/// The followers of events of one kind. Followers get events soon after they happen, so that memory
/// does not increase with the number of events.
template <class Event> class Followers {
public:
    void add(EventFollower<Event>& follower) { all_.push_back(&follower); }
    void forget(EventFollower<Event>& follower) { std::erase(all_, &follower); }
    bool are_any() const { return !all_.empty(); }

    void give(std::span<const Event> events) const {
        for (EventFollower<Event>* follower : all_) follower->take(events);
    }
    /// Memory for one more event, which followers receive at the next call of `hand_over`. All
    /// members must be written.
    Event& note() {
        if (!noted_.has_room()) noted_.grow();
        return noted_.add();
    }
    void hand_over() {
        give(noted_.all());
        noted_.clear();
    }

private:
    std::vector<EventFollower<Event>*> all_;
    NotedEvents<Event> noted_;
};

} // namespace carrom
