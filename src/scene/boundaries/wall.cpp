// SPDX-License-Identifier: BSD-3-Clause
// A wall at rest.
#include "scene/boundaries/boundary.hpp"

namespace carrom::boundaries {

BoundaryDeclaration wall() {
    return {.kind = BoundaryKind::wall,
            .help = "at rest",
            .has_restitution = true,
            .takes_growing_discs = true,
            .runs_on_gpu =
                [](const Boundary& side) { return side.restitution == 1 && !side.surface.rubs(); },
            .summary =
                [](const Boundary& side, std::string_view name) {
                    return fmt::format("{} wall{}", name, loss_text(side));
                }};
}

} // namespace carrom::boundaries
