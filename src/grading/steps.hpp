// SPDX-License-Identifier: BSD-3-Clause
// Reads a student's output step by step. The lines of a step may come in any order of ids, because
// a program that prints them so can be right all the same.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "core/disc_state.hpp"
#include "grading/lines.hpp"

namespace carrom {

/// What the task asks for.
struct WantedSteps {
    std::uint64_t n_discs = 0;
    std::int64_t last = 0;
    bool are_all = false; ///< otherwise the last one alone has to be there
};

class StudentSteps {
public:
    /// The stream must outlive this.
    StudentSteps(std::istream& stream, std::string name, const WantedSteps& wanted);

    bool is_due(std::int64_t step) const {
        return step == wanted_.last || (wanted_.are_all && step < wanted_.last);
    }

    /// The first line that is not read yet; nothing at the end of the output.
    const std::optional<StudentLine>& next_line() const { return next_; }
    bool is_next(std::int64_t step) const { return next_ && next_->step == step; }

    /// Reads all lines of the next step, which must exist. The functions below are about it.
    void read();

    /// By id; all are of this step if it is whole.
    const std::vector<StudentLine>& lines() const { return lines_; }
    bool is_whole() const { return is_whole_; } ///< each disc has exactly one line
    bool has_counters() const { return n_counters_ == lines_.size(); }
    /// What is wrong with the form of the lines, or empty. The last step that is there may have
    /// counters, even if it should not be the last.
    const std::string& problem() const { return problem_; }
    /// Whether each disc has a line, and the order of lines is what `problem` is about.
    bool is_only_in_other_order() const { return is_whole_ && !is_in_order_; }

    /// Why it is wrong that the next line is not of `step`, or empty.
    std::string missing_problem(std::int64_t step) const;
    /// Why it is wrong that the next line exists.
    std::string more_problem() const;

    /// See StudentOutput.
    std::string remark() const { return output_.remark(); }

private:
    void go_on();
    void take(std::uint64_t n_before);
    void add_problem(const std::string& text);
    std::string counters_problem() const;

    WantedSteps wanted_;
    StudentOutput output_;
    std::optional<StudentLine> next_;
    std::vector<StudentLine> lines_;
    std::vector<bool> is_there_; ///< by id
    bool is_whole_ = false, is_in_order_ = true;
    std::uint64_t n_counters_ = 0;
    std::string problem_;
};

} // namespace carrom
