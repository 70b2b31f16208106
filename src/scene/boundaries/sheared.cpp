// SPDX-License-Identifier: BSD-3-Clause
// A periodic side whose images move. The shear rate and the rules of conflict are declared with
// the flow (scene/effects/shear.cpp), because the bottom and the top side share them.
#include "scene/boundaries/boundary.hpp"

namespace carrom::boundaries {

BoundaryDeclaration sheared() {
    return {.kind = BoundaryKind::sheared,
            .help = "bottom and top, periodic with images that move",
            .summary = [](const Boundary&, std::string_view name) {
                return fmt::format("{} side sheared", name);
            }};
}

} // namespace carrom::boundaries
