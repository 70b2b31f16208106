// SPDX-License-Identifier: BSD-3-Clause
// How discs are ordered: psi6, numbers of Voronoi neighbours, the structure factor.
#include "measure/order_tables.hpp"
#include "measure/sampler.hpp"
#include "statistics/hexatic_order.hpp"

namespace carrom {

void Sampler::sample_psi6() {
    const HexaticSums now = simulation_.hexatic_order(sums_.largest_distance, output_.bins);
    const auto cells_of = [&now](std::size_t n) { return static_cast<double>(now.neighbours[n]); };
    double n_cells = 0;
    for (std::size_t n = 0; n < now.neighbours.size(); ++n) n_cells += cells_of(n);
    sums_.psi6.insert(sums_.psi6.end(),
                      {now.real.value(), now.imaginary.value(), now.modulus.value(), cells_of(5),
                       cells_of(6), cells_of(7), n_cells});
    for (std::size_t n = 0; n < now.neighbours.size(); ++n)
        sums_.neighbours[n] += now.neighbours[n];
    for (std::size_t k = 0; k < output_.bins; ++k) {
        sums_.moduli[k] += now.moduli[k];
        sums_.psi6_pairs[k] += now.pairs[k];
        sums_.psi6_products[k] += now.products[k].value();
    }
}

void Sampler::sample_structure_factor(std::span<const Disc> discs, const Extent& box) {
    const std::vector<WaveVector> vectors = wave_vectors_of(scene_);
    DensityModes modes = density_modes(discs, simulation_.clock(), scene_.n_discs,
                                       box.x_high - box.x_low, box.y_high - box.y_low, vectors,
                                       simulation_.n_threads());
    ranks_.sum(std::span(modes.real));
    ranks_.sum(std::span(modes.imaginary));
    for (std::size_t k = 0; k < vectors.size(); ++k)
        sums_.structure_factor[k] += modes.squared_modulus(k) / static_cast<double>(scene_.n_discs);
}

} // namespace carrom
