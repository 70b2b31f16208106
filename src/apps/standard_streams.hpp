// SPDX-License-Identifier: BSD-3-Clause
// Standard error, whatever it is: a run of days must not end because its log is full or closed.
#pragma once

#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace carrom {

/// Puts something that cannot be read from (0) or written to (1, 2) in the place of each standard
/// stream that is closed: else the next file that is opened would take its number, and messages
/// would end in data. From here on a pipe that nobody reads is an error of writing, not the end of
/// the process. Call before anything is opened.
void keep_standard_streams();

/// Prints to standard error. What cannot be written there is dropped: there is nobody left to tell.
template <class... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
    fmt::memory_buffer text;
    fmt::format_to(fmt::appender(text), format, std::forward<Values>(values)...);
    std::fwrite(text.data(), 1, text.size(), stderr);
}

} // namespace carrom
