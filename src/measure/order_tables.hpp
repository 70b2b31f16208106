// SPDX-License-Identifier: BSD-3-Clause
// Tables of the order of discs: psi6, numbers of Voronoi neighbours, the structure factor.
#pragma once

#include <cstddef>
#include <vector>

#include <carrom/measured_table.hpp>

#include "measure/sample_sums.hpp"
#include "scene/scene.hpp"
#include "statistics/structure_factor.hpp"

namespace carrom {

/// |psi6| of all discs together, at a sample.
double psi6_at(const SampleSums& sums, std::size_t sample);

void add_psi6_tables(const SampleSums& sums, std::vector<MeasuredTable>& tables);

/// Those of the scene's box, which is periodic all round.
std::vector<WaveVector> wave_vectors_of(const Scene& scene);

void add_structure_tables(const SampleSums& sums, const Scene& scene,
                          std::vector<MeasuredTable>& tables);

} // namespace carrom
