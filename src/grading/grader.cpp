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
/// A right program may round so many times worse than the runs by which growth is measured.
constexpr double growth_margin = 1000;
/// This factor for a single step from known numbers.
constexpr double step_margin = 20;
constexpr std::uint64_t own_runs = 6; ///< from the output's numbers, the others from near by
/// In radii: roundings may decide which discs collide if differences are this large.
constexpr double deciding = 0.1;
/// In radii: a number with few digits in a line of others with more excuses no larger difference,
/// because zeros at its end may be left out. A step does not follow from lines that all are
/// coarser.
constexpr double coarsest_digit = 0.01;
/// In radii: an output whose numbers all have few digits excuses no larger difference.
constexpr double coarsest_output = 0.5;

} // namespace

Grader::Grader(const SceneParameters& scene, double tolerance, std::istream& stream,
               const std::string& name, bool counts_points)
    : scene_(scene), setting_{scene.box, scene.radius, scene.micro_steps, scene.sync_every},
      tolerance_(tolerance), unit_(static_cast<double>(scene.micro_steps)), output_(stream, name),
      lines_(scene.n_discs), digits_before_(scene.n_discs),
      is_counter_unknown_(scene.n_discs, false), counts_points_(counts_points) {}

void Grader::note_growth(std::int64_t step, const ExpectedDiscs& expected) {
    if (has_left_runs_) return;
    const double largest = *std::max_element(expected.spread.begin(), expected.spread.end());
    has_left_runs_ = growth_margin * largest > deciding * setting_.radius;
    first_left_ = step;
}

bool Grader::grade(std::int64_t step, const ExpectedDiscs& expected) {
    if (!read(step)) return false;
    n_steps_ += 1;
    if (!can_grade(step)) {
        n_not_graded_ += 1;
        return are_possible(step);
    }
    const Aim aim = has_left_runs_ ? aim_from_own_lines() : aim_at(expected);
    const bool is_as_it_should_be = hold(aim, step);
    if (!is_as_it_should_be && !(counts_points_ && are_possible(step))) return false;
    own_before_ = own_state(aim, step);
    before_ = own_before_;
    if (!is_as_it_should_be) has_left_runs_ = true; // the program's run is elsewhere by now
    if (!has_left_runs_) before_->discs = aim.discs;
    for (const StudentLine& line : lines_) digits_before_[line.id] = line.last_digit;
    finest_before_ = finest_;
    written_before_ = step;
    return true;
}

/// A step follows from the student's lines only if they are of the step before, and fine enough.
bool Grader::can_grade(std::int64_t step) const {
    if (!has_left_runs_) return true;
    return step - written_before_ <= 1 && finest_before_ <= coarsest_digit * setting_.radius;
}

/// Compares the lines of a step with the rule, and counts points.
bool Grader::hold(const Aim& aim, std::int64_t step) {
    const bool are_places_right = hold_to(aim, step) && hold_excused(aim, step);
    const bool are_counters_right = hold_counters(aim, step);
    if (is_last(step)) points_.are_counters_right = are_counters_right;
    if (step == 0) points_.is_start_right = are_places_right;
    if (step > 0) points_.n_graded += 1;
    if (step > 0 && are_places_right) points_.n_right += 1;
    return are_places_right && are_counters_right;
}

void Grader::grade_end() {
    StudentLine line;
    if (!output_.next(line)) return;
    points_.are_lines_whole = false;
    if (verdict_.empty())
        verdict_ = fmt::format("line {}: the output should end before this line\nrule: lines\n",
                               line.number);
}

/// Reads the lines of a step; false if they are not those of all discs by id.
bool Grader::read(std::int64_t step) {
    finest_ = unlimited;
    for (DiscId id = 0; id < scene_.n_discs; ++id) {
        StudentLine& line = lines_[id];
        const std::string wrong = output_.next(line)
                                      ? misplaced(line, step, id)
                                      : fmt::format(
                                            "end of the output: step {}, disc {} is missing", step,
                                            id);
        finest_ = std::min(finest_, line.finest_digit);
        if (wrong.empty()) continue;
        points_.are_lines_whole = false;
        if (!verdict_.empty()) return false;
        verdict_ = wrong + "\nrule: lines\n  each step that is written has all discs by id; the "
                           "last one has p_c and w_c too\n";
        return false;
    }
    if (finest_ == unlimited) finest_ = 0; // whole numbers do not show how they were rounded
    return true;
}

/// Checks what holds at any step, whatever roundings decide: finite numbers, centres in the box.
bool Grader::are_possible(std::int64_t step) {
    const double slack = setting_.radius; // a disc may be beyond its wall to the micro-step's end
    for (const StudentLine& line : lines_) {
        const bool is_inside = line.x >= -slack && line.x <= setting_.box.x + slack &&
                               line.y >= -slack && line.y <= setting_.box.y + slack;
        if (is_inside && std::isfinite(line.vx) && std::isfinite(line.vy)) continue;
        if (!verdict_.empty()) return false;
        verdict_ = fmt::format("line {}: step {}, disc {} is outside the box or not finite\n"
                               "rule: lines\n  each number is finite, and each centre in the box\n",
                               line.number, step, line.id);
        return false;
    }
    return true;
}

std::string Grader::misplaced(const StudentLine& line, std::int64_t step, DiscId id) const {
    if (line.step != step || line.id != id)
        return fmt::format("line {}: should be of step {}, disc {}, is of step {}, disc {}",
                           line.number, step, id, line.step, line.id);
    const bool needs_counters = is_last(step) && step > 0;
    if (line.has_counters != needs_counters)
        return fmt::format("line {}: step {}, disc {}: should {}", line.number, step, id,
                           needs_counters ? "end in p_c and w_c"
                                          : "have no p_c and w_c; the last step has them");
    return {};
}

double Grader::tolerance_of(const StudentLine& line) const {
    return tolerance_ + std::max(std::min(line.last_digit, coarsest_digit * setting_.radius),
                                 std::min(finest_, coarsest_output * setting_.radius));
}

Grader::Aim Grader::aim_at(const ExpectedDiscs& expected) const {
    Aim aim{expected.discs, expected.clock, {}, {}};
    for (const StudentLine& line : lines_)
        aim.allowed.push_back(tolerance_of(line) + growth_margin * expected.spread[line.id]);
    return aim;
}

/// The student's numbers as a state of the run, with the counters of `aim`.
SharedState Grader::own_state(const Aim& aim, std::int64_t step) const {
    SharedState state{setting_, {}, step * setting_.micro_steps};
    const auto tau = static_cast<double>(state.micro_steps_done % setting_.sync_every);
    for (const StudentLine& line : lines_) {
        DiscState disc = aim.discs[line.id];
        disc.x = line.x;
        disc.y = line.y;
        disc.vx = line.vx / unit_;
        disc.vy = line.vy / unit_;
        disc.tau = tau;
        state.discs.push_back(disc);
    }
    return state;
}

/// Changes numbers to others that the student's program writes in the same way.
void Grader::move_last_digits(DiscState& disc, std::uint64_t seed) const {
    double* const numbers[] = {&disc.x, &disc.y, &disc.vx, &disc.vy};
    for (std::uint64_t i = 0; i < 4; ++i) {
        const double digits = 0.5 * digits_before_[disc.id] / (i < 2 ? 1 : unit_);
        *numbers[i] = nudged(*numbers[i], disc.id, 4 * seed + i) +
                      digits * drawn(disc.id, 4 * seed + i);
    }
}

/// One step of the rule from the student's own step before. The other runs begin as
/// far away as the student's last digits allow.
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
    for (const StudentLine& line : lines_) {
        const double grown = step_margin * spread[line.id];
        aim.allowed.push_back(grown > deciding * setting_.radius ? unlimited
                                                                 : tolerance_of(line) + grown);
    }
    return aim;
}

double Grader::difference_to(const std::vector<DiscState>& discs, double clock, DiscId id) const {
    const DiscState& disc = discs[id];
    const StudentLine& line = lines_[id];
    const double differences[] = {
        std::fabs(line.x - disc.x_at(clock)), std::fabs(line.y - disc.y_at(clock)),
        std::fabs(line.vx - disc.vx * unit_), std::fabs(line.vy - disc.vy * unit_)};
    double largest = 0;
    for (const double one : differences) {
        if (!(one <= std::numeric_limits<double>::max())) return unlimited; // also for NaN
        largest = std::max(largest, one);
    }
    return largest;
}

bool Grader::hold_to(const Aim& aim, std::int64_t step) {
    for (const StudentLine& line : lines_) {
        const double off = difference_to(aim.discs, aim.clock, line.id);
        const bool is_finite = std::isfinite(line.x + line.y + line.vx + line.vy);
        if (!is_finite || off > aim.allowed[line.id]) return blame(aim, line.id, step);
        if (has_left_runs_) continue;
        if (off > tolerance_of(line) && !first_drift_) first_drift_ = step;
        if (!first_drift_) largest_ = std::max(largest_, off);
    }
    return true;
}

/// If roundings decide, a disc may be at any place to which a rounding leads. Equal times
/// are not roundings: if a wrong choice between them gives the line, that is the mistake.
bool Grader::hold_excused(const Aim& aim, std::int64_t step) {
    for (const StudentLine& line : lines_) {
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

bool Grader::hold_counters(const Aim& aim, std::int64_t step) {
    if (!is_last(step) || step == 0) return true;
    for (const StudentLine& line : lines_) {
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
    return true;
}

std::vector<GivenDisc> Grader::given(const Aim& aim) const {
    std::vector<GivenDisc> discs;
    for (const StudentLine& line : lines_) {
        const double allowed = aim.allowed[line.id];
        discs.push_back({line.x, line.y, line.vx, line.vy,
                         allowed == unlimited ? tolerance_of(line) : allowed});
    }
    return discs;
}

/// Notes the disc's line if it is the first that differs; returns false.
bool Grader::blame(const Aim& aim, DiscId id, std::int64_t step) {
    if (!verdict_.empty()) return false;
    const StudentLine& line = lines_[id];
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
    if (!verdict_.empty()) return verdict_;
    std::string text = fmt::format("{}: {} discs in {} written steps; numbers within {:.3g}, the "
                                   "largest difference {:.3g}\n",
                                   n_not_graded_ > 0 ? "not graded to the end" : "same",
                                   scene_.n_discs, n_steps_, tolerance_, largest_);
    if (first_drift_)
        text += fmt::format("from step {} on differences are only amplified roundings\n",
                            *first_drift_);
    if (!has_left_runs_) return text;
    text += fmt::format("from step {} on roundings decide: runs that begin one bit apart differ\n",
                        first_left_);
    if (n_not_graded_ > 0)
        text +=
            "  later steps were not graded; write every step (`print`) with more digits to have "
            "them graded\n";
    else
        text += "  from there on each step was held to the rule from the output's step before\n";
    return text;
}

} // namespace carrom
