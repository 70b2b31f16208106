// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/subcommands.hpp"

#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "apps/shell/codes_of_files.hpp"
#include "apps/shell/number_words.hpp"
#include "grading/grader.hpp"
#include "grading/runs.hpp"
#include "initial_state/scene_input.hpp"
#include "parallel/agreement.hpp"
#include "run/start/scene_source.hpp"
#include "scene/read_scene.hpp"
#include "simulation/first_discs.hpp"

namespace carrom {

namespace {

constexpr const char* compare_footer =
    R"(OUTPUT has the lines that a program for the same scene has written: `step id x y vx vy`, in
the last step also `p_c w_c`. It is held to the time-stepped method. The first line that differs is
printed, with the rule that decides it and what the program may do instead: candidates, order, one
collision a step, impulse, stop at a wall, overlap, corner, precision, counters, lines. Lines that
are no lines of discs, such as a header or a time, are left out with a remark.

The tolerance is for positions and for velocities per step. One unit of the last digit that OUTPUT
has comes on top, up to half a radius. Roundings grow with every collision, and lines may be off by
that much more.

With --points grading goes on behind a wrong or missing step, from the lines of the student, and a
score is printed: 10 points for whole lines (5 of them for their order), 10 for the start, 60 for
the share of steps that follow from the step before, 20 for the counters of the last step. If the
scene does not ask for every step, the last one alone is enough, and the start is left out of the
sum.

Examples:
  carrom compare output.txt inputs/tiny.in
  ./student < scene.in | carrom compare - scene.in
  carrom compare output.txt scene.in --set time.micro_steps=4

Exit codes: 0 the same; 1 different; 2 wrong input; 6 no mistake, but not all steps could be
graded. docs/classroom.md has the rules in full.)";

struct CompareOptions {
    std::string output, scene;
    std::vector<std::string> overrides;
    std::optional<double> tolerance;
    bool counts_points = false;
};

/// The reasons why lines of this scene cannot be compared with a run.
std::vector<Problem> reasons_against(const SceneParameters& scene) {
    std::vector<Problem> problems;
    const auto add = [&](const char* text) { problems.push_back({scene.name, 0, text}); };
    if (scene.text_output == TextOutput::none)
        add("writes no lines of discs; try: --set output.text=every_step");
    if (scene.method != Method::time_stepped || scene.accuracy)
        add("is not of the time-stepped method; try: --set time.method=time-stepped");
    if (scene.effects.are_any() || scene.freezes())
        add("has effects; outputs are compared without");
    if (scene.origin.is_on())
        add("has box.origin; outputs are compared from the lower left corner of the box");
    if (scene.precision != Precision::double_ || scene.arithmetic != Arithmetic::stable)
        add("has another precision or arithmetic; outputs are compared to the default");
    return problems;
}

/// Reads the scene. On rank 0 `stream` is then at the first line of discs. **Collective.**
SceneParameters read_scene_on_all(const CompareOptions& options,
                                  std::unique_ptr<std::istream>& stream,
                                  const Communicator& ranks) {
    SceneSource source;
    let_root(ranks, [&] { source.text = read_scene_text(*stream, options.scene); });
    broadcast(source.text, ranks);
    source.stream = std::move(stream);
    SceneParameters scene = read_with_files(source, options.overrides, ranks);
    stream = std::move(source.stream);
    if (std::vector<Problem> problems = reasons_against(scene); !problems.empty())
        throw InputError(std::move(problems));
    return scene;
}

/// Compares the lines with the runs step by step; returns whether all agree. **Collective.**
bool grade(ComparedRuns& runs, Grader& grader, const Communicator& ranks) {
    int goes_on = 1, has_left_runs = 0, is_right = 0;
    for (std::int64_t step = 0; goes_on == 1; ++step) {
        ExpectedDiscs expected;
        if (has_left_runs == 0) expected = runs.at(step);
        let_root(ranks, [&] {
            goes_on = grader.grade(step, expected) ? 1 : 0;
            has_left_runs = grader.has_left_runs() ? 1 : 0;
            is_right = grader.is_right() ? 1 : 0;
        });
        ranks.broadcast(goes_on);
        ranks.broadcast(has_left_runs);
    }
    ranks.broadcast(is_right);
    return is_right == 1;
}

/// Runs `carrom compare`. **Collective.**
ExitCode compare(const CompareOptions& options, const Communicator& ranks) {
    std::unique_ptr<std::istream> scene_file;
    std::ifstream output_file;
    let_root(ranks, [&] {
        std::vector<Problem> problems;
        const auto open = [&](const std::string& path, const auto& take) {
            try {
                take(open_input(path));
            } catch (const InputError& error) {
                problems.insert(problems.end(), error.problems().begin(), error.problems().end());
            }
        };
        open(options.scene, [&](std::ifstream file) {
            scene_file = std::make_unique<std::ifstream>(std::move(file));
        });
        if (options.output != "-")
            open(options.output, [&](std::ifstream file) { output_file = std::move(file); });
        if (!problems.empty()) throw InputError(std::move(problems));
    });
    const SceneParameters scene = read_scene_on_all(options, scene_file, ranks);
    ComparedRuns runs(scene, first_discs(scene, scene_file.get(), ranks, {}), ranks);
    std::istream& output = options.output == "-" ? std::cin : output_file;
    Grader grader(scene, options.tolerance.value_or(1e-6 * scene.radius), output,
                  options.output == "-" ? "standard input" : options.output, options.counts_points);
    const bool is_same = grade(runs, grader, ranks);
    if (ranks.is_root()) fmt::print("{}", grader.verdict());
    if (ranks.is_root() && options.counts_points) fmt::print("{}", grader.points().text());
    int is_graded = grader.has_graded_all() ? 1 : 0; // known only on rank 0
    ranks.broadcast(is_graded);
    if (!is_same) return ExitCode::difference;
    return is_graded == 1 ? ExitCode::success : incomplete;
}

} // namespace

Subcommand compare_subcommand() {
    const auto options = std::make_shared<CompareOptions>();
    const auto action = [options](std::vector<Problem>& problems) -> Action {
        if (!problems.empty()) return failing(problems);
        return {[options](const Communicator& ranks) { return compare(*options, ranks); }, true};
    };
    return {"compare",
            "Grade the output of another program for the same scene",
            compare_footer,
            {{"OUTPUT", "", "Lines of discs; - for standard input", &options->output, true},
             {"SCENE", "", "SCENE.toml or FILE.in", &options->scene, true},
             {"--tolerance", "X", "Of each number; default 1e-6 of the radius",
              number(options->tolerance, 0.0, largest_double)},
             {"--points", "", "Print a score of 100 in parts, too", &options->counts_points},
             {"--set", "KEY=VALUE", "Set any scene key; may be repeated", &options->overrides}},
            action};
}

} // namespace carrom
