// SPDX-License-Identifier: BSD-3-Clause
// "velocities": distributions of the components of velocities, and of speeds.
#include <cmath>

#include <fmt/format.h>

#include "measure/pair_reach.hpp"
#include "measure/speeds.hpp"
#include "measure/table_parts.hpp"

namespace carrom {

namespace {

constexpr QuantitySetting largest_velocity_setting{"largest_velocity"};

class Velocities : public Measurement {
public:
    explicit Velocities(MeasuredRun& run)
        : Measurement(run), largest_velocity_(largest_velocity_setting.of(run.output)),
          vx_(n_bins_of(run), 0), vy_(vx_), speeds_(vx_) {}

    void begin() override {
        const double usual = usual_speed(run_);
        if (!is_given()) largest_velocity_ = 5 * usual;
    }

    bool has_velocities() const override { return true; }

    void sample(const SampledState& state) override {
        const std::size_t n = n_bins_of(run_);
        const double unit = run_.system.velocity_unit(), largest = largest_velocity_;
        const double per_component = static_cast<double>(n) / (2 * largest),
                     per_speed = static_cast<double>(n) / largest;
        std::vector<std::uint64_t> vx(n, 0), vy(n, 0), speeds(n, 0);
        for (const DiscState& disc : state.inside) {
            const double u = disc.vx * unit, v = disc.vy * unit;
            count(vx, (u + largest) * per_component);
            count(vy, (v + largest) * per_component);
            count(speeds, std::sqrt(u * u + v * v) * per_speed);
        }
        add_over(run_.ranks, std::move(vx), vx_);
        add_over(run_.ranks, std::move(vy), vy_);
        add_over(run_.ranks, std::move(speeds), speeds_);
    }

    void keep(KeptNumbers& kept) override {
        if (is_given())
            kept.same(largest_velocity_);
        else
            kept(largest_velocity_);
        kept.same(vx_.size());
        kept(vx_), kept(vy_), kept(speeds_);
    }

    std::vector<MeasuredTable> tables() const override { return {components(), speeds()}; }

private:
    bool is_given() const { return run_.output.is_given(largest_velocity_setting.name); }

    MeasuredTable components() const {
        const std::size_t n = vx_.size();
        const double largest = largest_velocity_, width = 2 * largest / static_cast<double>(n);
        MeasuredTable table{
            "velocities",
            {"vx_density, vy_density: of probability, per length per step; velocities "
             "in lengths per step",
             fmt::format("beyond the table: {} of vx, {} of vy, of {}",
                         run_.counts.n_discs - total(vx_), run_.counts.n_discs - total(vy_),
                         run_.counts.n_discs)},
            {"from", "to", "vx_count", "vy_count", "vx_density", "vy_density"},
            {}};
        for (std::size_t k = 0; k < n; ++k)
            table.rows.push_back({edge(-largest, largest, k, n), edge(-largest, largest, k + 1, n),
                                  static_cast<double>(vx_[k]), static_cast<double>(vy_[k]),
                                  share(vx_[k], run_.counts.n_discs, width),
                                  share(vy_[k], run_.counts.n_discs, width)});
        return table;
    }

    MeasuredTable speeds() const {
        const std::size_t n = speeds_.size();
        const double width = largest_velocity_ / static_cast<double>(n);
        MeasuredTable table{
            "speeds",
            {"density: of probability, per length per step; speeds in lengths per step",
             fmt::format("beyond the table: {} of {}", run_.counts.n_discs - total(speeds_),
                         run_.counts.n_discs)},
            {"from", "to", "count", "density"},
            {}};
        for (std::size_t k = 0; k < n; ++k)
            table.rows.push_back(
                {edge(0, largest_velocity_, k, n), edge(0, largest_velocity_, k + 1, n),
                 static_cast<double>(speeds_[k]), share(speeds_[k], run_.counts.n_discs, width)});
        return table;
    }

    double largest_velocity_;
    std::vector<std::uint64_t> vx_, vy_, speeds_;
};

} // namespace

MeasuredQuantity velocities_quantity() {
    return {{.name = "velocities",
             .help = "Distributions of vx, of vy and of speeds.",
             .keys = {bins_key(),
                      largest_velocity_setting
                          .number("length/step", "Largest component in the table of velocities.",
                                  "5 standard deviations")
                          .within({.low = 0, .excludes_low = true})}},
            make_measurement<Velocities>,
            {"speeds"}};
}

} // namespace carrom
