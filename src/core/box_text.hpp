// SPDX-License-Identifier: BSD-3-Clause
// Formats a box for messages: a square as "10", other boxes as "10 x 5". A format such as {:.3g}
// applies to both lengths.
#pragma once

#include <string>

#include <carrom/box.hpp>
#include <fmt/format.h>

template <> struct fmt::formatter<carrom::Box> : fmt::formatter<double> {
    template <class Context> auto format(const carrom::Box& box, Context& context) const {
        auto out = fmt::formatter<double>::format(box.x, context);
        if (box.is_square()) return out;
        context.advance_to(fmt::format_to(out, " x "));
        return fmt::formatter<double>::format(box.y, context);
    }
};

namespace carrom {

/// The text "side 10" for a square box, otherwise a text such as "sides 10 and 5".
inline std::string sides_text(const Box& box) {
    return box.is_square() ? fmt::format("side {}", box.x)
                           : fmt::format("sides {} and {}", box.x, box.y);
}

} // namespace carrom
