// SPDX-License-Identifier: BSD-3-Clause
#include "grading/steps.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace carrom {

namespace {

std::string of_lines(const std::string& problem, const char* rule) {
    return fmt::format("{}\nrule: lines\n  {}\n", problem, rule);
}

} // namespace

StudentSteps::StudentSteps(std::istream& stream, std::string name, const WantedSteps& wanted)
    : wanted_(wanted), output_(stream, std::move(name)), lines_(wanted.n_discs),
      is_there_(wanted.n_discs, false) {
    go_on();
}

void StudentSteps::go_on() {
    next_.emplace();
    if (!output_.next(*next_)) next_.reset();
}

void StudentSteps::add_problem(const std::string& text) {
    if (problem_.empty())
        problem_ = of_lines(text, "each step that is written has all discs by id; the last one has "
                                  "p_c and w_c too");
}

void StudentSteps::read() {
    const std::int64_t step = next_->step;
    is_whole_ = is_in_order_ = true;
    n_counters_ = 0;
    problem_.clear();
    std::fill(is_there_.begin(), is_there_.end(), false);
    std::uint64_t n_read = 0;
    for (; is_next(step); go_on()) take(n_read++);
    const auto missing = std::find(is_there_.begin(), is_there_.end(), false);
    if (missing == is_there_.end()) {
        const std::string counters = counters_problem();
        are_counters_in_place_ = counters.empty();
        if (!counters.empty()) add_problem(counters);
        return;
    }
    is_whole_ = false;
    const std::string where = next_ ? fmt::format("line {}", next_->number) : "end of the output";
    add_problem(
        fmt::format("{}: step {}, disc {} is missing", where, step, missing - is_there_.begin()));
}

/// Stores the next line, after `n_before` lines of the same step.
void StudentSteps::take(std::uint64_t n_before) {
    const StudentLine& line = *next_;
    if (line.id >= lines_.size()) {
        is_whole_ = false;
        return add_problem(fmt::format("line {}: step {} has a disc {}, but ids end with {}",
                                       line.number, line.step, line.id, lines_.size() - 1));
    }
    if (is_there_[line.id]) {
        is_whole_ = false;
        return add_problem(
            fmt::format("line {}: step {} has disc {} twice", line.number, line.step, line.id));
    }
    if (line.id != n_before) {
        is_in_order_ = false;
        add_problem(fmt::format("line {}: should be of step {}, disc {}, is of disc {}",
                                line.number, line.step, n_before, line.id));
    }
    is_there_[line.id] = true;
    n_counters_ += line.has_counters ? 1 : 0;
    lines_[line.id] = line;
}

std::string StudentSteps::counters_problem() const {
    const std::int64_t step = lines_.front().step;
    const bool is_end = !next_, is_late = step >= wanted_.last;
    const bool may_have = step > 0 && (is_end || is_late),
               must_have = may_have && is_end && is_late;
    for (const StudentLine& line : lines_) {
        if (line.has_counters ? may_have && has_counters() : !must_have && n_counters_ == 0)
            continue;
        return fmt::format("line {}: step {}, disc {}: should {}", line.number, step, line.id,
                           may_have ? "end in p_c and w_c"
                                    : "have no p_c and w_c; the last step has them");
    }
    return {};
}

std::string StudentSteps::missing_problem(std::int64_t step) const {
    if (next_ && next_->step < step)
        return of_lines(
            fmt::format("line {}: step {} follows step {}", next_->number, next_->step, step - 1),
            "each step is written once, one after the other");
    if (!is_due(step)) return {};
    const char* rule = "no step is left out";
    if (next_)
        return of_lines(fmt::format("line {}: step {} is missing before it", next_->number, step),
                        rule);
    if (wanted_.are_all && step > 0)
        return of_lines(
            fmt::format("end of the output: {} steps, should be {}", step - 1, wanted_.last), rule);
    return of_lines(fmt::format("end of the output: step {} is missing", step), rule);
}

std::string StudentSteps::more_problem() const {
    return of_lines(fmt::format("line {}: step {} follows, should be {} steps", next_->number,
                                next_->step, wanted_.last),
                    "the output ends with the last step");
}

} // namespace carrom
