// SPDX-License-Identifier: BSD-3-Clause
// Chooses, for a scene, one of the dynamics for which engines are compiled. No other code makes
// this choice.
#pragma once

#include "dynamics/all_dynamics.hpp"
#include "scene/key.hpp"

namespace carrom {

/// Calls `make.template operator()<D>()` with the scene's dynamics as D and returns its result,
/// which has the same type for every D. Scenes with effects always have the default precision and
/// arithmetic: the reader of scenes reports an error for any other.
template <class Make> auto with_dynamics_of(const SceneParameters& scene, const Make& make) {
    const Effects& effects = scene.effects;
    const bool has_species = !effects.species.empty();
    const bool radii_change = effects.growth != 0 || effects.barostat.is_on();
    if (radii_change) return make.template operator()<GrowingDynamics>();
    if (effects.are_sheared()) return make.template operator()<ShearedDynamics>();
    if (effects.are_periodic())
        return has_species ? make.template operator()<PeriodicMixedDynamics>()
                           : make.template operator()<PeriodicDynamics>();
    if (has_species) return make.template operator()<WalledMixedDynamics>();
    if (effects.are_any()) return make.template operator()<WalledDynamics>();
    if (scene.precision == Precision::single)
        return make.template operator()<StudyDynamics<float>>();
    return scene.arithmetic == Arithmetic::stable
               ? make.template operator()<PlainDynamics>()
               : make.template operator()<StudyDynamics<double>>();
}

inline ContactFormula contact_formula_of(const SceneParameters& scene) {
    if (scene.arithmetic == Arithmetic::stable) return ContactFormula::stable;
    return scene.contraction ? ContactFormula::naive_contracted : ContactFormula::naive;
}

/// The dynamics with the scene's parameters, converted to micro-steps as unit of time. `box` may
/// differ from the scene's box, because an effect may have changed its sides.
template <class D> D dynamics_of(const SceneParameters& scene, const Box& box) {
    return D(box, scene.radius, per_micro_step(scene), contact_formula_of(scene));
}
template <class D> D dynamics_of(const SceneParameters& scene) {
    return dynamics_of<D>(scene, scene.box);
}

} // namespace carrom
