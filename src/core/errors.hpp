// SPDX-License-Identifier: BSD-3-Clause
// The kinds of failure, told apart by who knows of them (docs/architecture.md): the input is wrong
// and every rank knows; a collective operation failed on some rank and all have agreed on it; an
// invariant is broken.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace carrom {

enum class ExitCode : int {
    success = 0,
    difference = 1,
    bad_input = 2,
    collective_failure = 3,
    output_failure = 4,
    broken_invariant = 70,
    stopped = 75
};

/// One thing wrong with an input: where, what, and how to mend it. `line` 0 means the place has no
/// line.
struct Problem {
    std::string place;
    std::int64_t line = 0;
    std::string text;

    friend bool operator==(const Problem&, const Problem&) = default;
};

/// "place:line: text", or "place: text" where there is no line. Control characters are escaped.
std::string to_string(const Problem& problem);

/// A wrong scene, disc list or option. Thrown on every rank with the same problems; rank 0 prints
/// them. Exit code 2.
class InputError : public std::runtime_error {
public:
    explicit InputError(std::vector<Problem> problems);
    const std::vector<Problem>& problems() const { return problems_; }

private:
    std::vector<Problem> problems_;
};

/// A collective operation that failed on some rank. Thrown on every rank, with the lowest failing
/// rank's text.
class CollectiveError : public std::runtime_error {
public:
    explicit CollectiveError(const std::string& text, ExitCode code = ExitCode::collective_failure)
        : std::runtime_error(text), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// Ends the program when an invariant is broken. Also in Release: a wrong number must never look
/// like a result. The handler prints and aborts; the parallel module installs one that aborts all
/// ranks.
[[noreturn]] void fail(std::string_view text, const char* file, int line);
using FailureHandler = void (*)(std::string_view text, const char* file, int line);
void set_failure_handler(FailureHandler handler);

inline void ensure(bool claim, std::string_view text, const char* file = __builtin_FILE(),
                   int line = __builtin_LINE()) {
    if (!claim) [[unlikely]]
        fail(text, file, line);
}

} // namespace carrom
