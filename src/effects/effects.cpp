// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/effects/effects.hpp"

#include <fmt/format.h>

namespace carrom {

Effects per_micro_step(const Effects& effects, double micro_steps) {
    Effects scaled = effects;
    scaled.contact.contact_time *= micro_steps;
    return scaled;
}

std::string description(const Effects& effects) {
    switch (effects.contact.kind) {
    case ContactKind::elastic: return {};
    case ContactKind::none: return "discs pass through each other";
    case ContactKind::restitution:
        return fmt::format("restitution {:g} of pairs, contact time {:g}", effects.contact.restitution, effects.contact.contact_time);
    }
    return {};
}

} // namespace carrom
