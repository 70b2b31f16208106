// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/folder_guard.hpp"

#include <algorithm>

#include "io/files.hpp"

namespace carrom {

void FolderGuard::commit() {
    if (scene_.folder.empty()) return;
    on_root(ranks_, "output.folder " + scene_.folder, ExitCode::output_failure, [&] {
        if (std::any_of(locks_.begin(), locks_.end(),
                        [](const auto& lock) { return lock.is_lost(); }))
            throw FileError("it, or its lock, was moved, removed or replaced while the run wrote "
                            "there; bring it back, then go on by --resume");
    });
}

} // namespace carrom
