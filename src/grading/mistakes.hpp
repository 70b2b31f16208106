// SPDX-License-Identifier: BSD-3-Clause
// The mistakes that `carrom compare` knows, and the search for the one that gives a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/disc_state.hpp"
#include "grading/lines.hpp"
#include "grading/rule.hpp"

namespace carrom {

/// A disc in a line of a student's output, and by how much the rule's numbers may differ.
struct GivenDisc {
    double x = 0, y = 0, vx = 0, vy = 0;
    double tolerance = 0;
};

/// The begin of a search: a state that the student's output and the rule share.
struct SharedState {
    RuleSetting setting;
    std::vector<DiscState> discs; ///< by id
    std::int64_t micro_steps_done = 0;
};

struct Explanation {
    const char* rule;               ///< a rule in docs/classroom.md
    const char* mistake;            ///< what a program does that gives these lines
    bool is_of_equal_times = false; ///< a wrong choice between collisions at one time
    std::size_t n_unexplained = 0;  ///< lines that it does not give
};

/// The mistake that gives the line of disc `wrong` after `micro_steps` more, and the
/// most of the other lines. `given` is by id. Costs a plain run for each mistake.
std::optional<Explanation> explain(const SharedState& state, std::int64_t micro_steps,
                                   const std::vector<GivenDisc>& given, DiscId wrong);

/// Whether the plain rule leads from the state to the discs at `clock` in `micro_steps`.
bool follows_rule(const SharedState& state, std::int64_t micro_steps,
                  const std::vector<DiscState>& discs, double clock);

/// The contacts of the disc in the next micro-step, by the rule: a line for each candidate.
std::string facts(const SharedState& state, DiscId id);

/// Whether all lines are the discs at time 0 with numbers rounded to single precision, and their
/// digits show it. `unit` multiplies velocities.
bool is_rounded_to_float(const std::vector<StudentLine>& lines, const std::vector<DiscState>& discs,
                         double unit);

/// False if a search would take minutes.
bool can_explain(std::uint64_t n_discs, std::int64_t micro_steps);

} // namespace carrom
