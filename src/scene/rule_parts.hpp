// SPDX-License-Identifier: BSD-3-Clause
// Conditions on scenes, and functions that make rules from them.
#pragma once

#include "scene/key.hpp"
#include "scene/limits.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

inline bool is_time_stepped(const SceneParameters& s) { return s.method == Method::time_stepped; }
inline bool is_rough(const SceneParameters& s) {
    return s.effects.contact.kind == ContactKind::rough;
}
inline bool has_species(const SceneParameters& s) { return !s.effects.species.empty(); }
inline bool has_open(const SceneParameters& s) { return s.effects.have_open_boundaries(); }
inline bool has_moving(const SceneParameters& s) {
    return has_boundary(s.effects, BoundaryKind::moving);
}
/// Whether there are fixed bodies, or discs that will freeze and become fixed bodies.
inline bool has_fixed_bodies(const SceneParameters& s) {
    return s.effects.fixed_bodies.are_any() || s.freezes();
}
inline bool has_effects(const SceneParameters& s) { return s.effects.are_any() || s.freezes(); }
/// Ends the message "... has no meaning ..." for keys that need an obstacle.
inline constexpr const char* no_obstacles =
    "without 'effects.obstacles.discs', 'segments', 'arcs', 'polygons' or a 'box.shape'";
inline bool has_growing_discs(const SceneParameters& s) { return s.effects.growth != 0; }
inline bool has_barostat(const SceneParameters& s) { return s.effects.barostat.is_on(); }
inline bool is_periodic_all_round(const SceneParameters& s) {
    return s.effects.is_periodic_x() && s.effects.is_periodic_y();
}

using RuleKeys = std::vector<std::string_view>;
using IsBroken = bool (*)(const SceneParameters&);

inline Rule rule(std::string_view one, std::string_view other, std::string_view why,
                 const RuleKeys& keys, IsBroken is_broken) {
    return {one, other, why, keys, {}, is_broken};
}
inline Rule rule(std::string_view one, std::string_view other, std::string_view why,
                 BoundaryKind side, IsBroken is_broken) {
    return {one, other, why, {}, side, is_broken};
}

} // namespace carrom
