// SPDX-License-Identifier: BSD-3-Clause
// Where the messages of a run go. The program prints them to standard error. A program that uses
// the library may receive them; otherwise they are dropped.
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
    /// Passes each message, which ends with a line break, to `take`. Only one rank has a `take`, so
    /// callers need not test their rank.
    explicit Messages(Take take, bool is_quiet = false)
        : take_(std::move(take)), is_quiet_(is_quiet) {}

    /// A message that the user should get even in a quiet run.
    template <class... Values>
    void warn(fmt::format_string<Values...> format, Values&&... values) const {
        if (take_) take_(fmt::vformat(format, fmt::make_format_args(values...)));
    }

    /// A message about progress, which is left out in a quiet run.
    template <class... Values>
    void note(fmt::format_string<Values...> format, Values&&... values) const {
        if (!is_quiet_) warn(format, std::forward<Values>(values)...);
    }

private:
    Take take_;
    bool is_quiet_ = false;
};

} // namespace carrom
