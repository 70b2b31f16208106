// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/subcommands.hpp"

#include <cstdio>
#include <memory>

#include "scene/key_page.hpp"

namespace carrom {

Subcommand keys_subcommand() {
    const auto rules_alone = std::make_shared<bool>(false);
    return {"keys",
            "Print the reference of scene keys, docs/reference/keys.md",
            "",
            {{"--conflicts", "", "Print what does not go together, docs/reference/conflicts.md",
              rules_alone.get()}},
            [rules_alone](std::vector<Problem>&) -> Action {
                return {[is_short = *rules_alone](const Communicator& ranks) {
                    const std::string text = is_short ? conflicts_page() : key_page();
                    if (ranks.is_root()) std::fputs(text.c_str(), stdout);
                    return ExitCode::success;
                }};
            }};
}

} // namespace carrom
