// SPDX-License-Identifier: BSD-3-Clause
// From a scene to the dynamics that engines are compiled for: the one place where the choice is
// made.
#pragma once

#include <type_traits>

#include "dynamics/all_dynamics.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// Calls `make.template operator()<Dynamics>()` with the scene's dynamics and returns the result,
/// of one type for all. Effects have the default precision and arithmetic: the reader of scenes
/// checks that.
template <class Make> auto with_dynamics_of(const Scene& scene, const Make& make) {
    const bool is_periodic = scene.effects.are_periodic();
    if (scene.effects.contact.kind == ContactKind::rough)
        return is_periodic ? make.template operator()<PeriodicRoughDynamics>()
                           : make.template operator()<RoughDynamics>();
    if (!scene.effects.species.empty())
        return is_periodic ? make.template operator()<PeriodicMixedDynamics>()
                           : make.template operator()<MixedDynamics>();
    if (is_periodic) {
        switch (scene.effects.contact.kind) {
        case ContactKind::none: return make.template operator()<PeriodicIdealGasDynamics>();
        case ContactKind::restitution: return make.template operator()<PeriodicInelasticDynamics>();
        case ContactKind::rough: // above
        case ContactKind::elastic: return make.template operator()<PeriodicElasticDynamics>();
        }
    }
    switch (scene.effects.contact.kind) {
    case ContactKind::none: return make.template operator()<IdealGasDynamics>();
    case ContactKind::restitution: return make.template operator()<InelasticDynamics>();
    case ContactKind::rough: // above
    case ContactKind::elastic:
        if (scene.effects.are_any()) return make.template operator()<ElasticDynamics>();
    }
    const auto with = [&]<class Real>(Real) {
        if (scene.arithmetic == Arithmetic::stable)
            return make.template operator()<BasicPlainDynamics<Real, StableContact>>();
        return scene.contraction
                   ? make.template operator()<BasicPlainDynamics<Real, NaiveContact<true>>>()
                   : make.template operator()<BasicPlainDynamics<Real, NaiveContact<false>>>();
    };
    return scene.precision == Precision::single ? with(float{}) : with(double{});
}

/// The dynamics with the scene's numbers.
template <class Dynamics> Dynamics dynamics_of(const Scene& scene) {
    if constexpr (std::is_constructible_v<Dynamics, double, double, const Effects&>)
        return Dynamics(scene.box_size, scene.radius,
                        per_micro_step(scene.effects, static_cast<double>(scene.micro_steps)));
    else
        return Dynamics(scene.box_size, scene.radius);
}

} // namespace carrom
