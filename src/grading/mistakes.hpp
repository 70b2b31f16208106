// SPDX-License-Identifier: BSD-3-Clause
// The mistakes that `carrom compare` knows, and the search for the mistake that produces a given
// line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/disc_state.hpp"
#include "grading/lines.hpp"
#include "grading/rule.hpp"

namespace carrom {

/// A disc in a line of a student's output, and the tolerance of its numbers.
struct GivenDisc {
    double x = 0, y = 0, vx = 0, vy = 0;
    double tolerance = 0;
};

/// The start of a search: a state in which the student's output and the rule agree.
struct SharedState {
    RuleSetting setting;
    std::vector<DiscState> discs; ///< by id
    std::int64_t micro_steps_done = 0;
};

struct Explanation {
    const char* rule;    ///< the violated rule of docs/classroom.md
    const char* mistake; ///< the mistake in the student's program that produces these lines
    /// Whether the mistake is about collisions at the same time
    bool is_of_equal_times = false;
    std::size_t n_unexplained = 0; ///< number of lines that the mistake does not explain
};

/// The mistake that reproduces the line of disc `wrong` and as many other lines as possible,
/// `micro_steps` after `state`. `given` is in order of id. Cost: some 30 runs of the rule.
std::optional<Explanation> explain(const SharedState& state, std::int64_t micro_steps,
                                   const std::vector<GivenDisc>& given, DiscId wrong);

/// Whether a run of the plain rule from `state` leads to `discs` after `micro_steps`. Positions of
/// `discs` are compared at the time `clock` since the last sync.
bool follows_rule(const SharedState& state, std::int64_t micro_steps,
                  const std::vector<DiscState>& discs, double clock);

/// Lists the disc's contacts in the next micro-step according to the rule, each of the first eight
/// in a line of its own.
std::string facts(const SharedState& state, DiscId id);

/// Whether all lines are the discs at time 0 rounded to single precision, within the lines' digits,
/// and some line shows the rounding. `unit` converts velocities to lengths per step.
bool is_rounded_to_float(const std::vector<StudentLine>& lines, const std::vector<DiscState>& discs,
                         double unit);

/// Whether a search for the mistake takes less than a few minutes.
bool can_explain(std::uint64_t n_discs, std::int64_t micro_steps);

} // namespace carrom
