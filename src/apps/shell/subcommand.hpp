// SPDX-License-Identifier: BSD-3-Clause
// The form of a subcommand: a table of its options, and its action.
//
// command_line.cpp turns these tables into a parser. To add a subcommand, write a function that
// returns its table, and call it in command_line.cpp.
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
    std::function<ExitCode(const Communicator&)> act; ///< called by every rank. **Collective.**
    /// Whether MPI is needed even if the program runs alone, without a launcher
    bool needs_mpi = false;
    bool stops_on_request = false; ///< whether stop signals are recorded from the start
};

/// Makes an action that throws these problems.
Action failing(std::vector<Problem> problems);

/// Stores the word after an option, or appends a problem if the word is wrong.
using TakeWord = std::function<void(const char* option, const std::string& word,
                                    std::vector<Problem>& problems)>;

/// An option of a subcommand. The word after it (all of them, if it may be repeated) is stored in
/// `value` unchanged, or read as a number (number_words.hpp). A switch sets its value to true.
struct Option {
    const char* name;      ///< such as "--threads"; a name without dashes is a positional argument
    const char* type_name; ///< type of the word that follows, such as "FILE"; empty for a switch
    const char* help;
    std::variant<std::string*, std::vector<std::string>*, bool*, TakeWord> value;
    bool is_required = false;
    const char* group = "Options"; ///< heading in the help text
};

struct Subcommand {
    const char* name;
    const char* help; ///< one line of help
    const char* footer;
    std::vector<Option> options; ///< what `value` points to must live as long as `action`
    /// Called when all values are known; returns the action. It appends to the command line's
    /// `problems`, or passes `problems` on to the action, which may find more.
    std::function<Action(std::vector<Problem>& problems)> action;
    const char* word_too_many = "is one word too many";
};

} // namespace carrom
