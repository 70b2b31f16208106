// SPDX-License-Identifier: BSD-3-Clause
#include "core/errors.hpp"

#include <cstdio>
#include <cstdlib>

#include "core/printable.hpp"

namespace carrom {

namespace {

std::string list_of(const std::vector<Problem>& problems) {
    std::string text;
    for (const Problem& problem : problems) {
        if (!text.empty()) text += '\n';
        text += to_string(problem);
    }
    return text;
}

void print_and_abort(std::string_view text, const char* file, int line) {
    std::fprintf(stderr, "carrom: internal error: %.*s (%s:%d)\n", static_cast<int>(text.size()),
                 text.data(), file, line);
    std::abort();
}

FailureHandler failure_handler = print_and_abort;

} // namespace

std::string to_string(const Problem& problem) {
    std::string place = problem.place;
    if (problem.line > 0) place += ':' + std::to_string(problem.line);
    return printable(place.empty() ? problem.text : place + ": " + problem.text);
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(list_of(problems)), problems_(std::move(problems)) {}

void set_failure_handler(FailureHandler handler) { failure_handler = handler; }

void fail(std::string_view text, const char* file, int line) {
    failure_handler(text, file, line);
    std::abort();
}

} // namespace carrom
