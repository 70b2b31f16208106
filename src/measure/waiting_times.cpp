// SPDX-License-Identifier: BSD-3-Clause
#include "measure/waiting_times.hpp"

#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace carrom {

namespace {

/// F_s is compared only if there are at least this many late origins: their variance is needed.
constexpr double fewest_late_origins = 8;
constexpr std::size_t most_octaves = 64, most_lags = 1000;

/// The first waiting time of an octave, in samples.
std::uint64_t begin_of(std::size_t octave) {
    return octave == 0 ? 0 : std::uint64_t{1} << (octave - 1);
}

double steps_of(std::size_t octave, std::int64_t steps_per_sample) {
    return static_cast<double>(begin_of(octave)) * static_cast<double>(steps_per_sample);
}

} // namespace

VectorBlocks& WaitingTimes::cell(std::size_t octave, std::size_t lag) {
    if (octaves_.size() <= octave) octaves_.resize(octave + 1);
    std::vector<VectorBlocks>& lags = octaves_[octave];
    if (lags.size() <= lag) lags.resize(lag + 1, VectorBlocks(n_numbers * n_kinds_));
    return lags[lag];
}

void WaitingTimes::add(std::size_t lag, std::uint64_t origin, std::span<const MovedDiscs> moved) {
    std::vector<double> numbers;
    for (const MovedDiscs& one : moved)
        numbers.insert(numbers.end(),
                       {one.squares, one.scattering, one.overlap, one.scattering * one.scattering});
    cell(static_cast<std::size_t>(std::bit_width(origin)), lag).add(numbers);
}

/// Stores or restores all means. Combinations of octave and lag without origins have no means.
void WaitingTimes::keep(KeptNumbers& kept) {
    std::size_t n_octaves = octaves_.size();
    kept(n_octaves);
    if (n_octaves > most_octaves) return kept.refuse();
    octaves_.resize(n_octaves);
    for (std::size_t octave = 0; octave < n_octaves; ++octave) {
        std::size_t n_lags = octaves_[octave].size();
        kept(n_lags);
        if (n_lags > most_lags) return kept.refuse();
        octaves_[octave].resize(n_lags, VectorBlocks(n_numbers * n_kinds_));
        for (VectorBlocks& blocks : octaves_[octave]) {
            std::int64_t is_there = blocks.n_samples() > 0 ? 1 : 0;
            kept(is_there);
            if (is_there == 0) continue;
            std::vector<std::int64_t> words = blocks.words();
            kept(words);
            if (kept.is_restored() && !blocks.set_words(words)) return kept.refuse();
        }
    }
}

MeasuredTable WaitingTimes::table(std::string name, std::size_t kind, const MultipleTau& scheme,
                                  std::int64_t steps_per_sample) const {
    MeasuredTable table{
        std::move(name),
        {"the correlations by waiting time: the steps from the first sample to an origin, at least "
         "`from` and less than `to`",
         "squares: of displacements; scattering: F_s; overlap: as in the correlations; means over "
         "discs and the origins of the octave, with one standard error (nan where there are too "
         "few)"},
        {"from", "to", "steps", "count", "squares", "squares_error", "scattering",
         "scattering_error", "overlap", "overlap_error"},
        {}};
    for (std::size_t octave = 0; octave < octaves_.size(); ++octave) {
        for (std::size_t lag = 0; lag < octaves_[octave].size(); ++lag) {
            const VectorBlocks& blocks = octaves_[octave][lag];
            if (blocks.n_samples() == 0) continue;
            const std::vector<SampledMean> means = blocks.means();
            std::vector<double> row = {
                steps_of(octave, steps_per_sample), steps_of(octave + 1, steps_per_sample),
                static_cast<double>(scheme.lag(lag)) * static_cast<double>(steps_per_sample),
                static_cast<double>(blocks.n_samples())};
            for (std::size_t k = 0; k + 1 < n_numbers; ++k) {
                row.push_back(means[n_numbers * kind + k].value);
                row.push_back(means[n_numbers * kind + k].error);
            }
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

void WaitingTimes::add_octave(std::size_t octave, std::size_t lag, std::size_t kind,
                              Sums& sums) const {
    if (octaves_[octave].size() <= lag) return;
    const VectorBlocks& blocks = octaves_[octave][lag];
    if (blocks.n_samples() == 0) return;
    const std::vector<SampledMean> means = blocks.means();
    const auto n = static_cast<double>(blocks.n_samples());
    sums.n += n;
    sums.scattering += n * means[n_numbers * kind + 1].value;
    sums.squared_scattering += n * means[n_numbers * kind + 3].value;
}

WaitingTimes::Comparison WaitingTimes::compare(std::size_t lag, std::size_t kind,
                                               std::uint64_t length,
                                               std::uint64_t n_samples) const {
    Comparison result;
    Sums early, late;
    for (std::size_t octave = octaves_.size(); octave-- > 0;) {
        const std::uint64_t begin = begin_of(octave), end = begin_of(octave + 1);
        if (begin >= n_samples / 4) {
            add_octave(octave, lag, kind, late);
            result.late_from = begin;
        }
        if (end - 1 <= length / 4) add_octave(octave, lag, kind, early);
    }
    if (!(early.n > 0) || late.n < fewest_late_origins) return result;
    result.early = early.scattering / early.n;
    result.late = late.scattering / late.n;
    const double variance = late.squared_scattering / late.n - result.late * result.late,
                 independent = static_cast<double>(n_samples - length - result.late_from) /
                               (2 * static_cast<double>(length));
    if (variance > 0 && independent > 1)
        result.deviation = std::fabs(result.late - result.early) /
                           std::sqrt(variance * (independent + 1) / (independent - 1));
    return result;
}

} // namespace carrom
