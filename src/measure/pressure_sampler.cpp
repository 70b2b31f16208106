// SPDX-License-Identifier: BSD-3-Clause
#include "measure/pressure_sampler.hpp"

#include <array>

#include "core/errors.hpp"

namespace carrom {

namespace {

constexpr std::size_t n_words = 2 * 4; ///< words of StressSums
constexpr std::size_t n_numbers = 13;

std::vector<double> numbers_of(const MotionSample& l) {
    return {l.motion.xx, l.motion.xy,  l.motion.yy, l.momentum_x, l.momentum_y,
            l.mass,      l.speed_unit, l.n_discs,   l.area,       l.stress.xx,
            l.stress.xy, l.stress.yy,  l.energy};
}

MotionSample sample_of(const std::vector<double>& numbers) {
    MotionSample l;
    l.motion = {numbers[0], numbers[1], numbers[2]};
    l.momentum_x = numbers[3];
    l.momentum_y = numbers[4];
    l.mass = numbers[5];
    l.speed_unit = numbers[6];
    l.n_discs = numbers[7];
    l.area = numbers[8];
    l.stress = {numbers[9], numbers[10], numbers[11]};
    l.energy = numbers[12];
    return l;
}

} // namespace

PressureSampler::PressureSampler(Simulation& simulation, const Communicator& ranks)
    : simulation_(&simulation), ranks_(&ranks), last_sums_(simulation.stress_sums()) {}

PressureSampler::PressureSampler(Simulation& simulation, const Communicator& ranks,
                                 PressureSums& sums)
    : PressureSampler(simulation, ranks) {
    sums.virial_bound = simulation.stress_bound();
    begin_interval(simulation.motion_sample());
}

PressureSampler PressureSampler::going_on(Simulation& simulation, const Communicator& ranks,
                                          PressureSums& sums) {
    simulation.begin_stress_sums(sums.virial_bound);
    PressureSampler sampler(simulation, ranks);
    if (sums.pending_virial.size() != n_words || sums.last_motion.size() != n_numbers)
        throw InputError({{"[output.measurements]", 0,
                           "the checkpoint's measurements of "
                           "\"pressure\" are not whole"}});
    sampler.last_ = sample_of(sums.last_motion);
    if (ranks.is_root()) {
        StressSums pending(sums.virial_bound);
        std::size_t next = 0;
        for (ExactSum* part : pending.parts()) {
            part->add_words(sums.pending_virial[next], sums.pending_virial[next + 1]);
            next += 2;
        }
        sampler.last_sums_ -= pending;
    }
    sums.pending_virial.clear();
    sums.last_motion.clear();
    return sampler;
}

/// The last sample is at `now`, and sums before it do not count. **Collective.**
void PressureSampler::begin_interval(const MotionSample& now) {
    last_sums_ = simulation_->stress_sums();
    last_ = now;
    simulation_->integrate(since_last(), last_);
}

/// The sums on this rank since the last sample.
StressSums PressureSampler::since_last() const {
    StressSums since = simulation_->stress_sums();
    since -= last_sums_;
    return since;
}

void PressureSampler::sample(PressureSums& sums, double steps) {
    MotionSample now = simulation_->motion_sample();
    simulation_->integrate(since_last(), now);
    const double unit = simulation_->velocity_unit();
    last_integral_ = unit * Tensor{now.stress.xx - last_.stress.xx, now.stress.xy - last_.stress.xy,
                                   now.stress.yy - last_.stress.yy};
    const MotionIntegrals mean = integrals_between(simulation_->averaged_system(), last_, now,
                                                   steps);
    for (const double number :
         {mean.pressure(&Tensor::xx), mean.pressure(&Tensor::xy), mean.pressure(&Tensor::yy),
          mean.temperature(), mean.energy() / mean.area})
        sums.pressures.push_back(number);
    begin_interval(now);
}

double PressureSampler::temperature() const {
    return temperature_at(simulation_->averaged_system(), last_);
}

void PressureSampler::store(PressureSums& sums) const {
    StressSums since = since_last();
    for (ExactSum* part : since.parts()) {
        ranks_->sum(*part);
        sums.pending_virial.push_back(part->low_word());
        sums.pending_virial.push_back(part->high_word());
    }
    sums.last_motion = numbers_of(last_);
}

void keep_pressure(KeptNumbers& kept, PressureSums& sums, std::optional<PressureSampler>& sampler,
                   Simulation& simulation, const Communicator& ranks) {
    PressureSums all = sums;
    if (!kept.is_restored()) sampler->store(all);
    kept(all.virial_bound), kept(all.pressures), kept(all.pending_virial), kept(all.last_motion);
    if (!kept.is_restored()) return;
    sums = std::move(all);
    sampler = PressureSampler::going_on(simulation, ranks, sums);
}

} // namespace carrom
