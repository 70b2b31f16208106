// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <stdexcept>
#include <string>

#include "core/errors.hpp"

using namespace carrom;

TEST_CASE("a problem names its place, and its line where it has one") {
    CHECK(to_string(Problem{"gas.toml", 12, "radius must be positive"}) ==
          "gas.toml:12: radius must be positive");
    CHECK(to_string(Problem{"--set time.steps", 0, "not a number"}) ==
          "--set time.steps: not a number");
    CHECK(to_string(Problem{"", 0, "no input"}) == "no input");
}

TEST_CASE("an input error carries all problems, one a line") {
    const std::vector<Problem> problems = {{"a.in", 1, "first"}, {"a.in", 7, "second"}};
    const InputError error(problems);
    CHECK(error.problems() == problems);
    CHECK(std::string(error.what()) == "a.in:1: first\na.in:7: second");
}

TEST_CASE("a collective error carries its exit code") {
    CHECK(CollectiveError("disk full").code() == ExitCode::collective_failure);
    CHECK(CollectiveError("disk full", ExitCode::output_failure).code() ==
          ExitCode::output_failure);
    CHECK(static_cast<int>(ExitCode::bad_input) == 2);
    CHECK(static_cast<int>(ExitCode::collective_failure) == 3);
}

TEST_CASE("a broken invariant reaches the handler with its text and place, a kept one does not") {
    struct Broken {
        std::string text, file;
        int line;
    };
    set_failure_handler([](std::string_view text, const char* file, int line) {
        throw Broken{std::string(text), file, line};
    });
    CHECK_NOTHROW(ensure(true, "kept"));
    int line = 0;
    try {
        line = __LINE__ + 1;
        ensure(false, "each disc has one owner");
        FAIL("ensure returned");
    } catch (const Broken& broken) {
        CHECK(broken.text == "each disc has one owner");
        CHECK(broken.file.find("errors_test.cpp") != std::string::npos);
        CHECK(broken.line == line);
    }
}
