// SPDX-License-Identifier: BSD-3-Clause
// A subcommand as a table of its options and what they lead to.
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

/// What a command line asks for.
struct Action {
    std::function<ExitCode(const Communicator&)> act; ///< every rank calls it. **Collective.**
    bool needs_mpi = false;        ///< without a launcher too; else a lone process starts no MPI
    bool stops_on_request = false; ///< signals are noted, from the start of the process on
};

/// An action that throws these problems.
Action failing(std::vector<Problem> problems);

/// Takes the word behind an option, or notes what is wrong with it.
using TakeWord = std::function<void(const char* option, const std::string& word,
                                    std::vector<Problem>& problems)>;

/// The word behind an option (all of them, where it may be repeated) goes to `value` as it stands,
/// or is taken as a number (number_words.hpp); a switch sets it.
struct Option {
    const char* name;      ///< "--threads"; without dashes it is known by its place
    const char* type_name; ///< of the word that follows, as in "FILE"; empty for a switch
    const char* help;
    std::variant<std::string*, std::vector<std::string>*, bool*, TakeWord> value;
    bool is_required = false;
    const char* group = "Options"; ///< of the help
};

struct Subcommand {
    const char* name;
    const char* help; ///< one line
    const char* footer;
    std::vector<Option> options; ///< their values must live as long as `action`
    /// Called once all values are there, with the problems of the words so far: adds its own, or
    /// leaves them to the action, which may find more.
    std::function<Action(std::vector<Problem>& problems)> action;
    const char* word_too_many = "is one word too many";
};

} // namespace carrom
