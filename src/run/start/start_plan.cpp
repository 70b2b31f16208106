// SPDX-License-Identifier: BSD-3-Clause
#include "run/start/start_plan.hpp"

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "initial_state/scene_input.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "parallel/agreement.hpp"
#include "run/files/data_output.hpp"
#include "run/files/outputs.hpp"
#include "run/files/report_file.hpp"
#include "run/files/run_folder.hpp"
#include "scene/read_scene.hpp"

namespace carrom {

namespace {

using Problems = std::vector<Problem>;

/// Calls `read`. If it throws an InputError, adds the problems to `problems` and returns false. A
/// rank may find problems that other ranks do not, so no rank may throw before all ranks have
/// agreed.
template <class Read> bool collect(Problems& problems, const Read& read) {
    try {
        read();
        return true;
    } catch (const InputError& error) {
        append(problems, error.problems());
        return false;
    }
}

std::unique_ptr<std::istream> open(const std::string& input) {
    if (input == "-") return std::make_unique<std::istream>(std::cin.rdbuf());
    return std::make_unique<std::ifstream>(open_input(input));
}

std::vector<NamedFile> read_by(const RunOptions& options) {
    std::vector<NamedFile> sources;
    if (!options.input.empty() && options.input != "-")
        sources.push_back({"the input", options.input});
    if (!options.restart.empty()) sources.push_back({"the checkpoint", options.restart});
    return sources;
}

/// Adds the problems of the output paths that the options name.
void check_destinations(const RunOptions& options, PlaceProblems& found) {
    const Problems shared = problems_with(outputs_named_by(options), read_by(options));
    if (!options.output.empty())
        found.note("--output", options.output, write_problem_of_stream(options.output));
    if (!options.report.empty() && shared.empty())
        found.note("--report", options.report, write_problem_of_file(options.report));
    append(found.problems, shared);
}

/// Loads the scene and opens its input. **Collective.**
SceneParameters load_scene(const RunOptions& options, const Problems& problems_so_far,
                           const Communicator& ranks, SceneSource& source) {
    PlaceProblems found; // rank 0 alone lists problems that all ranks find
    Problems& problems = found.problems;
    bool is_readable = true;
    if (ranks.is_root()) {
        problems = problems_so_far;
        check_destinations(options, found);
        is_readable = !options.input.empty() && collect(problems, [&] {
            source.stream = open(options.input);
            source.text = read_scene_text(*source.stream,
                                          options.input == "-" ? "standard input" : options.input);
        });
    }
    SceneParameters scene;
    if (ranks.all(is_readable)) {
        broadcast(source.text, ranks);
        Problems same_everywhere;
        scene = read_with_files(source, options.overrides, same_everywhere, problems, ranks);
        check_folder(scene, same_everywhere);
        if (ranks.is_root()) append(problems, same_everywhere);
        if (ranks.is_root() && (!problems.empty() || are_columns_wrong(source))) {
            if (!goes_on(options) || are_columns_wrong(source))
                append(problems, disc_line_problems_of(scene, source.stream.get()));
            if (problems.empty())
                problems.push_back({discs_path(scene), 0, "changes while it is being read"});
            append(problems, problems_of_outputs(options, scene, files_read_for(options, scene)));
        }
    }
    found.agree(ranks);
    return scene;
}

/// Checks the output paths of a restart without an input, whose scene is in the checkpoint.
/// **Collective.**
void check_without_scene(const RunOptions& options, const Problems& problems_so_far,
                         const Communicator& ranks) {
    PlaceProblems found;
    if (ranks.is_root()) {
        found.problems = problems_so_far;
        check_destinations(options, found);
    }
    found.agree(ranks);
}

/// If --resume continues a run that was killed before its first checkpoint, the copy of its scene
/// becomes the input.
RunOptions with_input_of_folder(RunOptions options, const Communicator& ranks) {
    if (!options.resume || !options.input.empty() || options.folder.empty()) return options;
    std::string copy, overrides;
    on_root(ranks, options.folder, ExitCode::bad_input, [&] {
        if (find_checkpoints(checkpoints_of_run(options.folder)).empty())
            copy = scene_copy_of(options.folder);
        // Only a copy in TOML will do: the other format needs lines of discs, which copies lack
        if (!copy.ends_with(".toml")) copy.clear();
        for (const std::string& override : overrides_of_copy(copy)) overrides += override + '\n';
    });
    ranks.broadcast(copy);
    ranks.broadcast(overrides);
    options.input = copy;
    std::vector<std::string> all;
    std::istringstream lines(overrides);
    for (std::string line; std::getline(lines, line);) all.push_back(line);
    all.insert(all.end(), options.overrides.begin(), options.overrides.end());
    options.overrides = std::move(all);
    return options;
}

std::string words_of(const RestartPlan& plan) {
    std::string text;
    switch (plan.from) {
    case RestartPlan::From::scene: return "begins at step 0\n";
    case RestartPlan::From::file: return "goes on from " + plan.place + "\n";
    case RestartPlan::From::folder:
        text = fmt::format("goes on from the newest checkpoint in {}\n", plan.place);
        break;
    case RestartPlan::From::own_folder:
        text = fmt::format("goes on from the newest checkpoint in {}, or begins at step 0\n",
                           plan.place);
        break;
    }
    for (const std::string& path : plan.candidates) text += fmt::format("  {}\n", path);
    return text;
}

} // namespace

std::vector<Destination> outputs_named_by(const RunOptions& options) {
    std::vector<Destination> destinations;
    if (!options.output.empty()) destinations.push_back({"--output", options.output, Output::text});
    if (!options.report.empty())
        destinations.push_back({"--report", options.report, Output::report});
    return destinations;
}

std::vector<NamedFile> files_read_for(const RunOptions& options, const SceneParameters& scene) {
    std::vector<NamedFile> sources = read_by(options);
    if (!scene.discs_file.empty() || !scene.discs_from.empty())
        sources.push_back({"the file of discs", discs_path(scene)});
    return sources;
}

void check_folder(const SceneParameters& scene, Problems& problems) {
    const bool is_needed = scene.checkpoint || scene.trajectory || scene.collisions ||
                           scene.measurements;
    const auto is_of_folder = [](const Problem& problem) {
        return problem.place == "--set output.folder" ||
               problem.text.starts_with("'output.folder'");
    };
    if (is_needed && scene.folder.empty() &&
        std::none_of(problems.begin(), problems.end(), is_of_folder))
        problems.push_back({scene.name, 0,
                            "'output.folder' is missing: the folder for what the run writes; "
                            "-o FOLDER sets it too"});
}

StartPlan plan_start(const RunOptions& options, const Problems& problems,
                     const Communicator& ranks) {
    StartPlan plan{with_input_of_folder(options, ranks)};
    if (!goes_on(plan.options) || plan.has_scene())
        plan.scene = load_scene(plan.options, problems, ranks, plan.source);
    else
        check_without_scene(plan.options, problems, ranks);
    plan.restart = plan_restart(plan.options, plan.scene, ranks);
    return plan;
}

std::string text_of(const StartPlan& plan) {
    const std::string scene = plan.has_scene() ? "scene of " + plan.options.input
                                               : "scene of the checkpoint";
    std::string text = scene + "\n" + words_of(plan.restart);
    for (const std::string& override : plan.options.overrides)
        text += fmt::format("with {}\n", override);
    return text;
}

SceneParameters load_scene_alone(const RunOptions& options, const Problems& problems,
                                 const Communicator& ranks) {
    SceneSource source;
    return load_scene(options, problems, ranks, source);
}

} // namespace carrom
