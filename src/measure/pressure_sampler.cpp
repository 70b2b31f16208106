// SPDX-License-Identifier: BSD-3-Clause
#include "measure/pressure_sampler.hpp"

#include <algorithm>
#include <cstdint>

namespace carrom {

namespace {

std::vector<double> numbers_of(const MotionSample& l) {
    return {l.motion.xx, l.motion.xy,  l.motion.yy, l.momentum_x, l.momentum_y,
            l.mass,      l.speed_unit, l.n_discs,   l.area,       l.stress.xx,
            l.stress.xy, l.stress.yy,  l.energy};
}

constexpr std::size_t n_numbers_of_sample = 13;

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

void PressureSampler::sample(double steps) {
    const MotionSample now = interval_.now(), &last = interval_.last();
    const double unit = system_->velocity_unit();
    last_integral_ = unit * Tensor{now.stress.xx - last.stress.xx, now.stress.xy - last.stress.xy,
                                   now.stress.yy - last.stress.yy};
    mean_energy_ = unit * (now.energy - last.energy) / (2 * steps);
    const MotionIntegrals mean = integrals_between(system_->averaged_system(), last, now, steps);
    pressures_.insert(pressures_.end(),
                      {mean.pressure(&Tensor::xx), mean.pressure(&Tensor::xy),
                       mean.pressure(&Tensor::yy), mean.temperature(), mean.energy() / mean.area});
    interval_.begin(now);
}

double PressureSampler::temperature() const {
    return temperature_at(system_->averaged_system(), last());
}

void PressureSampler::keep(KeptNumbers& kept, std::optional<PressureSampler>& sampler,
                           DiscSystem& system, const Communicator& ranks) {
    MotionInterval::Pending pending;
    std::vector<std::uint64_t> words;
    std::vector<double> pressures, last;
    if (!kept.is_restored()) {
        pending = sampler->interval_.pending();
        words.assign(pending.words.begin(), pending.words.end());
        pressures = sampler->pressures_;
        last = numbers_of(sampler->last());
    }
    kept(pending.bound), kept(pressures), kept(words), kept(last);
    if (!kept.is_restored()) return;
    if (!(pending.bound > 0) || words.size() != pending.words.size() ||
        last.size() != n_numbers_of_sample)
        return kept.refuse();
    std::ranges::copy(words, pending.words.begin());
    sampler = PressureSampler(system, std::move(pressures),
                              MotionInterval(system, ranks, pending, sample_of(last)));
}

} // namespace carrom
