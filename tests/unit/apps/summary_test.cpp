// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/run_command/report.hpp"
#include "apps/run_command/summary.hpp"

namespace carrom {

namespace {

SceneParameters small_scene() {
    SceneParameters scene;
    scene.name = "small \xff.toml"; // a file's name need not be valid UTF-8
    scene.box = 10;
    scene.radius = 1;
    scene.n_discs = 4;
    scene.method = Method::time_stepped;
    scene.micro_steps = 2;
    scene.steps = 50;
    return scene;
}

RunResult small_result() {
    RunResult result;
    result.start.n_discs = result.end.n_discs = 4;
    result.start.kinetic_energy = 8;
    result.end.kinetic_energy = 10;
    result.start.wall_collisions = 5;
    result.end.wall_collisions = 25;
    result.end.pair_collisions = 30;
    result.last_step = 50;
    result.averages.wall_pressure = {0.125, 0.0625};
    result.wall_seconds = 2e-6;
    result.phase_seconds = {{"search", 1.5}, {"output", 0.5}};
    return result;
}

} // namespace

TEST_CASE("rates are per disc, and per step or micro-step") {
    CHECK(ns_per_disc_step(small_result()) == Approx(10));
    CHECK(energy_drift(small_result()) == Approx(0.25));
    CHECK(collisions_per_disc(small_scene(), small_result()) ==
          Approx((20 + 2 * 30) / (4.0 * 50 * 2)));
}

TEST_CASE(
    "rejected candidates are a share of all candidates, overlaps are per disc and in diameters") {
    RunResult result = small_result();
    CHECK(rejected_share(result) == 0);
    result.end.rejected_candidates = 50;
    CHECK(rejected_share(result) == Approx(50.0 / (20 + 30 + 50)));
    result.end.overlapping_pairs = 3;
    result.end.deepest_overlap = 0.5;
    const auto report = nlohmann::json::parse(report_text(small_scene(), result));
    CHECK(report.at("overlapping_pairs_per_disc") == 1.5);
    CHECK(report.at("deepest_overlap") == 0.25);
    CHECK(summary_text(small_scene(), result).find("50 % of all") != std::string::npos);
    CHECK(summary_text(small_scene(), result)
              .find("3 pairs at the end, 1.5 per disc, by up to 0.25 diameters") !=
          std::string::npos);
}

TEST_CASE("the summary names precision and arithmetic where they leave the default") {
    SceneParameters scene = small_scene();
    CHECK(summary_text(scene, small_result()).find("precision") == std::string::npos);
    scene.precision = Precision::single;
    scene.arithmetic = Arithmetic::naive;
    CHECK(summary_text(scene, small_result())
              .find("precision = \"single\", arithmetic = \"naive\"") != std::string::npos);
}

TEST_CASE("a run of no steps, and one of discs at rest, have rates of zero") {
    RunResult result = small_result();
    result.last_step = 0;
    result.start.kinetic_energy = 0;
    CHECK(ns_per_disc_step(result) == 0);
    CHECK(std::isnan(energy_drift(result))); // undefined, because the energy was 0 at the start
    CHECK(summary_text(small_scene(), result).find("changed from 0") != std::string::npos);
    result.end = {};
    CHECK(energy_drift(result) == 0);
    CHECK(collisions_per_disc(small_scene(), result) == 0);
}

TEST_CASE("imbalance is told where there are several ranks, of what ranks do without waiting for "
          "others") {
    RunResult result = small_result();
    CHECK(summary_text(small_scene(), result).find("imbalance") == std::string::npos);
    result.ranks = 2;
    result.phase_seconds = {{"search", 8},   {"move", 2},      {"sync", 0.5}, {"wait", 5},
                            {"exchange", 7}, {"conflicts", 3}, {"set-up", 9}, {"output", 4}};
    result.phase_imbalance = {{"search", 1.25}, {"move", 1.5},    {"sync", 1.75}, {"wait", 2},
                              {"exchange", 2},  {"conflicts", 2}, {"set-up", 2},  {"output", 2}};
    result.imbalance = 1.125;
    CHECK(busy_seconds(result.phase_seconds) == 10.5);
    const std::string text = summary_text(small_scene(), result);
    CHECK(text.find("1.125 times the mean of the ranks' own work on the busiest; move is least "
                    "even, 1.500") != std::string::npos);
    const auto report = nlohmann::json::parse(report_text(small_scene(), result));
    CHECK(report.at("imbalance") == 1.125);
    CHECK(report.at("phase_imbalance").at("sync") == 1.75);
}

TEST_CASE("the report is JSON with the numbers of the result") {
    const auto report = nlohmann::json::parse(report_text(small_scene(), small_result()));
    CHECK(report.at("n_discs") == 4);
    CHECK(report.at("steps") == 50);
    CHECK(report.at("kinetic_energy") == 10.0);
    CHECK(report.at("momentum").size() == 2);
    CHECK(report.at("averages").at("wall_pressure").at("value") == 0.125);
    CHECK(report.at("averages").at("wall_pressure").at("error") == 0.0625);
    CHECK(report.at("averages").at("mean_free_time").at("error").is_null());
    CHECK(report.at("phase_seconds").at("search") == 1.5);
    CHECK(report.at("state_hash") == "00000000000000000000000000000000");
}

TEST_CASE("what nothing is averaged of is null, with the reason") {
    RunResult result = small_result();
    result.averages = {};
    const auto report = nlohmann::json::parse(report_text(small_scene(), result));
    const auto& averages = report.at("averages");
    CHECK(report.at("temperature").at("value").is_null());
    for (const auto* one :
         {&report.at("temperature"), &report.at("pressure"), &report.at("pressure_tensor").at("xy"),
          &report.at("compressibility"), &averages.at("mean_speed"),
          &averages.at("collision_frequency"), &averages.at("wall_pressure")}) {
        CHECK(one->at("value").is_null());
        CHECK(one->at("error").is_null());
        CHECK(one->at("without_error") == "nothing is averaged: no step came after the first one");
    }
}

TEST_CASE("a run that is too short for errors says what they take") {
    RunResult result = small_result();
    result.averages.steps = 10;
    result.averages.n_blocks = 10;
    result.averages.pressure.value = 0.5;
    result.averages.pressure.is_short = true;
    const auto report = nlohmann::json::parse(report_text(small_scene(), result));
    const std::string reason = report.at("pressure").at("without_error");
    CHECK(reason.starts_with("too short: an error takes 16 steps and 32 collisions"));
    CHECK(report.at("pressure").at("error").is_null());
    CHECK(doubts_of_averages(result.averages) == "none: " + reason);
}

TEST_CASE("what is conserved or still changing has no error, and says so") {
    RunResult result = small_result();
    result.averages.steps = 50;
    result.averages.n_blocks = 40;
    result.averages.temperature.value = 0.998;
    result.averages.temperature.is_conserved = true;
    result.averages.pressure = {0.5, 2e-12, 3, 5};
    result.averages.compressibility.value = 29;
    result.averages.compressibility.is_changing = true;
    result.averages.compressibility.first = 29.5;
    result.averages.compressibility.last = 28.5;
    const std::string text = summary_text(small_scene(), result);
    CHECK(text.find("kT = 0.998 (conserved)\n") != std::string::npos);
    CHECK(text.find("= 29 (from 29.5 to 28.5)\n") != std::string::npos);
    CHECK(text.find("Z is still changing, so without an error; uncertain themselves, with less "
                    "than 8 independent samples\n") != std::string::npos);
    CHECK(text.find("P = 0.5 +- 2e-12") != std::string::npos);
    const auto report = nlohmann::json::parse(report_text(small_scene(), result));
    CHECK(report.at("temperature").at("error").is_null());
    CHECK(report.at("temperature").at("without_error") == "conserved");
    CHECK(report.at("compressibility").at("error").is_null());
    CHECK(report.at("compressibility").at("first") == 29.5);
    CHECK(report.at("compressibility").at("last") == 28.5);
    CHECK(report.at("pressure").at("correlation_time") == 3);
}

TEST_CASE("What has no number, as kT once all discs have left, is named in words") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                     infinite = std::numeric_limits<double>::infinity();
    RunResult result = small_result();
    result.averages.steps = 50;
    result.averages.n_blocks = 40;
    for (const auto& [first, last] : {std::pair(0.5, nan), std::pair(infinite, 0.5)}) {
        Estimate& temperature = result.averages.temperature;
        temperature.value = 0.25;
        temperature.is_changing = true;
        temperature.first = first, temperature.last = last;
        result.averages.pressure_tensor.xx.value = nan;
        result.averages.pressure_tensor.yy.value = 0.5;
        const std::string text = summary_text(small_scene(), result);
        CHECK(text.find("kT = 0.25 (still changing)\n") != std::string::npos);
        CHECK(text.find("pressure xx undefined, xy ") != std::string::npos);
        CHECK(text.find("nan") == std::string::npos);
        CHECK(text.find("inf") == std::string::npos);
    }
}

} // namespace carrom
