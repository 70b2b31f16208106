// SPDX-License-Identifier: BSD-3-Clause
// Reads from the output of a student's program the lines that list discs. Other lines, such as a
// header or a time, contain no disc; they are skipped and listed in a remark.
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "core/disc_state.hpp"
#include "scene/line_reader.hpp"

namespace carrom {

struct StudentLine {
    std::int64_t number = 0; ///< line number, from 1
    std::int64_t step = 0;
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;
    double digits[4] = {}; ///< the unit of the last digit of x, y, vx, vy; 0 for a whole number
    double last_digit = 0; ///< unit of the last digit of the number with the fewest digits
    /// Unit of the last digit of the number with most digits; infinite if all are whole numbers
    double finest_digit = 0;
    bool has_counters = false;
    std::uint64_t pair_collisions = 0, wall_collisions = 0;
};

class StudentOutput {
public:
    /// `stream` must outlive this object.
    StudentOutput(std::istream& stream, std::string name);

    /// Reads the next line of a disc; returns false at the end. Throws InputError if a word is not
    /// a number, or if the output has lines but no line of a disc.
    bool next(StudentLine& line);

    /// Describes the lines that were left out; empty if there are none.
    std::string remark() const;

private:
    [[noreturn]] void refuse(const std::string& text) const;
    double number(std::string_view word) const;
    std::uint64_t count(std::string_view word) const;
    bool next_words();
    bool is_disc() const;
    void leave_out(std::string_view text);

    LineReader lines_;
    std::string name_;
    std::vector<std::string_view> words_;
    bool has_discs_ = false;
    std::int64_t n_left_out_ = 0, first_left_out_ = 0;
    std::string left_out_; ///< the first line that was left out
};

} // namespace carrom
