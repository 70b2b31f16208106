// SPDX-License-Identifier: BSD-3-Clause
#include "apps/outputs.hpp"

#include <cerrno>
#include <filesystem>

#include <unistd.h>

#include <fmt/format.h>

#include "apps/data_output.hpp"
#include "apps/restart.hpp"
#include "apps/standard_streams.hpp"
#include "io/checkpoint_folder.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

/// What rank 0 finds, and the locks it takes on the way.
class Claims {
public:
    void check(const char* key, const std::string& path, const Obstacle& found) {
        if (found.text.empty()) return;
        (found.is_failure ? failures_ : problems_)
            .push_back({fmt::format("{} {}", key, path), 0, found.text});
    }

    /// `path` is locked by `lock_path`.
    void lock(const char* key, const std::string& path, const std::string& lock_path) {
        const std::string& holder = locks_.emplace_back(lock_path).holder();
        if (!holder.empty())
            problems_.push_back(
                {fmt::format("{} {}", key, path), 0,
                 fmt::format(
                     "another run is writing there ({}); wait for its end, or name another place",
                     holder)});
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

std::vector<NamedFile> recordings_of(const Scene& scene) {
    std::vector<NamedFile> files;
    if (scene.trajectory) {
        const std::string& file = scene.trajectory->file;
        files.push_back({"output.trajectory.file", file});
        files.push_back({"the sidecar of output.trajectory.file",
                         std::filesystem::path(file).replace_extension(".xdmf").string()});
    }
    if (scene.collisions) files.push_back({"output.collisions.file", scene.collisions->file});
    return files;
}

/// An empty path is missing from the scene, which is told elsewhere.
void check_recording(Claims& claims, const char* key, const std::string& path) {
    if (path.empty()) return;
    if (std::filesystem::is_directory(path))
        claims.check(key, path, {"is a directory; name a file"});
    else
        claims.check(key, path, obstacle_to_opening(path));
}

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

bool same_place(const std::string& a, const std::string& b) {
    std::error_code ignored;
    return std::filesystem::equivalent(a, b, ignored);
}

/// Makes nothing and locks nothing unless `may_begin`, and then only if all is right.
void check_places(Claims& claims, const Scene& scene, const std::vector<NamedFile>& sources,
                  std::vector<NamedFile> destinations, bool may_begin) {
    for (const NamedFile& file : recordings_of(scene)) destinations.push_back(file);
    claims.add(problems_with(destinations, sources));
    constexpr const char *folder_key = "output.checkpoint.folder",
                         *tables_key = "output.measurements.folder",
                         *trajectory_key = "output.trajectory.file",
                         *log_key = "output.collisions.file";
    if (scene.trajectory) check_recording(claims, trajectory_key, scene.trajectory->file);
    if (scene.collisions) check_recording(claims, log_key, scene.collisions->file);
    const auto check_folder = [&](const char* key, const std::string& folder) {
        // A folder is made only for a run that nothing else keeps from running.
        std::error_code ignored;
        const bool may_try = (may_begin && claims.is_clear()) ||
                             std::filesystem::exists(folder, ignored);
        if (!folder.empty())
            claims.check(key, folder,
                         may_try ? obstacle_to_folder(folder) : obstacle_to_making(folder));
    };
    if (scene.checkpoint) check_folder(folder_key, scene.checkpoint->folder);
    if (scene.measurements && !scene.measurements->folder.empty())
        check_folder(tables_key, scene.measurements->folder);
    if (!may_begin || !claims.is_clear()) return;
    const bool is_shared = scene.checkpoint && scene.measurements &&
                           same_place(scene.checkpoint->folder, scene.measurements->folder);
    if (scene.measurements && !is_shared)
        claims.lock(tables_key, scene.measurements->folder,
                    (std::filesystem::path(scene.measurements->folder) / ".carrom.lock").string());
    if (scene.checkpoint)
        claims.lock(folder_key, scene.checkpoint->folder,
                    (std::filesystem::path(scene.checkpoint->folder) / ".carrom.lock").string());
    if (scene.trajectory)
        claims.lock(trajectory_key, scene.trajectory->file, scene.trajectory->file + ".lock");
    if (scene.collisions)
        claims.lock(log_key, scene.collisions->file, scene.collisions->file + ".lock");
}

} // namespace

std::vector<WriteLock> claim_outputs(const Scene& scene, const std::vector<NamedFile>& sources,
                                     const std::vector<NamedFile>& others,
                                     const Communicator& ranks) {
    Claims claims;
    if (ranks.is_root()) check_places(claims, scene, sources, others, true);
    return claims.agreed(ranks);
}

std::vector<Problem> problems_of_outputs(const Scene& scene,
                                         const std::vector<NamedFile>& sources) {
    Claims claims;
    check_places(claims, scene, sources, {}, false);
    return claims.all();
}

void check_older_checkpoints(const Scene& scene, std::int64_t first_step,
                             const Communicator& ranks) {
    if (!scene.checkpoint) return;
    const OlderCheckpoints older = older_checkpoints(scene, first_step + 1, scene.steps, ranks);
    std::vector<Problem> problems;
    const std::string place = "output.checkpoint.folder " + scene.checkpoint->folder;
    if (ranks.is_root()) {
        for (const auto& [path, difference] : older.of_others)
            problems.push_back({place, 0,
                                fmt::format("{} is another run's ({}) and would be written over; "
                                            "name another folder, or move it away",
                                            path, difference)});
        if (!older.later_others.empty()) {
            const auto& [path, difference] = older.later_others.front();
            print_message("warning: {}: {} is another run's ({}), and --restart with this folder "
                          "and no scene would take it\n",
                          place, path, difference);
        }
        if (older.last_own >= 0 && first_step < 0)
            print_message("{} has checkpoints of this very run up to step {}; they are written "
                          "anew (--restart latest goes on from there)\n",
                          place, older.last_own);
    }
    agree_on_problems(ranks, problems);
}

} // namespace carrom
