// SPDX-License-Identifier: BSD-3-Clause
// The queue of predicted collisions compared with a sorted list of all of them, with predictions
// that become void.
#include "catch.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "event_driven/event_queue.hpp"

using namespace carrom;

namespace {

/// Draws predictions for discs whose versions change; times come from a grid, so that many are
/// equal.
class Predictions {
public:
    Predictions(std::uint32_t n_discs, unsigned seed)
        : discs_(n_discs), versions_(n_discs, 0), random_(seed) {
        for (std::uint32_t i = 0; i < n_discs; ++i) discs_[i].id = (i * 7919ull) % n_discs;
    }

    Event draw(double from, double step, int n_steps) {
        Event event;
        event.time = from + step * static_cast<double>(below(static_cast<std::uint32_t>(n_steps)));
        event.generation = below(3);
        event.p = below(n_discs());
        event.q = below(n_discs() + 2);
        if (event.q >= n_discs())
            event.q = event.q == n_discs() ? x_wall : y_wall;
        else if (event.q == event.p)
            event.q = x_wall;
        else if (discs_[event.q].id < discs_[event.p].id)
            std::swap(event.p, event.q);
        event.versions = versions_of(event);
        return event;
    }
    void happen(const Event& event) {
        ++versions_[event.p];
        if (!is_wall(event.q)) ++versions_[event.q];
    }
    bool is_current(const Event& event) const { return versions_of(event) == event.versions; }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
    std::uint32_t n_discs() const { return static_cast<std::uint32_t>(discs_.size()); }
    EventOrder order() const { return EventOrder(discs_); }

private:
    std::uint32_t versions_of(const Event& event) const {
        return versions_[event.p] + (is_wall(event.q) ? 0 : versions_[event.q]);
    }

    std::vector<DiscState> discs_;
    std::vector<std::uint32_t> versions_;
    std::mt19937 random_;
};

bool are_same(const Event& a, const Event& b) {
    return a.time == b.time && a.generation == b.generation && a.p == b.p && a.q == b.q &&
           a.versions == b.versions;
}

} // namespace

TEST_CASE("events come out in the total order, stale ones never") {
    for (const std::uint32_t n_discs : {2u, 30u, 3000u}) {
        CAPTURE(n_discs);
        Predictions predictions(n_discs, n_discs);
        const EventOrder before = predictions.order();
        const auto is_current = [&](const Event& event) { return predictions.is_current(event); };
        EventQueue queue;
        queue.restart(0, 1, n_discs / 2);
        std::vector<Event> all;
        const auto add = [&](const Event& event) {
            if (event.time > 1) return;
            queue.push(event, before);
            all.push_back(event);
        };
        for (int k = 0; k < 20000; ++k) add(predictions.draw(0, 0x1p-12, 4097));
        std::size_t n_happened = 0;
        for (Event first; queue.pop(first, 1e300, before, is_current); ++n_happened) {
            std::erase_if(all, [&](const Event& event) { return !is_current(event); });
            const auto least = std::min_element(all.begin(), all.end(), before);
            REQUIRE(least != all.end());
            REQUIRE(are_same(first, *least));
            predictions.happen(first);
            for (std::uint32_t k = predictions.below(n_happened < 300 ? 60 : 3); k > 0; --k)
                add(predictions.draw(first.time, k % 2 == 0 ? 0x1p-20 : 0x1p-12, 2000));
        }
        CHECK(std::none_of(all.begin(), all.end(), is_current));
        CHECK(n_happened > 100);
    }
}

TEST_CASE("millions of predictions that go stale take the memory of those that do not") {
    Predictions predictions(20, 1);
    const EventOrder before = predictions.order();
    const auto is_current = [&](const Event& event) { return predictions.is_current(event); };
    EventQueue queue;
    queue.restart(0, 1, 10);
    int n_happened = 0;
    queue.push(predictions.draw(0, 0, 1), before);
    for (Event first; n_happened < 500'000 && queue.pop(first, 1e300, before, is_current);
         ++n_happened) {
        predictions.happen(first);
        // One event soon, as if discs had no room, and others later in the same bucket and in later
        // ones.
        queue.push(predictions.draw(first.time + 1e-9, 0, 1), before);
        for (int k = 0; k < 3; ++k) queue.push(predictions.draw(0.05, 0.01, 90), before);
    }
    CHECK(n_happened == 500'000);
    CHECK(queue.bytes() < 2'000'000);
}
