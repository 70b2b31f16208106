// SPDX-License-Identifier: BSD-3-Clause
// Tables of "diffusion": how far discs fly and how long they keep their velocities.
#pragma once

#include <vector>

#include <carrom/measured_table.hpp>

#include "measure/sample_sums.hpp"

namespace carrom {

void add_diffusion_tables(const SampleSums& sums, std::vector<MeasuredTable>& tables);

} // namespace carrom
