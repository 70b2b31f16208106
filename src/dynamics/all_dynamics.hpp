// SPDX-License-Identifier: BSD-3-Clause
// All types of dynamics for which kernels and engines are compiled. engine/dynamics_of_scene.hpp
// chooses one of them for each scene. Each type adds some seconds of compile time. So only choices
// that would otherwise be made for each pair are made at compile time, all others at run time.
#pragma once

#include "dynamics/dynamics.hpp"
#include "dynamics/studied_arithmetic.hpp"

namespace carrom {

/// The dynamics of a scene that names no effect: free flight, elastic pairs, four elastic walls at
/// rest (docs/understanding/method.md, sections 3 and 4).
using PlainDynamics = Dynamics<WalledSpace, EqualBodies, PlainSurroundings<>>;
/// The plain dynamics with less accurate arithmetic, for studies of errors.
template <class Real>
using StudyDynamics =
    Dynamics<WalledSpace, EqualBodies, PlainSurroundings<StudiedArithmetic<Real>>>;

using WalledDynamics = Dynamics<WalledSpace, EqualBodies>;
using WalledMixedDynamics = Dynamics<WalledSpace, SpeciesBodies>;
using PeriodicDynamics = Dynamics<PeriodicSpace, EqualBodies>;
using PeriodicMixedDynamics = Dynamics<PeriodicSpace, SpeciesBodies>;
/// Discs of one or several species that may grow, in boxes with or without periodic sides.
using GrowingDynamics = Dynamics<PeriodicSpace, GrowingBodies>;
/// Sheared boxes use this type even if there is only one species.
using ShearedDynamics = Dynamics<ShearedSpace, SpeciesBodies>;

// Calls make(Type) for each type of dynamics.
#define CARROM_FOR_EACH_DYNAMICS(make)                                                             \
    make(PlainDynamics) make(StudyDynamics<double>) make(StudyDynamics<float>)                     \
        make(WalledDynamics) make(WalledMixedDynamics) make(PeriodicDynamics)                      \
            make(PeriodicMixedDynamics) make(GrowingDynamics) make(ShearedDynamics)

} // namespace carrom
