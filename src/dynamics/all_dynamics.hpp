// SPDX-License-Identifier: BSD-3-Clause
// All dynamics that kernels and engines are compiled for. engine/dynamics_of_scene.hpp chooses one
// of them. Each costs some seconds of compile time, so choices that are not made for each pair are
// made at run time.
#pragma once

#include "dynamics/dynamics.hpp"
#include "dynamics/studied_arithmetic.hpp"

namespace carrom {

/// The dynamics of a scene that names no effect: free flight, elastic pairs, four elastic walls at
/// rest (docs/understanding/method.md, sections 3 and 4).
using PlainDynamics = Dynamics<WalledSpace, EqualBodies, PlainSurroundings<>>;
/// The plain dynamics in less accurate arithmetic.
template <class Real>
using StudyDynamics =
    Dynamics<WalledSpace, EqualBodies, PlainSurroundings<StudiedArithmetic<Real>>>;

using WalledDynamics = Dynamics<WalledSpace, EqualBodies>;
using WalledMixedDynamics = Dynamics<WalledSpace, SpeciesBodies>;
using PeriodicDynamics = Dynamics<PeriodicSpace, EqualBodies>;
using PeriodicMixedDynamics = Dynamics<PeriodicSpace, SpeciesBodies>;
/// For one species or several. The box may have walls only, and then no images.
using GrowingDynamics = Dynamics<PeriodicSpace, GrowingBodies>;
/// One species or several.
using ShearedDynamics = Dynamics<ShearedSpace, SpeciesBodies>;

// Calls make(dynamics) for each of these dynamics.
#define CARROM_FOR_EACH_DYNAMICS(make)                                                             \
    make(PlainDynamics) make(StudyDynamics<double>) make(StudyDynamics<float>)                     \
        make(WalledDynamics) make(WalledMixedDynamics) make(PeriodicDynamics)                      \
            make(PeriodicMixedDynamics) make(GrowingDynamics) make(ShearedDynamics)

} // namespace carrom
