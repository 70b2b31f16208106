// SPDX-License-Identifier: BSD-3-Clause
// Predicted collisions of one replay in their total order: time, generation, id of P, wall before pair, id of Q.
//
// Predictions are not taken back: one whose discs have collided since is known by their versions and passed over.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "carrom/core/disc.hpp"

namespace carrom {

/// Stand for a wall in the place of a second disc; x comes before y.
inline constexpr std::uint32_t x_wall = 0xfffffffe, y_wall = 0xffffffff;
inline bool is_wall(std::uint32_t partner) { return partner >= x_wall; }

struct Event {
    double time = 0;
    std::uint32_t generation = 0;
    std::uint32_t p = 0, q = x_wall;              ///< slots; p has the lower id
    std::uint32_t p_version = 0, q_version = 0;   ///< the states it was predicted from
};

class EventOrder {
public:
    explicit EventOrder(std::span<const Disc> discs) : discs_(discs) {}

    bool operator()(const Event& a, const Event& b) const {
        if (a.time != b.time) [[likely]] return a.time < b.time;
        return before_at_one_time(a, b);
    }

private:
    bool before_at_one_time(const Event& a, const Event& b) const {
        if (a.generation != b.generation) return a.generation < b.generation;
        if (a.p != b.p) return discs_[a.p].id < discs_[b.p].id;
        if (is_wall(a.q) || is_wall(b.q)) return is_wall(a.q) && (!is_wall(b.q) || a.q < b.q);
        return discs_[a.q].id < discs_[b.q].id;
    }

    std::span<const Disc> discs_;
};

class EventQueue {
public:
    void clear() { heap_.clear(); }
    bool is_empty() const { return heap_.empty(); }

    void push(const Event& event, const EventOrder& before) {
        heap_.push_back(event);
        std::push_heap(heap_.begin(), heap_.end(), [&](const Event& a, const Event& b) { return before(b, a); });
    }

    Event pop(const EventOrder& before) {
        std::pop_heap(heap_.begin(), heap_.end(), [&](const Event& a, const Event& b) { return before(b, a); });
        const Event first = heap_.back();
        heap_.pop_back();
        return first;
    }

    std::size_t bytes() const { return heap_.capacity() * sizeof(Event); }

private:
    std::vector<Event> heap_;
};

} // namespace carrom
