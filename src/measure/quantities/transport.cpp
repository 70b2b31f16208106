// SPDX-License-Identifier: BSD-3-Clause
// "transport": shear viscosity, bulk viscosity and thermal conductivity of a gas in a periodic box.
//
// The coefficients follow from the variance of the changes of Helfand moments, as the coefficient
// of diffusion follows from displacements (Viscardi and Gaspard, Phys. Rev. E 68, 041204 (2003)). A
// moment's change is the time integral of stress or of the heat current. Both integrals are exact
// sums over collisions, not sums over samples, because velocities are constant between collisions.
// So the derivative of the variance is Green and Kubo's integral without an error of quadrature.
// Lags are chosen by multiple_tau.hpp. Cost: one pass over the discs at each sample, and some
// hundred instructions for each collision. Memory: a few hundred numbers.
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/exact_sum.hpp"
#include "dynamics/species.hpp"
#include "engine/engine.hpp"
#include "measure/hdf5_key.hpp"
#include "measure/measurement.hpp"
#include "measure/multiple_tau.hpp"
#include "measure/pressure_sampler.hpp"
#include "measure/speeds.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

namespace {

/// The components of a moment: time integrals of two components of shear stress, of half the trace
/// of stress, and of the heat current along x and y.
enum Component : std::uint8_t { shear_xy, shear_normal, trace, heat_x, heat_y, n_components };

/// Henderson's approximation of Z = P A / (N kT) for hard discs.
double usual_pressure_per_density(double packing) {
    return (1 + packing * packing / 8) / ((1 - packing) * (1 - packing));
}

class Transport : public Measurement, public PairFollower {
public:
    explicit Transport(MeasuredRun& run)
        : Measurement(run), scheme_(static_cast<std::uint64_t>(correlation_points.of(run.output))),
          heat_{ExactSum(1), ExactSum(1)} {}
    ~Transport() override { run_.system.engine().followers_of_pairs().forget(*this); }

    void begin() override {
        pressure_.emplace(run_.system, run_.ranks);
        speed_ = std::max(usual_speed(run_), 0x1p-200);
        const Totals totals = run_.system.energies();
        const double n = static_cast<double>(totals.n_discs);
        drift_ = {totals.momentum_x / n, totals.momentum_y / n};
        usual_trace_ = usual_pressure_per_density(n * std::numbers::pi * run_.scene.radius *
                                                  run_.scene.radius / run_.scene.area()) *
                       (totals.kinetic_energy -
                        n * (drift_[0] * drift_[0] + drift_[1] * drift_[1]) / 2) *
                       static_cast<double>(run_.output.every_steps);
        follow();
        last_step_ = run_.system.step();
    }

    void take(std::span<const PairEvent> events) override {
        for (const PairEvent& event : events) {
            const double time = event.steps_since(last_step_, run_.scene.micro_steps);
            // s: sum of both velocities relative to the drift, which the collision conserves; r:
            // difference of both velocities after the collision. The discs are equal and elastic,
            // so the impulse i on p increases the energy of p by i . s / 2.
            const double sx = event.p_vx + event.q_vx - 2 * drift_[0],
                         sy = event.p_vy + event.q_vy - 2 * drift_[1], rx = event.p_vx - event.q_vx,
                         ry = event.p_vy - event.q_vy;
            const double gained = (event.ix * sx + event.iy * sy) / 2,
                         // Energy of p minus energy of q before the collision
                difference = (rx * sx + ry * sy) / 2 - 2 * gained;
            // First term: the energy that p gives to q times their separation. The second term
            // corrects for the current before the collision, because `sample` multiplies the
            // current at the end of the interval by the length of the whole interval.
            const auto sum = [&](double r, double i, double d) {
                return -gained * d - time * (gained * r + difference * i);
            };
            heat_[0].add(sum(rx, event.ix, event.dx));
            heat_[1].add(sum(ry, event.iy, event.dy));
        }
    }

    void sample(const SampledState& state) override {
        if (state.is_first) return note({});
        const double steps = static_cast<double>(run_.output.every_steps),
                     unit = run_.system.velocity_unit();
        for (const DiscState& disc : state.shown) {
            const double vx = disc.vx * unit, vy = disc.vy * unit, e = energy(vx, vy) * steps;
            heat_[0].add(e * (vx - drift_[0]));
            heat_[1].add(e * (vy - drift_[1]));
        }
        std::array<double, n_components> change{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            ExactSum all = heat_[axis];
            run_.ranks.sum(all);
            change[heat_x + axis] = all.value();
            heat_[axis].clear();
        }
        pressure_->sample(steps);
        const Tensor& stress = pressure_->last_integral();
        change[shear_xy] = stress.xy;
        change[shear_normal] = (stress.xx - stress.yy) / 2;
        change[trace] = (stress.xx + stress.yy) / 2;
        // The estimated mean is subtracted, because it is much larger than the fluctuations.
        change[trace] -= usual_trace_;
        temperature_ += pressure_->pressures()[3];
        pressure_->forget_pressures();
        for (std::size_t k = 0; k < n_components; ++k) change[k] += moments_[k];
        note(change);
        last_step_ = run_.system.step();
    }

    void keep(KeptNumbers& kept) override {
        kept.same(static_cast<std::int64_t>(scheme_.points()));
        PressureSampler::keep(kept, pressure_, run_.system, run_.ranks);
        kept(speed_), kept(drift_), kept(last_step_), kept(n_samples_), kept(temperature_);
        kept(usual_trace_), kept(moments_);
        if (kept.is_restored()) follow();
        std::array<std::uint64_t, 4> words{};
        for (std::size_t axis = 0; axis < 2 && !kept.is_restored(); ++axis) {
            ExactSum all = heat_[axis];
            run_.ranks.sum(all);
            words[2 * axis] = all.low_word(), words[2 * axis + 1] = all.high_word();
        }
        kept(words);
        for (std::size_t axis = 0; axis < 2 && kept.is_restored() && run_.ranks.is_root(); ++axis)
            heat_[axis].add_words(words[2 * axis], words[2 * axis + 1]);
        std::size_t n_lags = lags_.size(), n_levels = levels_.size();
        kept(n_lags), kept(n_levels);
        if (n_lags > 2000 || n_levels > 64) return kept.refuse();
        lags_.resize(n_lags, VectorBlocks(n_values));
        levels_.resize(n_levels, Level(scheme_.points()));
        for (VectorBlocks& blocks : lags_) {
            std::vector<std::int64_t> of = blocks.words();
            kept(of);
            if (kept.is_restored() && !blocks.set_words(of)) return kept.refuse();
        }
        for (Level& level : levels_)
            for (auto& moments : level) kept(moments);
    }

    std::vector<MeasuredTable> tables() const override;

private:
    using Moments = std::array<double, n_components>;
    using Level = std::vector<Moments>;
    /// Values of a lag, from the changes over it: shear^2 (mean of both components), trace^2,
    /// heat^2 (mean of both components) and trace.
    static constexpr std::size_t n_values = 4;

    /// Kinetic energy of a disc of mass 1, relative to the centre of mass.
    double energy(double vx, double vy) const {
        const double x = vx - drift_[0], y = vy - drift_[1];
        return (x * x + y * y) / 2;
    }

    void follow() {
        const double usual = speed_ * speed_ * speed_ *
                             static_cast<double>(run_.output.every_steps) * 0x1p70;
        heat_ = {ExactSum(usual), ExactSum(usual)};
        run_.system.engine().followers_of_pairs().forget(*this);
        run_.system.engine().followers_of_pairs().add(*this);
    }

    /// Adds to each lag the change of the moments since the earlier sample, then stores `moments`.
    void note(const Moments& moments) {
        moments_ = moments;
        for (std::size_t level = levels_.size(); level < scheme_.n_levels(n_samples_); ++level) {
            levels_.emplace_back(scheme_.points());
            for (std::uint64_t point = 0; level > 0 && point < scheme_.points() / 2; ++point)
                levels_[level][point] = levels_[level - 1][2 * point];
        }
        lags_.resize(scheme_.n_lags(n_samples_), VectorBlocks(n_values));
        scheme_.for_each_pair(
            n_samples_, [&](std::size_t lag, std::size_t level, std::size_t slot) {
                Moments d;
                for (std::size_t k = 0; k < n_components; ++k)
                    d[k] = moments[k] - levels_[level][slot][k];
                lags_[lag].add(
                    std::array{(d[shear_xy] * d[shear_xy] + d[shear_normal] * d[shear_normal]) / 2,
                               d[trace] * d[trace],
                               (d[heat_x] * d[heat_x] + d[heat_y] * d[heat_y]) / 2, d[trace]});
            });
        for (std::size_t level = 0; level < levels_.size(); ++level)
            if (scheme_.keeps(level, n_samples_))
                levels_[level][scheme_.slot(level, n_samples_)] = moments;
        ++n_samples_;
    }

    MultipleTau scheme_;
    std::optional<PressureSampler> pressure_;
    double speed_ = 0;              ///< typical speed, which defines the units of sums
    std::array<double, 2> drift_{}; ///< velocity of the centre of mass, per step
    std::array<ExactSum, 2> heat_;  ///< time integral of the heat current since the last sample
    std::int64_t last_step_ = 0;    ///< step of the last sample
    std::uint64_t n_samples_ = 0;   ///< including the first one
    double temperature_ = 0;        ///< sum over intervals of the mean kT of each
    double usual_trace_ = 0;        ///< estimated mean change of the trace in an interval
    Moments moments_{};             ///< moments of the last sample; 0 at the first one
    std::vector<Level> levels_;
    std::vector<VectorBlocks> lags_;
};

/// A coefficient is the variance `spread` divided by `scale` and by twice the lag. Its slope is the
/// increase of `spread` since the previous lag, divided by `scale` and by twice the increase of the
/// lag: Green and Kubo's integral.
std::vector<MeasuredTable> Transport::tables() const {
    MeasuredTable table{
        "transport",
        {"by lag: viscosities of shear and of bulk and thermal conductivity, from the mean squares "
         "of Helfand moments, with one standard error (nan where there are too few); *_slope: from "
         "their growth since the lag before, which is the integral of Green and Kubo",
         "count: overlapping origins; mass of 1, lengths in the scene's unit, times in steps"},
        {"steps", "count", "shear", "shear_error", "bulk", "bulk_error", "conductivity",
         "conductivity_error", "shear_slope", "bulk_slope", "conductivity_slope"},
        {}};
    if (n_samples_ < 2) return {table};
    const double kT = temperature_ / static_cast<double>(n_samples_ - 1), area = run_.scene.area();
    const std::array<double, 3> scale = {area * kT, area * kT, area * kT * kT};
    std::array<double, 3> before{};
    double time_before = 0;
    for (std::size_t lag = 0; lag < lags_.size(); ++lag) {
        if (lags_[lag].n_samples() == 0) continue;
        const double time = static_cast<double>(scheme_.lag(lag)) *
                            static_cast<double>(run_.output.every_steps);
        const std::vector<SampledMean> means = lags_[lag].means();
        const double mean_trace = means[3].value;
        const std::array<double, 3> spread = {
            means[0].value, means[1].value - mean_trace * mean_trace, means[2].value};
        // With t the trace, <t^2> - <t>^2 has the same error as the mean of t^2 - 2 <t> t.
        const std::array about_mean = {0.0, 1.0, 0.0, -2 * mean_trace};
        const std::array<double, 3> errors = {
            means[0].error, lags_[lag].weighted_mean(about_mean).error, means[2].error};
        std::vector<double> row = {time, static_cast<double>(lags_[lag].n_samples())};
        for (std::size_t k = 0; k < 3; ++k) {
            row.push_back(spread[k] / (2 * scale[k] * time));
            row.push_back(errors[k] / (2 * scale[k] * time));
        }
        for (std::size_t k = 0; k < 3; ++k)
            row.push_back((spread[k] - before[k]) / (2 * scale[k] * (time - time_before)));
        before = spread;
        time_before = time;
        table.rows.push_back(std::move(row));
    }
    return {table};
}

bool is_another_gas(const SceneParameters& s) {
    const bool is_at_home = s.effects.is_periodic_x() && s.effects.is_periodic_y() &&
                            !s.effects.are_sheared();
    Effects others = s.effects;
    others.boundaries = {};
    return measures(s, "transport") && (!is_at_home || others.are_any());
}

} // namespace

MeasuredQuantity transport_quantity() {
    return {{.name = "transport",
             .help = "Viscosities and thermal conductivity from exact integrals over events.",
             .needs_lasting_sides = true,
             .keys = {correlation_points_key(), hdf5_key()},
             .follows_collisions = true,
             .rules = {{.one = "\"transport\"",
                        .other = "walls or effects",
                        .why = "it takes equal elastic discs in a box that is periodic all round",
                        .keys = {quantities_key},
                        .is_broken = is_another_gas}},
             .check = check_correlation_points,
             .check_times = warn_without_lags},
            make_measurement<Transport>};
}

} // namespace carrom
