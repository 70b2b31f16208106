// SPDX-License-Identifier: BSD-3-Clause
// The time-stepped engine's log of collisions, for runs with followers of collisions.
#include <cmath>

#include "time_stepped/step_walls.hpp"
#include "time_stepped/time_stepped_engine.hpp"

namespace carrom {

template <class Dynamics>
void TimeSteppedEngine<Dynamics>::record_velocities(std::span<const DiscState> results) {
    unhit_.clear();
    for (const Candidate& c : verdicts_.kept) unhit_.push_back(results[c.p]);
    if (!this->pair_followers_.are_any()) return;
    unhit_partners_.clear();
    for (const Candidate& c : verdicts_.kept)
        unhit_partners_.push_back(c.is_wall() ? DiscState{} : results[c.q]);
}

/// Two ranks may both carry out the same collision. Only the owner of its first disc logs it.
template <class Dynamics>
void TimeSteppedEngine<Dynamics>::log_collisions(std::span<const DiscState> results, int m) {
    const auto k = static_cast<double>(this->micro_steps_);
    for (std::size_t i = 0; i < unhit_.size(); ++i) {
        const Candidate& c = verdicts_.kept[i];
        if (c.p >= discs_.n_own()) continue;
        // a disc that departs is set to rest, but this is not an impulse
        if (results[c.p].has_departed()) unhit_[i].vx = unhit_[i].vy = 0;
        const double dx = (results[c.p].vx - unhit_[i].vx) * k,
                     dy = (results[c.p].vy - unhit_[i].vy) * k;
        double mass = 1;
        if constexpr (Dynamics::has_species) mass = dynamics_.species_table().of(unhit_[i].id).mass;
        if (this->wall_followers_.are_any() && c.is_wall()) {
            const StepWalls walls(dynamics_);
            const auto met = walls.met(unhit_[i], m, c.time);
            const std::uint32_t body = walls.met_fixed_body(unhit_[i], m, c.time);
            if (body != BodyContact::no_body)
                this->wall_followers_.note() = body_event(
                    dynamics_.frame_at(m + c.time), dynamics_.touch(unhit_[i], body, m + c.time),
                    mass, results[c.p], results[c.p].vx - unhit_[i].vx,
                    results[c.p].vy - unhit_[i].vy, k);
            for (const std::size_t axis : {std::size_t{0}, std::size_t{1}})
                if (axis == 0 ? met.at_x : met.at_y)
                    this->wall_followers_.note() = wall_event(
                        dynamics_.frame_at(m + c.time), axis, mass, results[c.p],
                        results[c.p].vx - unhit_[i].vx, results[c.p].vy - unhit_[i].vy, k,
                        met.at_x && met.at_y);
        }
        if (this->pair_followers_.are_any() && !c.is_wall()) {
            const double time = m + c.time;
            record_in(this->pair_followers_.note(), dynamics_, unhit_[i],
                      dynamics_.separation_at(unhit_[i], unhit_partners_[i], time), results[c.p],
                      results[c.q], unhit_[i].vx, unhit_[i].vy, time, k, this->last_sync());
        }
        if (this->log_)
            this->log_->push_back({this->last_sync() + m, c.time, 0, unhit_[i].id,
                                   c.is_wall() ? Collision::wall : results[c.q].id,
                                   mass * std::sqrt(dx * dx + dy * dy)});
    }
    this->wall_followers_.hand_over();
    this->pair_followers_.hand_over();
}

// These members are called from time_stepped_engine.cpp, where the rest of the class is compiled.
#define CARROM_DEFINE(Dynamics)                                                                    \
    template void TimeSteppedEngine<Dynamics>::record_velocities(std::span<const DiscState>);      \
    template void TimeSteppedEngine<Dynamics>::log_collisions(std::span<const DiscState>, int);
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
