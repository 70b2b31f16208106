// SPDX-License-Identifier: BSD-3-Clause
// A plain implementation of the event-driven method (docs/understanding/method.md, section 3.3):
// every collision at its time, one after another.
//
// It has one heap, and predicts by brute force: after each collision its discs are compared with
// all others. The order is time, generation, id of P, wall before pair, id of Q, x before y. Price:
// N predicates per collision and N^2/2 a sync.
//
// Four rules that the page does not contain. The two sides of a corner that are met at one time
// follow each other without other events in between, so that x and y are equivalent. A pair that
// has just collided cannot collide again at the same time until one of the two has had another
// collision. (In a touching cluster rounding can leave b = -1e-18, which is too small for the
// impulse to change, so the pair would collide for ever. Later it may collide again.) A sync
// forgets generations and partners, because they are not part of the stored state. And more than
// `most_events` collisions throw std::runtime_error, because a disc that fills its box collides
// without end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fixed_bodies.hpp"
#include "time_stepped.hpp"

namespace carrom::reference {

/// A collision. `time` counts from sync number `sync`. For walls, `q` is wall_x or wall_y, for
/// obstacles the body.
struct Event {
    static constexpr DiscId wall_x = 0, wall_y = 1;

    double time = 0;
    std::uint32_t generation = 0;
    DiscId p = 0;
    bool is_pair = false;
    DiscId q = wall_x;
    std::int64_t sync = 0;
    bool is_fixed_body = false; ///< comes before walls
    Copy copy{};                ///< the image of q, a disc or an obstacle

    friend bool operator==(const Event&, const Event&) = default;
};

class EventDrivenReference {
public:
    EventDrivenReference(const Setting& setting, std::span<const InputDisc> discs,
                         std::size_t most_events = 1000000);

    void run_micro_steps(std::int64_t count);
    void run_steps(std::int64_t count) { run_micro_steps(count * setting_.micro_steps); }

    std::span<const DiscState> discs() const { return discs_; }
    /// Spins by id, angles per micro-step; empty unless discs are rough.
    std::span<const double> spins() const { return spins_; }
    double clock() const { return static_cast<double>(micro_step_ % setting_.sync_every); }
    std::uint64_t wall_collisions() const { return wall_collisions_; }
    std::uint64_t pair_collisions() const { return pair_collisions_; }
    const std::vector<Event>& log() const { return log_; }

private:
    struct Prediction {
        Event event;
        std::uint64_t p_version = 0, q_version = 0;
    };
    /// A disc's last collision since the sync; `version` counts all its collisions.
    struct EventHistory {
        static constexpr DiscId no_partner = ~DiscId{0};
        double time = -1;
        DiscId partner = no_partner;
        std::size_t body = ~std::size_t{0}; ///< the obstacle
        Copy copy{};                        ///< the obstacle's image
        std::uint32_t generation = 0;
        std::uint64_t version = 0;
    };

    struct Wall {
        double place = 0, speed = 0; ///< for an oscillating wall, of its line
    };
    struct Meeting {
        double time = 0;
        bool is_high = false;
    };

    static bool comes_later(const Prediction& a, const Prediction& b);
    void run_until(double time);
    void predict_all();
    void predict_walls(DiscId p);
    void predict_fixed_body(DiscId p);
    Wall wall_at(DiscId disc, DiscId axis, bool is_high, double time) const;
    bool oscillates(std::size_t side) const {
        return setting_.effects.boundaries[side].amplitude > 0;
    }
    std::int64_t last_sync() const {
        return micro_step_ / setting_.sync_every * setting_.sync_every;
    }
    double gravity(DiscId axis) const;
    double fallen(double pull, double time) const;
    Meeting meeting(const DiscState& disc, DiscId axis) const;
    void rebound(DiscState& disc, DiscId axis, bool is_high, double time, double since) const;
    double time_since_collision(DiscId id, double time) const;
    double approach(const DiscState& p, const DiscState& q, Copy copy) const;
    void restart_frame(DiscState& disc, double time) const;
    double growth_at(double time) const;
    double growth_of_radius(DiscId disc) const;
    Contact growing_contact(const DiscState& p, const DiscState& q, Copy copy) const;
    Meeting growing_meeting(const DiscState& disc, DiscId axis) const;
    void push_growing(DiscState& p, DiscState& q, double restitution, Copy copy) const;
    void predict_pair(DiscId p, DiscId q);
    void push(Event event);
    bool is_valid(const Prediction& prediction) const;
    void forget_invalid();
    void happen(const Event& event);
    void carry_out(const Event& event);
    void note(DiscId id, DiscId partner, const Event& event);

    bool discs_grow() const { return setting_.effects.growth != 0; }
    /// Growth of radii per micro-step, relative to the first ones.
    double growth_rate() const {
        return setting_.effects.growth / static_cast<double>(setting_.micro_steps);
    }

    Setting setting_;
    std::shared_ptr<const FixedBodies> species_;
    std::vector<DiscState> discs_;
    std::vector<double> spins_;
    std::vector<EventHistory> history_of_;
    std::vector<Prediction> heap_;
    /// size of the heap at which void predictions are removed
    std::size_t most_predictions_ = 1000000;
    std::int64_t micro_step_ = 0;
    std::uint64_t wall_collisions_ = 0, pair_collisions_ = 0;
    std::size_t most_events_;
    std::vector<Event> log_;
};

} // namespace carrom::reference
