// SPDX-License-Identifier: BSD-3-Clause
#include "grading/grader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace carrom {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
/// How much roundings change discs is measured in a few runs. In another correct program the
/// changes may be larger by this factor.
constexpr double spread_margin = 1000;
/// Like spread_margin, for a single step that starts from the student's numbers.
constexpr double step_margin = 20;
/// Number of runs from the student's numbers; all but the first vary the last digits.
constexpr std::uint64_t own_runs = 6;
/// In radii: if differences are this large, roundings may decide which discs collide.
constexpr double deciding = 0.1;
/// In radii: the largest tolerance for a number with few digits if other numbers of its step have
/// more, because the number may have lost trailing zeros. If all lines are coarser than this, the
/// next step cannot be computed from them.
constexpr double coarsest_digit = 0.01;
/// In radii: the largest tolerance for an output whose numbers all have few digits.
constexpr double coarsest_output = 0.5;
/// Relative to the box: more than the error of a step in single precision, which has 24 bits.
constexpr double float_unit = 0x1p-21;
/// Relative to the longer side of the box: grading ends if a disc is farther outside than this,
/// because its numbers may overflow.
constexpr double farthest = 1000;

} // namespace

Grader::Grader(const SceneParameters& scene, double tolerance, std::istream& stream,
               const std::string& name, bool counts_points)
    : scene_(scene), setting_{scene.box, scene.radius, scene.micro_steps, scene.sync_every},
      tolerance_(tolerance), unit_(static_cast<double>(scene.micro_steps)),
      steps_(stream, name,
             {scene.n_discs, scene.steps, scene.text_output == TextOutput::every_step}),
      digits_before_(scene.n_discs), is_counter_unknown_(scene.n_discs, false),
      counts_points_(counts_points) {
    if (scene.steps > 0) points_.are_counters_right = false; // not right until they are compared
}

void Grader::record_spread(std::int64_t step, const ExpectedDiscs& expected) {
    if (has_left_runs_) return;
    const double largest = *std::max_element(expected.spread.begin(), expected.spread.end());
    has_left_runs_ = spread_margin * largest > deciding * setting_.radius;
    first_left_ = step;
}

bool Grader::grade(std::int64_t step, const ExpectedDiscs& expected) {
    record_spread(step, expected);
    if (step == 0) before_ = SharedState{setting_, expected.discs, 0};
    const bool goes_on = steps_.is_next(step) ? grade_lines(step, expected) : record_missing(step);
    if (goes_on) return step < scene_.steps || record_more(step);
    for (std::int64_t later = step + 1; later <= scene_.steps; ++later) count_missing(later);
    return false;
}

void Grader::count_missing(std::int64_t step) {
    if (!steps_.is_due(step)) return;
    if (step == 0)
        points_.is_start_right = false;
    else
        points_.n_missing += 1;
}

/// Records a problem. Returns whether grading continues.
bool Grader::record_problem(const std::string& problem) {
    points_.are_lines_whole = false;
    if (verdict_.empty()) verdict_ = problem;
    return counts_points_;
}

/// Records a missing step. Returns whether grading continues.
bool Grader::record_missing(std::int64_t step) {
    const std::string problem = steps_.missing_problem(step);
    if (problem.empty()) return true;
    count_missing(step);
    return record_problem(problem) && steps_.next_line() && steps_.next_line()->step > step;
}

/// Handles lines after the last step. Returns whether these lines are graded as a further step.
bool Grader::record_more(std::int64_t step) {
    if (!steps_.next_line()) return false;
    return record_problem(steps_.more_problem()) && step == scene_.steps &&
           steps_.is_next(step + 1);
}

bool Grader::grade_lines(std::int64_t step, const ExpectedDiscs& expected) {
    steps_.read();
    const bool were_lines_whole = points_.are_lines_whole;
    if (!steps_.problem().empty() && !record_problem(steps_.problem())) return false;
    if (steps_.is_only_in_other_order()) {
        points_.are_in_order = false;
        points_.are_lines_whole = were_lines_whole;
    }
    if (!steps_.is_whole()) {
        count_missing(step);
        return true;
    }
    finest_ = unlimited;
    for (const StudentLine& line : lines()) finest_ = std::min(finest_, line.finest_digit);
    if (finest_ == unlimited) finest_ = 0; // whole numbers do not show how they were rounded
    finest_ = std::max(finest_, unit_of_float_);
    n_steps_ += 1;
    if (!can_grade(step)) {
        n_not_graded_ += 1;
        if (step >= scene_.steps) points_.are_counters_right.reset();
        const bool goes_on = are_possible(step);
        if (goes_on) go_on_from_lines(step, {});
        return goes_on;
    }
    const Aim aim = has_left_runs_ ? aim_from_own_lines() : aim_at(expected);
    const bool is_right = hold(aim, step);
    if (!is_right && !(counts_points_ && are_possible(step))) return false;
    if (!is_right) has_left_runs_ = true; // later steps no longer match Carrom's own run
    go_on_from_lines(step, aim.discs);
    return true;
}

/// Makes the student's lines the state from which the next step is graded. `counters` are the
/// rule's counters, or empty if they are unknown.
void Grader::go_on_from_lines(std::int64_t step, const std::vector<DiscState>& counters) {
    if (counters.empty()) is_counter_unknown_.assign(scene_.n_discs, true);
    own_before_ = own_state(counters, step);
    before_ = own_before_;
    if (!has_left_runs_) before_->discs = counters;
    for (const StudentLine& line : lines()) digits_before_[line.id] = last_digit(line);
    finest_before_ = finest_;
    written_before_ = step;
}

/// Whether this step can be graded. Once the student's lines replace Carrom's run, grading needs
/// the lines of the step before, with enough digits.
bool Grader::can_grade(std::int64_t step) const {
    if (!has_left_runs_) return true;
    return own_before_ && step - written_before_ == 1 &&
           finest_before_ <= coarsest_digit * setting_.radius;
}

/// Compares the lines of a step with the rule, and counts points.
bool Grader::hold(const Aim& aim, std::int64_t step) {
    const bool are_places_right = (step > 0 || hold_precision(aim)) && hold_to(aim, step) &&
                                  hold_excused(aim, step);
    const bool are_counters_right = hold_counters(aim, step);
    if (step == 0) points_.is_start_right = are_places_right;
    if (step > 0 && step <= scene_.steps) {
        points_.n_graded += 1;
        if (are_places_right) points_.n_right += 1;
    }
    return are_places_right && are_counters_right;
}

/// Returns false if step 0 is the input rounded to single precision and the tolerance is finer.
/// Then later steps are graded as if the student's numbers had as few digits as a float.
bool Grader::hold_precision(const Aim& aim) {
    const double unit = float_unit * setting_.box.longest();
    if (tolerance_ >= unit || !is_rounded_to_float(lines(), aim.discs, unit_)) return true;
    unit_of_float_ = unit;
    finest_ = std::max(finest_, unit);
    if (verdict_.empty())
        verdict_ = "step 0 is the input rounded to single precision\nrule: precision\n  what the "
                   "program may do: numbers are read or kept as float, which has 7 digits\n";
    return false;
}

/// Checks conditions that hold at any step and for any roundings: numbers are finite, and centres
/// lie in the box. If points are counted, it is enough that the rule can continue from the numbers.
bool Grader::are_possible(std::int64_t step) {
    const double longest = setting_.box.longest();
    // A disc may be beyond its wall until the end of the micro-step.
    const double slack = counts_points_ ? farthest * longest : setting_.radius;
    for (const StudentLine& line : lines()) {
        const bool is_inside = line.x >= -slack && line.x <= setting_.box.x + slack &&
                               line.y >= -slack && line.y <= setting_.box.y + slack;
        const double speed = std::max(std::fabs(line.vx), std::fabs(line.vy));
        const double fastest = counts_points_ ? slack : std::numeric_limits<double>::max();
        if (is_inside && speed <= fastest) continue; // this test is false for NaN, too
        if (!verdict_.empty()) return false;
        verdict_ = fmt::format("line {}: step {}, disc {} is outside the box or not finite\n"
                               "rule: lines\n  each number is finite, and each centre in the box\n",
                               line.number, step, line.id);
        return false;
    }
    return true;
}

double Grader::tolerance_of(const StudentLine& line) const {
    return tolerance_ + std::max(std::min(last_digit(line), coarsest_digit * setting_.radius),
                                 std::min(finest_, coarsest_output * setting_.radius));
}

Grader::Aim Grader::aim_at(const ExpectedDiscs& expected) const {
    Aim aim{expected.discs, expected.clock, {}, {}};
    for (const StudentLine& line : lines())
        aim.allowed.push_back(tolerance_of(line) + spread_margin * expected.spread[line.id]);
    return aim;
}

/// The student's lines as a state of a run, with the given counters or without counters.
SharedState Grader::own_state(const std::vector<DiscState>& counters, std::int64_t step) const {
    SharedState state{setting_, {}, step * setting_.micro_steps};
    const auto tau = static_cast<double>(state.micro_steps_done % setting_.sync_every);
    for (const StudentLine& line : lines()) {
        DiscState disc;
        if (!counters.empty()) disc = counters[line.id];
        disc.id = line.id;
        disc.x = line.x;
        disc.y = line.y;
        disc.vx = line.vx / unit_;
        disc.vy = line.vy / unit_;
        disc.tau = tau;
        state.discs.push_back(disc);
    }
    return state;
}

/// Changes numbers at random within the rounding of the student's last digits.
void Grader::move_last_digits(DiscState& disc, std::uint64_t seed) const {
    double* const numbers[] = {&disc.x, &disc.y, &disc.vx, &disc.vy};
    for (std::uint64_t i = 0; i < 4; ++i) {
        const double digits = 0.5 * digits_before_[disc.id] / (i < 2 ? 1 : unit_);
        *numbers[i] = nudged(*numbers[i], disc.id, 4 * seed + i) +
                      digits * drawn(disc.id, 4 * seed + i);
    }
}

/// Computes one step of the rule from the student's lines of the previous step, and further runs
/// from states within the rounding of these lines' last digits.
Grader::Aim Grader::aim_from_own_lines() const {
    Aim aim;
    std::vector<double> spread(scene_.n_discs, 0);
    for (std::uint64_t seed = 0; seed < own_runs; ++seed) {
        std::vector<DiscState> discs = own_before_->discs;
        if (seed > 0)
            for (DiscState& disc : discs) move_last_digits(disc, seed);
        PlainRule rule(setting_, discs, own_before_->micro_steps_done, Mistake::none);
        for (std::int64_t i = 0; i < setting_.micro_steps; ++i) rule.run_micro_step();
        aim.clock = rule.clock();
        aim.others.emplace_back(rule.discs().begin(), rule.discs().end());
        aim.discs = aim.others.front();
        for (const DiscState& disc : rule.discs())
            spread[disc.id] = std::max(
                spread[disc.id], difference(aim.discs[disc.id], aim.clock, disc, aim.clock, unit_));
    }
    for (const StudentLine& line : lines()) {
        const double grown = step_margin * spread[line.id];
        aim.allowed.push_back(grown > deciding * setting_.radius ? unlimited
                                                                 : tolerance_of(line) + grown);
    }
    return aim;
}

double Grader::difference_to(const std::vector<DiscState>& discs, double clock, DiscId id) const {
    const DiscState& disc = discs[id];
    const StudentLine& line = lines()[id];
    const double differences[] = {
        std::fabs(line.x - disc.x_at(clock)), std::fabs(line.y - disc.y_at(clock)),
        std::fabs(line.vx - disc.vx * unit_), std::fabs(line.vy - disc.vy * unit_)};
    double largest = 0;
    for (const double one : differences) {
        if (!(one <= std::numeric_limits<double>::max())) return unlimited; // true for NaN, too
        largest = std::max(largest, one);
    }
    return largest;
}

bool Grader::hold_to(const Aim& aim, std::int64_t step) {
    for (const StudentLine& line : lines()) {
        const double off = difference_to(aim.discs, aim.clock, line.id);
        const bool is_finite = std::isfinite(line.x + line.y + line.vx + line.vy);
        if (!is_finite || off > aim.allowed[line.id]) return blame(aim, line.id, step);
        if (has_left_runs_) continue;
        if (off > tolerance_of(line) && !first_drift_) first_drift_ = step;
        if (!first_drift_) largest_ = std::max(largest_, off);
    }
    return true;
}

/// Accepts any result that a rounding can produce if roundings decide which discs collide. The
/// order of collisions at equal times does not depend on roundings, so a wrong order is a mistake.
bool Grader::hold_excused(const Aim& aim, std::int64_t step) {
    for (const StudentLine& line : lines()) {
        if (aim.allowed[line.id] != unlimited) continue;
        for (const std::vector<DiscState>& discs : aim.others)
            if (discs[line.id].pair_collisions != aim.discs[line.id].pair_collisions ||
                discs[line.id].wall_collisions != aim.discs[line.id].wall_collisions)
                is_counter_unknown_[line.id] = true;
        const auto is_near = [&](const std::vector<DiscState>& discs) {
            return difference_to(discs, aim.clock, line.id) <= deciding * setting_.radius;
        };
        if (difference_to(aim.discs, aim.clock, line.id) <= tolerance_of(line)) continue;
        if (std::none_of(aim.others.begin(), aim.others.end(), is_near))
            return blame(aim, line.id, step);
        const auto found = explain(shared_state(), setting_.micro_steps, given(aim), line.id);
        if (found && found->is_of_equal_times) return blame(aim, line.id, step);
    }
    return true;
}

/// Compares the counters of collisions, even if the output's last step is too early or too late.
bool Grader::hold_counters(const Aim& aim, std::int64_t step) {
    if (!steps_.has_counters() || (step < scene_.steps && steps_.next_line())) return true;
    points_.are_counters_right = false;
    for (const StudentLine& line : lines()) {
        const DiscState& disc = aim.discs[line.id];
        if (is_counter_unknown_[line.id] || (line.pair_collisions == disc.pair_collisions &&
                                             line.wall_collisions == disc.wall_collisions))
            continue;
        if (!verdict_.empty()) return false;
        verdict_ = fmt::format(
            "line {}: step {}, disc {}: p_c w_c should be {} {}, is {} {}\nrule: counters\n"
            "  a pair counts once for each of its discs, a bounce in a corner once, a stop at a "
            "wall not at all\n",
            line.number, step, line.id, std::uint64_t{disc.pair_collisions},
            std::uint64_t{disc.wall_collisions}, line.pair_collisions, line.wall_collisions);
        return false;
    }
    points_.are_counters_right = true;
    return true;
}

std::vector<GivenDisc> Grader::given(const Aim& aim) const {
    std::vector<GivenDisc> discs;
    for (const StudentLine& line : lines()) {
        const double allowed = aim.allowed[line.id];
        discs.push_back({line.x, line.y, line.vx, line.vy,
                         allowed == unlimited ? tolerance_of(line) : allowed});
    }
    return discs;
}

/// Records this line as the verdict if no earlier line has differed. Returns false.
bool Grader::blame(const Aim& aim, DiscId id, std::int64_t step) {
    if (!verdict_.empty()) return false;
    const StudentLine& line = lines()[id];
    const DiscState& disc = aim.discs[id];
    verdict_ = fmt::format("line {}: step {}, disc {} differs\n", line.number, step, id);
    const auto append = [this](const char* label, double x, double y, double vx, double vy) {
        verdict_ += fmt::format("  {:<9} {:.9g} {:.9g} {:.9g} {:.9g}\n", label, x + 0.0, y + 0.0,
                                vx + 0.0, vy + 0.0);
    };
    append("should be", disc.x_at(aim.clock), disc.y_at(aim.clock), disc.vx * unit_,
           disc.vy * unit_);
    append("is", line.x, line.y, line.vx, line.vy);
    verdict_ += reason(aim, id, step);
    return false;
}

std::string Grader::reason(const Aim& aim, DiscId id, std::int64_t step) const {
    if (step == 0) return "rule: lines\n  step 0 is the input as it is\n";
    const std::int64_t micro_steps = (step - written_before_) * setting_.micro_steps;
    if (!can_explain(scene_.n_discs, micro_steps))
        return "rule: not searched for, which would take too long; write every step (`print`), or "
               "fewer "
               "discs\n";
    if (!has_left_runs_)
        ensure(follows_rule(*before_, micro_steps, aim.discs, aim.clock),
               "the plain rule of `carrom compare` is not that of the run");
    const SharedState& state = shared_state();
    const std::optional<Explanation> found = explain(state, micro_steps, given(aim), id);
    std::string text = found ? fmt::format("rule: {}\n  what the program may do: {}\n", found->rule,
                                           found->mistake)
                             : "rule: none of the known mistakes gives this line\n";
    if (found && found->n_unexplained > 0)
        text += fmt::format("  {} more lines of the step differ otherwise\n", found->n_unexplained);
    if (micro_steps == 1) text += facts(state, id);
    return text;
}

std::string Grader::verdict() const {
    if (!verdict_.empty()) return verdict_ + steps_.remark();
    std::string text = fmt::format("{}: {} discs in {} written steps; numbers within {:.3g}, the "
                                   "largest difference {:.3g}\n",
                                   n_not_graded_ > 0 ? "not graded to the end" : "same",
                                   scene_.n_discs, n_steps_, tolerance_, largest_);
    if (first_drift_)
        text += fmt::format("from step {} on differences are only amplified roundings\n",
                            *first_drift_);
    if (!has_left_runs_) return text + steps_.remark();
    text += fmt::format("from step {} on roundings decide: runs that begin one bit apart differ\n",
                        first_left_);
    if (n_not_graded_ > 0)
        text +=
            "  later steps were not graded; write every step (`print`) with more digits to have "
            "them graded\n";
    else
        text += "  from there on each step was held to the rule from the output's step before\n";
    return text + steps_.remark();
}

} // namespace carrom
