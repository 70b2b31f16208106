// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/words.hpp"

#include <fmt/format.h>

#include "core/printable.hpp"

namespace carrom {

const char* name_of(Method method) {
    return method == Method::time_stepped ? "time-stepped" : "event-driven";
}

std::string labelled_line(const char* label, const std::string& text) {
    return fmt::format("{:<12}{}\n", label, printable(text));
}

} // namespace carrom
