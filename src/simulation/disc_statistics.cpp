// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/disc_statistics.hpp"

#include "dynamics/container.hpp"
#include "engine/engine.hpp"
#include "statistics/pair_distances.hpp"

namespace carrom {

MotionSample motion_sample(const DiscSystem& system) {
    MotionSample sample = sample_motion(system.in_flow(), system.species_if_mixed(),
                                        system.heaviest(), system.n_discs(), system.n_threads(),
                                        system.ranks());
    const Extent box = system.box();
    sample.area = area_of(system.effects().fixed_bodies,
                          {box.x_high - box.x_low, box.y_high - box.y_low});
    return sample;
}

void integrate(const DiscSystem& system, const StressSums& mine, MotionSample& sample) {
    add_integrals(mine, system.ranks(), sample);
    integrate_flights(system, sample);
}

void integrate_flights(const DiscSystem& system, MotionSample& sample) {
    add_flights(system.engine().flight_integral(), system.frame(), sample);
}

void count_pair_distances(DiscSystem& system, double bin_width,
                          std::span<const DiscId> species_ends, std::span<std::uint64_t> counts) {
    const std::size_t n_bins = counts.size() / n_pair_kinds(species_ends.size());
    const LocalView now = system.engine().local_view(bin_width * static_cast<double>(n_bins));
    count_pair_distances(now, bin_width, species_ends, system.n_threads(), counts);
    system.engine().forget_images();
}

} // namespace carrom
