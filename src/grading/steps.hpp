// SPDX-License-Identifier: BSD-3-Clause
// Reads a student's output step by step. If the lines of a step are not in order of id, that is a
// problem, but the step can still be graded for points.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "core/disc_state.hpp"
#include "grading/lines.hpp"

namespace carrom {

/// The steps that the task requires.
struct WantedSteps {
    std::uint64_t n_discs = 0;
    std::int64_t last = 0;
    bool are_all = false; ///< whether all steps are required, or only the last
};

class StudentSteps {
public:
    /// `stream` must outlive this object.
    StudentSteps(std::istream& stream, std::string name, const WantedSteps& wanted);

    bool is_due(std::int64_t step) const {
        return step == wanted_.last || (wanted_.are_all && step < wanted_.last);
    }

    /// The next line, which is not yet part of a step; nothing at the end of the output.
    const std::optional<StudentLine>& next_line() const { return next_; }
    bool is_next(std::int64_t step) const { return next_ && next_->step == step; }

    /// Reads all lines of the next step, which must exist. The functions below describe this step.
    void read();

    /// The lines in order of id. Unless the step is whole, some lines may be of earlier steps.
    const std::vector<StudentLine>& lines() const { return lines_; }
    bool is_whole() const { return is_whole_; } ///< each disc has exactly one line
    bool has_counters() const { return n_counters_ == lines_.size(); }
    /// Describes what is wrong with the form of the lines, or is empty. The output's last step may
    /// have counters, even if it comes too early.
    const std::string& problem() const { return problem_; }
    /// Whether the order of the lines is all that is wrong with their form.
    bool is_only_in_other_order() const {
        return is_whole_ && are_counters_in_place_ && !is_in_order_;
    }

    /// The message that a required `step` is missing, or that steps decrease; otherwise empty.
    std::string missing_problem(std::int64_t step) const;
    /// The message that the output has a line after the last step.
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
    std::vector<bool> is_there_; ///< by id: whether the step has a line of the disc
    bool is_whole_ = false, is_in_order_ = true, are_counters_in_place_ = true;
    std::uint64_t n_counters_ = 0;
    std::string problem_;
};

} // namespace carrom
