// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "engine.hpp"
#include "measurements.hpp"

namespace carrom {

Simulation::Simulation(const Scene& scene, std::vector<InputDisc> discs, const Communicator& communicator,
                       const Tuning& tuning)
    : engine_(std::make_unique<Engine>(scene, std::move(discs), communicator, tuning)) {}

Simulation::~Simulation() = default;

void Simulation::advance_towards(std::int64_t last_step) { engine_->advance_towards(last_step); }

std::int64_t Simulation::step() const { return engine_->step(); }

std::span<const Disc> Simulation::discs() const { return engine_->own(); }

double Simulation::clock() const { return engine_->clock(); }

double Simulation::velocity_unit() const { return static_cast<double>(engine_->micro_steps()); }

Totals Simulation::totals() const {
    const Communicator& communicator = engine_->communicator();
    Totals totals;
    totals.n_discs = engine_->n_discs();
    totals.rejected_candidates = communicator.sum(engine_->n_rejected());
    measure_collisions(engine_->own(), communicator, totals);
    measure_motion(engine_->own(), velocity_unit(), communicator, totals);
    engine_->settle_now();
    totals.overlapping_pairs = count_overlaps(engine_->population(), engine_->grid(), engine_->clock(), engine_->law(),
                                              communicator, engine_->n_threads());
    return totals;
}

PhaseSeconds Simulation::phase_seconds() const { return engine_->phases().seconds(); }

} // namespace carrom
