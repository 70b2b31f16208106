// SPDX-License-Identifier: BSD-3-Clause
// From what a scene asks for to the law that engines are compiled for: the one place where the choice is made.
#pragma once

#include <type_traits>

#include "carrom/effects/laws.hpp"
#include "carrom/scene/scene.hpp"

namespace carrom {

/// Calls `make.template operator()<Law>()` with the scene's law and returns what it gives, the same type for every law.
/// Effects have the default precision and arithmetic: the reader of scenes sees to that.
template <class Make> auto with_law_of(const Scene& scene, const Make& make) {
    const bool is_periodic = scene.effects.are_periodic();
    if (scene.effects.contact.kind == ContactKind::rough)
        return is_periodic ? make.template operator()<PeriodicRoughLaw>() : make.template operator()<RoughLaw>();
    if (!scene.effects.classes.empty()) return is_periodic ? make.template operator()<PeriodicMixedLaw>() : make.template operator()<MixedLaw>();
    if (is_periodic) {
        switch (scene.effects.contact.kind) {
        case ContactKind::none: return make.template operator()<PeriodicIdealGasLaw>();
        case ContactKind::restitution: return make.template operator()<PeriodicInelasticLaw>();
        case ContactKind::rough: // above
        case ContactKind::elastic: return make.template operator()<PeriodicElasticLaw>();
        }
    }
    switch (scene.effects.contact.kind) {
    case ContactKind::none: return make.template operator()<IdealGasLaw>();
    case ContactKind::restitution: return make.template operator()<InelasticLaw>();
    case ContactKind::rough: // above
    case ContactKind::elastic:
        if (scene.effects.are_any()) return make.template operator()<ElasticLaw>();
    }
    const auto with = [&]<class Real>(Real) {
        if (scene.arithmetic == Arithmetic::stable) return make.template operator()<BasicPlainLaw<Real, StableContact>>();
        return scene.contraction ? make.template operator()<BasicPlainLaw<Real, NaiveContact<true>>>()
                                 : make.template operator()<BasicPlainLaw<Real, NaiveContact<false>>>();
    };
    return scene.precision == Precision::single ? with(float{}) : with(double{});
}

/// The law with the scene's numbers.
template <class Law> Law law_of(const Scene& scene) {
    if constexpr (std::is_constructible_v<Law, double, double, const Effects&>)
        return Law(scene.box_size, scene.radius, per_micro_step(scene.effects, static_cast<double>(scene.micro_steps)));
    else return Law(scene.box_size, scene.radius);
}

} // namespace carrom
