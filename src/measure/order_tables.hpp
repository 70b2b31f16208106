// SPDX-License-Identifier: BSD-3-Clause
// Tables of the order of discs: psi6 and numbers of Voronoi neighbours.
#pragma once

#include <cstddef>
#include <vector>

#include <carrom/measured_table.hpp>

#include "measure/sample_sums.hpp"

namespace carrom {

/// |psi6| of all discs together, at a sample.
double psi6_at(const SampleSums& sums, std::size_t sample);

void add_psi6_tables(const SampleSums& sums, std::vector<MeasuredTable>& tables);

} // namespace carrom
