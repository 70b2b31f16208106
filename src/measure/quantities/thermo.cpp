// SPDX-License-Identifier: BSD-3-Clause
// "thermo": energy, temperature, pressure and rate of collisions over time, with a row for each
// sample. Rows are appended to its file during the run.
#include <cmath>

#include <fmt/format.h>

#include "measure/measurement.hpp"
#include "measure/pressure_sampler.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

class Thermo : public Measurement {
public:
    Thermo(MeasuredRun& run, const Measurements& others) : Measurement(run), others_(others) {}

    void begin() override { sampler_.emplace(run_.system, run_.ranks); }

    void end_interval() override {
        sampler_->sample(static_cast<double>(run_.output.every_steps));
        if (are_means_) before_ = energies_now();
    }
    void sample(const SampledState& state) override {
        if (state.follows_effects) sampler_->begin_interval();
        const Energies now = energies_now(), before = state.follows_effects ? before_ : now;
        const bool are_means = are_means_ && !state.is_first,
                   is_mean_known = are_means && !run_.scene.effects.are_sheared();
        const double motion = is_mean_known ? sampler_->mean_energy()
                                            : (before.of_motion + now.of_motion) / 2;
        rows_.insert(rows_.end(),
                     {motion + (before.other + now.other) / 2,
                      are_means ? sampler_->mean_temperature() : sampler_->temperature(),
                      sampler_->last().n_discs,
                      static_cast<double>(sampler_->last().pair_collisions)});
    }

    void keep(KeptNumbers& kept) override {
        kept(rows_);
        PressureSampler::keep(kept, sampler_, run_.system, run_.ranks);
    }

    std::vector<MeasuredTable> tables() const override { return {}; }

    std::optional<MeasuredTable> rows_from(std::size_t first) const override {
        const std::int64_t every_steps = run_.output.every_steps;
        MeasuredTable table{
            "thermo",
            {fmt::format("one row every {} steps from step {}", every_steps,
                         run_.counts.first_step),
             "energy: of motion, spin and height; temperature: kT; collision_rate: collisions with "
             "other discs per disc and step",
             fmt::format("xx, xy, yy (pressure tensor), {}collision_rate: since the row before; "
                         "times in steps",
                         are_means_ ? "temperature, energy of motion, " : "")},
            {"step", "time", "energy", "temperature", "xx", "xy", "yy", "collision_rate"},
            {},
            true};
        std::vector<ThermoColumn> columns;
        for (const auto& other : others_)
            if (std::optional<ThermoColumn> column = other->thermo_column())
                columns.push_back(std::move(*column));
        for (const ThermoColumn& column : columns) {
            table.columns.push_back(column.name);
            table.remarks.push_back(column.remark);
        }
        for (std::size_t k = first; k < rows_.size() / 4; ++k) {
            const double* const now = rows_.data() + 4 * k;
            const double step = run_.step_of(k);
            std::vector<double> row = {step, step, now[0], now[1]};
            if (k == 0) {
                row.resize(row.size() + 4, std::nan(""));
            } else {
                const double* const before = now - 4;
                const double* const p = sampler_->pressures().data() +
                                        PressureSampler::n_numbers * (k - 1);
                const double steps = static_cast<double>(every_steps),
                             n_discs = (before[2] + now[2]) / 2;
                row.insert(row.end(),
                           {p[0], p[1], p[2], 2 * (now[3] - before[3]) / (n_discs * steps)});
            }
            for (const ThermoColumn& column : columns) row.push_back(column.at_sample(k));
            table.rows.push_back(std::move(row));
        }
        return table;
    }

private:
    struct Energies {
        double of_motion = 0, other = 0;
    };
    Energies energies_now() const {
        const Totals totals = run_.system.energies();
        return {totals.kinetic_energy, totals.other_energy()};
    }

    const Measurements& others_;
    /// Whether temperatures and kinetic energies are means over the interval before each sample
    const bool are_means_ = does_energy_jump(run_.scene.effects);
    Energies before_;          ///< values at the present step, before effects acted
    std::vector<double> rows_; ///< per sample: energy, kT, discs, pair collisions so far
    std::optional<PressureSampler> sampler_;
};

} // namespace

MeasuredQuantity thermo_quantity() {
    return {{.name = "thermo",
             .help = "Energy, kT, pressure tensor and rate of collisions over time.",
             .has_history = true},
            [](MeasuredRun& run, const Measurements& others) -> std::unique_ptr<Measurement> {
                return std::make_unique<Thermo>(run, others);
            }};
}

} // namespace carrom
