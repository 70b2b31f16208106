// SPDX-License-Identifier: BSD-3-Clause
// Standard error that may be full or closed: a long run must not end because of its log.
#pragma once

#include <string_view>

#include <fmt/core.h>

#include "parallel/communicator.hpp"
#include "run/messages.hpp"

namespace carrom {

/// Replaces each standard stream that is closed by one that cannot be read from (0) or
/// written to (1, 2). Otherwise the next file would get its number, and messages would
/// go into data. From here on a pipe without a reader is an error of writing, and does
/// not end the process. To be called before anything is opened.
void keep_standard_streams();

/// Prints to standard error; escapes control characters except ends of lines. Text
/// that cannot be written is dropped, because there is no reader.
void print_text(std::string_view text);

template <class... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
    print_text(fmt::vformat(format, fmt::make_format_args(values...)));
}

/// Prints the messages of a run to standard error on rank 0, and drops them on the others.
Messages messages_of(const Communicator& ranks, bool is_quiet);

/// Writes the rest of standard output. Returns false, with a message, if any of it was
/// lost, but not if the reader of a pipe has ended.
bool finish_standard_output();

/// Whether standard error is a terminal, whose last line can be rewritten.
bool has_terminal();
/// Replaces the last line of a terminal.
void rewrite_line(std::string_view text);

} // namespace carrom
