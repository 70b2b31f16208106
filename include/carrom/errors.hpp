// SPDX-License-Identifier: BSD-3-Clause
// The exceptions of the library, and the exit codes that belong to them.
//
// Every rank throws the same exception, so a program may catch it and continue. A broken invariant,
// an MPI error or a rank that runs out of memory throws nothing, but ends all ranks immediately.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace carrom {

/// Exit codes of the program `carrom`, and of `Session::run`.
enum class ExitCode : int {
    success = 0,
    difference = 1,         ///< a comparison found a difference
    bad_input = 2,          ///< a scene, a file to read or an argument is wrong
    collective_failure = 3, ///< a collective operation failed on at least one rank
    output_failure = 4,     ///< a file could not be written
    broken_invariant = 70,  ///< an error in the program itself
    stopped = 75            ///< stopped on request before the end
};

/// A problem with an input: the place (a file or key), the line in it (0 if there is none), and a
/// description with advice.
struct Problem {
    std::string place;
    std::int64_t line = 0;
    std::string text;

    friend bool operator==(const Problem&, const Problem&) = default;
};

/// "place:line: text", or "place: text" if there is no line. Control characters are escaped.
std::string to_string(const Problem& problem);

/// A wrong scene, disc list or argument. Every rank throws the same list of all problems; `what()`
/// has one line for each problem. Exit code 2.
class InputError : public std::runtime_error {
public:
    explicit InputError(std::vector<Problem> problems);
    const std::vector<Problem>& problems() const { return problems_; }

private:
    std::vector<Problem> problems_;
};

/// A collective operation failed on at least one rank. Every rank throws it with the text of the
/// lowest rank that failed. `code()` is 2 for a damaged file, 4 for a file that cannot be written,
/// else 3.
class CollectiveError : public std::runtime_error {
public:
    explicit CollectiveError(const std::string& text, ExitCode code = ExitCode::collective_failure)
        : std::runtime_error(text), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

} // namespace carrom
