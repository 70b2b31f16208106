// SPDX-License-Identifier: BSD-3-Clause
// What a reader has against an input, in a form that a test can write down.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"

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

} // namespace carrom::test
