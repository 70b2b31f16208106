// SPDX-License-Identifier: BSD-3-Clause
// A side beyond which the box repeats itself. The opposite side must be of the same kind.
#include <cmath>

#include "scene/boundaries/boundary.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

/// Whether one of two opposite sides is periodic without the other.
bool is_half_periodic(const SceneParameters& s, std::size_t low) {
    const auto& sides = s.effects.boundaries;
    return (sides[low].kind == BoundaryKind::periodic) !=
           (sides[low + 1].kind == BoundaryKind::periodic);
}

std::vector<Rule> rules_of_periodic_sides() {
    return {
        rule("a periodic side", "an open side", "this version does not have both",
             BoundaryKind::periodic,
             [](const SceneParameters& s) { return s.effects.are_periodic() && has_open(s); }),
        rule("a periodic side", "walls or an open side opposite (left, right)",
             "box.left.kind and box.right.kind must both be \"periodic\", or neither",
             {"box.left.kind", "box.right.kind"},
             [](const SceneParameters& s) { return is_half_periodic(s, 0); }),
        rule("a periodic side", "walls or an open side opposite (bottom, top)",
             "box.bottom.kind and box.top.kind must both be \"periodic\", or neither",
             {"box.bottom.kind", "box.top.kind"},
             [](const SceneParameters& s) { return is_half_periodic(s, 2); }),
    };
}

/// Checks that each period is longer than two diameters, so that a disc cannot touch another one on
/// both sides at once. Sheared sides count as periodic here.
void check_periodic_box(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    const Periods periods = scene.effects.periods(scene.box);
    const double period = periods.shortest();
    const double least = 4 * scene.radius * (1 + 1e-6);
    if (!periods.are_any() || period >= least) return;
    draft.refuse({side_key(periods.x == period ? 0 : 2, "kind")},
                 fmt::format("a box of side {} is too small to be periodic: it must be at least "
                             "{}, two diameters and a millionth of them, so that a disc cannot "
                             "touch another one on both sides at once",
                             period, least));
}

/// Limits the number of images of a disc. The engines search for partners up to the mean
/// distance between discs, and each period within it gives one more image of the disc itself.
void check_images(const SceneDraft& draft) {
    constexpr double most = 0x1p20;
    const SceneParameters& scene = draft.scene;
    const Periods periods = scene.effects.periods(scene.box);
    const double period = periods.shortest();
    if (!periods.are_any() || scene.n_discs == 0) return;
    const double apart = std::sqrt(scene.box.x / static_cast<double>(scene.n_discs)) *
                         std::sqrt(scene.box.y);
    if (apart <= most * period) return;
    draft.refuse({"box.size"},
                 fmt::format("the periodic side {} is too short beside the other one: discs are "
                             "{:.3g} apart on average, and may be 2^20 such sides apart at most",
                             period, apart));
}

} // namespace

namespace boundaries {

BoundaryDeclaration periodic() {
    return {.kind = BoundaryKind::periodic,
            .help = "in pairs, the box repeats itself",
            .takes_growing_discs = true,
            .runs_on_gpu = [](const Boundary&) { return true; },
            .rules = rules_of_periodic_sides(),
            .check_room =
                [](const SceneDraft& draft) {
                    check_periodic_box(draft);
                    check_images(draft);
                },
            .summary = [](const Boundary&,
                          std::string_view name) { return fmt::format("{} side periodic", name); }};
}

} // namespace boundaries

} // namespace carrom
