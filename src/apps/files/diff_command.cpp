// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/subcommands.hpp"

#include <array>
#include <memory>

#include <fmt/format.h>

#include "io/checkpoint.hpp"
#include "io/frame_file.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

/// Runs `carrom diff`. **Collective.**
ExitCode diff(const std::array<std::string, 2>& paths, const Communicator& ranks) {
    for (const std::string& path : paths) check_damage(path, ranks);
    int is_same = 1;
    let_root(ranks, [&] {
        const FileDifference difference = compare_files(paths[0], paths[1]);
        is_same = difference.is_same ? 1 : 0;
        if (difference.is_same) return;
        fmt::print("first: {}\nlargest: {} ({})\n", difference.first, difference.largest,
                   difference.largest_in);
    });
    ranks.broadcast(is_same);
    return is_same == 1 ? ExitCode::success : ExitCode::difference;
}

} // namespace

Subcommand diff_subcommand() {
    constexpr const char* examples = R"(Examples:
  carrom diff kept/checkpoint-000000001000.h5 other/checkpoint-000000001000.h5
  carrom diff a.h5 b.h5 && echo the same to the bit)";
    const auto paths = std::make_shared<std::array<std::string, 2>>();
    const auto action = [paths](std::vector<Problem>&) -> Action {
        return {[paths](const Communicator& ranks) { return diff(*paths, ranks); }};
    };
    return {"diff",
            "Compare two files; exit code 1 if they differ",
            examples,
            {{"A", "", help_of_file, &(*paths)[0], true},
             {"B", "", "Another of the same kind", &(*paths)[1], true}},
            action};
}

} // namespace carrom
