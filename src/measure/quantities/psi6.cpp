// SPDX-License-Identifier: BSD-3-Clause
// "psi6": the hexatic order of discs, from their Voronoi neighbours.
#include <cmath>
#include <numeric>

#include "measure/kept_blocks.hpp"
#include "measure/pair_reach.hpp"
#include "measure/table_parts.hpp"
#include "simulation/disc_order.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

namespace {

constexpr std::size_t per_sample = 7; ///< number of values for each sample in `psi6_`

/// Means of the history's columns, except the step and the real and imaginary parts.
MeasuredTable means_of(const MeasuredTable& history) {
    MeasuredTable table{"psi6",
                        {"means of the history with one standard error (from joined samples; nan "
                         "where there are too few)"},
                        {},
                        {{}}};
    for (const std::size_t column : {1u, 4u, 5u, 6u, 7u}) {
        std::vector<double> terms;
        for (const std::vector<double>& row : history.rows) terms.push_back(row[column]);
        const double sum = std::accumulate(terms.begin(), terms.end(), 0.0);
        table.columns.push_back(history.columns[column]);
        table.rows[0].push_back(sum / static_cast<double>(terms.size()));
        table.columns.push_back(history.columns[column] + "_error");
        table.rows[0].push_back(standard_error(std::move(terms)));
    }
    return table;
}

class Psi6 : public Measurement {
public:
    explicit Psi6(MeasuredRun& run)
        : Measurement(run), largest_distance_(largest_distance_setting.of(run.output)),
          neighbours_(HexaticSums::most_neighbours + 1, 0), moduli_(n_bins_of(run), 0),
          pairs_(moduli_), products_(moduli_.size(), 0), blocks_(moduli_.size()) {}

    bool moves_discs() const override { return true; }

    void sample(const SampledState& /*state*/) override {
        const HexaticSums now = hexatic_order(run_.system, largest_distance_, n_bins_of(run_));
        const auto cells_of = [&now](std::size_t n) {
            return static_cast<double>(now.neighbours[n]);
        };
        double n_cells = 0;
        for (std::size_t n = 0; n < now.neighbours.size(); ++n) n_cells += cells_of(n);
        psi6_.insert(psi6_.end(), {now.real.value(), now.imaginary.value(), now.modulus.value(),
                                   cells_of(5), cells_of(6), cells_of(7), n_cells});
        for (std::size_t n = 0; n < now.neighbours.size(); ++n) neighbours_[n] += now.neighbours[n];
        std::vector<double> g6_now;
        for (std::size_t k = 0; k < n_bins_of(run_); ++k) {
            moduli_[k] += now.moduli[k];
            pairs_[k] += now.pairs[k];
            products_[k] += now.products[k].value();
            g6_now.push_back(g6_of(static_cast<double>(now.pairs[k]), now.products[k].value()));
        }
        blocks_.add(g6_now);
    }

    void keep(KeptNumbers& kept) override {
        keep_largest_distance(kept, run_, largest_distance_);
        kept.same(moduli_.size());
        kept(psi6_), kept(neighbours_), kept(moduli_), kept(pairs_), kept(products_);
        keep_blocks(kept, blocks_);
    }

    std::vector<MeasuredTable> tables() const override {
        MeasuredTable over_time = history();
        MeasuredTable means = means_of(over_time);
        return {std::move(means), std::move(over_time), distribution(), correlation(),
                neighbours()};
    }

    std::optional<ThermoColumn> thermo_column() const override {
        return ThermoColumn{"psi6", "psi6: of all discs together",
                            [this](std::size_t sample) { return psi6_at(sample); }};
    }

private:
    static double g6_of(double pairs, double products) { return pairs > 0 ? products / pairs : 0; }
    /// The modulus of the mean of psi6 over all discs at a sample.
    double psi6_at(std::size_t sample) const {
        const double* const now = psi6_.data() + per_sample * sample;
        return std::sqrt(now[0] * now[0] + now[1] * now[1]) / now[per_sample - 1];
    }

    MeasuredTable history() const {
        MeasuredTable table{
            "psi6_history",
            {"psi6: modulus of its mean over all discs, also by parts; local: mean of "
             "the discs' moduli; times in steps",
             "fivefold, sixfold, sevenfold: shares of discs with so many Voronoi "
             "neighbours"},
            {"step", "psi6", "real", "imaginary", "local", "fivefold", "sixfold", "sevenfold"},
            {}};
        for (std::size_t k = 0; k < psi6_.size() / per_sample; ++k) {
            const double* const now = psi6_.data() + per_sample * k;
            std::vector<double> row = {run_.step_of(k), psi6_at(k)};
            for (std::size_t part = 0; part + 1 < per_sample; ++part)
                row.push_back(now[part] / now[per_sample - 1]);
            table.rows.push_back(std::move(row));
        }
        return table;
    }

    MeasuredTable distribution() const {
        const std::size_t n = moduli_.size();
        MeasuredTable table{"psi6_distribution",
                            {"density: of probability, of the modulus of a disc's psi6"},
                            {"from", "to", "count", "density"},
                            {}};
        for (std::size_t k = 0; k < n; ++k)
            table.rows.push_back({edge(0, 1, k, n), edge(0, 1, k + 1, n),
                                  static_cast<double>(moduli_[k]),
                                  share(moduli_[k], total(moduli_), 1 / static_cast<double>(n))});
        return table;
    }

    MeasuredTable correlation() const {
        const std::size_t n = pairs_.size();
        MeasuredTable table{"psi6_correlation",
                            {"g6: mean over pairs of the real part of psi6* psi6, 0 without pairs",
                             "distances in the scene's unit of length; pairs: of all samples; "
                             "g6_error: one standard error, nan where samples are too few"},
                            {"from", "to", "pairs", "g6", "g6_error"},
                            {}};
        const std::vector<double> errors = errors_of(blocks_, run_.counts.n_samples);
        for (std::size_t k = 0; k < n; ++k) {
            const double pairs = static_cast<double>(pairs_[k]);
            table.rows.push_back({edge(0, largest_distance_, k, n),
                                  edge(0, largest_distance_, k + 1, n), pairs,
                                  g6_of(pairs, products_[k]), errors[k]});
        }
        return table;
    }

    MeasuredTable neighbours() const {
        MeasuredTable table{
            "neighbours",
            {"count: discs with so many Voronoi neighbours, of all samples; the last "
             "row is of more, too"},
            {"neighbours", "count", "share"},
            {}};
        for (std::size_t k = 0; k < neighbours_.size(); ++k)
            table.rows.push_back({static_cast<double>(k), static_cast<double>(neighbours_[k]),
                                  share(neighbours_[k], total(neighbours_), 1)});
        return table;
    }

    double largest_distance_;
    /// For each sample: the sums over discs of the real part, the imaginary part and the modulus,
    /// the numbers of discs with 5, 6 and 7 neighbours, and the number of all discs
    std::vector<double> psi6_;
    std::vector<std::uint64_t> neighbours_, moduli_, pairs_; ///< counts as in HexaticSums
    std::vector<double> products_;                           ///< sums as in HexaticSums
    VectorBlocks blocks_;                                    ///< samples of g6, for its errors
};

} // namespace

MeasuredQuantity psi6_quantity() {
    return {{.name = "psi6",
             .help = "Hexatic order, its correlation g6(r), and numbers of neighbours; where radii "
                     "differ, those of the radical tessellation.",
             .keys = {bins_key(), largest_distance_key()},
             .has_history = true,
             .check = check_largest_distance},
            make_measurement<Psi6>,
            {"psi6_history", "psi6_distribution", "psi6_correlation", "neighbours"}};
}

} // namespace carrom
