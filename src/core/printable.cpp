// SPDX-License-Identifier: BSD-3-Clause
#include "core/printable.hpp"

namespace carrom {

namespace {

void append_escape(std::string& text, unsigned char byte) {
    constexpr const char* digits = "0123456789abcdef";
    text += "\\x";
    text += digits[byte / 16];
    text += digits[byte % 16];
}

} // namespace

std::string printable(std::string_view text, bool keeps_lines) {
    std::string shown;
    shown.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const unsigned char next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1])
                                                       : 0;
        // U+0080 to U+009F are control characters, too: byte C2 in UTF-8, then a byte 80 to 9F.
        const bool is_wide = byte == 0xc2 && next >= 0x80 && next <= 0x9f;
        const bool is_control = byte < 0x20 || byte == 0x7f;
        if (is_wide) {
            append_escape(shown, next);
            ++i;
        } else if (is_control && !(keeps_lines && text[i] == '\n')) {
            append_escape(shown, byte);
        } else {
            shown += text[i];
        }
    }
    return shown;
}

} // namespace carrom
