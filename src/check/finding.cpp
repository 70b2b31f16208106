// SPDX-License-Identifier: BSD-3-Clause
#include "check/finding.hpp"

#include <fmt/format.h>

namespace carrom {

std::string text_of(const Finding& f, const SceneParameters& scene, const std::string& body,
                    std::int64_t step) {
    std::string who = fmt::format("check failed at step {}: disc {} on rank {} ", step, f.disc,
                                  f.rank);
    switch (f.invariant) {
    case Invariant::finite: return who + "has a number in its state that is not finite";
    case Invariant::owned_once:
        if (f.disc >= scene.n_discs)
            return who + fmt::format("does not exist: ids end at {}", scene.n_discs - 1);
        return who + (f.value == 0 ? "is owned by no rank any more"
                                   : fmt::format("is owned {} times", f.value));
    case Invariant::radius:
        return who + fmt::format("has the radius {:.17g} in its column, and collides with {:.17g}",
                                 f.value, f.bound);
    case Invariant::in_box:
        return who +
               fmt::format("is {:.3g} outside the box; rounding explains {:.3g}", f.value, f.bound);
    case Invariant::departed:
        if (f.partner == 0)
            return who + fmt::format("has departed, and is {:.3g} from where open sides let it go; "
                                     "rounding explains {:.3g}",
                                     f.value, f.bound);
        return who + (f.value < 0 ? "has departed without going through an open side"
                                  : "has come back into the box, and no inlet has let it in");
    case Invariant::in_domain: return who + fmt::format("is in the domain of rank {}", f.value);
    case Invariant::in_cell: return who + "is not in the cell that it is filed under";
    case Invariant::clear:
        return who + fmt::format("overlaps {} by {:.3g}; rounding explains {:.3g}", body, f.value,
                                 f.bound);
    case Invariant::counters:
        return who + fmt::format("has counted {} collisions with {} in this step, but had {}",
                                 f.value, f.partner == 0 ? "walls" : "discs", f.bound);
    case Invariant::motion:
        return who + fmt::format("has changed its {} by {:.3g} a micro-step without a collision",
                                 f.partner == 0 ? "velocity" : "spin", f.value);
    case Invariant::overlap:
        return who +
               fmt::format(
                   "overlaps disc {} by {:.3g}{}; rounding explains {:.3g}", f.partner, f.value,
                   scene.method == Method::time_stepped ? ", though both were free to collide" : "",
                   f.bound);
    case Invariant::energy:
        return who + fmt::format("is the first of some whose energy together has changed by a "
                                 "share of {:.3g}; rounding explains {:.3g}",
                                 f.value, f.bound);
    }
    return who;
}

} // namespace carrom
