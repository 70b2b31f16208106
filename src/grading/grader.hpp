// SPDX-License-Identifier: BSD-3-Clause
// Compares a student's lines with the rule (rule.hpp, docs/classroom.md), step by step on one rank.
//
// At first lines are compared with Carrom's own run. Each disc may differ by the tolerance plus the
// difference that roundings can have caused so far. When this is a tenth of a radius, two correct
// programs may have different collisions. From then on a step is compared with the rule applied to
// the student's previous step. If points are counted, grading continues after a step that is
// missing or unreadable. Memory: N lines. Time after the end of Carrom's own runs: six steps of the
// plain rule per step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "grading/lines.hpp"
#include "grading/mistakes.hpp"
#include "grading/points.hpp"
#include "grading/runs.hpp"
#include "grading/steps.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

class Grader {
public:
    /// `scene` and `stream` must outlive this object. With `counts_points` grading goes on after
    /// a wrong step, from the student's own lines.
    Grader(const SceneParameters& scene, double tolerance, std::istream& stream,
           const std::string& name, bool counts_points);

    /// Whether the student's lines have replaced Carrom's own runs, which then need not go on.
    bool has_left_runs() const { return has_left_runs_; }
    /// Reads the lines of `step`, if there are any, and compares them with the rule. `expected` is
    /// empty once `has_left_runs()` is true. Returns whether to grade the next step, which may be
    /// the one after the last.
    bool grade(std::int64_t step, const ExpectedDiscs& expected);
    /// Whether no line has differed so far.
    bool is_right() const { return verdict_.empty(); }
    const Points& points() const { return points_; }
    /// Whether all written steps so far were compared with the rule.
    bool has_graded_all() const { return n_not_graded_ == 0; }

    /// Describes the line that differs, or in which sense the output counts as correct.
    std::string verdict() const;

private:
    /// The expected result of a step, and how far lines may differ from it.
    struct Aim {
        std::vector<DiscState> discs;
        double clock = 0;
        /// Allowed difference by id; infinite if other roundings can move the disc by 0.1 radii
        std::vector<double> allowed;
        std::vector<std::vector<DiscState>> others; ///< results of the runs with other roundings
    };

    void record_spread(std::int64_t step, const ExpectedDiscs& expected);
    bool record_problem(const std::string& problem);
    bool record_missing(std::int64_t step);
    bool record_more(std::int64_t step);
    void count_missing(std::int64_t step);
    bool grade_lines(std::int64_t step, const ExpectedDiscs& expected);
    bool can_grade(std::int64_t step) const;
    void go_on_from_lines(std::int64_t step, const std::vector<DiscState>& counters);
    bool hold(const Aim& aim, std::int64_t step);
    bool hold_precision(const Aim& aim);
    bool are_possible(std::int64_t step);
    double tolerance_of(const StudentLine& line) const;
    Aim aim_at(const ExpectedDiscs& expected) const;
    void move_last_digits(DiscState& disc, std::uint64_t seed) const;
    Aim aim_from_own_lines() const;
    SharedState own_state(const std::vector<DiscState>& counters, std::int64_t step) const;
    double difference_to(const std::vector<DiscState>& discs, double clock, DiscId id) const;
    bool hold_to(const Aim& aim, std::int64_t step);
    bool hold_counters(const Aim& aim, std::int64_t step);
    bool hold_excused(const Aim& aim, std::int64_t step);
    std::vector<GivenDisc> given(const Aim& aim) const;
    bool blame(const Aim& aim, DiscId id, std::int64_t step);
    std::string reason(const Aim& aim, DiscId id, std::int64_t step) const;
    const SharedState& shared_state() const { return has_left_runs_ ? *own_before_ : *before_; }
    const std::vector<StudentLine>& lines() const { return steps_.lines(); }
    double last_digit(const StudentLine& line) const {
        return std::max(line.last_digit, unit_of_float_);
    }

    const SceneParameters& scene_;
    RuleSetting setting_;
    double tolerance_, unit_;
    StudentSteps steps_;
    std::optional<SharedState> before_;     ///< the run's discs at the last step with all lines
    std::optional<SharedState> own_before_; ///< the student's discs at that step
    std::int64_t written_before_ = 0;
    double unit_of_float_ = 0; ///< bound of a step's error if the student's numbers are floats
    std::vector<double> digits_before_; ///< StudentLine::last_digit in the step before, by id
    /// Unit of the finest last digit in the lines of this step, and of the step before
    double finest_ = 0, finest_before_ = 0;
    std::vector<bool> is_counter_unknown_;
    bool has_left_runs_ = false;
    std::int64_t first_left_ = 0, n_steps_ = 0, n_not_graded_ = 0;
    std::optional<std::int64_t> first_drift_;
    double largest_ = 0;
    std::string verdict_; ///< text about the first line that differs; empty if there is none
    bool counts_points_;
    Points points_;
};

} // namespace carrom
