// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/simulation/simulation.hpp"

#include <utility>

#include "engine.hpp"
#include "measurements.hpp"
#include "one_engine.hpp"

namespace carrom {

Simulation::Simulation(const Scene& scene, std::vector<InputDisc> discs, const Communicator& communicator,
                       const Tuning& tuning)
    : communicator_(communicator), velocity_unit_(static_cast<double>(scene.micro_steps)),
      engine_(std::make_unique<OneEngine>(scene, std::move(discs), communicator, tuning)) {}

Simulation::~Simulation() = default;

void Simulation::advance_towards(std::int64_t last_step) { engine_->advance_towards(last_step); }

std::int64_t Simulation::step() const { return engine_->step(); }

std::span<const Disc> Simulation::discs() const { return engine_->own(); }

double Simulation::clock() const { return engine_->clock(); }

Totals Simulation::totals() const {
    Totals totals;
    totals.n_discs = engine_->n_discs();
    measure_collisions(engine_->own(), communicator_, totals);
    measure_motion(engine_->own(), velocity_unit_, communicator_, totals);
    engine_->add_to(totals);
    return totals;
}

PhaseSeconds Simulation::phase_seconds() const { return engine_->phase_seconds(); }

} // namespace carrom
