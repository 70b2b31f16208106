// SPDX-License-Identifier: BSD-3-Clause
// "partial_structure_factor": S_ab(k) of each pair of species, for wave vectors of a periodic box.
//
// S_ab is the mean of Re(rho_a rho_b*) / N, where rho_a is the sum of exp(i k r) over the discs of
// species a, and N is the number of all discs. So S is the sum of S_ab over all a and b. At large k
// S_aa tends to the fraction of discs in species a, and S_ab of different species tends to 0.
#include <utility>

#include <fmt/format.h>

#include "measure/kept_blocks.hpp"
#include "measure/pair_reach.hpp"
#include "measure/wave_bins.hpp"
#include "statistics/pair_distances.hpp"

namespace carrom {

namespace {

constexpr std::size_t most_species = 8;

/// Elements of `sums_` and `blocks_` are ordered by kind of pair (pair_distances.hpp), then by bin.
class PartialStructureFactor : public WaveMeasurement {
public:
    explicit PartialStructureFactor(MeasuredRun& run)
        : WaveMeasurement(run), n_species_(run.scene.effects.species.size()) {
        sums_.resize(n_pair_kinds(n_species_) * waves_.size());
        blocks_ = VectorBlocks(sums_.size());
    }

    void sample(const SampledState& state) override {
        std::vector<DensityModes> modes;
        for (const DiscStates& discs : by_species(state.shown))
            modes.push_back(waves_.modes(run_, discs));
        std::vector<double> now;
        for (std::size_t b = 0; b < n_species_; ++b) {
            for (std::size_t a = 0; a <= b; ++a) {
                std::vector<double> products(waves_.vectors().size());
                for (std::size_t k = 0; k < products.size(); ++k)
                    products[k] = modes[a].product(modes[b], k) /
                                  static_cast<double>(run_.scene.n_discs);
                const std::vector<double> means = waves_.means(products);
                now.insert(now.end(), means.begin(), means.end());
            }
        }
        for (std::size_t k = 0; k < now.size(); ++k) sums_[k] += now[k];
        blocks_.add(now);
    }

    std::vector<MeasuredTable> tables() const override {
        MeasuredTable table{
            "partial_structure_factor",
            {"S_a_b: mean of the real part of rho_a rho_b*, over the number of all discs; rho_a: "
             "sum of exp(i k r) over the discs of species a, counted from 1 in the order of ids",
             "over the box's wave vectors of lengths from `from` to `to`, nan without any; of each "
             "two opposite vectors one counts; wavenumbers in radians per length",
             "errors: one standard error, nan where samples are too few"},
            {"from", "to", "count"},
            {}};
        for (std::size_t b = 1; b <= n_species_; ++b)
            for (std::size_t a = 1; a <= b; ++a)
                for (const char* ending : {"", "_error"})
                    table.columns.push_back(fmt::format("S_{}_{}{}", a, b, ending));
        const double n_samples = static_cast<double>(run_.counts.n_samples);
        const std::vector<double> counts = waves_.counts(),
                                  errors = errors_of(blocks_, run_.counts.n_samples);
        for (std::size_t bin = 0; bin < waves_.size(); ++bin) {
            std::vector<double> row = {waves_.low(bin), waves_.high(bin), counts[bin]};
            for (std::size_t k = bin; k < sums_.size(); k += waves_.size())
                row.insert(row.end(), {sums_[k] / n_samples, errors[k]});
            table.rows.push_back(std::move(row));
        }
        return {std::move(table)};
    }

private:
    std::vector<DiscStates> by_species(std::span<const DiscState> discs) const {
        std::vector<DiscStates> all(n_species_);
        for (const DiscState& disc : discs) {
            std::size_t species = 0;
            for (DiscId end = count_of(0); disc.id >= end; end += count_of(species)) ++species;
            all[species].push_back(disc);
        }
        return all;
    }
    std::uint64_t count_of(std::size_t species) const {
        return run_.scene.effects.species[species].count;
    }

    std::size_t n_species_;
};

bool is_partial_structure_factor_measured(const SceneParameters& scene) {
    return measures(scene, "partial_structure_factor");
}

} // namespace

MeasuredQuantity partial_structure_factor_quantity() {
    constexpr std::string_view name = "\"partial_structure_factor\"";
    std::vector<Rule> rules = rules_of_waves<is_partial_structure_factor_measured>(name);
    rules.push_back({.one = name,
                     .other = "equal discs, or more than eight species",
                     .why = "it has a curve for each two species; \"structure_factor\" takes all "
                            "discs together",
                     .keys = {quantities_key},
                     .is_broken = [](const SceneParameters& s) {
                         const std::size_t n = s.effects.species.size();
                         return is_partial_structure_factor_measured(s) &&
                                (n < 2 || n > most_species);
                     }});
    return {{.name = "partial_structure_factor",
             .help = "S_ab(k) of each two species; they add up to S(k).",
             .needs_lasting_sides = true,
             .keys = {bins_key(), largest_wavenumber_key()},
             .rules = std::move(rules),
             .check = check_wavenumber},
            make_measurement<PartialStructureFactor>};
}

} // namespace carrom
