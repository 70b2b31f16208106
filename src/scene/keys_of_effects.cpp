// SPDX-License-Identifier: BSD-3-Clause
#include "scene/boundaries/boundary.hpp"

namespace carrom {

std::vector<Key> keys_of_effects() {
    std::vector<Key> all = keys_of_boundaries();
    const auto add = [&all](const std::vector<Key>& part) {
        all.insert(all.end(), part.begin(), part.end());
    };
    for (const EffectDeclaration& one : all_effects()) add(one.keys);
    for (const BoundaryDeclaration& one : all_boundaries()) add(one.keys);
    return all;
}

} // namespace carrom
