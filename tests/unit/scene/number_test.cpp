// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <bit>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "scene/number.hpp"
#include "scene/read_scene.hpp"
#include "scene/unknown_key.hpp"

using namespace carrom;

TEST_CASE("numbers are the whole text, or none") {
    CHECK(parse_double("1.5") == 1.5);
    CHECK(parse_double("+1.5e2") == 150);
    CHECK(parse_double("-.5") == -0.5);
    for (const char* wrong :
         {"", " 1", "1 ", "1,5", "1.5x", "0x10", "+-1", "--1", "e5", "1e400", "1e-400"}) {
        CAPTURE(wrong);
        CHECK_FALSE(parse_double(wrong).has_value());
    }
    CHECK(std::isnan(*parse_double("nan")));
    CHECK(parse_integer("-7") == -7);
    CHECK_FALSE(parse_integer("9223372036854775808").has_value());
    CHECK(parse_id("18446744073709551615") == 18446744073709551615u);
    CHECK_FALSE(parse_id("-1").has_value());
}

TEST_CASE("a double written with 17 digits is read back bit for bit, in text and in TOML") {
    std::mt19937_64 engine(5);
    for (int i = 0; i < 300; ++i) {
        const double size = std::ldexp(1 + static_cast<double>(engine() >> 11) * 0x1p-53,
                                       static_cast<int>(engine() % 400) - 200);
        char text[64];
        std::snprintf(text, sizeof text, "%.17g", size);
        CHECK(std::bit_cast<std::uint64_t>(*parse_double(text)) ==
              std::bit_cast<std::uint64_t>(size));
        char scene_text[400];
        std::snprintf(scene_text, sizeof scene_text,
                      "[box]\nsize = %.17e\n[discs]\ncount = 1\nradius = %.17e\n[time]\nsteps = "
                      "1\nmethod = \"time-stepped\"\n",
                      4 * size, size);
        const SceneParameters scene = read_scene(scene_text, "s.toml");
        CHECK(scene.radius == size);
        CHECK(scene.box.x == 4 * size);
    }
}

TEST_CASE("words are parted by blanks") {
    std::vector<std::string_view> words;
    split_words("  a\tb   c \r", 5, words);
    CHECK(words == std::vector<std::string_view>{"a", "b", "c"});
    split_words("a b c d", 2, words);
    CHECK(words == std::vector<std::string_view>{"a", "b", "c d"});
    split_words(" \t", 2, words);
    CHECK(words.empty());
}

TEST_CASE("edit distance counts insertions, deletions and replacements") {
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("steps", "steps") == 0);
    CHECK(edit_distance("flaw", "lawn") == 2);
    CHECK(edit_distance("cuont", "count") == 1);
    CHECK(edit_distance("ab", "ba") == 1);
    CHECK(edit_distance("abcd", "badc") == 2);
}
