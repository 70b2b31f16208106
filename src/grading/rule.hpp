// SPDX-License-Identifier: BSD-3-Clause
// The time-stepped method in one process, with a switch for each mistake. `carrom compare` uses it
// to find the mistake that produces a student's line.
//
// A micro-step tests all pairs whose paths may meet, sorts the possible collisions (candidates) and
// handles them in order. Without a mistake the result equals the engine's. Cost: up to N^2/2 tests.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/disc_state.hpp"
#include "dynamics/resting_walls.hpp"
#include "engine/collision.hpp"

namespace carrom {

/// One deviation from the rule; `known_mistakes` in mistakes.cpp describes them.
enum class Mistake {
    none,
    ties_by_higher_id,
    pair_before_wall,
    order_of_ids,
    walls_first,
    pairs_first,
    first_choices_only,
    every_collision,
    every_candidate,
    each_from_start,
    last_from_start,
    half_impulse,
    no_stop,
    bounce_for_stop,
    stop_reverses,
    stop_on_one_axis,
    overlap_collides,
    overlap_parting_collides,
    overlap_leaves,
    overlap_at_end,
    corner_on_one_axis,
    /// The mistakes `one_disc_only` and the next two concern one collision of the disc `subject`
    one_disc_only,
    pair_missed,
    wall_missed,
};

struct RuleSetting {
    Box box;
    double radius = 0;
    std::int64_t micro_steps = 1, sync_every = 64;
};

class PlainRule {
public:
    /// A possible collision of a micro-step, and whether it is carried out.
    struct Candidate {
        double t = 0; ///< time since the micro-step's start
        DiscId p = 0, q = Collision::wall;
        bool is_kept = false;
    };

    /// `discs` are in order of id, as a DiscSystem stores them after `micro_steps_done`.
    PlainRule(const RuleSetting& setting, std::vector<DiscState> discs,
              std::int64_t micro_steps_done, Mistake mistake = Mistake::none, DiscId subject = 0);

    void run_micro_step();

    /// The discs in order of id, at `clock()`.
    std::span<const DiscState> discs() const { return discs_; }
    double clock() const { return static_cast<double>(micro_steps_ % setting_.sync_every); }
    /// The candidates of the last micro-step, in the order in which they were handled.
    std::span<const Candidate> candidates() const { return candidates_; }

private:
    struct Path;

    void find_candidates(double m);
    void inspect(const DiscState& p, const DiscState& q, double m);
    double contact_time(const DiscState& p, const DiscState& q, double m) const;
    double overlap_time(const DiscState& p, const DiscState& q, double m) const;
    double wall_time(const DiscState& disc, double m) const;
    void sort_candidates();
    void keep_candidates(double m);
    bool is_first_of_subject(const Candidate& candidate, Mistake mistake);
    void keep_all_collisions(double m);
    void keep(const Candidate& candidate, double m);
    void keep_from_start(const Candidate& candidate, double m);
    void collide(DiscState& p, DiscState& q, double time) const;
    void bounce(DiscState& disc, double m, double t) const;
    void stop(DiscState& disc, double m, double t) const;
    void synchronize();

    RuleSetting setting_;
    RestingWalls<double> x_walls_, y_walls_;
    double deepest_overlap_;
    Mistake mistake_;
    DiscId subject_;
    bool has_missed_ = false; ///< whether the mistake about `subject` has been made
    std::vector<DiscState> discs_;
    /// The discs at the micro-step's start, for mistakes with `from_start` in their name
    std::vector<DiscState> start_;
    std::int64_t micro_steps_;
    std::vector<Candidate> candidates_;
};

} // namespace carrom
