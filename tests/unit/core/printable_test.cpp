// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "catch.hpp"

#include "core/errors.hpp"
#include "core/printable.hpp"

using namespace carrom;

TEST_CASE("control characters are shown as escapes, all other bytes as they are") {
    CHECK(printable("disc 7, 80 %") == "disc 7, 80 %");
    CHECK(printable("\x1b[2J\a\r\t\x7f") == "\\x1b[2J\\x07\\x0d\\x09\\x7f");
    CHECK(printable(std::string("a\0b", 3)) == "a\\x00b");
    CHECK(printable("r\xc3\xa9sum\xc3\xa9 \xff") == "r\xc3\xa9sum\xc3\xa9 \xff");
    CHECK(printable("\xc2\x9b"
                    "2J\xc2\xa0") == "\\x9b2J\xc2\xa0"); // the second one is a space
    CHECK(printable("\xc2") == "\xc2");
}

TEST_CASE("ends of lines stay where lines are meant") {
    CHECK(printable("a\nb") == "a\\x0ab");
    CHECK(printable("a\nb\r", true) == "a\nb\\x0d");
}

TEST_CASE("a problem is one line, whatever its place is called") {
    CHECK(to_string({"two\nlines\x1b.toml", 3, "has no\rend"}) ==
          "two\\x0alines\\x1b.toml:3: has no\\x0dend");
}
