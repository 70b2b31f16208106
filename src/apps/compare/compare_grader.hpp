// SPDX-License-Identifier: BSD-3-Clause
// Holds a student's lines to the rule, step by step, on one rank.
//
// As long as roundings cannot decide anything, lines are held to the program's own run. Each disc
// may be off by the tolerance and by what roundings have grown to. From then on two right programs
// have different discs, so each step is held to the rule as it goes on from the student's own step
// before. Costs N lines of memory, and a plain step for each line later on.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "apps/compare/compare_lines.hpp"
#include "apps/compare/compare_mistakes.hpp"
#include "apps/compare/compare_runs.hpp"
#include "scene/scene.hpp"

namespace carrom {

class Grader {
public:
    /// `scene` and `stream` must outlive this.
    Grader(const Scene& scene, double tolerance, std::istream& stream, const std::string& name);

    /// The program's runs are of use only until this is true.
    bool has_left_runs() const { return has_left_runs_; }
    /// Looks how far roundings have grown at a step, whether it is written or not.
    void note_growth(std::int64_t step, const ExpectedDiscs& expected);
    /// Reads the lines of that step and holds them to the rule; false at the first that differs.
    /// `expected` is empty once roundings decide.
    bool grade(std::int64_t step, const ExpectedDiscs& expected);
    /// Behind the last step there must be no more lines.
    bool grade_end();
    /// Whether all written steps so far were held to the rule.
    bool has_graded_all() const { return n_not_graded_ == 0; }

    /// What differs, or how the output is the same.
    std::string verdict() const;

private:
    /// What a step is held to.
    struct Aim {
        std::vector<Disc> discs;
        double clock = 0;
        std::vector<double> allowed;           ///< by id; infinite where roundings decide
        std::vector<std::vector<Disc>> others; ///< what other roundings lead to
    };

    bool read(std::int64_t step);
    bool are_possible(std::int64_t step);
    std::string misplaced(const StudentLine& line, std::int64_t step, DiscId id) const;
    double tolerance_of(const StudentLine& line) const;
    Aim aim_at(const ExpectedDiscs& expected) const;
    void move_last_digits(Disc& disc, std::uint64_t seed) const;
    Aim aim_from_own_lines() const;
    SharedState own_state(const Aim& aim, std::int64_t step) const;
    double difference_to(const std::vector<Disc>& discs, double clock, DiscId id) const;
    bool hold_to(const Aim& aim, std::int64_t step);
    bool hold_counters(const Aim& aim, std::int64_t step);
    bool hold_excused(const Aim& aim, std::int64_t step);
    std::vector<GivenDisc> given(const Aim& aim) const;
    bool blame(const Aim& aim, DiscId id, std::int64_t step);
    std::string reason(const Aim& aim, DiscId id, std::int64_t step) const;
    const SharedState& shared_state() const { return has_left_runs_ ? *own_before_ : *before_; }
    bool is_last(std::int64_t step) const { return step == scene_.steps; }

    const Scene& scene_;
    RuleSetting setting_;
    double tolerance_, unit_;
    StudentOutput output_;
    std::vector<StudentLine> lines_;        ///< of the step, by id
    std::optional<SharedState> before_;     ///< of the written step before, to go on from
    std::optional<SharedState> own_before_; ///< the same as the student's lines have it
    std::int64_t written_before_ = 0;
    std::vector<double> digits_before_; ///< StudentLine::last_digit
    std::vector<bool> is_counter_unknown_;
    bool has_left_runs_ = false;
    std::int64_t first_left_ = 0, n_steps_ = 0, n_not_graded_ = 0;
    std::optional<std::int64_t> first_drift_;
    double largest_ = 0;
    std::string verdict_;
};

} // namespace carrom
