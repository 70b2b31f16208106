// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/scene/scene.hpp"

#include <filesystem>
#include <numbers>

namespace carrom {

double Scene::packing() const {
    const double share = radius / box_size;
    return static_cast<double>(n_discs) * std::numbers::pi * share * share;
}

std::string discs_path(const Scene& scene) {
    return (std::filesystem::path(scene.name).parent_path() / scene.discs_file).string();
}

} // namespace carrom
