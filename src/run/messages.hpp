// SPDX-License-Identifier: BSD-3-Clause
// The way of a run's messages. The program prints them to standard error. A program
// that uses the library may take them; otherwise they are dropped.
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
    /// Passes each message, which ends in a line break, to `take`. One rank has a
    /// taker and the others have none, so callers need not ask for their rank.
    explicit Messages(Take take, bool is_quiet = false)
        : take_(std::move(take)), is_quiet_(is_quiet) {}

    /// A message that the user should know of, also in a quiet run.
    template <class... Values>
    void warn(fmt::format_string<Values...> format, Values&&... values) const {
        if (take_) take_(fmt::vformat(format, fmt::make_format_args(values...)));
    }

    /// A message about progress, which a quiet run omits.
    template <class... Values>
    void note(fmt::format_string<Values...> format, Values&&... values) const {
        if (!is_quiet_) warn(format, std::forward<Values>(values)...);
    }

private:
    Take take_;
    bool is_quiet_ = false;
};

} // namespace carrom
