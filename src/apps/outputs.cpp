// SPDX-License-Identifier: BSD-3-Clause
#include "apps/outputs.hpp"

#include <cerrno>
#include <filesystem>

#include <unistd.h>

#include <fmt/format.h>

#include "apps/restart.hpp"
#include "apps/run_folder.hpp"
#include "core/write_problem.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

constexpr const char* folder_key = "output.folder";

/// What rank 0 finds, and the locks it takes on the way.
class Claims {
public:
    void check(const char* key, const std::string& path, const Obstacle& found) {
        if (found.text.empty()) return;
        (found.is_failure ? failures_ : problems_)
            .push_back({fmt::format("{} {}", key, path), 0, found.text});
    }

    void lock(const std::string& folder) {
        const WriteLock& lock = locks_.emplace_back(folder + "/.carrom.lock");
        if (!lock.obstacle().empty()) check(folder_key, folder, {lock.obstacle()});
        if (!lock.holder().empty())
            check(folder_key, folder,
                  {fmt::format("another run is writing there ({}); wait for its end, or name "
                               "another folder",
                               lock.holder())});
    }

    void add(const std::vector<Problem>& problems) {
        problems_.insert(problems_.end(), problems.begin(), problems.end());
    }
    bool is_clear() const { return problems_.empty() && failures_.empty(); }

    std::vector<Problem> all() const {
        std::vector<Problem> found = problems_;
        found.insert(found.end(), failures_.begin(), failures_.end());
        return found;
    }

    /// **Collective.**
    std::vector<WriteLock> agreed(const Communicator& ranks) {
        std::string text;
        for (const Problem& failure : failures_)
            text += (text.empty() ? "" : "\n") + to_string(failure);
        agree_on_problems(ranks, problems_.empty() ? problems_ : all());
        agree(ranks, text.empty(), text, ExitCode::output_failure);
        return std::move(locks_);
    }

private:
    std::vector<Problem> problems_, failures_;
    std::vector<WriteLock> locks_;
};

/// What would keep a folder from being made, without making it.
Obstacle obstacle_to_making(const std::string& folder) {
    std::error_code ignored;
    std::filesystem::path place = std::filesystem::absolute(folder, ignored);
    while (place.has_relative_path() && !std::filesystem::exists(place, ignored))
        place = place.parent_path();
    if (!std::filesystem::is_directory(place, ignored))
        return {fmt::format("cannot be made: {} is not a folder", place.string())};
    if (::access(place.c_str(), W_OK | X_OK) == 0) return {};
    return obstacle("cannot be made in " + place.string(), errno);
}

/// What in the folder keeps the run from writing there.
std::string obstacle_in_folder(const RunOptions& options, const Scene& scene) {
    const std::string& folder = scene.folder;
    std::error_code ignored;
    for (const std::string& path : files_of_run(folder)) {
        const auto status = std::filesystem::symlink_status(path, ignored);
        if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
            return path + " is not a plain file";
    }
    const std::string trace = trace_of_run(folder);
    if (trace.empty() || options.overwrite) {
        if (options.resume && trace.empty())
            return "no run has begun there; leave --resume out to begin one";
        return {};
    }
    if (!goes_on(options))
        return fmt::format("has {} of a run: go on with it by --resume, begin anew by --overwrite, "
                           "or name another folder",
                           trace);
    const std::string difference = difference_from_run(folder, scene);
    if (difference.empty()) return {};
    return fmt::format("has {} of another run ({}); name another folder", trace, difference);
}

/// Makes nothing and locks nothing unless `may_begin`, and then only if all is right.
void check_places(Claims& claims, const RunOptions& options, const Scene& scene,
                  const std::vector<NamedFile>& sources, std::vector<NamedFile> destinations,
                  bool may_begin) {
    const std::string& folder = scene.folder;
    if (!folder.empty())
        for (const std::string& path : files_of_run(folder))
            if (!goes_on(options) || path != scene_copy_of(folder))
                destinations.push_back({"a file of output.folder,", path});
    claims.add(problems_with(destinations, sources));
    if (folder.empty()) return;
    std::error_code ignored;
    const bool may_try = (may_begin && claims.is_clear()) ||
                         std::filesystem::exists(folder, ignored);
    claims.check(folder_key, folder,
                 may_try ? obstacle_to_folder(folder) : obstacle_to_making(folder));
    if (!claims.is_clear()) return;
    if (may_begin) claims.lock(folder);
    if (claims.is_clear()) claims.check(folder_key, folder, {obstacle_in_folder(options, scene)});
}

} // namespace

std::vector<WriteLock> claim_outputs(const RunOptions& options, const Scene& scene,
                                     const std::vector<NamedFile>& sources,
                                     const std::vector<NamedFile>& others,
                                     const Communicator& ranks) {
    Claims claims;
    if (ranks.is_root()) check_places(claims, options, scene, sources, others, true);
    return claims.agreed(ranks);
}

std::vector<Problem> problems_of_outputs(const RunOptions& options, const Scene& scene,
                                         const std::vector<NamedFile>& sources) {
    Claims claims;
    check_places(claims, options, scene, sources, {}, false);
    return claims.all();
}

void prepare_outputs(const Scene& scene, bool begins_anew, const Communicator& ranks) {
    if (scene.folder.empty()) return;
    on_root(ranks, scene.folder, ExitCode::output_failure, [&] {
        if (begins_anew) remove_run(scene.folder);
        prepare_folder(scene);
    });
}

} // namespace carrom
