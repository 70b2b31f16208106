// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"

#include "apps/run_command/command_options.hpp"
#include "apps/shell/command_line.hpp"

namespace carrom {

namespace {

struct Checked {
    RunOptions options;
    std::vector<Problem> problems;
};

/// Names of options that are numbers, and the words after them.
using Words = std::vector<std::pair<std::string, std::string>>;

Checked checked(const Words& words, RunOptions given = {}) {
    Checked result;
    const std::vector<Option> options = run_options(given);
    for (const auto& [name, word] : words)
        for (const Option& option : options)
            if (option.name == name)
                std::get<TakeWord>(option.value)(option.name, word, result.problems);
    result.options = completed(given, result.problems);
    return result;
}

Action action_of(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    return parse_command_line(static_cast<int>(words.size()), arguments.data());
}

/// The places of the problems of a command line that is wrong for any input.
std::vector<std::string> refused_places(const std::vector<std::string>& words) {
    const Action action = action_of(words);
    CHECK_FALSE(action.needs_mpi);
    std::vector<std::string> places;
    try {
        action.act(Communicator::world()); // runs on this process alone
    } catch (const InputError& error) {
        for (const Problem& problem : error.problems()) places.push_back(problem.place);
    }
    return places;
}

} // namespace

TEST_CASE("options that are not given keep their defaults") {
    const auto [options, problems] = checked({});
    CHECK(problems.empty());
    CHECK(options.digits == 17);
    CHECK_FALSE(options.threads.has_value());
    CHECK_FALSE(options.tuning.window.has_value());
    CHECK(options.overrides.empty());
}

TEST_CASE("steps are an override like any other, and the last word") {
    RunOptions given;
    given.overrides = {"time.steps=3", "box.size=4"};
    const auto [options, problems] = checked({{"--steps", "12"}}, given);
    CHECK(problems.empty());
    CHECK(options.overrides ==
          std::vector<std::string>{"time.steps=3", "box.size=4", "time.steps=12"});
}

TEST_CASE("every wrong option is told, each by its name") {
    const auto [options, problems] = checked({{"--threads", "0"},
                                              {"--steps", "1.5"},
                                              {"--digits", "18"},
                                              {"--window", "nan"},
                                              {"--cell-width", "0"},
                                              {"--rebalance-every", "-1"},
                                              {"--rebalance-above", "x"}});
    std::vector<std::string> places;
    for (const Problem& problem : problems) places.push_back(problem.place);
    std::sort(places.begin(), places.end());
    CHECK(places == std::vector<std::string>{"--cell-width", "--digits", "--rebalance-above",
                                             "--rebalance-every", "--steps", "--threads",
                                             "--window"});
}

TEST_CASE("a window may be a hundred-thousandth of a micro-step, and no shorter") {
    CHECK(checked({{"--window", "1e-5"}}).problems.empty());
    for (const char* wrong : {"0.99e-5", "1e-300", "0", "-1", "inf"}) {
        const auto [options, problems] = checked({{"--window", wrong}});
        REQUIRE(problems.size() == 1);
        CHECK(problems[0].text.find("a number from 1e-05 on") != std::string::npos);
        CHECK_FALSE(options.tuning.window.has_value());
    }
}

TEST_CASE("zero is a number of steps, and switches rebalancing off or on at every inspection") {
    const auto [options, problems] = checked(
        {{"--steps", "0"}, {"--rebalance-every", "0"}, {"--rebalance-above", "0"}});
    CHECK(problems.empty());
    CHECK(options.overrides == std::vector<std::string>{"time.steps=0"});
    CHECK(options.tuning.rebalance_every == 0);
    CHECK(options.tuning.rebalance_above == 0);
}

TEST_CASE("a command line is refused for words that fit nowhere") {
    using Places = std::vector<std::string>;
    CHECK(refused_places({"carrom", "run", "a.in", "b.in"}) == Places{"b.in"});
    CHECK(refused_places({"carrom", "run", "--thread", "3", "a.in", "--steps", "-4"}) ==
          Places{"--thread", "--steps"});
    CHECK(refused_places({"carrom", "info", "a.h5", "b.h5"}) == Places{"b.h5"});
    CHECK(refused_places({"carrom", "run", "a.in", "--set", "time.steps", "5"}) ==
          Places{"5", "--set time.steps"});
    CHECK(refused_places({"carrom"}) == Places{"command line"});
    CHECK(refused_places({"carrom", "walk"}) == Places{"command line"});
    CHECK(refused_places({"carrom", "info"}) == Places{"command line"});
}

TEST_CASE("empty words are refused: they come from variables that are not set") {
    using Places = std::vector<std::string>;
    for (const char* option : {"--output", "--report", "--restart", "--set", "--threads"})
        CHECK(refused_places({"carrom", "run", "a.in", option, ""}) == Places{option});
    CHECK(refused_places({"carrom", "run", "--report", "", "--restart", "", "a.in"}) ==
          Places{"--restart", "--report"});
    CHECK(refused_places({"carrom", "run", "a.in", "--output="}) == Places{"command line"});
    CHECK(refused_places({"carrom", "convert", "a.h5", "--to", "csv", "--output", ""}) ==
          Places{"--output"});
    CHECK(refused_places({"carrom", "accuracy", "a.in", "--output", ""}) == Places{"--output"});
}

TEST_CASE("only simulations need MPI, and only runs wait for the end of a step to stop") {
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"carrom", "--help"},
                                               {"carrom", "--version"},
                                               {"carrom", "run", "--help"},
                                               {"carrom", "run"},
                                               {"carrom", "info", "a.h5"},
                                               {"carrom", "verify", "a.h5"},
                                               {"carrom", "diff", "a.h5", "b.h5"},
                                               {"carrom", "convert", "a.h5", "--to", "csv"}}) {
        const Action action = action_of(words);
        CHECK_FALSE(action.needs_mpi);
        CHECK_FALSE(action.stops_on_request);
    }
    CHECK(action_of({"carrom", "run", "a.in"}).needs_mpi);
    CHECK(action_of({"carrom", "run", "a.in"}).stops_on_request);
    // no, because it may have to wait for its input
    CHECK_FALSE(action_of({"carrom", "run", "-"}).stops_on_request);
    CHECK(action_of({"carrom", "run", "--restart", "kept"}).needs_mpi);
    CHECK(action_of({"carrom", "accuracy", "a.in"}).needs_mpi);
}

} // namespace carrom
