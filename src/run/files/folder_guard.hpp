// SPDX-License-Identifier: BSD-3-Clause
// Ends a run whose folder was moved, removed or replaced while the run wrote there.
//
// Files are opened by their paths, so the run would otherwise continue in any folder that has taken
// the name, such as another run's, or an empty one where a disk is no longer mounted. So the guard
// tests whether the path of the lock file still leads to the open lock file. Cost: two system calls
// and a reduction for each stretch of steps, in runs with a folder.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "io/write_lock.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/advance.hpp"

namespace carrom {

/// The first action of a run, so that no other action writes before the test of the folder.
class FolderGuard : public StepAction {
public:
    /// `locks` are the locks that rank 0 holds. All arguments must outlive this.
    FolderGuard(std::span<const WriteLock> locks, const SceneParameters& scene,
                const Communicator& ranks)
        : locks_(locks), scene_(scene), ranks_(ranks) {}

    std::int64_t next_due(std::int64_t) const override {
        return std::numeric_limits<std::int64_t>::max();
    }
    /// If the folder is no longer the run's, every rank throws CollectiveError, code 4.
    /// **Collective.**
    bool act() override {
        commit();
        return true;
    }
    void commit() override;

private:
    std::span<const WriteLock> locks_;
    const SceneParameters& scene_;
    const Communicator& ranks_;
};

} // namespace carrom
