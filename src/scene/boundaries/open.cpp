// SPDX-License-Identifier: BSD-3-Clause
// A side through which discs leave the box for ever.
#include "scene/boundaries/boundary.hpp"

namespace carrom::boundaries {

BoundaryDeclaration open() {
    return {.kind = BoundaryKind::open,
            .help = "discs leave the box",
            .summary = [](const Boundary&, std::string_view name) {
                return fmt::format("{} side open", name);
            }};
}

} // namespace carrom::boundaries
