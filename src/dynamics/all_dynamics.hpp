// SPDX-License-Identifier: BSD-3-Clause
// Every law that kernels and engines are compiled for. simulation/law_of_scene.hpp chooses among
// them.
#pragma once

#include "dynamics/effect_dynamics.hpp"
#include "dynamics/periodic_dynamics.hpp"
#include "dynamics/plain_dynamics.hpp"

// make(law) for each.
#define CARROM_FOR_EACH_PERIODIC_DYNAMICS(make)                                                    \
    make(PeriodicElasticDynamics) make(PeriodicIdealGasDynamics) make(PeriodicInelasticDynamics)   \
        make(PeriodicMixedDynamics) make(PeriodicRoughDynamics)
#define CARROM_FOR_EACH_DYNAMICS(make)                                                             \
    make(PlainDynamics) make(NaiveDynamics) make(ContractedDynamics) make(SingleDynamics)          \
        make(SingleNaiveDynamics) make(SingleContractedDynamics) make(ElasticDynamics)             \
            make(IdealGasDynamics) make(InelasticDynamics) make(MixedDynamics) make(RoughDynamics) \
                CARROM_FOR_EACH_PERIODIC_DYNAMICS(make)
