// SPDX-License-Identifier: BSD-3-Clause
// "structure_factor": S(k) over the wave vectors of a periodic box.
#include <algorithm>
#include <numbers>

#include "measure/kept_blocks.hpp"
#include "measure/pair_reach.hpp"
#include "measure/wave_bins.hpp"

namespace carrom {

namespace {

/// `sums_` has an element for each wave vector, and `blocks_` for each bin of wavenumbers.
class StructureFactor : public WaveMeasurement {
public:
    explicit StructureFactor(MeasuredRun& run) : WaveMeasurement(run) {
        sums_.resize(waves_.vectors().size());
        blocks_ = VectorBlocks(waves_.size());
    }

    void sample(const SampledState& state) override {
        const DensityModes modes = waves_.modes(run_, state.shown);
        std::vector<double> now(sums_.size());
        for (std::size_t k = 0; k < now.size(); ++k) {
            now[k] = modes.squared_modulus(k) / static_cast<double>(run_.scene.n_discs);
            sums_[k] += now[k];
        }
        blocks_.add(waves_.means(now));
    }

    std::vector<MeasuredTable> tables() const override {
        const double n_samples = static_cast<double>(run_.counts.n_samples);
        std::vector<MeasuredTable> tables;
        const std::vector<double> sums = waves_.means(sums_), counts = waves_.counts(),
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
        for (std::size_t bin = 0; bin < waves_.size(); ++bin)
            table.rows.push_back({waves_.low(bin), waves_.high(bin), counts[bin],
                                  sums[bin] / n_samples, errors[bin]});
        tables.push_back(std::move(table));
        const WaveVector& peak = waves_.vectors()[highest];
        tables.push_back({"structure_factor_peak",
                          {"the wave vector of the largest mean S of all"},
                          {"kx", "ky", "k", "S"},
                          {{2 * std::numbers::pi * peak.n / run_.scene.box.x,
                            2 * std::numbers::pi * peak.m / run_.scene.box.y,
                            waves_.length_of(peak), sums_[highest] / n_samples}}});
        return tables;
    }
};

bool is_structure_factor_measured(const SceneParameters& scene) {
    return measures(scene, "structure_factor");
}

} // namespace

MeasuredQuantity structure_factor_quantity() {
    return {{.name = "structure_factor",
             .help = "S(k), and the wave vector where it is largest.",
             .needs_lasting_sides = true,
             .keys = {bins_key(), largest_wavenumber_key()},
             .rules = rules_of_waves<is_structure_factor_measured>("\"structure_factor\""),
             .check = check_wavenumber},
            make_measurement<StructureFactor>,
            {"structure_factor_peak"}};
}

} // namespace carrom
