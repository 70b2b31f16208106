// SPDX-License-Identifier: BSD-3-Clause
// Errors of averages over time for correlated samples.
//
// Samples are joined into blocks of equal length. When there are `most_blocks`, neighbouring blocks
// are joined in pairs, so that memory does not grow with time. The error comes from blocks so long
// that their means are independent (Flyvbjerg and Petersen, J. Chem. Phys. 91, 461 (1989)).
// Jonsson's test (Phys. Rev. E 98, 043304 (2018)) finds that length automatically. The remaining
// correlation between neighbouring blocks of that length is added.
//
// In runs of at least 30 correlation times the estimated error is within 10 % of the scatter
// between runs. In runs of only eight correlation times it is a fifth too small.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace carrom {

/// An error needs at least this many blocks.
constexpr std::size_t fewest_blocks = 4;
/// Blocks are joined in pairs when there are this many.
constexpr std::size_t most_blocks = 128;

/// Results for the mean of all blocks, from the means of consecutive blocks.
struct BlockedMean {
    double error = std::numeric_limits<double>::quiet_NaN(); ///< one standard error; NaN if
                                                             ///< blocks are too few or not finite
    /// The number of successive blocks, at least 1, that count as much as one independent block.
    double blocks_per_independent = std::numeric_limits<double>::quiet_NaN();
    bool is_constant = false; ///< blocks agree to within rounding: a conserved quantity
    bool is_changing = false; ///< the run's halves differ by more than chance explains, or the
                              ///< blocks follow a trend
};

/// `terms` are the means of blocks of one length, in order of time.
BlockedMean blocked_mean(std::span<const double> terms);
/// Returns only the error of blocked_mean.
double standard_error(std::span<const double> terms);

/// A mean over samples with its error.
struct SampledMean {
    double value = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();
    /// Correlation time in samples; the shortest measurable one is half a block
    double correlation_time = std::numeric_limits<double>::quiet_NaN();
    double independent_samples = std::numeric_limits<double>::quiet_NaN();
    bool is_constant = false, is_changing = false;
};

/// Samples of a vector, such as g(r) in all its bins. Memory: at most `most_blocks` vectors.
class VectorBlocks {
public:
    explicit VectorBlocks(std::size_t n_values = 0) : n_values_(n_values) {}

    std::size_t n_values() const { return n_values_; }
    std::int64_t n_samples() const;
    std::size_t n_blocks() const { return n_values_ == 0 ? 0 : blocks_.size() / n_values_; }

    /// Adds one sample of `n_values()` numbers. Samples must be equally spaced in time.
    void add(std::span<const double> sample);

    /// The mean of each value, with its error.
    std::vector<SampledMean> means() const;
    /// The mean of the weighted sum of all values. Its error includes correlations between values.
    SampledMean weighted_mean(std::span<const double> weights) const;

    /// All data as words, for a checkpoint. The words do not depend on ranks or threads if the
    /// samples do not.
    std::vector<std::int64_t> words() const;
    /// Restores the data from `words()`. Returns false, and changes nothing, if the words are
    /// incomplete or belong to another number of values.
    bool set_words(std::span<const std::int64_t> words);

private:
    void join_pairs();
    template <class Number> SampledMean mean_of(const Number& number) const;

    std::size_t n_values_ = 0;
    std::int64_t samples_per_block_ = 1, n_present_ = 0;
    std::vector<double> blocks_;  ///< sums over whole blocks, block after block
    std::vector<double> present_; ///< sums over the samples of the unfinished block
};

} // namespace carrom
