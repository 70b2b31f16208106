// SPDX-License-Identifier: BSD-3-Clause
// A broken invariant of a disc. Ranks compare their findings, and one finding is reported.
#pragma once

#include <cstdint>
#include <string>

#include "check/check_failure.hpp"
#include "core/disc_state.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// The meaning of `partner`, `value` and `bound` depends on the invariant (see text_of).
struct Finding {
    Finding() = default; ///< no broken invariant
    Finding(Invariant broken, int owner, DiscId id, double how_much = 0, double allowed = 0,
            DiscId other = 0)
        : invariant(broken), rank(owner), is_found(1), disc(id), partner(other), value(how_much),
          bound(allowed) {}

    Invariant invariant{};
    int rank = 0;
    int is_found = 0;
    DiscId disc = 0, partner = 0;
    double value = 0, bound = 0;
};

/// The error message. `body` names the fixed body that a disc overlaps, if there is one.
std::string text_of(const Finding& finding, const SceneParameters& scene, const std::string& body,
                    std::int64_t step);

} // namespace carrom
