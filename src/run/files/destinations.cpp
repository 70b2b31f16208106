// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/destinations.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "run/files/owned_files.hpp"

namespace carrom {

namespace {

/// Whether two paths lead to the same file, even if it is missing, or if the paths differ by links
/// or spelling.
bool is_same_file(const std::string& a, const std::string& b) {
    std::error_code error;
    if (std::filesystem::equivalent(a, b, error)) return true;
    const auto whole = [&error](const std::string& path) {
        return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
    };
    const auto whole_a = whole(a);
    return !error && whole_a == whole(b) && !error;
}

bool is_special(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
           !std::filesystem::is_directory(status);
}

/// Whether the file has several hard links: text written in place would appear under all of them.
bool has_other_names(const std::string& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error) &&
           std::filesystem::hard_link_count(path, error) > 1 && !error;
}

const char* words_for(FileContent content) {
    switch (content) {
    case FileContent::hdf5: return "an HDF5 file";
    case FileContent::report: return "a report";
    case FileContent::scene: return "a scene or a file of discs";
    case FileContent::table: return "a table";
    default: return "another file";
    }
}

/// Whether an output may replace a file with this content.
bool may_replace(Output output, FileContent content) {
    switch (output) {
    case Output::report: return content == FileContent::nothing || content == FileContent::report;
    case Output::scene: return content == FileContent::nothing || content == FileContent::scene;
    default: return content == FileContent::nothing || content == FileContent::other;
    }
}

/// Why this output is not allowed, or an empty text. Other outputs and input files are not
/// compared.
std::string reason_against(const Destination& target, const std::string& own_folder) {
    if (target.kind == Output::of_folder) return {};
    if (target.kind == Output::folder) {
        const std::string owner = owner_of_folder(target.path);
        return owner.empty() ? owner : fmt::format("is {}; name another folder", owner);
    }
    const std::string owner = owner_of_file(target.path, own_folder);
    if (!owner.empty()) return fmt::format("is {}; name another file", owner);
    if (target.kind == Output::text && has_other_names(target.path))
        return "has other names (hard links), of which one may be a run's; name another file";
    const FileContent content = content_of(target.path);
    if (may_replace(target.kind, content)) return {};
    return fmt::format("is {}, which {} does not replace; name another file, or remove this one",
                       words_for(content), target.name);
}

} // namespace

std::vector<Problem> problems_with(const std::vector<Destination>& destinations,
                                   const std::vector<NamedFile>& sources,
                                   const std::string& own_folder) {
    std::vector<Problem> problems;
    for (std::size_t k = 0; k < destinations.size(); ++k) {
        const Destination& target = destinations[k];
        const auto refuse = [&](const std::string& why) {
            problems.push_back({fmt::format("{} {}", target.name, target.path), 0, why});
        };
        if (is_special(target.path)) {
            if (target.kind != Output::text) refuse("is not a plain file");
            continue;
        }
        const std::size_t n_before = problems.size();
        // Only a folder may be both output and source, because a restart reads its own folder
        for (const NamedFile& source : sources)
            if (target.kind != Output::folder && is_same_file(target.path, source.path))
                refuse(fmt::format("is {} itself", source.name));
        for (std::size_t other = 0; other < k; ++other)
            if (is_same_file(target.path, destinations[other].path))
                refuse(fmt::format("is the same file as {}; each needs its own",
                                   destinations[other].name));
        if (problems.size() > n_before) continue;
        if (const std::string reason = reason_against(target, own_folder); !reason.empty())
            refuse(reason);
    }
    return problems;
}

} // namespace carrom
