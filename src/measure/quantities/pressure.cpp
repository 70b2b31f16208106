// SPDX-License-Identifier: BSD-3-Clause
// "pressure": the pressure tensor and the compressibility factor, from all collisions of pairs.
#include <numeric>

#include "measure/measurement.hpp"
#include "measure/pressure_sampler.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

namespace {

class Pressure : public Measurement {
public:
    using Measurement::Measurement;

    void begin() override { sampler_.emplace(run_.system, run_.ranks); }

    void end_interval() override { sampler_->sample(static_cast<double>(run_.output.every_steps)); }
    void sample(const SampledState& state) override {
        if (state.follows_effects) sampler_->begin_interval();
    }

    void keep(KeptNumbers& kept) override {
        PressureSampler::keep(kept, sampler_, run_.system, run_.ranks);
    }

    std::vector<MeasuredTable> tables() const override {
        if (!sampler_ || sampler_->pressures().empty()) return {};
        MeasuredTable over_time = history();
        MeasuredTable means = means_of(over_time);
        return {std::move(means), std::move(over_time)};
    }

private:
    MeasuredTable history() const {
        MeasuredTable table{
            "pressure_history",
            {"pressure tensor between two steps: impulse times distance of pairs, and "
             "the kinetic part at both; docs/understanding/pressure.md",
             "pressure: half the trace; compressibility: P A / (N kT); "
             "temperature: kT of translation; times in steps"},
            {"from_step", "to_step", "xx", "xy", "yy", "pressure", "temperature",
             "compressibility"},
            {}};
        constexpr std::size_t n = PressureSampler::n_numbers;
        const std::vector<double>& pressures = sampler_->pressures();
        for (std::size_t k = 0; k < pressures.size() / n; ++k) {
            const double* const one = pressures.data() + n * k;
            const double from = run_.step_of(k);
            const double pressure = (one[0] + one[2]) / 2;
            table.rows.push_back({from, from + static_cast<double>(run_.output.every_steps), one[0],
                                  one[1], one[2], pressure, one[3], pressure / one[4]});
        }
        return table;
    }

    /// Means of the history's columns from `xx` on. The compressibility factor is the mean pressure
    /// divided by the mean of N kT / A.
    MeasuredTable means_of(const MeasuredTable& history) const {
        MeasuredTable table{
            "pressure",
            {"means of the history with one standard error (from joined intervals; nan "
             "where there are too few)"},
            {},
            {}};
        std::vector<double> means, errors;
        for (std::size_t column = 2; column < history.columns.size(); ++column) {
            std::vector<double> terms;
            for (const std::vector<double>& row : history.rows) terms.push_back(row[column]);
            const double sum = std::accumulate(terms.begin(), terms.end(), 0.0);
            means.push_back(sum / static_cast<double>(terms.size()));
            errors.push_back(standard_error(terms));
            table.columns.push_back(history.columns[column]);
        }
        double ideal = 0;
        const std::vector<double>& pressures = sampler_->pressures();
        for (std::size_t k = 4; k < pressures.size(); k += PressureSampler::n_numbers)
            ideal += pressures[k];
        means.back() = means[3] * static_cast<double>(history.rows.size()) / ideal;
        for (std::size_t column = 2; column < history.columns.size(); ++column)
            table.columns.push_back(history.columns[column] + "_error");
        means.insert(means.end(), errors.begin(), errors.end());
        table.rows.push_back(std::move(means));
        return table;
    }

    std::optional<PressureSampler> sampler_;
};

} // namespace

MeasuredQuantity pressure_quantity() {
    return {{.name = "pressure",
             .help = "The pressure tensor and the compressibility, from all collisions of pairs.",
             .has_history = true},
            make_measurement<Pressure>,
            {"pressure_history"}};
}

} // namespace carrom
