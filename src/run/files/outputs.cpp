// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/outputs.hpp"

#include <cerrno>
#include <filesystem>

#include <unistd.h>

#include <fmt/format.h>

#include "core/write_problem.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "parallel/agreement.hpp"
#include "run/files/owned_files.hpp"
#include "run/files/run_folder.hpp"
#include "run/start/restart.hpp"

namespace carrom {

namespace {

constexpr const char* folder_key = "output.folder";

/// The problem that would prevent the folder from being created. Does not create it.
WriteProblem write_problem_of_new_folder(const std::string& folder) {
    std::error_code ignored;
    std::filesystem::path place = std::filesystem::absolute(folder, ignored);
    while (place.has_relative_path() && !std::filesystem::exists(place, ignored))
        place = place.parent_path();
    if (!std::filesystem::is_directory(place, ignored))
        return {fmt::format("cannot be made: {} is not a folder", place.string())};
    if (::access(place.c_str(), W_OK | X_OK) == 0) return {};
    return write_problem("cannot be made in " + place.string(), errno);
}

/// Why the run cannot use the contents of its folder; empty if it can.
std::string problem_in_folder(const RunOptions& options, const SceneParameters& scene) {
    const std::string& folder = scene.folder;
    std::error_code ignored;
    for (const std::string& path : files_of_run(folder)) {
        const auto status = std::filesystem::symlink_status(path, ignored);
        if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
            return path + " is not a plain file";
    }
    if (std::string with_copy = problem_with_copy(scene); !with_copy.empty()) return with_copy;
    const std::string with_tables = problem_with_tables(scene);
    if (!with_tables.empty()) return with_tables;
    const std::string trace = trace_of_run(folder);
    if (trace.empty() || options.overwrite) {
        if (options.resume && trace.empty())
            return "no run has begun there; leave --resume out to begin one";
        return trace.empty() ? trace : problem_of_removal(folder);
    }
    if (!goes_on(options))
        return fmt::format("has {} of a run: go on with it by --resume, begin anew by --overwrite, "
                           "or name another folder",
                           trace);
    const std::string difference = difference_from_run(folder, scene);
    if (difference.empty()) return {};
    return fmt::format("has {} of another run ({}); name another folder", trace, difference);
}

WriteLock locked(const std::string& folder, MadeFolders made, PlaceProblems& found) {
    WriteLock lock(fmt::format("{}/{}", folder, lock_of_run), std::move(made));
    found.note(folder_key, folder, {lock.problem()});
    if (!lock.holder().empty())
        found.note(folder_key, folder,
                   {fmt::format("another run is writing there ({}); wait for its end, or name "
                                "another folder",
                                lock.holder())});
    return lock;
}

/// Adds the problems of the run's outputs to `found`. If there are none, creates the folder and
/// adds its lock to `locks`. If `locks` is null, creates no folder and takes no lock.
void check_places(PlaceProblems& found, const RunOptions& options, const SceneParameters& scene,
                  const std::vector<NamedFile>& sources, std::vector<Destination> destinations,
                  std::vector<WriteLock>* locks) {
    const std::string& folder = scene.folder;
    if (!folder.empty())
        for (const std::string& path : files_of_run(folder))
            if (!goes_on(options) || path != scene_copy_of(folder))
                destinations.push_back({"a file of output.folder,", path, Output::of_folder});
    if (!folder.empty()) destinations.push_back({folder_key, folder, Output::folder});
    for (const Problem& problem : problems_with(destinations, sources, folder))
        found.problems.push_back(problem);
    if (folder.empty()) return;
    for (const NamedFile& source : sources)
        if (options.overwrite && is_in_subfolder_of_run(source.path, folder))
            found.note(source.name, source.path,
                       {"is of the run that --overwrite removes; copy it to another folder first"});
    std::error_code ignored;
    const bool may_try = (locks && found.all().empty()) || std::filesystem::exists(folder, ignored);
    MadeFolders made = may_try ? MadeFolders(folder) : MadeFolders();
    found.note(folder_key, folder,
               may_try ? write_problem_of_folder(folder) : write_problem_of_new_folder(folder));
    if (!found.all().empty()) return;
    if (locks) locks->push_back(locked(folder, std::move(made), found));
    if (found.all().empty()) found.note(folder_key, folder, {problem_in_folder(options, scene)});
}

} // namespace

void PlaceProblems::note(const std::string& key, const std::string& path,
                         const WriteProblem& found) {
    if (found.text.empty()) return;
    (found.is_failure ? failures : problems)
        .push_back({fmt::format("{} {}", key, path), 0, found.text});
}

std::vector<Problem> PlaceProblems::all() const {
    std::vector<Problem> found = problems;
    found.insert(found.end(), failures.begin(), failures.end());
    return found;
}

void PlaceProblems::agree(const Communicator& ranks) const {
    agree_on_problems(ranks, problems.empty() ? problems : all());
    carrom::agree(ranks, failures.empty(), InputError(failures).what(), ExitCode::output_failure);
}

std::vector<WriteLock> claim_outputs(const RunOptions& options, const SceneParameters& scene,
                                     const std::vector<NamedFile>& sources,
                                     const std::vector<Destination>& others,
                                     const Communicator& ranks) {
    PlaceProblems found;
    std::vector<WriteLock> locks;
    if (ranks.is_root()) check_places(found, options, scene, sources, others, &locks);
    found.agree(ranks);
    return locks;
}

std::vector<Problem> problems_of_outputs(const RunOptions& options, const SceneParameters& scene,
                                         const std::vector<NamedFile>& sources) {
    PlaceProblems found;
    check_places(found, options, scene, sources, {}, nullptr);
    return found.all();
}

void prepare_outputs(const SceneParameters& scene, bool begins_anew, const Communicator& ranks) {
    if (scene.folder.empty()) return;
    on_root(ranks, scene.folder, ExitCode::output_failure, [&] {
        if (begins_anew) remove_run(scene.folder);
        prepare_folder(scene);
    });
}

} // namespace carrom
