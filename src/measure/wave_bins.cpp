// SPDX-License-Identifier: BSD-3-Clause
#include "measure/wave_bins.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "measure/kept_blocks.hpp"
#include "measure/pair_reach.hpp"
#include "measure/table_parts.hpp"

namespace carrom {

Key largest_wavenumber_key() {
    return largest_wavenumber
        .number("1/length", "Reach of structure factors; at most a million wave vectors.",
                "4 pi over the diameter, or 100,000 vectors")
        .within({.low = 0, .excludes_low = true});
}

void check_wavenumber(const SceneDraft& draft) {
    constexpr double most_vectors = 1e6, most_by_default = 1e5;
    SceneParameters& scene = draft.scene;
    const double lx = scene.box.x, ly = scene.box.y;
    const auto reach = [=](double n_vectors) {
        return std::sqrt(8 * std::numbers::pi * n_vectors / (lx * ly));
    };
    const std::string name(largest_wavenumber.name);
    if (!scene.measurements->is_given(name))
        scene.measurements->derive(
            name, std::min(2 * std::numbers::pi / scene.radius, reach(most_by_default)));
    const double largest = largest_wavenumber.of(*scene.measurements);
    const double least = 2 * std::numbers::pi / std::max(lx, ly);
    if (largest >= least && largest <= reach(most_vectors)) return;
    draft.refuse({largest_wavenumber.key_name(), quantities_key},
                 fmt::format("'output.measurements.largest_wavenumber' must be from {:.6g}, the "
                             "box's first, to {:.6g}, where a million are, not {:g}",
                             least, reach(most_vectors), largest));
}

WaveBins::WaveBins(const MeasuredRun& run)
    : box_(run.scene.box), largest_(largest_wavenumber.of(run.output)), n_bins_(n_bins_of(run)),
      vectors_(wave_vectors(box_.x, box_.y, largest_)) {}

double WaveBins::low(std::size_t bin) const { return edge(0, largest_, bin, n_bins_); }

double WaveBins::length_of(const WaveVector& vector) const {
    return wavenumber(vector, box_.x, box_.y);
}

std::size_t WaveBins::bin_of(const WaveVector& vector) const {
    const double place = length_of(vector) / largest_ * static_cast<double>(n_bins_);
    return std::min(static_cast<std::size_t>(place), n_bins_ - 1);
}

std::vector<double> WaveBins::counts() const {
    std::vector<double> counts(n_bins_, 0);
    for (const WaveVector& vector : vectors_) counts[bin_of(vector)] += 1;
    return counts;
}

std::vector<double> WaveBins::means(std::span<const double> numbers) const {
    const std::vector<double> n = counts();
    std::vector<double> means(n_bins_, 0);
    for (std::size_t k = 0; k < vectors_.size(); ++k) means[bin_of(vectors_[k])] += numbers[k];
    for (std::size_t bin = 0; bin < n_bins_; ++bin)
        means[bin] = n[bin] > 0 ? means[bin] / n[bin] : std::nan("");
    return means;
}

DensityModes WaveBins::modes(const MeasuredRun& run, std::span<const DiscState> discs) const {
    DensityModes modes = density_modes(discs, run.system.clock(), run.scene.n_discs, box_.x, box_.y,
                                       vectors_, run.system.n_threads());
    run.ranks.sum(std::span(modes.real));
    run.ranks.sum(std::span(modes.imaginary));
    return modes;
}

void WaveMeasurement::keep(KeptNumbers& kept) {
    kept.same(waves_.largest());
    kept.same(sums_.size());
    kept(sums_);
    keep_blocks(kept, blocks_);
}

} // namespace carrom
