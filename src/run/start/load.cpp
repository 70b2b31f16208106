// SPDX-License-Identifier: BSD-3-Clause
#include "run/start/load.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "initial_state/closed_regions.hpp"
#include "initial_state/scene_input.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "machine/machine.hpp"
#include "parallel/agreement.hpp"
#include "run/files/data_output.hpp"
#include "run/files/destinations.hpp"
#include "run/files/outputs.hpp"
#include "run/files/report_file.hpp"
#include "run/files/run_folder.hpp"
#include "run/memory_check.hpp"
#include "run/start/restart.hpp"
#include "run/start/scene_source.hpp"
#include "scene/effects/effect.hpp"
#include "scene/limits.hpp"
#include "scene/read_scene.hpp"
#include "simulation/compression.hpp"

namespace carrom {

namespace {

using Problems = std::vector<Problem>;

/// Runs `read` and adds the problems of an InputError to `problems`; true if there was
/// none. A rank may find problems that the others do not know of yet, so the exception
/// must not leave before all ranks have agreed.
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

/// Files that the options name. They are checked because a run must not end in a file
/// that cannot be written, nor empty its own input.
std::vector<Destination> named_by(const RunOptions& options) {
    std::vector<Destination> destinations;
    if (!options.output.empty()) destinations.push_back({"--output", options.output, Output::text});
    if (!options.report.empty())
        destinations.push_back({"--report", options.report, Output::report});
    return destinations;
}

std::vector<NamedFile> read_by(const RunOptions& options) {
    std::vector<NamedFile> sources;
    if (!options.input.empty() && options.input != "-")
        sources.push_back({"the input", options.input});
    if (!options.restart.empty()) sources.push_back({"the checkpoint", options.restart});
    return sources;
}

/// Adds the problems of the places that the options name.
void check_destinations(const RunOptions& options, PlaceProblems& found) {
    const Problems shared = problems_with(named_by(options), read_by(options));
    if (!options.output.empty())
        found.note("--output", options.output, write_problem_of_stream(options.output));
    if (!options.report.empty() && shared.empty())
        found.note("--report", options.report, write_problem_of_file(options.report));
    append(found.problems, shared);
}

/// The files that are read; outputs must be others.
std::vector<NamedFile> read_for(const RunOptions& options, const SceneParameters& scene) {
    std::vector<NamedFile> sources = read_by(options);
    if (!scene.discs_file.empty() || !scene.discs_from.empty())
        sources.push_back({"the file of discs", discs_path(scene)});
    return sources;
}

/// A run writes into one folder. A wrong name of it is a problem already.
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

/// Loads the scene and opens its input. **Collective.**
SceneParameters load_scene(const RunOptions& options, const Problems& problems_so_far,
                           const Communicator& ranks, SceneSource& source) {
    PlaceProblems found; // all ranks' together: one rank lists each
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
            append(problems, problems_of_outputs(options, scene, read_for(options, scene)));
        }
    }
    found.agree(ranks);
    return scene;
}

/// Checks a restart without a scene, in which fewer things can go wrong. **Collective.**
void check_without_scene(const RunOptions& options, const Problems& problems_so_far,
                         const Communicator& ranks) {
    PlaceProblems found;
    if (ranks.is_root()) {
        found.problems = problems_so_far;
        check_destinations(options, found);
    }
    found.agree(ranks);
}

/// The course program's own scenes are as fast. **Collective.**
void warn_of_units(const RunOptions& options, const SceneParameters& scene,
                   const std::vector<InputDisc>& discs, const Communicator& ranks) {
    if (scene.lines_before_discs > 0) return;
    double fastest = 0;
    for (const InputDisc& disc : discs) fastest = std::max(fastest, std::hypot(disc.vx, disc.vy));
    double later = std::max(largest_wall_speed(scene.effects), usual_speed_of_effects(scene));
    for (const Boundary& side : scene.effects.boundaries)
        later = std::max({later, std::fabs(side.speed), std::sqrt(side.temperature)});
    const std::string warning = units_warning(ranks.max(fastest), later, scene);
    if (!warning.empty()) options.messages.warn("{}: warning: {}\n", scene.name, warning);
}

/// Nobody sees where random insertion puts discs; listed ones are where their author wants them.
/// **Collective.**
void warn_of_closed_regions(const RunOptions& options, const SceneParameters& scene,
                            const std::vector<InputDisc>& discs, const Communicator& ranks) {
    if (scene.generator != Generator::random) return;
    const ShutInDiscs found = find_shut_in(scene, discs, ranks);
    if (found.n_discs == 0) return;
    options.messages.warn("{}: warning: {} of {} discs begin in {} region{} that effects.obstacles "
                          "shut off from the largest one, and cannot leave; leave a gap, or list "
                          "the discs (discs.list, discs.file)\n",
                          scene.name, found.n_discs, scene.n_discs, found.n_regions,
                          found.n_regions == 1 ? "" : "s");
}

/// Lets a run that was killed before its first checkpoint begin with the copy of its
/// scene. **Collective.**
RunOptions with_input_of_folder(RunOptions options, const Communicator& ranks) {
    if (!options.resume || !options.input.empty() || options.folder.empty()) return options;
    std::string copy, overrides;
    on_root(ranks, options.folder, ExitCode::bad_input, [&] {
        if (find_checkpoints(checkpoints_of_run(options.folder)).empty())
            copy = scene_copy_of(options.folder);
        if (!copy.ends_with(".toml")) copy.clear(); // the copy does not have the lines of discs
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

} // namespace

SceneParameters load_scene_alone(const RunOptions& options, const Problems& problems,
                                 const Communicator& ranks) {
    SceneSource source;
    return load_scene(options, problems, ranks, source);
}

Loaded load(const RunOptions& given, const Problems& problems, const Communicator& ranks) {
    const RunOptions options = with_input_of_folder(given, ranks);
    SceneSource source;
    Loaded loaded;
    if (!goes_on(options) || !options.input.empty())
        loaded.scene = load_scene(options, problems, ranks, source);
    else
        check_without_scene(options, problems, ranks);
    std::vector<std::string> found;
    if (goes_on(options)) {
        found = restart_candidates(options, loaded.scene, ranks);
        load_restart(options, loaded, ranks);
        Problems missing; // if the library wrote the checkpoint: its scenes need no folder
        check_folder(loaded.scene, missing);
        if (!missing.empty()) throw InputError(missing);
    }
    const SceneParameters& scene = loaded.scene;
    try {
        if (!loaded.start.stored) check_memory(scene, ranks);
        loaded.locks = claim_outputs(options, scene, read_for(options, scene), named_by(options),
                                     ranks);
        // The last ranks of a run that was killed may have stored more before they ended.
        if (goes_on(options) && restart_candidates(options, scene, ranks) != found) {
            options.messages.note("another checkpoint has come meanwhile\n");
            loaded.start.stored.reset(); // its memory is needed
            load_restart(options, loaded, ranks);
        }
        if (goes_on(options) && !loaded.start.stored) begin_anew(options, scene, ranks);
    } catch (const InputError& error) { // thrown on every rank
        Problems all;
        if (ranks.is_root()) all = error.problems();
        if (ranks.is_root() && !loaded.start.stored)
            append(all, disc_line_problems_of(scene, source.stream.get()));
        agree_on_problems(ranks, all);
    }
    Tuning tuning = options.tuning;
    tuning.threads = options.threads.value_or(default_threads(ranks));
    check_threads(tuning.threads, ranks);
    const std::string crowded = warning_of_crowded_threads(tuning.threads, scene.n_discs, ranks);
    if (!crowded.empty()) options.messages.warn("warning: {}\n", crowded);
    if (!loaded.start.stored)
        loaded.start.discs = first_discs(scene, source.stream.get(), ranks, tuning);
    warn_of_units(options, scene, loaded.start.discs, ranks);
    if (!loaded.start.stored) warn_of_closed_regions(options, scene, loaded.start.discs, ranks);
    for (const std::string& warning : scene.warnings)
        options.messages.warn("{}: warning: {}\n", scene.name, warning);
    return loaded;
}

} // namespace carrom
