// SPDX-License-Identifier: BSD-3-Clause
// A subcommand as a table of its options and its action.
//
// command_line.cpp turns tables into a parser. A new subcommand is a function that returns a table,
// and a line in command_line.cpp.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// The action that a command line requests.
struct Action {
    std::function<ExitCode(const Communicator&)> act; ///< every rank calls it. **Collective.**
    /// Whether a single process without a launcher starts MPI
    bool needs_mpi = false;
    bool stops_on_request = false; ///< signals are recorded from the start of the process on
};

/// An action that throws these problems.
Action failing(std::vector<Problem> problems);

/// Takes the word after an option, or records that it is wrong.
using TakeWord = std::function<void(const char* option, const std::string& word,
                                    std::vector<Problem>& problems)>;

/// The word after an option (all of them, if it may be repeated) is stored in `value` unchanged, or
/// taken as a number (number_words.hpp). A switch sets its value.
struct Option {
    const char* name;      ///< such as "--threads"; a name without dashes is a positional argument
    const char* type_name; ///< type of the word that follows, such as "FILE"; empty for a switch
    const char* help;
    std::variant<std::string*, std::vector<std::string>*, bool*, TakeWord> value;
    bool is_required = false;
    const char* group = "Options"; ///< the heading under which the help lists it
};

struct Subcommand {
    const char* name;
    const char* help; ///< one line of help
    const char* footer;
    std::vector<Option> options; ///< their values must live as long as `action`
    /// Called when all values are known; `problems` are those of the command line so far. Adds
    /// its own problems, or leaves them to the action, which may find more.
    std::function<Action(std::vector<Problem>& problems)> action;
    const char* word_too_many = "is one word too many";
};

} // namespace carrom
