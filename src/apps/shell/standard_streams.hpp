// SPDX-License-Identifier: BSD-3-Clause
// Standard error, whatever it is: a run of days must not end because its log is full or closed.
#pragma once

#include <string_view>

#include <fmt/core.h>

#include "parallel/communicator.hpp"
#include "run/messages.hpp"

namespace carrom {

/// Fills the place of each standard stream that is closed with something that cannot be read from
/// (0) or written to (1, 2). Else the next file that is opened would take its number, and messages
/// would end in data. From here on a pipe that nobody reads is an error of writing, not the end of
/// the process. Call before anything is opened.
void keep_standard_streams();

/// Prints to standard error; control characters but ends of lines are escaped. What cannot be
/// written there is dropped: nobody is left to read it.
void print_text(std::string_view text);

template <class... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
    print_text(fmt::vformat(format, fmt::make_format_args(values...)));
}

/// Prints the messages of a run: rank 0 to standard error, the others nowhere.
Messages messages_of(const Communicator& ranks, bool is_quiet);

/// Writes what standard output still holds. False, with a message, where any of it was lost; not
/// where the reader of a pipe had enough.
bool finish_standard_output();

/// Whether standard error is a terminal, whose last line can be written anew.
bool has_terminal();
/// Replaces the last line of a terminal.
void rewrite_line(std::string_view text);

} // namespace carrom
