// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/run_folder.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <unistd.h>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/plain_file.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "io/frame_file.hpp"
#include "io/table_file.hpp"
#include "measure/hdf5_key.hpp"
#include "measure/measurement.hpp"
#include "run/pilot/setting_choice.hpp"
#include "scene/compare.hpp"
#include "scene/frozen_discs.hpp"
#include "scene/read_scene.hpp"

namespace carrom {

namespace {

namespace fs = std::filesystem;

constexpr std::array copies = {"scene.toml", "scene.in"};
constexpr std::array files = {"report.json", "trajectory.h5", "trajectory.xdmf", "collisions.h5"};
constexpr std::array folders = {"checkpoints", "trajectory", "collisions", "measurements"};
constexpr std::string_view table_file = "tables.h5";
constexpr std::string_view override_mark = "# --set ";

std::string in(const std::string& folder, const std::string& name) {
    return (fs::path(folder) / name).string();
}

bool is_there(const std::string& path) {
    std::error_code error;
    return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

/// Whether a recording has no frame or collision after step 0, so that a new run would record the
/// same contents. False if the file cannot be read.
bool is_of_start(const std::string& path) {
    try {
        const FileSummary summary = FrameFile(path).summary();
        return summary.kind == FileKind::collisions
                   ? summary.n_rows == 0
                   : summary.steps.empty() || summary.steps.back() == 0;
    } catch (const InputError&) {
        return false;
    }
}

/// Whether a file is the table "thermo" with at most one row, which is the first sample's.
bool has_rows_of_start(const fs::path& path) {
    std::ifstream file = open_plain_file(path);
    std::size_t n_lines = 0;
    for (std::string line; std::getline(file, line);) n_lines += line.starts_with('#') ? 0 : 1;
    return file.eof() && path.stem() == "thermo" && n_lines <= 2;
}

bool is_segment(const fs::path& path) {
    const std::string stem = path.stem().string();
    return path.extension() == ".h5" && stem.size() >= 4 &&
           stem.find_first_not_of("0123456789") == std::string::npos;
}

/// Whether a run may have written a file, judged by its name and, for a table, by its contents: the
/// first line of a CSV file names the table.
bool is_written_by_run(std::string_view folder, const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(path, error))) return false;
    if (folder == "checkpoints") return is_named_as_checkpoint(path.string());
    const std::string stem = path.stem().string();
    if (folder == "measurements") {
        if (path.filename() == table_file) return is_table_file(path.string());
        std::ifstream file = open_plain_file(path);
        std::string line;
        std::getline(file, line);
        return path.extension() == ".csv" && line.starts_with("# ") && line.ends_with(": " + stem);
    }
    return is_segment(path);
}

/// The first entry of a folder for which `is_wanted` holds; empty if there is none. If the folder
/// exists but cannot be listed, the reason is put in `error`.
template <class Wanted>
std::string find_entry(const std::string& folder, std::error_code& error, const Wanted& is_wanted) {
    fs::directory_iterator entry(folder, error);
    if (error == std::errc::no_such_file_or_directory) error.clear();
    for (const fs::directory_iterator end; !error && entry != end; entry.increment(error))
        if (is_wanted(entry->path())) return entry->path().filename().string();
    return {};
}

/// The settings in the first lines of a scene's copy: those of `--set`, and absolute paths of
/// files, because the copy is in another folder.
std::vector<std::string> overrides_for_copy(const SceneParameters& scene) {
    std::vector<std::string> overrides = scene.overrides;
    std::erase_if(overrides,
                  // not listed, because they follow from the scene when the copy is read
                  [](const std::string& one) { return is_of_frozen(one); });
    if (!scene.discs_file.empty())
        overrides.push_back("discs.file=" + fs::absolute(discs_path(scene)).string());
    if (!scene.discs_from.empty())
        overrides.push_back("discs.from=" + fs::absolute(discs_path(scene)).string());
    return overrides;
}

std::string text_of_copy(const SceneParameters& scene) {
    std::string text;
    for (const std::string& override : overrides_for_copy(scene))
        text += fmt::format("{}{}\n", override_mark, override);
    return text + scene.text;
}

} // namespace

bool is_subfolder_of_run(std::string_view name) {
    return std::find(folders.begin(), folders.end(), name) != folders.end();
}

std::string name_of_replica(std::int64_t k) { return fmt::format("{:04}", k); }

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
        if (is_there(path) && !(fs::is_directory(path, error) && fs::is_empty(path, error)))
            return name;
    }
    return {};
}

std::string recorded_beyond_start(const std::string& folder) {
    if (folder.empty()) return {};
    for (const char* name : {"report.json", "trajectory.h5", "collisions.h5"})
        if (is_there(in(folder, name)) && !is_of_start(in(folder, name))) return name;
    const auto found_in = [&folder](const char* name, const auto& is_recorded) -> std::string {
        std::error_code error;
        const std::string found = find_entry(in(folder, name), error, is_recorded);
        if (error) return name;
        return found.empty() ? found : fmt::format("{}/{}", name, found);
    };
    // The file that joins the segments is made before the first segment. So if there are only
    // segments, the joining file was lost.
    for (const char* name : {"trajectory", "collisions"}) {
        if (is_there(in(folder, name + std::string(".h5")))) continue;
        if (std::string found = found_in(name, is_segment); !found.empty()) return found;
    }
    return found_in("measurements", [](const fs::path& path) {
        return path.extension() == ".csv" && !has_rows_of_start(path);
    });
}

std::string problem_with_tables(const SceneParameters& scene) {
    if (!scene.measurements) return {};
    const std::string& folder = scene.measurements->folder;
    std::error_code error;
    const bool has_table_file = hdf5_setting.of(*scene.measurements) != 0;
    const std::string found = find_entry(folder, error, [&](const fs::path& path) {
        std::error_code ignored;
        const bool is_empty = fs::is_regular_file(fs::symlink_status(path, ignored)) &&
                              fs::file_size(path, ignored) == 0;
        const bool may_be_replaced = path.filename() == table_file
                                         ? has_table_file
                                         : path.extension() == ".csv" &&
                                               is_name_of_table(path.stem().string());
        return may_be_replaced && !is_empty && !is_written_by_run("measurements", path);
    });
    if (error) return fmt::format("{} cannot be listed: {}", folder, error.message());
    if (found.empty()) return {};
    OpenProblem problem;
    static_cast<void>(open_plain_file(in(folder, found), problem));
    return fmt::format("{} {}, and this run may write a table of that name; move it away",
                       in(folder, found),
                       problem.text.empty() ? "is no table that a run has written" : problem.text);
}

std::string problem_with_copy(const SceneParameters& scene) {
    for (const std::string& line : overrides_for_copy(scene))
        if (line.find_first_of("\r\n") != std::string::npos)
            return "its copy of the scene names the file of discs on one line, and the path of "
                   "that file has a line break; move the file";
    return {};
}

std::string scene_copy_of(const std::string& folder) {
    for (const char* name : copies)
        if (std::error_code error; fs::is_regular_file(in(folder, name), error))
            return in(folder, name);
    return {};
}

std::vector<std::string> overrides_of_copy(const std::string& path) {
    std::vector<std::string> overrides;
    std::ifstream file = open_plain_file(path);
    for (std::string line; std::getline(file, line) && line.starts_with(override_mark);)
        overrides.push_back(line.substr(override_mark.size()));
    return overrides;
}

std::string difference_from_run(const std::string& folder, const SceneParameters& scene) {
    const std::string path = scene_copy_of(folder);
    if (path.empty()) return "there is no scene.toml";
    try {
        std::ifstream file = open_plain_file(path);
        const std::vector<std::string> overrides = overrides_of_copy(path);
        std::string skipped;
        for (std::size_t k = 0; k < overrides.size(); ++k) std::getline(file, skipped);
        SceneText text = read_scene_text(file, path);
        text.discs_follow = scene.discs_follow; // the copy does not contain the discs
        if (has_column(scene, DiscColumn::radius))
            text.columns = DiscColumns{scene.effects.species, {}, true};
        SceneParameters there = read_scene(text, overrides), here = scene;
        there.discs_file = here.discs_file; // not compared, because the copy has an absolute path
        for (SceneParameters* one : {&there, &here})
            if (one->accuracy) decide_on(*one, {scene.method, scene.micro_steps});
        if (there.awaits_frozen() && !here.frozen.empty())
            set_frozen(there, here.frozen, has_column(here, DiscColumn::radius));
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
        if (fs::is_symlink(fs::symlink_status(in(folder, name), error))) continue;
        std::vector<fs::path> ours;
        for (fs::directory_iterator entry(in(folder, name), error), end; !error && entry != end;
             entry.increment(error))
            if (is_written_by_run(name, entry->path())) ours.push_back(entry->path());
        for (const fs::path& path : ours) fs::remove(path, error);
    }
}

std::string problem_of_removal(const std::string& folder) {
    std::error_code error;
    for (const char* name : folders) {
        const std::string path = in(folder, name);
        if (fs::is_symlink(fs::symlink_status(path, error)))
            return path + " is a symbolic link, and --overwrite removes nothing behind one; remove "
                          "the link first, or name another folder";
        if (fs::is_directory(path, error) && ::access(path.c_str(), R_OK | W_OK | X_OK) != 0)
            return fmt::format("--overwrite cannot remove what is in {}: {}", path,
                               std::strerror(errno));
    }
    return {};
}

void prepare_folder(const SceneParameters& scene) {
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
