// SPDX-License-Identifier: BSD-3-Clause
#include "run/start/restart.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "parallel/agreement.hpp"
#include "run/files/run_folder.hpp"
#include "run/pilot/setting_choice.hpp"
#include "scene/compare.hpp"
#include "scene/frozen_discs.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

std::string place_of(const RunOptions& options) {
    return options.resume ? "--resume" : "--restart " + options.restart;
}

[[noreturn]] void refuse(const RunOptions& options, const std::string& text) {
    throw InputError({{place_of(options), 0, text}});
}

/// Whether the newest checkpoint of the run's own folder is used.
bool is_own(const RunOptions& options) { return options.resume || options.restart == "latest"; }

/// The folder of the run's own checkpoints.
std::string own_folder(const RunOptions& options, const SceneParameters& scene) {
    if (scene.checkpoint) return scene.checkpoint->folder;
    if (!options.folder.empty()) return checkpoints_of_run(options.folder);
    refuse(options, options.input.empty() ? "name the folder of the run with -o, or the scene"
                                          : "the run has no folder to search: name output.folder "
                                            "or -o");
}

/// The folder that `--restart` names, or its subfolder of checkpoints if it is the folder of a run;
/// empty if it names a file. **Collective.**
std::string named_folder(const RunOptions& options, const Communicator& ranks) {
    std::string folder;
    std::error_code ignored;
    if (ranks.is_root() && std::filesystem::is_directory(options.restart, ignored)) {
        const std::string inner = checkpoints_of_run(options.restart);
        folder = std::filesystem::is_directory(inner, ignored) ? inner : options.restart;
    }
    ranks.broadcast(folder);
    return folder;
}

/// The paths of a folder's checkpoints of steps before `end`, newest first, the same on every rank.
/// **Collective.**
std::vector<std::string> candidates_in(
    const std::string& folder, const Communicator& ranks,
    std::int64_t end = std::numeric_limits<std::int64_t>::max()) {
    std::string list;
    on_root(ranks, folder, ExitCode::bad_input, [&] {
        for (const FoundFile& found : find_checkpoints(folder))
            if (found.step < end) list += found.path + '\0';
    });
    ranks.broadcast(list);
    std::vector<std::string> paths;
    std::istringstream stream(list);
    for (std::string path; std::getline(stream, path, '\0');) paths.push_back(path);
    return paths;
}

/// Reads the checkpoint, and takes the scene from it if there is no input. Throws if the checkpoint
/// does not belong to the scene's run. **Collective.**
Checkpoint read_matching(const std::string& path, const RunOptions& options, SceneParameters& scene,
                         const Communicator& ranks) {
    Checkpoint checkpoint = read_checkpoint(path, ranks);
    const SceneParameters there = scene_of(checkpoint.header, {});
    std::vector<std::string> overrides = options.overrides;
    const bool asks_again = std::erase_if(overrides, [](const std::string& text) {
                                return text.starts_with("time.accuracy=");
                            }) > 0;
    SceneParameters here = options.input.empty() ? scene_of(checkpoint.header, overrides) : scene;
    if (here.accuracy || asks_again) {
        if (here.accuracy) decide_on(here, {there.method, there.micro_steps});
        options.messages.note(
            "time.accuracy chooses at a run's start: going on with the checkpoint's setting\n");
    }
    if (here.awaits_frozen() && !there.frozen.empty()) set_frozen(here, there.frozen);
    refuse_other_run(checkpoint.header, here, path);
    scene = here;
    return checkpoint;
}

/// The problems on one line, without their place, which is the same for all.
std::string reasons(const InputError& error) {
    std::string text;
    for (const Problem& problem : error.problems())
        text += (text.empty() ? "" : "; ") + problem.text;
    return text;
}

/// Reads the first of `paths`, sorted newest first, that is an undamaged checkpoint of this run.
/// **Collective.**
std::optional<Checkpoint> read_newest(const std::vector<std::string>& paths,
                                      const RunOptions& options, SceneParameters& scene,
                                      const Communicator& ranks) {
    const auto pass_over = [&options](const std::string& path, const std::string& reason) {
        const std::size_t named = reason.starts_with(path + ": ") ? path.size() + 2 : 0;
        options.messages.warn("passing over {}: {}\n", path, reason.substr(named));
    };
    for (const std::string& path : paths) {
        try {
            return read_matching(path, options, scene, ranks);
        } catch (const CollectiveError& error) {
            if (error.code() != ExitCode::bad_input) throw;
            pass_over(path, error.what());
        } catch (const InputError& error) {
            pass_over(path, reasons(error));
        }
    }
    return std::nullopt;
}

} // namespace

std::vector<std::string> earlier_checkpoints(const std::string& folder,
                                             const SceneParameters& scene, std::int64_t step,
                                             const Communicator& ranks) {
    std::vector<std::string> paths;
    for (const std::string& path : candidates_in(folder, ranks, step)) {
        try {
            const std::optional<CheckpointHeader> header = check_damage(path, ranks);
            if (header && header->step < step &&
                physical_differences(scene_of(*header, {}), scene).empty())
                paths.push_back(path);
        } catch (const CollectiveError&) {
        } catch (const InputError&) {
        }
    }
    std::reverse(paths.begin(), paths.end());
    return paths;
}

RestartPlan plan_restart(const RunOptions& options, const SceneParameters& scene,
                         const Communicator& ranks) {
    using From = RestartPlan::From;
    if (!goes_on(options)) return {};
    if (is_own(options)) {
        std::string folder = own_folder(options, scene);
        std::vector<std::string> candidates = candidates_in(folder, ranks);
        return {From::own_folder, std::move(folder), std::move(candidates)};
    }
    std::string folder = named_folder(options, ranks);
    if (folder.empty()) return {From::file, options.restart, {options.restart}};
    std::vector<std::string> candidates = candidates_in(folder, ranks);
    return {From::folder, std::move(folder), std::move(candidates)};
}

bool has_other_checkpoints(RestartPlan& plan, const Communicator& ranks) {
    if (!plan.goes_on() || plan.from == RestartPlan::From::file) return false;
    std::vector<std::string> now = candidates_in(plan.place, ranks);
    const bool are_others = now != plan.candidates;
    plan.candidates = std::move(now);
    return are_others;
}

void begin_anew(const RestartPlan& plan, const RunOptions& options, const SceneParameters& scene,
                const Communicator& ranks) {
    let_root(ranks, [&] {
        const std::string recorded = recorded_beyond_start(scene.folder);
        if (!recorded.empty())
            refuse(options, fmt::format("{} has {} of a run and no checkpoint to go on from; begin "
                                        "anew by --overwrite, or name another folder",
                                        scene.folder, recorded));
    });
    options.messages.warn("no checkpoint in {}: beginning at step 0\n", plan.place);
}

std::optional<RunStart> read_restart(const RestartPlan& plan, const RunOptions& options,
                                     SceneParameters& scene, const Communicator& ranks) {
    using From = RestartPlan::From;
    if (!plan.goes_on()) return std::nullopt;
    std::optional<Checkpoint> checkpoint;
    if (plan.from == From::file) {
        checkpoint = read_matching(plan.place, options, scene, ranks);
    } else {
        checkpoint = read_newest(plan.candidates, options, scene, ranks);
        if (!checkpoint && !plan.candidates.empty())
            refuse(options, plan.place + ": no checkpoint there can be gone on from");
        if (!checkpoint && plan.from != From::own_folder)
            refuse(options, "there is no checkpoint; only `latest` and --resume may begin anew");
        if (!checkpoint && options.input.empty())
            refuse(options, plan.place + ": there is no checkpoint, and no scene to begin with");
    }
    if (!checkpoint) return std::nullopt;
    const CheckpointHeader& header = checkpoint->header;
    if (scene.steps < header.step)
        refuse(options,
               fmt::format("the checkpoint is of step {}, and the run is to end at step {}",
                           header.step, scene.steps));
    options.messages.note("going on from step {}\n", header.step);
    return start_of(std::move(*checkpoint));
}

RunStart start_of(Checkpoint checkpoint) {
    RunStart start;
    std::vector<std::int64_t> kept = std::move(checkpoint.samples.effects);
    start.samples = std::move(checkpoint.samples);
    start.stored = StoredState{std::move(checkpoint.discs), checkpoint.header.micro_steps_done,
                               std::move(checkpoint.columns), std::move(kept)};
    return start;
}

} // namespace carrom
