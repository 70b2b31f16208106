// SPDX-License-Identifier: BSD-3-Clause
// Errors of measured curves. A sample of a curve is a vector, and the errors of its elements come
// from blocks of samples (statistics/blocking.hpp).
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "measure/kept_numbers.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

/// Stores or restores blocks; call it after a measurement's other numbers. Checkpoints of Carrom
/// 0.2 have no blocks. After a restart from such a checkpoint the curve has no errors, because the
/// blocks lack the samples before the restart.
inline void keep_blocks(KeptNumbers& kept, VectorBlocks& blocks) {
    if (kept.is_restored() && kept.is_at_end()) return;
    std::vector<std::int64_t> words = blocks.words();
    kept(words);
    if (kept.is_restored() && !blocks.set_words(words)) kept.refuse();
}

/// One standard error of each value of the curve; NaN if there are too few samples, or if the
/// blocks do not contain all `n_samples` samples.
inline std::vector<double> errors_of(const VectorBlocks& blocks, std::uint64_t n_samples) {
    std::vector<double> errors(blocks.n_values(), std::numeric_limits<double>::quiet_NaN());
    if (blocks.n_samples() != static_cast<std::int64_t>(n_samples)) return errors;
    const std::vector<SampledMean> means = blocks.means();
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] = means[k].error;
    return errors;
}

} // namespace carrom
