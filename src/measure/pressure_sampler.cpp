// SPDX-License-Identifier: BSD-3-Clause
#include "measure/pressure_sampler.hpp"

#include <array>

#include "core/errors.hpp"

namespace carrom {

namespace {

std::array<ExactSum*, 3> parts_of(PairVirial& virial) {
    return {&virial.xx, &virial.xy, &virial.yy};
}

} // namespace

PressureSampler::PressureSampler(Simulation& simulation, const Communicator& ranks)
    : simulation_(&simulation), ranks_(&ranks), last_virial_(simulation.virial()) {}

PressureSampler::PressureSampler(Simulation& simulation, const Communicator& ranks,
                                 SampleSums& sums)
    : PressureSampler(simulation, ranks) {
    sums.virial_bound = simulation.virial_bound();
    last_ = simulation.motion();
}

PressureSampler PressureSampler::going_on(Simulation& simulation, const Communicator& ranks,
                                          SampleSums& sums) {
    simulation.begin_virial(sums.virial_bound);
    PressureSampler sampler(simulation, ranks);
    if (sums.pending_virial.size() != 6 || sums.last_motion.size() != 5)
        throw InputError({{"[output.measurements]", 0,
                           "the checkpoint's measurements of "
                           "\"pressure\" are not whole"}});
    const std::vector<double>& m = sums.last_motion;
    sampler.last_ = {{m[0], m[1], m[2]}, m[3], m[4], 0};
    if (ranks.is_root()) {
        PairVirial pending(sums.virial_bound);
        std::size_t next = 0;
        for (ExactSum* part : parts_of(pending)) {
            part->add_words(sums.pending_virial[next], sums.pending_virial[next + 1]);
            next += 2;
        }
        sampler.last_virial_ -= pending;
    }
    sums.pending_virial.clear();
    sums.last_motion.clear();
    return sampler;
}

/// Over all ranks. **Collective.**
PairVirial PressureSampler::since_last() const {
    PairVirial since = simulation_->virial();
    since -= last_virial_;
    for (ExactSum* part : parts_of(since)) ranks_->sum(*part);
    return since;
}

void PressureSampler::sample(SampleSums& sums, double steps) {
    const MotionNow now = simulation_->motion();
    const PairVirial virial = since_last();
    const double area = (last_.area + now.area) / 2, unit = simulation_->velocity_unit() / steps;
    const auto mean = [this, &now](double Tensor::* part) {
        return (last_.flux.*part + now.flux.*part) / 2;
    };
    const double energy = (mean(&Tensor::xx) + mean(&Tensor::yy)) / 2; // N kT
    const double n_discs = (last_.n_discs + now.n_discs) / 2;
    for (const double number :
         {(mean(&Tensor::xx) + unit * virial.xx.value()) / area,
          (mean(&Tensor::xy) + unit * virial.xy.value()) / area,
          (mean(&Tensor::yy) + unit * virial.yy.value()) / area, energy / n_discs, energy / area})
        sums.pressures.push_back(number);
    last_virial_ = simulation_->virial();
    last_ = now;
}

void PressureSampler::store(SampleSums& sums) const {
    PairVirial since = since_last();
    for (const ExactSum* part : parts_of(since)) {
        sums.pending_virial.push_back(part->low_word());
        sums.pending_virial.push_back(part->high_word());
    }
    sums.last_motion = {last_.flux.xx, last_.flux.xy, last_.flux.yy, last_.n_discs, last_.area};
}

} // namespace carrom
