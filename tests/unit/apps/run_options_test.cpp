// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include "catch.hpp"

#include "apps/command_line.hpp"
#include "apps/run_options.hpp"

namespace carrom {

namespace {

struct Checked {
    RunOptions options;
    std::vector<Problem> problems;
};

Checked checked(const RunWords& words) {
    Checked result;
    result.options = checked_run_options(words, result.problems);
    return result;
}

/// The places of the problems that a whole command line has before any input is looked at.
std::vector<std::string> refused_places(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::vector<std::string> places;
    try {
        parse_command_line(static_cast<int>(words.size()), arguments.data());
    } catch (const InputError& error) {
        for (const Problem& problem : error.problems()) places.push_back(problem.place);
    }
    return places;
}

} // namespace

TEST_CASE("Options that are not given keep their defaults") {
    const auto [options, problems] = checked({});
    CHECK(problems.empty());
    CHECK(options.digits == 17);
    CHECK_FALSE(options.threads.has_value());
    CHECK_FALSE(options.tuning.window.has_value());
    CHECK(options.overrides.empty());
}

TEST_CASE("Steps are an override like any other, and the last word") {
    RunWords words;
    words.overrides = {"time.steps=3", "box.size=4"};
    words.steps = "12";
    const auto [options, problems] = checked(words);
    CHECK(problems.empty());
    CHECK(options.overrides ==
          std::vector<std::string>{"time.steps=3", "box.size=4", "time.steps=12"});
}

TEST_CASE("Every wrong option is told, each by its name") {
    RunWords words;
    words.threads = "0";
    words.steps = "1.5";
    words.digits = "18";
    words.window = "nan";
    words.cell_width = "0";
    words.rebalance_every = "-1";
    words.rebalance_above = "x";
    const auto [options, problems] = checked(words);
    std::vector<std::string> places;
    for (const Problem& problem : problems) places.push_back(problem.place);
    std::sort(places.begin(), places.end());
    CHECK(places == std::vector<std::string>{"--cell-width", "--digits", "--rebalance-above",
                                             "--rebalance-every", "--steps", "--threads",
                                             "--window"});
}

TEST_CASE("A window may be a hundred-thousandth of a micro-step, and no shorter") {
    RunWords words;
    words.window = "1e-5";
    CHECK(checked(words).problems.empty());
    for (const char* wrong : {"0.99e-5", "1e-300", "0", "-1", "inf"}) {
        words.window = wrong;
        const auto [options, problems] = checked(words);
        REQUIRE(problems.size() == 1);
        CHECK(problems[0].text.find("a number from 1e-05 on") != std::string::npos);
        CHECK_FALSE(options.tuning.window.has_value());
    }
}

TEST_CASE("Zero is a number of steps, and switches rebalancing off or on at every look") {
    RunWords words;
    words.steps = words.rebalance_every = words.rebalance_above = "0";
    const auto [options, problems] = checked(words);
    CHECK(problems.empty());
    CHECK(options.overrides == std::vector<std::string>{"time.steps=0"});
    CHECK(options.tuning.rebalance_every == 0);
    CHECK(options.tuning.rebalance_above == 0);
}

TEST_CASE("A command line is refused for words that fit nowhere") {
    CHECK(refused_places({"carrom", "run", "a.in"}).empty());
    CHECK(refused_places({"carrom", "run", "-"}).empty());
    CHECK(refused_places({"carrom", "run", "a.in", "b.in"}) == std::vector<std::string>{"b.in"});
    CHECK(refused_places({"carrom", "run", "--thread", "3", "a.in", "--steps", "-4"}) ==
          std::vector<std::string>{"--thread", "--steps"});
    CHECK(refused_places({"carrom"}) == std::vector<std::string>{"command line"});
    CHECK(refused_places({"carrom", "walk"}) == std::vector<std::string>{"command line"});
}

} // namespace carrom
