// SPDX-License-Identifier: BSD-3-Clause
// Every law that kernels and engines are compiled for. simulation/law_of_scene.hpp chooses among them.
#pragma once

#include "carrom/effects/effect_law.hpp"
#include "carrom/effects/periodic_law.hpp"
#include "carrom/effects/plain_law.hpp"

// make(law) for each.
#define CARROM_FOR_EACH_PERIODIC_LAW(make) \
    make(PeriodicElasticLaw) make(PeriodicIdealGasLaw) make(PeriodicInelasticLaw) make(PeriodicMixedLaw) make(PeriodicRoughLaw)
#define CARROM_FOR_EACH_LAW(make) \
    make(PlainLaw) make(NaiveLaw) make(ContractedLaw) make(SingleLaw) make(SingleNaiveLaw) make(SingleContractedLaw) \
    make(ElasticLaw) make(IdealGasLaw) make(InelasticLaw) make(MixedLaw) make(RoughLaw) \
    CARROM_FOR_EACH_PERIODIC_LAW(make)
