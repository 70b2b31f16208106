// SPDX-License-Identifier: BSD-3-Clause
// A side through which discs leave the box. They come back only through inlets.
#include "scene/boundaries/boundary.hpp"
#include "scene/rule_parts.hpp"

namespace carrom::boundaries {

BoundaryDeclaration open() {
    return {.kind = BoundaryKind::open,
            .help = "discs leave the box",
            .rules = {rule("an open side", "walls that move",
                           "an open side needs walls at rest: discs leave where the box ends at "
                           "its start",
                           BoundaryKind::open,
                           [](const SceneParameters& s) {
                               return has_open(s) && !are_walls_at_rest(s.effects);
                           })},
            .summary = [](const Boundary&, std::string_view name) {
                return fmt::format("{} side open", name);
            }};
}

} // namespace carrom::boundaries
