// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene.hpp"

#include <algorithm>
#include <filesystem>
#include <numbers>

namespace carrom {

double Scene::packing() const {
    if (!effects.species.empty()) {
        double sum = 0;
        for (const Species& one : effects.species)
            sum += static_cast<double>(one.count) * std::numbers::pi * (one.radius / box.x) *
                   (one.radius / box.y);
        return sum;
    }
    return static_cast<double>(n_discs) * std::numbers::pi * (radius / box.x) * (radius / box.y);
}

double first_spin(const Scene& scene, DiscId id) {
    const auto run = std::upper_bound(
        scene.spins.begin(), scene.spins.end(), id,
        [](DiscId wanted, const SpinRun& one) { return wanted < one.end; });
    return run == scene.spins.end() ? 0 : run->spin;
}

std::string discs_path(const Scene& scene) {
    const std::string& name = scene.discs_from.empty() ? scene.discs_file : scene.discs_from;
    return (std::filesystem::path(scene.name).parent_path() / name).string();
}

} // namespace carrom
