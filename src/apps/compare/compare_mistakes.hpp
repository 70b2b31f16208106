// SPDX-License-Identifier: BSD-3-Clause
// The mistakes that `carrom compare` knows, in words, and the search for the one that gives a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/compare/compare_rule.hpp"
#include "core/disc.hpp"

namespace carrom {

/// What a line of a student's output has for a disc, and how far the rule's numbers may be off.
struct GivenDisc {
    double x = 0, y = 0, vx = 0, vy = 0;
    double tolerance = 0;
};

/// Where the search begins: a state that the student's output and the rule share.
struct SharedState {
    RuleSetting setting;
    std::vector<Disc> discs; ///< by id
    std::int64_t micro_steps_done = 0;
};

struct Explanation {
    const char* rule;               ///< of docs/classroom.md
    const char* mistake;            ///< what a program does that gives these lines
    bool is_of_equal_times = false; ///< a wrong choice between collisions at one time
    std::size_t n_unexplained = 0;  ///< lines that it does not give
};

/// The mistake that gives the line of disc `wrong` after `micro_steps` more, and as many of the
/// other lines as any other. `given` is by id. Costs a plain run for each mistake.
std::optional<Explanation> explain(const SharedState& state, std::int64_t micro_steps,
                                   const std::vector<GivenDisc>& given, DiscId wrong);

/// True if the plain rule gets from the state to the discs at `clock` so many micro-steps on.
bool follows_rule(const SharedState& state, std::int64_t micro_steps,
                  const std::vector<Disc>& discs, double clock);

/// What the disc meets in the next micro-step, by the rule: a line for each candidate.
std::string facts(const SharedState& state, DiscId id);

/// False where a search would take minutes.
bool can_explain(std::uint64_t n_discs, std::int64_t micro_steps);

} // namespace carrom
