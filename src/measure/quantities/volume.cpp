// SPDX-License-Identifier: BSD-3-Clause
// "volume": the packing fraction and the box's area per disc at constant pressure, and their
// fluctuations.
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "engine/engine.hpp"
#include "measure/measurement.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

namespace {

class Volume : public Measurement {
public:
    using Measurement::Measurement;

    void sample(const SampledState& /*state*/) override {
        sizes_.push_back(run_.system.engine().size());
        if (!has_sides()) return;
        const Box box = run_.system.engine().box();
        widths_.push_back(box.x);
        heights_.push_back(box.y);
    }

    void keep(KeptNumbers& kept) override {
        kept(sizes_);
        if (has_sides()) kept(widths_), kept(heights_);
    }

    std::vector<MeasuredTable> tables() const override {
        MeasuredTable over_time = history();
        MeasuredTable means = means_of(over_time);
        return {std::move(means), std::move(over_time)};
    }

private:
    /// Whether the ratio of the box's sides changes.
    bool has_sides() const { return run_.scene.effects.barostat.axes == BarostatAxes::each; }
    /// The box's area per disc, divided by the mean squared diameter in the scene.
    double volume_of_scene() const {
        const SceneParameters& scene = run_.scene;
        return std::numbers::pi / 4 / scene.packing();
    }

    MeasuredTable history() const {
        MeasuredTable table{
            "volume_history",
            {"size: factor of all radii; packing: of discs of that size; volume: area of the box "
             "a disc, over the mean of the squared diameters",
             "times in steps"},
            {"step", "size", "packing", "volume"},
            {}};
        const double volume = volume_of_scene(), packing = run_.scene.packing();
        for (std::size_t k = 0; k < sizes_.size(); ++k) {
            const double square = sizes_[k] * sizes_[k];
            table.rows.push_back({run_.step_of(k), sizes_[k], packing * square, volume / square});
            if (has_sides())
                table.rows.back().insert(table.rows.back().end(), {widths_[k], heights_[k]});
        }
        if (!has_sides()) return table;
        table.remarks.push_back("width, height: sides of the box along x and y");
        table.columns.insert(table.columns.end(), {"width", "height"});
        return table;
    }

    MeasuredTable means_of(const MeasuredTable& history) const {
        MeasuredTable table{
            "volume",
            {"means of the history with one standard error (from joined samples; nan where there "
             "are too few)",
             "compressibility: N times the variance of the volume over its mean, which is kT "
             "kappa over the mean of the squared diameters"},
            {},
            {{}}};
        const auto add = [&table](const std::string& name, const std::vector<double>& terms) {
            const double mean = std::accumulate(terms.begin(), terms.end(), 0.0) /
                                static_cast<double>(terms.size());
            table.columns.push_back(name);
            table.rows[0].push_back(mean);
            table.columns.push_back(name + "_error");
            table.rows[0].push_back(standard_error(terms));
            return mean;
        };
        std::vector<double> packings, volumes, squares, ratios;
        for (const std::vector<double>& row : history.rows) {
            packings.push_back(row[2]);
            volumes.push_back(row[3]);
            if (has_sides()) ratios.push_back(row[4] / row[5]);
        }
        add("packing", packings);
        const double volume = add("volume", volumes),
                     n_discs = static_cast<double>(run_.scene.n_discs);
        for (const double one : volumes)
            squares.push_back(n_discs * (one - volume) * (one - volume) / volume);
        add("compressibility", squares);
        if (!has_sides()) return table;
        table.remarks.push_back("ratio: of the sides of the box, width over height");
        add("ratio", ratios);
        return table;
    }

    std::vector<double> sizes_;
    std::vector<double> widths_, heights_; ///< sides of the box, if their ratio changes
};

} // namespace

MeasuredQuantity volume_quantity() {
    return {{.name = "volume",
             .help = "Packing and volume at constant pressure, and the compressibility from their "
                     "fluctuations.",
             .has_history = true,
             .rules = {{.one = "\"volume\"",
                        .other = "no effects.barostat",
                        .why = "nothing changes the volume then; set effects.barostat.pressure",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "volume") && !s.effects.barostat.is_on();
                            }}}},
            make_measurement<Volume>,
            {"volume_history"}};
}

} // namespace carrom
