// SPDX-License-Identifier: BSD-3-Clause
// Predicted collisions of one block run, sorted by their total order: time, generation, id of P,
// wall before pair, id of Q.
//
// A prediction is not removed when it becomes void. It stores the sum of its discs' versions, which
// grow with each collision, and is skipped if this sum has changed. Discs that have no room to move
// can collide millions of times in a window, so void predictions are removed whenever the queue has
// twice as many events as were valid at the last removal.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/disc_state.hpp"
#include "core/image.hpp"

namespace carrom {

/// Values of `q` for events without a second disc: first the numbers of fixed bodies, then the
/// walls across x and across y.
inline constexpr std::uint32_t first_fixed_body = 0x80000000, x_wall = 0xfffffffe,
                               y_wall = 0xffffffff;
inline bool is_wall(std::uint32_t partner) { return partner >= first_fixed_body; }
inline bool is_fixed_body(std::uint32_t partner) {
    return partner >= first_fixed_body && partner < x_wall;
}

struct Event {
    double time = 0;
    std::uint32_t generation = 0;
    std::uint32_t p = 0, q = x_wall; ///< slots; p has the lower id
    /// Displacement of q's image, in box lengths, from the position in its slot
    std::int16_t image_x = 0, image_y = 0;
    std::uint32_t versions = 0; ///< sum of both discs' versions when the event was predicted
    std::uint32_t next = 0;     ///< index of the next event in the same bucket of the queue

    bool has_image() const { return image_x != 0 || image_y != 0; }
    Image image() const { return {image_x, image_y}; }
    void set_image(Image image) {
        image_x = static_cast<std::int16_t>(image.x);
        image_y = static_cast<std::int16_t>(image.y);
    }
};
static_assert(sizeof(Event) == 32);

class EventOrder {
public:
    explicit EventOrder(std::span<const DiscState> discs) : discs_(discs) {}

    bool operator()(const Event& a, const Event& b) const {
        if (a.time != b.time) [[likely]]
            return a.time < b.time;
        return before_at_equal_times(a, b);
    }

private:
    bool before_at_equal_times(const Event& a, const Event& b) const {
        if (a.generation != b.generation) return a.generation < b.generation;
        if (a.p != b.p && discs_[a.p].id != discs_[b.p].id)
            return discs_[a.p].id < discs_[b.p].id; // ids are equal for two images of one disc
        if (is_wall(a.q) || is_wall(b.q)) return is_wall(a.q) && (!is_wall(b.q) || a.q < b.q);
        return discs_[a.q].id < discs_[b.q].id;
    }

    std::span<const DiscState> discs_;
};

/// The reverse order, for heaps that keep the first event on top.
inline auto after(const EventOrder& before) {
    return [&before](const Event& a, const Event& b) { return before(b, a); };
}

/// Buckets of equal length in time with about one event each, so that most operations only append
/// to a list. The bucket that is being emptied is a heap. So even if thousands of events have the
/// same time, the cost of each grows only as the logarithm of their number.
class EventQueue {
public:
    /// Removes all events. New events will lie in [begin, end], and about `n_expected` of them will
    /// be in the queue at any time.
    void restart(double begin, double end, std::size_t n_expected) {
        pool_.clear();
        first_free_ = none;
        heads_.assign(std::max<std::size_t>(n_expected, 1), none);
        begin_ = begin;
        buckets_per_time_ = static_cast<double>(heads_.size()) / (end - begin);
        current_ = 0;
        now_.clear();
        most_waiting_ = most_now_ = std::max<std::size_t>(least_to_sweep, 16 * n_expected);
    }

    void push(const Event& event, const EventOrder& before) {
        const double place = (event.time - begin_) * buckets_per_time_;
        const std::size_t bucket = std::min(static_cast<std::size_t>(place), heads_.size() - 1);
        if (bucket <= current_) return push_now(event, before);
        std::uint32_t entry = first_free_;
        if (entry == none) {
            entry = static_cast<std::uint32_t>(pool_.size());
            pool_.emplace_back();
        } else {
            first_free_ = pool_[entry].next;
        }
        pool_[entry] = event;
        pool_[entry].next = heads_[bucket];
        heads_[bucket] = entry;
    }

    /// Removes and returns the first event for which `is_current(event)` holds, and removes all
    /// events before it. Returns false if no such event has a time up to `last`.
    template <class IsCurrent>
    bool pop(Event& first, double last, const EventOrder& before, const IsCurrent& is_current) {
        if (has_outgrown()) [[unlikely]]
            sweep(before, is_current);
        for (;;) {
            while (!now_.empty()) {
                if (now_.front().time > last) return false;
                if (now_.size() > 1) std::pop_heap(now_.begin(), now_.end(), after(before));
                first = now_.back();
                now_.pop_back();
                if (is_current(first)) return true;
            }
            if (++current_ >= heads_.size()) {
                current_ = heads_.size() - 1;
                return false;
            }
            empty_bucket(before, is_current);
        }
    }

    std::size_t bytes() const {
        return pool_.capacity() * sizeof(Event) + heads_.capacity() * sizeof(std::uint32_t) +
               now_.capacity() * sizeof(Event);
    }

private:
    static constexpr std::uint32_t none = 0xffffffff;
    static constexpr std::size_t least_to_sweep = 4096;

    bool has_outgrown() const {
        return now_.size() > most_now_ || (first_free_ == none && pool_.size() > most_waiting_);
    }

    /// Removes all events that are not current. A sweep tests every event, but since the last sweep
    /// at least half of them have been added, so sweeps add only a constant cost per event.
    template <class IsCurrent> void sweep(const EventOrder& before, const IsCurrent& is_current) {
        std::erase_if(now_, [&is_current](const Event& event) { return !is_current(event); });
        std::make_heap(now_.begin(), now_.end(), after(before));
        most_now_ = std::max(most_now_, 2 * now_.size());
        std::size_t n_kept = 0;
        for (std::size_t bucket = current_ + 1; bucket < heads_.size(); ++bucket) {
            std::uint32_t entry = heads_[bucket];
            heads_[bucket] = none;
            while (entry != none) {
                Event& event = pool_[entry];
                const bool is_kept = is_current(event);
                std::uint32_t& head = is_kept ? heads_[bucket] : first_free_;
                n_kept += is_kept;
                entry = std::exchange(event.next, std::exchange(head, entry));
            }
        }
        most_waiting_ = std::max(most_waiting_, 2 * n_kept);
    }

    void push_now(const Event& event, const EventOrder& before) {
        now_.push_back(event);
        if (now_.size() > 1) std::push_heap(now_.begin(), now_.end(), after(before));
    }
    template <class IsCurrent>
    void empty_bucket(const EventOrder& before, const IsCurrent& is_current) {
        std::uint32_t entry = heads_[current_];
        while (entry != none) {
            const Event& taken = pool_[entry];
            if (is_current(taken)) push_now(taken, before);
            const std::uint32_t next = taken.next;
            pool_[entry].next = first_free_;
            first_free_ = entry;
            entry = next;
        }
    }

    double begin_ = 0, buckets_per_time_ = 1;
    std::size_t current_ = 0; ///< number of the bucket whose events are in `now_`
    std::vector<Event> now_;
    std::vector<std::uint32_t> heads_;
    std::vector<Event> pool_;
    std::uint32_t first_free_ = none;
    /// The sizes of `now_` and `pool_` above which a sweep is due.
    std::size_t most_now_ = least_to_sweep, most_waiting_ = least_to_sweep;
};

} // namespace carrom
