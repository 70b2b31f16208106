// SPDX-License-Identifier: BSD-3-Clause
// What the library throws, and the exit codes that go with it.
//
// Every rank throws the same exception, so a program may catch it and go on. A broken invariant,
// an MPI error and a rank without memory are not thrown: they end all ranks at once.
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
    collective_failure = 3, ///< an operation of all ranks failed on at least one of them
    output_failure = 4,     ///< a file could not be written
    broken_invariant = 70,  ///< the program itself is wrong
    stopped = 75            ///< stopped on request before the end
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

/// A wrong scene, disc list or argument. Thrown on every rank with the same problems, all that
/// there are. `what()` has one line for each. Exit code 2.
class InputError : public std::runtime_error {
public:
    explicit InputError(std::vector<Problem> problems);
    const std::vector<Problem>& problems() const { return problems_; }

private:
    std::vector<Problem> problems_;
};

/// A collective operation that failed on some rank. Thrown on every rank, with the lowest failing
/// rank's text. `code()` is 2 for a damaged file, 4 for a file that could not be written, else 3.
class CollectiveError : public std::runtime_error {
public:
    explicit CollectiveError(const std::string& text, ExitCode code = ExitCode::collective_failure)
        : std::runtime_error(text), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

} // namespace carrom
