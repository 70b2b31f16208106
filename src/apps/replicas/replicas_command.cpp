// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/subcommands.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/replicas/replicas_join.hpp"
#include "apps/run_command/command_options.hpp"
#include "apps/run_command/run_command.hpp"
#include "apps/shell/number_words.hpp"
#include "apps/shell/standard_streams.hpp"
#include "parallel/agreement.hpp"
#include "run/files/destinations.hpp"
#include "run/files/run_folder.hpp"
#include "run/start/load.hpp"
#include "scene/key.hpp"

namespace carrom {

namespace {

constexpr const char* replicas_footer =
    R"(Replica k has the scene's seed plus k, and a folder of its own, FOLDER/000k.
Ranks take replicas in turn, and each runs its own alone. The same command again
does what is missing: replicas that are done are left alone, and one that was
stopped goes on from its last checkpoint.

FOLDER/replicas.csv has a line for each replica. replicas.json has the averages
over replicas, each with the standard error of the mean, and the scatter between
replicas over the errors that they claim. A warning says where it is too large.
Measured tables are averaged line by line.

Examples:
  mpirun -np 8 carrom replicas inputs/gas.toml --count 64 -o FOLDER
  carrom replicas inputs/gas.toml --count 4 -o FOLDER --set discs.packing=0.3

Exit codes: those of carrom run.)";

struct ReplicasOptions {
    RunOptions run;
    std::int64_t count = 0;
    std::string folder;
};

/// The keys of the scene's random seeds, to which replica k adds k.
std::vector<const Key*> seeds_of(const SceneParameters& scene) {
    std::vector<const Key*> seeds;
    for (const Key& key : keys())
        if (key.is_seed && key.has_meaning(scene)) seeds.push_back(&key);
    return seeds;
}

/// The options of the run of replica `k`.
RunOptions options_of(const ReplicasOptions& options, const SceneParameters& scene,
                      std::int64_t k) {
    RunOptions one = options.run;
    one.folder = (std::filesystem::path(options.folder) / name_of_replica(k)).string();
    one.quiet = true;
    for (const Key* key : seeds_of(scene))
        one.overrides.push_back(
            fmt::format("{}={}", key->name, std::get<std::int64_t>(key->get(scene).data) + k));
    one.overrides.push_back("output.text=none");
    one.overrides.push_back("output.folder=" + one.folder);
    one.resume = !trace_of_run(one.folder).empty();
    return one;
}

/// Whether the replica is complete. Throws InputError if the complete run has another scene.
bool is_done(const RunOptions& one, const Communicator& rank) {
    if (!one.resume) return false;
    const SceneParameters scene = load_scene_alone(one, {}, rank);
    if (last_step_reported(one.folder) != scene.steps) return false;
    const std::string difference = difference_from_run(one.folder, scene);
    if (!difference.empty())
        throw InputError({{one.folder, 0, difference + "; take another folder with -o"}});
    return true;
}

/// Runs this rank's replicas one after the other. Returns `stopped` if a stop was requested.
ExitCode run_mine(const ReplicasOptions& options, const SceneParameters& scene,
                  const Communicator& ranks) {
    const Communicator alone = Communicator::of_this_rank();
    for (std::int64_t k = ranks.rank(); k < options.count; k += ranks.size()) {
        const RunOptions one = options_of(options, scene, k);
        if (is_done(one, alone)) continue;
        if (run_scene(one, {}, alone) != ExitCode::success) return ExitCode::stopped;
        print_message("replica {} of {} is done\n", k, options.count);
    }
    return ExitCode::success;
}

/// Runs all replicas; returns false if a stop was requested. Every rank throws if a replica failed.
bool all_are_done(const ReplicasOptions& options, const SceneParameters& scene,
                  const Communicator& ranks) {
    constexpr double patience_seconds = 1e9; // the other ranks' runs may take long
    ExitCode code = ExitCode::success, failure_code = ExitCode::success;
    std::string failure;
    try {
        code = run_mine(options, scene, ranks);
    } catch (const InputError& error) {
        failure = error.what();
        failure_code = ExitCode::bad_input;
    } catch (const CollectiveError& error) {
        failure = error.what();
        failure_code = error.code();
    }
    agree(ranks, failure.empty(), failure, failure_code, patience_seconds);
    return ranks.all(code == ExitCode::success);
}

ExitCode run_replicas(const ReplicasOptions& options, std::vector<Problem> problems,
                      const Communicator& ranks) {
    for (const auto& found : {problems_with({{"--folder", options.folder, Output::folder}}, {}),
                              problems_with_joined_files(options.folder)})
        problems.insert(problems.end(), found.begin(), found.end());
    if (const std::string trace = trace_of_run(options.folder); !trace.empty())
        problems.push_back({options.folder, 0,
                            fmt::format("has {} of a run; name another folder with -o, in which "
                                        "each replica gets its own",
                                        trace)});
    RunOptions first = options.run;
    first.overrides.push_back("output.folder=" + options.folder);
    const SceneParameters scene = load_scene_alone(first, problems, ranks);
    if (scene.reads_disc_lines() || seeds_of(scene).empty())
        throw InputError({{scene.name, 0,
                           "replicas differ by the seed of their discs, and this scene lists its "
                           "discs; let it generate them"}});
    if (!all_are_done(options, scene, ranks)) return ExitCode::stopped;
    JoinedReplicas joined;
    std::string failure;
    let_root(ranks, [&] {
        std::vector<Replica> replicas;
        for (std::int64_t k = 0; k < options.count; ++k)
            replicas.push_back(
                {options_of(options, scene, k).folder, scene.seed + static_cast<std::uint64_t>(k)});
        try {
            joined = join_replicas(replicas, options.folder);
        } catch (const CollectiveError& error) {
            failure = error.what();
        }
    });
    agree(ranks, failure.empty(), failure, ExitCode::output_failure);
    if (ranks.is_root() && !options.run.quiet) print_text(joined.averages);
    if (ranks.is_root() && !joined.warning.empty())
        print_message("warning: {}: {}\n", scene.name, joined.warning);
    return ExitCode::success;
}

std::vector<Option> options_of(ReplicasOptions& options) {
    RunOptions& run = options.run;
    return {
        {"INPUT", "", "SCENE.toml, whose discs are generated", &run.input, true},
        {"--count", "N", "Replicas, 1 to 10000",
         number(options.count, std::int64_t{1}, std::int64_t{10000}), true},
        {"-o,--folder", "FOLDER", "For the replicas' folders and what they say together",
         &options.folder, true},
        {"--threads", "T", "Threads of each; default 1", number(run.threads, 1, 1024)},
        {"--steps", "S", "The last step, counted from the scene's start, instead of the input's",
         number(run.steps, std::int64_t{0}, std::numeric_limits<std::int64_t>::max())},
        {"--set", "KEY=VALUE", "Set any scene key; may be repeated", &run.overrides},
        {"--quiet", "", "No averages on the terminal", &run.quiet},
    };
}

} // namespace

Subcommand replicas_subcommand() {
    const auto given = std::make_shared<ReplicasOptions>();
    given->run.threads = 1;
    const auto action = [given](std::vector<Problem>& problems) -> Action {
        ReplicasOptions options = *given;
        options.run = completed(options.run, problems);
        return {[options = std::move(options), problems](const Communicator& ranks) {
                    return run_replicas(options, problems, ranks);
                },
                true, true};
    };
    return {"replicas", "Run a scene many times from different seeds, and average", replicas_footer,
            options_of(*given), action};
}

} // namespace carrom
