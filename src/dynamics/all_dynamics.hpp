// SPDX-License-Identifier: BSD-3-Clause
// All dynamics that kernels and engines are compiled for. engine/dynamics_of_scene.hpp
// chooses one of them. Each costs some seconds of compile time, so questions that are
// not asked for each pair are answered at run time.
#pragma once

#include "dynamics/dynamics.hpp"
#include "dynamics/effect_dynamics.hpp"
#include "dynamics/growing_dynamics.hpp"
#include "dynamics/periodic_dynamics.hpp"
#include "dynamics/plain_dynamics.hpp"
#include "dynamics/resting_dynamics.hpp"
#include "dynamics/sheared_dynamics.hpp"
#include "dynamics/study_dynamics.hpp"

// Calls make(dynamics) for each of them.
#define CARROM_FOR_EACH_DYNAMICS(make)                                                             \
    make(PlainDynamics) make(StudyDynamics<double>) make(StudyDynamics<float>)                     \
        make(InelasticDynamics) make(MixedDynamics) make(RoughDynamics)                            \
            make(PeriodicElasticDynamics) make(PeriodicInelasticDynamics)                          \
                make(PeriodicMixedDynamics) make(PeriodicRoughDynamics) make(GrowingDynamics)      \
                    make(ShearedMixedDynamics) make(ShearedRoughDynamics)              \
                        make(RestingMixedDynamics) make(RestingRoughDynamics)

namespace carrom {

#define CARROM_CHECK(name) static_assert(Dynamics<name>);
CARROM_FOR_EACH_DYNAMICS(CARROM_CHECK)
#undef CARROM_CHECK

} // namespace carrom
