// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/blocking.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace carrom {

namespace {

/// Means of blocks count as equal if they differ by at most this share of the largest absolute
/// value, which rounding explains.
constexpr double rounding_share = 1e-10;
/// Halves of a run are compared if each has at least this many blocks.
constexpr std::size_t fewest_blocks_of_half = 8;
/// Difference of the halves' means, divided by its error, beyond which a run counts as changing. In
/// steady runs with independent blocks it is exceeded in one run of 2000.
constexpr double most_deviations = 4;
/// A run counts as changing if fewer blocks than this are independent: they follow a trend.
constexpr double fewest_independent = 3;

/// 95 of 100 values of chi squared are below these numbers, for 1, 2, 3 ... degrees of freedom.
constexpr std::array chi_squared = {3.841,  5.991,  7.815,  9.488,  11.070, 12.592, 14.067, 15.507,
                                    16.919, 18.307, 19.675, 21.026, 22.362, 23.685, 24.996, 26.296};

/// Statistics of blocks of one length.
struct Level {
    double n = 0, variance = 0, neighbours = 0; ///< neighbours: covariance of neighbouring blocks
};

double mean_of(std::span<const double> terms) {
    double sum = 0;
    for (const double term : terms) sum += term;
    return sum / static_cast<double>(terms.size());
}

Level level_of(std::span<const double> terms) {
    const auto n = static_cast<double>(terms.size());
    const double mean = mean_of(terms);
    Level level{n, 0, 0};
    for (std::size_t k = 0; k < terms.size(); ++k) {
        level.variance += (terms[k] - mean) * (terms[k] - mean) / n;
        if (k > 0) level.neighbours += (terms[k] - mean) * (terms[k - 1] - mean) / n;
    }
    return level;
}

/// Statistics of blocks of increasing length, until only two or three are left. Longer blocks that
/// are all equal, as counts of rare events can be, are left out, because their variance of 0 shows
/// neither an error nor a correlation.
std::vector<Level> levels_of(std::span<const double> terms) {
    std::vector<Level> levels;
    for (std::vector<double> joined(terms.begin(), terms.end()); joined.size() >= 2;) {
        levels.push_back(level_of(joined));
        if (levels.size() > 1 && !(levels.back().variance > 0)) {
            levels.pop_back();
            break;
        }
        for (std::size_t k = 0; k < joined.size() / 2; ++k)
            joined[k] = (joined[2 * k] + joined[2 * k + 1]) / 2;
        joined.resize(joined.size() / 2);
    }
    return levels;
}

/// The shortest blocks such that neighbouring blocks of this and of every greater length have no
/// more correlation than chance explains (Jonsson's test).
const Level& independent_level(std::span<const Level> levels) {
    double sum = 0;
    std::size_t chosen = levels.size() - 1;
    for (std::size_t k = levels.size(); k-- > 0;) {
        const auto& [n, variance, neighbours] = levels[k];
        const double expected = (n - 1) * variance / (n * n);
        sum += n * std::pow((expected + neighbours) / variance, 2);
        const std::size_t freedom = std::min(levels.size() - k, chi_squared.size());
        if (sum < chi_squared[freedom - 1]) chosen = k;
    }
    return levels[chosen];
}

/// The square of the error of the mean.
double squared_error(std::span<const Level> levels) {
    const Level& level = independent_level(levels);
    const double alone = level.variance, bias = level.variance / level.n,
                 with_neighbours = alone + 2 * (level.neighbours + bias);
    return std::max(alone, with_neighbours) / (level.n - 1);
}

bool differ_by_rounding(std::span<const double> terms) {
    const auto [least, most] = std::ranges::minmax(terms);
    const double largest = std::max(std::fabs(least), std::fabs(most));
    return largest > 0 && most - least <= rounding_share * largest;
}

/// The difference of the halves' means divided by its error; 0 if the halves are too short.
double deviation_of_halves(std::span<const double> terms) {
    const std::size_t half = terms.size() / 2;
    if (half < fewest_blocks_of_half) return 0;
    const auto first = terms.first(half), last = terms.last(half);
    const double difference = std::fabs(mean_of(first) - mean_of(last));
    const auto square = [](std::span<const double> part) {
        const std::vector<Level> levels = levels_of(part);
        return levels.front().variance > 0 ? squared_error(levels) : 0;
    };
    return difference > 0 ? difference / std::sqrt(square(first) + square(last)) : 0;
}

/// Whether the means of eighths of a run rise or fall throughout, with at most one of 28 pairs out
/// of order. By chance this happens in one of 2000 steady runs (Kendall, Biometrika 30, 81 (1938)).
/// For a trend that is steep at first this test is more sensitive than that of halves.
bool are_eighths_in_order(std::span<const double> terms) {
    constexpr std::size_t n_parts = 8;
    const std::size_t length = terms.size() / n_parts;
    if (length < 2) return false;
    int rising = 0, falling = 0,
        pairs = 0; // equal means (for instance of rare events) are neither rising nor falling
    for (std::size_t last = 1; last < n_parts; ++last) {
        for (std::size_t first = 0; first < last; ++first) {
            ++pairs;
            const double before = mean_of(terms.subspan(first * length, length)),
                         after = mean_of(terms.subspan(last * length, length));
            rising += before < after;
            falling += before > after;
        }
    }
    return falling >= pairs - 1 || rising >= pairs - 1;
}

} // namespace

BlockedMean blocked_mean(std::span<const double> terms) {
    BlockedMean result;
    if (terms.size() < fewest_blocks ||
        !std::ranges::all_of(terms, [](double term) { return std::isfinite(term); }))
        return result;
    result.is_constant = differ_by_rounding(terms);
    const std::vector<Level> levels = levels_of(terms);
    const Level& first = levels.front();
    result.error = 0;
    result.blocks_per_independent = 1;
    if (!(first.variance > 0)) return result;
    const double square = squared_error(levels), as_they_are = first.variance / (first.n - 1);
    result.error = std::sqrt(square);
    result.blocks_per_independent = std::max(1.0, square / as_they_are);
    result.is_changing = !result.is_constant && terms.size() >= 2 * fewest_blocks_of_half &&
                         (deviation_of_halves(terms) > most_deviations ||
                          are_eighths_in_order(terms) ||
                          first.n / result.blocks_per_independent < fewest_independent);
    return result;
}

double standard_error(std::span<const double> terms) { return blocked_mean(terms).error; }

std::int64_t VectorBlocks::n_samples() const {
    return static_cast<std::int64_t>(n_blocks()) * samples_per_block_ + n_present_;
}

void VectorBlocks::add(std::span<const double> sample) {
    present_.resize(n_values_);
    for (std::size_t k = 0; k < n_values_; ++k) present_[k] += sample[k];
    if (++n_present_ < samples_per_block_) return;
    blocks_.insert(blocks_.end(), present_.begin(), present_.end());
    present_.assign(n_values_, 0);
    n_present_ = 0;
    if (n_blocks() >= most_blocks) join_pairs();
}

void VectorBlocks::join_pairs() {
    const std::size_t n_joined = n_blocks() / 2;
    for (std::size_t block = 0; block < n_joined; ++block)
        for (std::size_t k = 0; k < n_values_; ++k)
            blocks_[block * n_values_ + k] = blocks_[2 * block * n_values_ + k] +
                                             blocks_[(2 * block + 1) * n_values_ + k];
    blocks_.resize(n_joined * n_values_);
    samples_per_block_ *= 2;
}

/// The mean over samples of `number(values)`, a linear function of the values.
template <class Number> SampledMean VectorBlocks::mean_of(const Number& number) const {
    const auto per_block = static_cast<double>(samples_per_block_),
               all = static_cast<double>(n_samples());
    if (!(all > 0)) return {};
    std::vector<double> terms(n_blocks());
    double sum = present_.empty() ? 0 : number(present_.data());
    for (std::size_t block = 0; block < terms.size(); ++block) {
        const double of_block = number(blocks_.data() + block * n_values_);
        sum += of_block;
        terms[block] = of_block / per_block;
    }
    const BlockedMean blocked = blocked_mean(terms);
    return {sum / all,
            blocked.error,
            blocked.blocks_per_independent * per_block / 2,
            all / (blocked.blocks_per_independent * per_block),
            blocked.is_constant,
            blocked.is_changing};
}

std::vector<SampledMean> VectorBlocks::means() const {
    std::vector<SampledMean> means(n_values_);
    for (std::size_t k = 0; k < n_values_; ++k)
        means[k] = mean_of([k](const double* values) { return values[k]; });
    return means;
}

SampledMean VectorBlocks::weighted_mean(std::span<const double> weights) const {
    return mean_of([&](const double* values) {
        double sum = 0;
        for (std::size_t k = 0; k < n_values_; ++k) sum += weights[k] * values[k];
        return sum;
    });
}

std::vector<std::int64_t> VectorBlocks::words() const {
    std::vector<std::int64_t> words = {static_cast<std::int64_t>(n_values_), samples_per_block_,
                                       n_present_};
    std::vector<double> present = present_;
    present.resize(n_values_);
    present.insert(present.end(), blocks_.begin(), blocks_.end());
    for (const double number : present) words.push_back(std::bit_cast<std::int64_t>(number));
    return words;
}

bool VectorBlocks::set_words(std::span<const std::int64_t> words) {
    constexpr std::size_t n_fixed = 3;
    if (words.size() < n_fixed + n_values_ || n_values_ == 0 ||
        words[0] != static_cast<std::int64_t>(n_values_) || words[1] < 1 || words[2] < 0 ||
        words[2] >= words[1])
        return false;
    const std::size_t n_numbers = words.size() - n_fixed;
    if (n_numbers % n_values_ != 0 || n_numbers / n_values_ > most_blocks) return false;
    samples_per_block_ = words[1];
    n_present_ = words[2];
    std::vector<double> numbers;
    for (const std::int64_t word : words.subspan(n_fixed))
        numbers.push_back(std::bit_cast<double>(word));
    const auto end_of_present = numbers.begin() + static_cast<std::ptrdiff_t>(n_values_);
    present_.assign(numbers.begin(), end_of_present);
    blocks_.assign(end_of_present, numbers.end());
    return true;
}

} // namespace carrom
