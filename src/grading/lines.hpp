// SPDX-License-Identifier: BSD-3-Clause
// Reads the lines of discs in the output of a student's program one by one.
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
    std::int64_t number = 0; ///< number of the line, from 1
    std::int64_t step = 0;
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;
    double last_digit = 0;   ///< the value of one unit of it, in the number with the fewest digits
    double finest_digit = 0; ///< in the number with the most; infinite if all are whole numbers
    bool has_counters = false;
    std::uint64_t pair_collisions = 0, wall_collisions = 0;
};

class StudentOutput {
public:
    /// The stream must outlive this.
    StudentOutput(std::istream& stream, std::string name);

    /// The next line that is not blank; false at the end. InputError if it is no line of a disc.
    bool next(StudentLine& line);

    std::int64_t line_number() const { return lines_.line_number(); }

private:
    [[noreturn]] void refuse(const std::string& text) const;
    double number(std::string_view word) const;
    std::uint64_t count(std::string_view word) const;

    LineReader lines_;
    std::string name_;
    std::vector<std::string_view> words_;
};

} // namespace carrom
