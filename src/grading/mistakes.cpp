// SPDX-License-Identifier: BSD-3-Clause
#include "grading/mistakes.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace carrom {

namespace {

struct KnownMistake {
    Mistake kind;
    const char* rule;
    const char* text;
};

constexpr const char* candidates = "candidates";
constexpr const char* order = "order";
constexpr const char* one_collision = "one collision a step";
constexpr const char* impulse = "impulse";
constexpr const char* stop_at_wall = "stop at a wall";
constexpr const char* overlap = "overlap";
constexpr const char* corner = "corner";

/// Small deviations from the rule come first, because the search reports the first of all mistakes
/// that explain the most lines.
constexpr std::array known_mistakes{
    KnownMistake{Mistake::ties_by_higher_id, order,
                 "of collisions at equal times the one of the higher ids is kept"},
    KnownMistake{Mistake::pair_before_wall, order,
                 "at equal times a pair is kept before a wall, whatever its ids"},
    KnownMistake{Mistake::walls_first, order,
                 "all walls are kept before any pair, whatever their times"},
    KnownMistake{Mistake::pairs_first, order,
                 "all pairs are kept before any wall, whatever their times"},
    KnownMistake{Mistake::order_of_ids, order,
                 "collisions are kept in the order of ids and not of times"},
    KnownMistake{Mistake::first_choices_only, order,
                 "a collision that is not kept still keeps its other disc from colliding"},
    KnownMistake{Mistake::corner_on_one_axis, corner,
                 "in a corner only one component of the velocity is reversed"},
    KnownMistake{Mistake::no_stop, stop_at_wall,
                 "a disc flies on through the wall after its collision"},
    KnownMistake{Mistake::stop_reverses, stop_at_wall,
                 "a disc that stops at a wall has its velocity reversed in the same step"},
    KnownMistake{Mistake::bounce_for_stop, stop_at_wall,
                 "a disc bounces off a wall after its collision, and does not stop there"},
    KnownMistake{Mistake::stop_on_one_axis, stop_at_wall,
                 "a disc that stops at a wall goes on along it"},
    KnownMistake{Mistake::overlap_collides, overlap,
                 "discs that overlap and approach collide at once"},
    KnownMistake{Mistake::overlap_parting_collides, overlap,
                 "discs that overlap collide at once, even while they part"},
    KnownMistake{Mistake::overlap_leaves, overlap,
                 "discs that overlap collide when they part: the later time of contact is taken"},
    KnownMistake{Mistake::overlap_at_end, overlap,
                 "only discs that overlap at the end of the step collide"},
    KnownMistake{Mistake::every_collision, one_collision,
                 "a disc collides again in the same step, wherever it flies"},
    KnownMistake{Mistake::every_candidate, one_collision,
                 "all collisions of the list are carried out, and discs collide more than once"},
    KnownMistake{Mistake::each_from_start, one_collision,
                 "discs collide more than once, each time with the velocities of the step's start, "
                 "and the changes add up"},
    KnownMistake{Mistake::last_from_start, one_collision,
                 "discs collide more than once, each time with the velocities of the step's start, "
                 "and only the last collision counts"},
    KnownMistake{Mistake::half_impulse, impulse,
                 "discs exchange half of their relative velocity, and fly on side by side"},
    KnownMistake{
        Mistake::one_disc_only, impulse,
        "a collision changes only one of its two discs, as when two threads write at once"},
    KnownMistake{Mistake::pair_missed, candidates, "two discs that should collide flew on freely"},
    KnownMistake{Mistake::wall_missed, candidates, "a disc flew on freely through a wall"},
};

/// A mistake that concerns a single disc is tried for up to this number of discs.
constexpr std::size_t most_subjects = 4;

std::vector<GivenDisc> run(const SharedState& state, std::int64_t micro_steps, Mistake mistake,
                           DiscId subject) {
    PlainRule rule(state.setting, state.discs, state.micro_steps_done, mistake, subject);
    for (std::int64_t i = 0; i < micro_steps; ++i) rule.run_micro_step();
    const auto unit = static_cast<double>(state.setting.micro_steps);
    std::vector<GivenDisc> result;
    for (const DiscState& disc : rule.discs())
        result.push_back(
            {disc.x_at(rule.clock()), disc.y_at(rule.clock()), disc.vx * unit, disc.vy * unit});
    return result;
}

bool agree(const GivenDisc& made, const GivenDisc& given) {
    const auto is_near = [&given](double a, double b) {
        return std::fabs(a - b) <= given.tolerance; // false for NaN, too
    };
    return is_near(made.x, given.x) && is_near(made.y, given.y) && is_near(made.vx, given.vx) &&
           is_near(made.vy, given.vy);
}

std::size_t n_different(const std::vector<GivenDisc>& made, const std::vector<GivenDisc>& given) {
    std::size_t n = 0;
    for (std::size_t id = 0; id < given.size(); ++id) n += agree(made[id], given[id]) ? 0 : 1;
    return n;
}

bool concerns_one_disc(Mistake mistake) {
    return mistake == Mistake::one_disc_only || mistake == Mistake::pair_missed ||
           mistake == Mistake::wall_missed;
}

/// Returns `wrong` and a few other discs whose lines differ from the rule, because an error at one
/// of them may be the reason why `wrong` meets another disc.
std::vector<DiscId> differing(const std::vector<GivenDisc>& made,
                              const std::vector<GivenDisc>& given, DiscId wrong) {
    std::vector<DiscId> ids{wrong};
    for (DiscId id = 0; id < given.size() && ids.size() < most_subjects; ++id)
        if (id != wrong && !agree(made[id], given[id])) ids.push_back(id);
    return ids;
}

} // namespace

std::optional<Explanation> explain(const SharedState& state, std::int64_t micro_steps,
                                   const std::vector<GivenDisc>& given, DiscId wrong) {
    std::optional<Explanation> best;
    const auto search = [&](const KnownMistake& known, DiscId subject) {
        const std::vector<GivenDisc> made = run(state, micro_steps, known.kind, subject);
        if (!agree(made[wrong], given[wrong])) return;
        const std::size_t n_unexplained = n_different(made, given);
        if (best && n_unexplained >= best->n_unexplained) return;
        best = Explanation{known.rule, known.text,
                           known.kind == Mistake::ties_by_higher_id ||
                               known.kind == Mistake::pair_before_wall ||
                               known.kind == Mistake::corner_on_one_axis,
                           n_unexplained};
    };
    for (const KnownMistake& known : known_mistakes)
        if (!concerns_one_disc(known.kind)) search(known, wrong);
    const std::vector<DiscId> subjects = differing(run(state, micro_steps, Mistake::none, wrong),
                                                   given, wrong);
    for (const KnownMistake& known : known_mistakes)
        for (const DiscId subject : subjects)
            if (concerns_one_disc(known.kind)) search(known, subject);
    return best;
}

bool follows_rule(const SharedState& state, std::int64_t micro_steps,
                  const std::vector<DiscState>& discs, double clock) {
    const std::vector<GivenDisc> made = run(state, micro_steps, Mistake::none, 0);
    const auto unit = static_cast<double>(state.setting.micro_steps);
    for (std::size_t id = 0; id < discs.size(); ++id)
        if (!agree(made[id], {discs[id].x_at(clock), discs[id].y_at(clock), discs[id].vx * unit,
                              discs[id].vy * unit, 0}))
            return false;
    return true;
}

std::string facts(const SharedState& state, DiscId id) {
    PlainRule rule(state.setting, state.discs, state.micro_steps_done);
    rule.run_micro_step();
    constexpr int most = 8;
    int n_found = 0;
    std::string text;
    for (const PlainRule::Candidate& candidate : rule.candidates()) {
        const bool is_wall = candidate.q == Collision::wall;
        if (candidate.p != id && (is_wall || candidate.q != id)) continue;
        if (++n_found > most) continue;
        const std::string partner = is_wall
                                        ? "a wall"
                                        : fmt::format("disc {}", candidate.p == id ? candidate.q
                                                                                   : candidate.p);
        text += fmt::format("  by the rule disc {} meets {} at {:.9g} of the step: {}\n", id,
                            partner, candidate.t,
                            candidate.is_kept ? "they collide" : "not kept, one has collided");
    }
    if (n_found > most) text += fmt::format("  and {} more, later\n", n_found - most);
    if (n_found == 0) text = fmt::format("  by the rule disc {} meets nothing in this step\n", id);
    return text;
}

bool is_rounded_to_float(const std::vector<StudentLine>& lines, const std::vector<DiscState>& discs,
                         double unit) {
    bool is_seen = false;
    for (const StudentLine& line : lines) {
        const DiscState& disc = discs[line.id];
        const double exact[] = {disc.x, disc.y, disc.vx * unit, disc.vy * unit};
        const double given[] = {line.x, line.y, line.vx, line.vy};
        for (std::size_t i = 0; i < 4; ++i) {
            if (line.digits[i] == 0) continue; // a whole number does not show its rounding
            const double slack = 0.501 * line.digits[i] + 1e-15 * std::fabs(exact[i]);
            const double rounded = static_cast<float>(exact[i]);
            if (!(std::fabs(given[i] - rounded) <= slack)) return false;
            is_seen = is_seen || std::fabs(given[i] - exact[i]) > slack;
        }
    }
    return is_seen;
}

bool can_explain(std::uint64_t n_discs, std::int64_t micro_steps) {
    constexpr double most_pairs = 2e10; // testing this many pairs takes a minute or two
    const auto n = static_cast<double>(n_discs);
    return n * n / 2 * static_cast<double>(micro_steps) *
               static_cast<double>(known_mistakes.size() + 3 * most_subjects) <
           most_pairs;
}

} // namespace carrom
