// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints of versions up to 0.2 keep all sums of all quantities in one list of fields.
#pragma once

#include <cstdint>
#include <vector>

namespace carrom {

/// The words of a checkpoint as Sampler keeps them now, whether they are older or not; words that
/// are of neither form stay as they are, so that they are refused. Throws InputError for sums of
/// version 0.2 that cannot go on at that step.
std::vector<std::int64_t> in_present_form(const std::vector<std::int64_t>& words,
                                          std::int64_t step);

} // namespace carrom
