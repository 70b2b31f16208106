// SPDX-License-Identifier: BSD-3-Clause
// Where the messages of a run go. The program prints them to standard error; a program that uses
// the library may take them; without a taker they are dropped.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace carrom {

class Messages {
public:
    using Take = std::function<void(const std::string&)>;

    /// Drops all messages.
    Messages() = default;
    /// Hands each message, which ends in a line break, to `take`. One rank has a taker, the others
    /// have none, so that callers need not ask which rank they are on.
    explicit Messages(Take take, bool is_quiet = false)
        : take_(std::move(take)), is_quiet_(is_quiet) {}

    /// Something that the user should know, also of a quiet run.
    template <class... Values>
    void warn(fmt::format_string<Values...> format, Values&&... values) const {
        if (take_) take_(fmt::vformat(format, fmt::make_format_args(values...)));
    }

    /// What the run does; a quiet run leaves it out.
    template <class... Values>
    void note(fmt::format_string<Values...> format, Values&&... values) const {
        if (!is_quiet_) warn(format, std::forward<Values>(values)...);
    }

private:
    Take take_;
    bool is_quiet_ = false;
};

} // namespace carrom
