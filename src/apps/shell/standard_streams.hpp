// SPDX-License-Identifier: BSD-3-Clause
// Keeps a run alive if standard error is full or closed, because a lost message must not end it.
#pragma once

#include <string_view>

#include <fmt/core.h>

#include "parallel/communicator.hpp"
#include "run/messages.hpp"

namespace carrom {

/// Opens each closed standard stream as a stream on which reading (0) or writing (1, 2) fails.
/// Otherwise the next file would get the stream's number, and messages would be written into data.
/// Also ignores SIGPIPE: a pipe without a reader gives a write error, but does not end the process.
/// Call it before any file is opened.
void keep_standard_streams();

/// Prints to standard error, with control characters escaped except ends of lines. If this fails,
/// the text is dropped, because an error message could not be written either.
void print_text(std::string_view text);

template <class... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
    print_text(fmt::vformat(format, fmt::make_format_args(values...)));
}

/// Prints the messages of a run to standard error on rank 0, and drops them on the others.
Messages messages_of(const Communicator& ranks, bool is_quiet);

/// Flushes standard output. Returns false and prints a message if output was lost, unless the
/// reader of a pipe has ended.
bool finish_standard_output();

/// Whether standard error is a terminal, whose last line can be rewritten.
bool has_terminal();
/// Replaces the last line of a terminal.
void rewrite_line(std::string_view text);

} // namespace carrom
