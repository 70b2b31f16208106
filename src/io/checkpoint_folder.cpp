// SPDX-License-Identifier: BSD-3-Clause
#include "io/checkpoint_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "io/files.hpp"

namespace carrom {

namespace {

constexpr std::string_view prefix = "checkpoint-", suffix = ".h5";

std::optional<FoundFile> as_checkpoint(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    std::string_view rest = name;
    FoundFile found{path.string(), 0};
    if (!rest.starts_with(prefix) || !rest.ends_with(suffix) ||
        rest.size() <= prefix.size() + suffix.size())
        return std::nullopt;
    rest = rest.substr(prefix.size(), rest.size() - prefix.size() - suffix.size());
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), found.step);
    if (error != std::errc{} || end != rest.data() + rest.size()) return std::nullopt;
    return found;
}

} // namespace

std::string checkpoint_path(const std::string& folder, std::int64_t step) {
    return (std::filesystem::path(folder) / fmt::format("{}{:012}{}", prefix, step, suffix))
        .string();
}

bool is_named_as_checkpoint(const std::string& path) {
    const std::string name = std::filesystem::path(path).filename().string();
    const std::optional<FoundFile> found = as_checkpoint(name);
    return found && name == checkpoint_path("", found->step);
}

std::vector<FoundFile> find_checkpoints(const std::string& folder) {
    std::vector<FoundFile> found;
    std::error_code error;
    std::filesystem::directory_iterator entry(folder, error);
    if (error == std::errc::no_such_file_or_directory) return found;
    for (const std::filesystem::directory_iterator end; !error && entry != end;
         entry.increment(error))
        if (auto file = as_checkpoint(entry->path())) found.push_back(std::move(*file));
    if (error) throw FileError("cannot be listed: " + error.message());
    std::sort(found.begin(), found.end(), [](const FoundFile& a, const FoundFile& b) {
        return a.step != b.step ? a.step > b.step : a.path < b.path;
    });
    return found;
}

WriteProblem write_problem_of_folder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return write_problem("cannot be made", error.value());
    const std::string probe = (std::filesystem::path(folder) / name_beside()).string();
    const int file = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return write_problem("no file can be made there", errno);
    ::close(file);
    ::unlink(probe.c_str());
    return {};
}

} // namespace carrom
