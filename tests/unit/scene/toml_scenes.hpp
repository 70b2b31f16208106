// SPDX-License-Identifier: BSD-3-Clause
// A valid scene, and the problems of invalid ones.
#pragma once

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/read_scene.hpp"

namespace carrom::test {

using Texts = std::vector<std::string>;

inline const std::string good = "[box]\nsize = 100\n"               // lines 1-2
                                "[discs]\ncount = 50\nradius = 1\n" // 3-5
                                "[time]\nsteps = 10\n";             // 6-7

inline std::vector<Problem> problems_in(const std::string& text, const Texts& overrides = {}) {
    return problems_of([&] { read_scene(text, "s.toml", overrides); });
}

/// The valid scene with line `number` replaced.
inline std::string with_line(int number, const std::string& line) {
    std::string text;
    std::size_t begin = 0;
    for (int i = 1; begin < good.size(); ++i) {
        const std::size_t end = good.find('\n', begin);
        text += (i == number ? line : good.substr(begin, end - begin)) + '\n';
        begin = end + 1;
    }
    return text;
}

} // namespace carrom::test
