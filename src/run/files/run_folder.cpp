// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/run_folder.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "io/files.hpp"
#include "run/pilot/setting_choice.hpp"
#include "scene/compare.hpp"
#include "scene/read_scene.hpp"

namespace carrom {

namespace {

namespace fs = std::filesystem;

constexpr std::array copies = {"scene.toml", "scene.in"};
constexpr std::array files = {"report.json", "trajectory.h5", "trajectory.xdmf", "collisions.h5"};
constexpr std::array folders = {"checkpoints", "trajectory", "collisions", "measurements"};
constexpr std::string_view override_mark = "# --set ";

std::string in(const std::string& folder, const std::string& name) {
    return (fs::path(folder) / name).string();
}

bool is_there(const std::string& path) {
    std::error_code error;
    return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

/// TOML that has been changed by `--set` says so in its first lines.
std::string text_of_copy(const Scene& scene) {
    std::string text;
    std::vector<std::string> overrides = scene.overrides;
    if (!scene.discs_file.empty())
        overrides.push_back("discs.file=" + fs::absolute(discs_path(scene)).string());
    if (!scene.discs_from.empty())
        overrides.push_back("discs.from=" + fs::absolute(discs_path(scene)).string());
    for (const std::string& override : overrides)
        text += fmt::format("{}{}\n", override_mark, override);
    return text + scene.text;
}

} // namespace

std::vector<std::string> files_of_run(const std::string& folder) {
    std::vector<std::string> paths;
    for (const char* name : copies) paths.push_back(in(folder, name));
    for (const char* name : files) paths.push_back(in(folder, name));
    return paths;
}

std::string report_of_run(const std::string& folder) { return in(folder, "report.json"); }

std::string checkpoints_of_run(const std::string& folder) { return in(folder, folders[0]); }

std::string trace_of_run(const std::string& folder) {
    for (const std::string& path : files_of_run(folder))
        if (is_there(path)) return fs::path(path).filename().string();
    for (const char* name : folders) {
        std::error_code error;
        const std::string path = in(folder, name);
        if (is_there(path) && !(fs::is_directory(path) && fs::is_empty(path, error))) return name;
    }
    return {};
}

std::string scene_copy_of(const std::string& folder) {
    for (const char* name : copies)
        if (fs::is_regular_file(in(folder, name))) return in(folder, name);
    return {};
}

std::vector<std::string> overrides_of_copy(const std::string& path) {
    std::vector<std::string> overrides;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line) && line.starts_with(override_mark);)
        overrides.push_back(line.substr(override_mark.size()));
    return overrides;
}

std::string difference_from_run(const std::string& folder, const Scene& scene) {
    const std::string path = scene_copy_of(folder);
    if (path.empty()) return "there is no scene.toml";
    try {
        std::ifstream file(path);
        const std::vector<std::string> overrides = overrides_of_copy(path);
        std::string skipped;
        for (std::size_t k = 0; k < overrides.size(); ++k) std::getline(file, skipped);
        SceneText text = read_scene_text(file, path);
        text.discs_follow = scene.discs_follow; // they are not in the copy
        if (has_column(scene, DiscColumn::radius))
            text.columns = DiscColumns{scene.effects.species, {}, true};
        Scene there = read_scene(text, overrides), here = scene;
        there.discs_file = here.discs_file; // seen from another folder
        for (Scene* one : {&there, &here})
            if (one->accuracy) decide_on(*one, {scene.method, scene.micro_steps});
        const std::vector<std::string> differences = physical_differences(there, here);
        return differences.empty() ? "" : differences.front();
    } catch (const InputError&) {
        return "its scene cannot be read";
    }
}

void remove_run(const std::string& folder) {
    std::error_code error;
    for (const std::string& path : files_of_run(folder))
        if (fs::is_regular_file(fs::symlink_status(path, error))) fs::remove(path, error);
    for (const char* name : folders) {
        std::vector<fs::path> ours;
        for (fs::directory_iterator entry(in(folder, name), error), end; !error && entry != end;
             entry.increment(error)) {
            const std::string kind = entry->path().extension().string();
            if (kind == ".h5" || kind == ".csv") ours.push_back(entry->path());
        }
        for (const fs::path& path : ours) fs::remove(path, error);
    }
}

void prepare_folder(const Scene& scene) {
    remove_unfinished(scene.folder);
    const std::string copy = in(scene.folder, scene.lines_before_discs > 0 ? copies[1] : copies[0]);
    std::vector<std::string> wanted = {scene.checkpoint->folder};
    if (scene.measurements) wanted.push_back(scene.measurements->folder);
    for (const std::string& path : wanted) {
        std::error_code error;
        fs::create_directories(path, error);
        if (error) throw FileError(fmt::format("{} cannot be made: {}", path, error.message()));
        remove_unfinished(path);
    }
    replace_file(copy, text_of_copy(scene));
}

} // namespace carrom
