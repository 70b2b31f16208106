// SPDX-License-Identifier: BSD-3-Clause
// Measured tables as files of CSV: remarks behind `#`, a line of names, then numbers that read back
// as the same bits.
#pragma once

#include <string>
#include <vector>

#include "measure/sampler.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

namespace carrom {

std::string csv_of(const MeasuredTable& table, const std::string& scene_name);

/// Writes each table as a whole file in the scene's folder for measurements, by rank 0. If one
/// cannot be written every rank throws CollectiveError, code 4. **Collective.**
void write_tables(const Scene& scene, const std::vector<MeasuredTable>& tables,
                  const Communicator& ranks);

} // namespace carrom
