// SPDX-License-Identifier: BSD-3-Clause
// "displacement": the mean square displacement since the first sample.
#include "measure/flights.hpp"
#include "measure/measurement.hpp"

namespace carrom {

namespace {

class Displacement : public Measurement {
public:
    explicit Displacement(MeasuredRun& run) : Measurement(run), flights_(run, false) {}

    void begin() override { flights_.follow(); }

    void sample(const SampledState& state) override {
        const std::span<const DiscState> discs = flights_.flown(state.shown);
        if (state.is_first) flights_.begin(discs);
        const std::array<double, 3> means = flights_.means(discs, state.n_discs);
        squares_.insert(squares_.end(), means.begin(), means.begin() + 2);
    }

    void keep(KeptNumbers& kept) override { kept(squares_); }
    void store_discs(StoredSamples& stored) override { flights_.store(stored); }
    void restore_discs(const StoredSamples& stored) override { flights_.restore(stored); }

    std::vector<MeasuredTable> tables() const override {
        MeasuredTable table{"displacement",
                            {"mean square displacement since from_step, over all discs, on through "
                             "periodic sides; lengths squared, times in steps"},
                            {"steps", "x", "y", "sum"},
                            {}};
        for (std::size_t k = 0; k < squares_.size() / 2; ++k) {
            const double x = squares_[2 * k], y = squares_[2 * k + 1];
            table.rows.push_back(
                {static_cast<double>(static_cast<std::int64_t>(k) * run_.output.every_steps), x, y,
                 x + y});
        }
        return {std::move(table)};
    }

private:
    Flights flights_;
    std::vector<double> squares_; ///< for each sample: mean square displacement along x and y
};

} // namespace

MeasuredQuantity displacement_quantity() {
    return {{.name = "displacement",
             .help = "Mean square displacement since the first sample.",
             .needs_lasting_sides = true,
             .has_history = true,
             .rules = {{.one = "sheared sides",
                        .other = "\"displacement\"",
                        .why = "discs drift apart with the flow",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "displacement") && s.effects.are_sheared();
                            }},
                       {.one = "\"displacement\"",
                        .other = "an open side",
                        .why = "with open sides velocities and densities alone are measured",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "displacement") &&
                                       s.effects.have_open_boundaries();
                            }}}},
            make_measurement<Displacement>};
}

} // namespace carrom
