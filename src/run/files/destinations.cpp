// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/destinations.hpp"

#include <filesystem>

#include <fmt/format.h>

namespace carrom {

namespace {

/// Also if files do not exist yet, and through links and other spellings.
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

} // namespace

std::vector<Problem> problems_with(const std::vector<NamedFile>& destinations,
                                   const std::vector<NamedFile>& sources) {
    std::vector<Problem> problems;
    for (std::size_t k = 0; k < destinations.size(); ++k) {
        const NamedFile& target = destinations[k];
        const auto refuse = [&](const std::string& why) {
            problems.push_back({fmt::format("{} {}", target.name, target.path), 0, why});
        };
        if (is_special(target.path)) {
            if (!target.may_be_special) refuse("is not a plain file");
            continue;
        }
        for (const NamedFile& source : sources)
            if (is_same_file(target.path, source.path))
                refuse(fmt::format("is {} itself", source.name));
        for (std::size_t other = 0; other < k; ++other)
            if (is_same_file(target.path, destinations[other].path))
                refuse(fmt::format("is the same file as {}; each needs its own",
                                   destinations[other].name));
    }
    return problems;
}

} // namespace carrom
