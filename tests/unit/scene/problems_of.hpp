// SPDX-License-Identifier: BSD-3-Clause
// The problems of an input, in a form that tests can compare.
#pragma once

#include <string>
#include <vector>

#include "catch.hpp"

#include "core/errors.hpp"
#include "scene/read_scene.hpp"

namespace carrom::test {

/// The problems of the InputError that `read` throws; none if it returns.
template <class Read> std::vector<Problem> problems_of(const Read& read) {
    try {
        read();
    } catch (const InputError& error) {
        return error.problems();
    }
    return {};
}

/// "place:line" of each, in order.
inline std::vector<std::string> places_of(const std::vector<Problem>& problems) {
    std::vector<std::string> places;
    for (const Problem& problem : problems)
        places.push_back(problem.place +
                         (problem.line > 0 ? ':' + std::to_string(problem.line) : ""));
    return places;
}

inline bool mentions(const std::vector<Problem>& problems, const std::string& text) {
    for (const Problem& problem : problems)
        if (problem.text.find(text) != std::string::npos) return true;
    return false;
}

/// A valid scene, to which tests add lines.
inline const std::string good_scene =
    "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = 10\n";

/// The texts of all problems of that scene with overrides, one on each line.
inline std::string problems_with(const std::vector<std::string>& overrides) {
    std::string text;
    for (const Problem& problem : problems_of([&] { read_scene(good_scene, "s.toml", overrides); }))
        text += problem.text + '\n';
    return text;
}

inline bool has(const std::string& text, const char* part) {
    UNSCOPED_INFO(text);
    return text.find(part) != std::string::npos;
}

} // namespace carrom::test
