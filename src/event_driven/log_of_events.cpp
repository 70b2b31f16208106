// SPDX-License-Identifier: BSD-3-Clause
// Passes events of the event-driven engine on to the log and to the followers of walls and pairs.
#include "event_driven/event_driven_engine.hpp"

namespace carrom {

template <class Dynamics>
void EventDrivenEngine<Dynamics>::log_events(const BlockOutcome& outcome, std::size_t first_part,
                                             std::size_t end_part) {
    const auto of_parts = [&](std::size_t BlockPart::* number, auto all) {
        const auto [first, end] = outcome.entries(number, first_part, end_part);
        return all.subspan(first, end - first);
    };
    for (const LoggedEvent& event : of_parts(&BlockPart::n_logged, std::span(outcome.log))) {
        double mass = 1;
        if constexpr (Dynamics::has_species) mass = dynamics_.species_table().of(event.p).mass;
        const Frame frame = dynamics_.frame_at(event.time);
        const double per_step = static_cast<double>(this->micro_steps_),
                     unit = mass * (frame.slowing * per_step);
        if (this->wall_followers_.are_any() && event.is_wall) {
            DiscState after;
            after.vx = event.vx, after.vy = event.vy;
            this->wall_followers_.note() = event.q <= 1 ? wall_event(frame, event.q, mass, after,
                                                                     event.gained_x, event.gained_y,
                                                                     per_step, false)
                                                        : body_event(frame, event.touch, mass,
                                                                     after, event.gained_x,
                                                                     event.gained_y, per_step);
        }
        if (this->log_)
            this->log_->push_back(
                {this->last_sync(), dynamics_.micro_steps_at(event.time), event.generation, event.p,
                 event.is_wall ? Collision::wall : event.q, event.impulse * unit});
    }
    this->wall_followers_.hand_over();
    this->pair_followers_.give(of_parts(&BlockPart::n_pairs, outcome.pairs.all()));
}

// This member is called from event_driven_engine.cpp, so it is instantiated here.
#define CARROM_DEFINE(Dynamics)                                                                    \
    template void EventDrivenEngine<Dynamics>::log_events(const BlockOutcome&, std::size_t,        \
                                                          std::size_t);
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
