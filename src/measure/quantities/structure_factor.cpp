// SPDX-License-Identifier: BSD-3-Clause
// "structure_factor": S(k) over the wave vectors of a periodic box.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "measure/kept_blocks.hpp"
#include "measure/pair_reach.hpp"
#include "measure/table_parts.hpp"
#include "statistics/structure_factor.hpp"

namespace carrom {

namespace {

constexpr QuantitySetting largest_wavenumber{"largest_wavenumber"};

/// At least one wave vector, and at most a million, because each is evaluated for each disc.
void check_wavenumber(const Check& check) {
    constexpr double most_vectors = 1e6, most_by_default = 1e5;
    Scene& scene = check.scene;
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
    check.refuse({largest_wavenumber.key_name(), quantities_key},
                 fmt::format("'output.measurements.largest_wavenumber' must be from {:.6g}, the "
                             "box's first, to {:.6g}, where a million are, not {:g}",
                             least, reach(most_vectors), largest));
}

class StructureFactor : public Measurement {
public:
    explicit StructureFactor(MeasuredRun& run)
        : Measurement(run), largest_(largest_wavenumber.of(run.output)),
          sums_(wave_vectors().size(), 0), blocks_(n_bins_of(run)) {}

    void sample(const SampledState& state) override {
        const Extent& box = state.box;
        const std::vector<WaveVector> vectors = wave_vectors();
        DensityModes modes = density_modes(state.shown, run_.simulation.clock(), run_.scene.n_discs,
                                           box.x_high - box.x_low, box.y_high - box.y_low, vectors,
                                           run_.simulation.n_threads());
        run_.ranks.sum(std::span(modes.real));
        run_.ranks.sum(std::span(modes.imaginary));
        std::vector<double> now(vectors.size());
        for (std::size_t k = 0; k < vectors.size(); ++k) {
            now[k] = modes.squared_modulus(k) / static_cast<double>(run_.scene.n_discs);
            sums_[k] += now[k];
        }
        blocks_.add(means_of_bins(vectors, now));
    }

    void keep(KeptNumbers& kept) override {
        kept.same(largest_);
        kept.same(sums_.size());
        kept(sums_);
        keep_blocks(kept, blocks_);
    }

    std::vector<MeasuredTable> tables() const override {
        const double lx = run_.scene.box.x, ly = run_.scene.box.y,
                     n_samples = static_cast<double>(run_.counts.n_samples);
        const std::vector<WaveVector> vectors = wave_vectors();
        const std::size_t n = n_bins_of(run_);
        std::vector<MeasuredTable> tables;
        const std::vector<double> sums = means_of_bins(vectors, sums_),
                                  counts = counts_of_bins(vectors),
                                  errors = errors_of(blocks_, run_.counts.n_samples);
        const auto highest = static_cast<std::size_t>(std::ranges::max_element(sums_) -
                                                      sums_.begin());
        MeasuredTable table{
            "structure_factor",
            {"S: mean square of the sum of exp(i k r) over discs, per disc, over the "
             "box's wave vectors of lengths from `from` to `to`; nan without any",
             "of each two opposite vectors one counts; wavenumbers in radians per "
             "length; S_error: one standard error, nan where samples are too few"},
            {"from", "to", "count", "S", "S_error"},
            {}};
        for (std::size_t bin = 0; bin < n; ++bin)
            table.rows.push_back({edge(0, largest_, bin, n), edge(0, largest_, bin + 1, n),
                                  counts[bin], sums[bin] / n_samples, errors[bin]});
        tables.push_back(std::move(table));
        const WaveVector& peak = vectors[highest];
        tables.push_back({"structure_factor_peak",
                          {"the wave vector of the largest mean S of all"},
                          {"kx", "ky", "k", "S"},
                          {{2 * std::numbers::pi * peak.n / lx, 2 * std::numbers::pi * peak.m / ly,
                            wavenumber(peak, lx, ly), sums_[highest] / n_samples}}});
        return tables;
    }

private:
    std::vector<WaveVector> wave_vectors() const {
        return carrom::wave_vectors(run_.scene.box.x, run_.scene.box.y, largest_);
    }

    std::size_t bin_of(const WaveVector& vector) const {
        const auto n = static_cast<double>(n_bins_of(run_));
        const double length = wavenumber(vector, run_.scene.box.x, run_.scene.box.y);
        return std::min(static_cast<std::size_t>(length / largest_ * n), n_bins_of(run_) - 1);
    }
    std::vector<double> counts_of_bins(const std::vector<WaveVector>& vectors) const {
        std::vector<double> counts(n_bins_of(run_), 0);
        for (const WaveVector& vector : vectors) counts[bin_of(vector)] += 1;
        return counts;
    }
    /// Of a number of each wave vector; NaN in a bin without any.
    std::vector<double> means_of_bins(const std::vector<WaveVector>& vectors,
                                      const std::vector<double>& numbers) const {
        const std::vector<double> counts = counts_of_bins(vectors);
        std::vector<double> means(counts.size(), 0);
        for (std::size_t k = 0; k < vectors.size(); ++k) means[bin_of(vectors[k])] += numbers[k];
        for (std::size_t bin = 0; bin < means.size(); ++bin)
            means[bin] = counts[bin] > 0 ? means[bin] / counts[bin] : std::nan("");
        return means;
    }

    double largest_;
    std::vector<double> sums_; ///< by wave vector, over all samples
    VectorBlocks blocks_;      ///< S in each bin
};

} // namespace

MeasuredQuantity structure_factor_quantity() {
    return {{.name = "structure_factor",
             .help = "S(k), and the wave vector where it is largest.",
             .keys = {bins_key(),
                      largest_wavenumber
                          .number("1/length",
                                  "Reach of the structure factor; at most a million wave vectors.",
                                  "4 pi over the diameter, or 100,000 vectors")
                          .within({.low = 0, .excludes_low = true})},
             .rules = {{.one = "sheared sides",
                        .other = "\"structure_factor\"",
                        .why = "the flow bends waves",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const Scene& s) {
                                return measures(s, "structure_factor") && s.effects.are_sheared();
                            }},
                       {.one = "\"structure_factor\"",
                        .other = "a side that is not periodic",
                        .why = "wave vectors are those of a box that repeats itself; make all four "
                               "sides periodic",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const Scene& s) {
                                return measures(s, "structure_factor") &&
                                       !(s.effects.is_periodic_x() && s.effects.is_periodic_y());
                            }}},
             .check = check_wavenumber},
            make_measurement<StructureFactor>,
            {"structure_factor_peak"}};
}

} // namespace carrom
