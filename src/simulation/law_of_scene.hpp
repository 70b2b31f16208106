// SPDX-License-Identifier: BSD-3-Clause
// From the precision and the arithmetic that a scene asks for to the law that engines are compiled for.
#pragma once

#include "carrom/effects/plain_law.hpp"
#include "carrom/scene/scene.hpp"

namespace carrom {

/// Calls `make.template operator()<Law>()` with the scene's law and returns what it gives, the same type for every law.
template <class Make> auto with_law_of(const Scene& scene, const Make& make) {
    const auto with = [&]<class Real>(Real) {
        if (scene.arithmetic == Arithmetic::stable) return make.template operator()<BasicPlainLaw<Real, StableContact>>();
        return scene.contraction ? make.template operator()<BasicPlainLaw<Real, NaiveContact<true>>>()
                                 : make.template operator()<BasicPlainLaw<Real, NaiveContact<false>>>();
    };
    return scene.precision == Precision::single ? with(float{}) : with(double{});
}

} // namespace carrom
