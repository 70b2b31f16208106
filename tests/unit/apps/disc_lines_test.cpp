// SPDX-License-Identifier: BSD-3-Clause
// Lines of discs compared with the output of C's printf, which the course program uses.
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "catch.hpp"

#include "apps/run_command/disc_lines.hpp"

namespace carrom {

namespace {

std::string line_text(std::int64_t step, const DiscLine& line, int digits, bool with_counters) {
    fmt::memory_buffer text;
    append_line(text, step, line, digits, with_counters);
    return {text.data(), text.size()};
}

template <class... Values> std::string printed(const char* format, Values... values) {
    std::array<char, 2000> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

} // namespace

TEST_CASE("a line is what printf prints, with and without counters") {
    const DiscLine line{7, 0.1, 1e-5, -1.0 / 3, 1e17, 12, 34};
    CHECK(line_text(3, line, 17, false) ==
          "3 7 0.10000000000000001 1.0000000000000001e-05 -0.33333333333333331 1e+17\n");
    CHECK(line_text(3, line, 17, true) ==
          "3 7 0.10000000000000001 1.0000000000000001e-05 -0.33333333333333331 1e+17 12 34\n");
    CHECK(line_text(0, {0, 2, 5, 1, 0, 0, 0}, 17, false) == "0 0 2 5 1 0\n");
}

TEST_CASE("numbers of every size are printed as printf prints them") {
    std::mt19937_64 random(1);
    for (int k = 0; k < 20000; ++k) {
        const double value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        const DiscLine line{1, value, -value, value / 3, 0, 0, 0};
        CHECK(line_text(2, line, 17, false) ==
              printed("2 1 %.17g %.17g %.17g %.17g\n", line.x, line.y, line.vx, line.vy));
        for (const int digits : {1, 8, 16})
            CHECK(line_text(2, line, digits, false) == printed("2 1 %.*f %.*f %.*f %.*f\n", digits,
                                                               line.x, digits, line.y, digits,
                                                               line.vx, digits, line.vy));
    }
}

TEST_CASE("the course program's look is eight decimals") {
    const DiscLine line{41, 123.456789012, 0.5, -2, 1e-9, 0, 0};
    CHECK(line_text(12, line, 8, false) == printed("%d %d %10.8lf %10.8lf %10.8lf %10.8lf\n", 12,
                                                   41, line.x, line.y, line.vx, line.vy));
}

} // namespace carrom
