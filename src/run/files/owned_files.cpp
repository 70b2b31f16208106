// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/owned_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <string_view>

#include <fcntl.h>

#include <fmt/format.h>

#include "io/files.hpp"
#include "run/files/run_folder.hpp"

namespace carrom {

namespace {

namespace fs = std::filesystem;

/// The absolute path, with links resolved as far as it exists.
fs::path canonical(const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
    return error ? path : whole;
}

bool is_there(const fs::path& path) {
    std::error_code error;
    return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

bool is_same_folder(const fs::path& folder, const std::string& own) {
    return !own.empty() && folder == canonical(own);
}

/// Whether the folder is a run's: it contains a lock, or checkpoints and other files of a run.
bool is_run_folder(const fs::path& folder) {
    std::error_code error;
    if (is_there(folder / lock_of_run)) return true;
    const auto files = files_of_run(folder.string());
    return fs::is_directory(checkpoints_of_run(folder.string()), error) &&
           std::any_of(files.begin(), files.end(), is_there);
}

bool is_replicas_folder(const fs::path& folder) {
    return is_run_folder(folder / name_of_replica(0));
}

/// The folder of the run that has `path` in one of its subfolders, or an empty path.
fs::path run_around(const fs::path& path, const std::string& own_folder) {
    for (fs::path place = path; place.has_relative_path(); place = place.parent_path()) {
        const fs::path folder = place.parent_path();
        if (is_subfolder_of_run(place.filename().string()) &&
            (is_same_folder(folder, own_folder) || is_run_folder(folder)))
            return folder;
    }
    return {};
}

std::string owner_of_spelling(const fs::path& path, const std::string& own_folder) {
    const fs::path folder = path.parent_path();
    const auto files = files_of_run(folder.string());
    const bool has_name_of_run = path.filename() == lock_of_run ||
                                 std::find(files.begin(), files.end(), path.string()) !=
                                     files.end();
    fs::path run = run_around(path, own_folder);
    if (run.empty() && has_name_of_run &&
        (is_same_folder(folder, own_folder) || is_run_folder(folder)))
        run = folder;
    if (!run.empty()) return fmt::format("a file of the run in {}", run.string());
    const fs::path end = path.extension();
    if ((end == ".csv" || end == ".json") && is_replicas_folder(folder))
        return fmt::format("a file of the replicas in {}", folder.string());
    return {};
}

/// Whether a text begins like a table of measurements, of replicas or of accuracy: with the table's
/// name, or with the names of its columns.
bool begins_as_table(std::string_view text) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const bool is_measured = line.starts_with("# ") && line.find(": ") != std::string_view::npos;
    return is_measured || line.starts_with("replica,seed,") || line.starts_with("scene,box_size,");
}

} // namespace

std::string owner_of_file(const std::string& path, const std::string& own_folder) {
    // A report replaces a link, but text is written to the link's target. Either may be a run's.
    const fs::path behind = canonical(path),
                   named = canonical(folder_of(path)) / fs::path(path).filename();
    const std::string owner = owner_of_spelling(behind, own_folder);
    return owner.empty() && named != behind ? owner_of_spelling(named, own_folder) : owner;
}

std::string owner_of_folder(const std::string& path) {
    const fs::path run = run_around(canonical(path), {});
    if (run.empty()) return owner_of_spelling(canonical(path), {});
    return fmt::format("a folder of the run in {}", run.string());
}

bool is_in_subfolder_of_run(const std::string& path, const std::string& folder) {
    return run_around(canonical(path), folder) == canonical(folder);
}

FileContent content_of(const std::string& path) {
    constexpr std::string_view hdf5_begin = "\x89HDF\r\n\x1a\n";
    constexpr std::size_t wanted = 4096;
    std::string text(wanted, '\0');
    try {
        text.resize(Descriptor(path, O_RDONLY).read(std::as_writable_bytes(std::span(text)), 0));
    } catch (const FileError&) {
        return FileContent::nothing;
    }
    if (text.empty()) return FileContent::nothing;
    if (text.starts_with(hdf5_begin)) return FileContent::hdf5;
    for (const fs::path& end : {fs::path(path).extension(), canonical(path).extension()})
        if (end == ".toml" || end == ".in" || end == ".discs") return FileContent::scene;
    if (text[text.find_first_not_of(" \t\r\n") % wanted] == '{') return FileContent::report;
    return begins_as_table(text) ? FileContent::table : FileContent::other;
}

} // namespace carrom
