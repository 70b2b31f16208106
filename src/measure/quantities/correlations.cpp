// SPDX-License-Identifier: BSD-3-Clause
// "correlations": how discs have moved relative to their own earlier states, over decades of time:
// mean square displacement, velocity autocorrelation, self-intermediate scattering function,
// non-Gaussian parameter, overlap and its susceptibility chi_4.
//
// Lags and origins are chosen by multiple_tau.hpp. Memory: 32 bytes for each disc, point and level.
// A level is added whenever the measured time doubles. Each sample sends each disc once, and
// compares it with some 1.5 times `correlation_points` of its earlier states.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "measure/followed_discs.hpp"
#include "measure/hdf5_key.hpp"
#include "measure/multiple_tau.hpp"
#include "measure/waiting_times.hpp"
#include "parallel/pieces.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

namespace {

constexpr QuantitySetting correlation_wavenumber{"correlation_wavenumber"},
    overlap_distance{"overlap_distance"};
constexpr std::size_t most_species = 8; ///< with more species there are no tables by species
/// The wavelength of F_s may not be less than the radius divided by this number, because on shorter
/// lengths all motion is free flight.
constexpr double shortest_waves = 1000;
/// Sums are over runs of this many consecutive ids, because all ids of such a run are on one rank.
constexpr std::uint64_t ids_of_run = Pieces::least_rows;

enum Moment : std::uint8_t { squares, fourths, products, waves, overlaps, n_moments };

/// Checks the wavenumber of F_s and the overlap distance against the sizes of discs and box.
void check_lengths(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    const std::string wave = correlation_wavenumber.key_name(),
                      overlap = overlap_distance.key_name();
    const double k = correlation_wavenumber.of(*scene.measurements),
                 least = 2 * std::numbers::pi / scene.box.longest(),
                 most = 2 * std::numbers::pi * shortest_waves / scene.radius,
                 distance = overlap_distance.of(*scene.measurements);
    if (k > 0 && k < least) // an invalid value of 0 has been reported already
        draft.refuse({wave, quantities_key},
                     fmt::format("'{}' = {:g} is a wave that is longer than the box; take {:g} or "
                                 "more",
                                 wave, k, least));
    if (k > most)
        draft.refuse({wave, quantities_key},
                     fmt::format("'{}' = {:g} is a wave that is shorter than a thousandth of the "
                                 "radius; take {:g} or less",
                                 wave, k, most));
    if (distance > scene.box.longest())
        draft.refuse({overlap, quantities_key},
                     fmt::format("'{}' = {:g} is longer than the box; take {:g} or less", overlap,
                                 distance, scene.box.longest()));
}

void check_correlations(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const std::string wave = correlation_wavenumber.key_name(),
                      overlap = overlap_distance.key_name();
    if (!draft.settings.has(wave))
        scene.measurements->derive(std::string(correlation_wavenumber.name),
                                   std::numbers::pi / scene.radius);
    if (!draft.settings.has(overlap))
        scene.measurements->derive(std::string(overlap_distance.name), 0.6 * scene.radius);
    check_lengths(draft);
    if (!scene.measurements->measures("transport")) // "transport" makes the same check
        check_correlation_points(draft);
}

/// cos(2 pi `turns`) to 1e-15, without a function call, so that loops over discs are vectorised.
/// With std::cos, half of a sample's time would be spent on cosines.
inline double cosine_of_turns(double turns) {
    constexpr double rounds = 0x1.8p52; // adding this number rounds to a whole number
    const double z = std::numbers::pi / 2 * (turns - ((turns + rounds) - rounds)), x = z * z;
    double series = 0; // sin z / z, for |z| up to pi / 4
    for (const double factorial :
         {1307674368000.0, 6227020800.0, 39916800.0, 362880.0, 5040.0, 120.0, 6.0})
        series = 1 / factorial - x * series;
    series = 1 - x * series;
    const double half = 1 - 2 * x * series * series; // cos 2 z
    return 2 * half * half - 1;
}

/// Compares discs with their own earlier states.
struct Comparison {
    const FollowedStates &now, &before;
    double turns_per_length, overlap_squared;

    /// Adds the moments of the `n` discs from index `begin` on, in order of id, to the sums
    /// of[0] to of[n_moments - 1]; `n` is at most `ids_of_run`. Terms are computed before they are
    /// added, because loops with sums in a fixed order are not vectorised.
    void add_to(double* of, std::size_t begin, std::size_t n) const {
        // These arrays are not initialised, which saves a tenth of a sample's time.
        std::array<double, ids_of_run> square, product, wave, is_near;
        const double *const x = &now.x[begin], *const y = &now.y[begin], *const vx = &now.vx[begin],
                            *const vy = &now.vy[begin], *const x_before = &before.x[begin],
                            *const y_before = &before.y[begin],
                            *const vx_before = &before.vx[begin],
                            *const vy_before = &before.vy[begin];
        for (std::size_t i = 0; i < n; ++i) {
            const double dx = x[i] - x_before[i], dy = y[i] - y_before[i];
            square[i] = dx * dx + dy * dy;
            is_near[i] = square[i] < overlap_squared ? 1.0 : 0.0;
            product[i] = vx[i] * vx_before[i] + vy[i] * vy_before[i];
            wave[i] = cosine_of_turns(dx * turns_per_length) +
                      cosine_of_turns(dy * turns_per_length);
        }
        std::array<double, n_moments> sums{};
        for (std::size_t i = 0; i < n; ++i) {
            sums[squares] += square[i];
            sums[fourths] += square[i] * square[i];
            sums[products] += product[i];
            sums[waves] += wave[i] / 2;
            sums[overlaps] += is_near[i];
        }
        for (std::size_t k = 0; k < n_moments; ++k) of[k] += sums[k];
    }
};

class Correlations : public Measurement {
public:
    explicit Correlations(MeasuredRun& run)
        : Measurement(run), discs_(run),
          scheme_(static_cast<std::uint64_t>(correlation_points.of(run.output))),
          wavenumber_(correlation_wavenumber.of(run.output)),
          overlap_(overlap_distance.of(run.output)) {
        DiscId end = 0;
        if (run.scene.effects.species.size() <= most_species)
            for (const Species& one : run.scene.effects.species) ends_.push_back(end += one.count);
        if (ends_.empty()) ends_.push_back(run.scene.n_discs);
        waiting_ = WaitingTimes(ends_.size() + 1);
    }

    void begin() override { discs_.begin(); }

    bool has_velocities() const override { return true; }

    void sample(const SampledState& /*state*/) override {
        const FollowedStates& now = discs_.now();
        begin_levels();
        std::vector<std::size_t> lags;
        std::vector<double> sums;
        const std::size_t n_sums = ends_.size() * n_runs() * n_moments;
        scheme_.for_each_pair(n_samples_,
                              [&](std::size_t lag, std::size_t level, std::size_t slot) {
                                  lags.push_back(lag);
                                  sums.resize(sums.size() + n_sums, 0);
                                  compare(now, levels_[level][slot], std::span(sums).last(n_sums));
                              });
        record_means(lags, sums);
        for (std::size_t level = 0; level < levels_.size(); ++level)
            if (scheme_.keeps(level, n_samples_))
                levels_[level][scheme_.slot(level, n_samples_)] = now;
        ++n_samples_;
    }

    void keep(KeptNumbers& kept) override {
        kept.same(static_cast<std::int64_t>(scheme_.points()));
        kept.same(wavenumber_), kept.same(overlap_);
        discs_.keep(kept);
        kept(n_samples_);
        std::size_t n_lags = lags_.size(), n_levels = levels_.size();
        kept(n_lags), kept(n_levels);
        if (n_lags > 1000 || n_levels > 64) return kept.refuse();
        lags_.resize(n_lags, VectorBlocks(n_values()));
        for (VectorBlocks& blocks : lags_) {
            std::vector<std::int64_t> words = blocks.words();
            kept(words);
            if (kept.is_restored() && !blocks.set_words(words)) return kept.refuse();
        }
        levels_.resize(n_levels, Level(scheme_.points()));
        for (Level& level : levels_)
            for (FollowedStates& states : level) keep_states(kept, states);
        if (kept.is_restored() && kept.is_at_end()) return; // data of an earlier version
        waiting_.keep(kept);
    }

    std::vector<MeasuredTable> tables() const override {
        std::vector<MeasuredTable> all = {table_of("correlations", ends_.size())};
        for (std::size_t kind = 0; ends_.size() > 1 && kind < ends_.size(); ++kind)
            all.push_back(table_of(fmt::format("correlations_{}", kind + 1), kind));
        add_waiting_times(all);
        return all;
    }

    /// Tests the last lag of each level and reports the one whose F_s depends most on the waiting
    /// time. Lags above 1/32 of the run are not tested: they have too few independent origins.
    std::string doubt() const override {
        WaitingTimes::Comparison most;
        std::uint64_t length = 0;
        for (std::size_t lag = scheme_.points() - 1; lag < lags_.size();
             lag += scheme_.points() / 2) {
            if (scheme_.lag(lag) * lags_per_run > n_samples_) break;
            const WaitingTimes::Comparison one = waiting_.compare(lag, ends_.size(),
                                                                  scheme_.lag(lag), n_samples_);
            if (one.deviation > most.deviation) most = one, length = scheme_.lag(lag);
        }
        if (most.deviation < most_deviations) return {};
        const auto steps = [&](std::uint64_t samples) {
            return samples * static_cast<std::uint64_t>(run_.output.every_steps);
        };
        return fmt::format("F_s of {} steps depends on the waiting time: {:.3g} at first, and "
                           "{:.3g} after {} steps or more; the discs age, or are not in "
                           "equilibrium, and correlations_waiting shows how",
                           steps(length), most.early, most.late, steps(most.late_from));
    }

private:
    using Level = std::vector<FollowedStates>;
    static constexpr std::uint64_t lags_per_run = 32;
    static constexpr double most_deviations = 4; ///< standard errors; 1 false warning in 300 runs

    void add_waiting_times(std::vector<MeasuredTable>& all) const {
        const auto add = [&](std::string name, std::size_t kind) {
            all.push_back(waiting_.table(std::move(name), kind, scheme_, run_.output.every_steps));
        };
        add("correlations_waiting", ends_.size());
        for (std::size_t kind = 0; ends_.size() > 1 && kind < ends_.size(); ++kind)
            add(fmt::format("correlations_waiting_{}", kind + 1), kind);
    }

    /// Number of values for a lag: moments and the squared overlap, for each species and all discs.
    std::size_t n_values() const { return (n_moments + 1) * (ends_.size() + 1); }

    void keep_states(KeptNumbers& kept, FollowedStates& states) {
        std::uint64_t is_there = run_.ranks.max(states.size() == 0 ? 0.0 : 1.0) > 0 ? 1 : 0;
        kept(is_there);
        if (is_there == 0) return;
        for (std::vector<double>* column : states.columns()) discs_.keep(kept, *column);
    }

    void begin_levels() {
        for (std::size_t level = levels_.size(); level < scheme_.n_levels(n_samples_); ++level) {
            levels_.emplace_back(scheme_.points());
            for (std::uint64_t point = 0; level > 0 && point < scheme_.points() / 2; ++point)
                levels_[level][point] = levels_[level - 1][2 * point];
        }
        lags_.resize(scheme_.n_lags(n_samples_), VectorBlocks(n_values()));
    }

    /// Adds this rank's discs to `sums`, which has a sum for each species, moment and run of ids.
    /// The terms of a sum are added on one rank in order of id, so that any numbers of ranks and
    /// threads give the same bits.
    void compare(const FollowedStates& now, const FollowedStates& before,
                 std::span<double> sums) const {
        const Comparison comparison{now, before, wavenumber_ / (2 * std::numbers::pi),
                                    overlap_ * overlap_};
        const DiscId end = discs_.first_id() + now.size();
        std::size_t kind = 0;
        for (DiscId id = discs_.first_id(), next = id; id < end; id = next) {
            while (id >= ends_[kind]) ++kind;
            const std::uint64_t run = id / ids_of_run;
            next = std::min({end, ends_[kind], (run + 1) * ids_of_run});
            comparison.add_to(&sums[(kind * n_runs() + run) * n_moments], id - discs_.first_id(),
                              next - id);
        }
    }

    /// Computes means from the sums of all ranks, and adds them as a sample to each of `lags`.
    /// `sums` has the sums of one lag after another. **Collective.**
    void record_means(const std::vector<std::size_t>& lags, std::vector<double>& sums) {
        // Each sum is computed on one rank and is 0 on all others, so adding the words is exact.
        std::vector<std::uint64_t> words(sums.size());
        for (std::size_t k = 0; k < sums.size(); ++k)
            words[k] = std::bit_cast<std::uint64_t>(sums[k]);
        run_.ranks.sum(std::span(words));
        const std::uint64_t* next = words.data();
        for (const std::size_t lag : lags) {
            std::vector<double> values;
            std::vector<MovedDiscs> moved;
            std::array<double, n_moments> all{};
            const auto add = [&](const std::array<double, n_moments>& totals, double n) {
                moved.push_back({totals[squares] / n, totals[waves] / n, totals[overlaps] / n});
                for (const double total : totals) values.push_back(total / n);
                values.push_back((totals[overlaps] / n) * (totals[overlaps] / n));
            };
            for (std::size_t kind = 0; kind < ends_.size(); ++kind) {
                std::array<double, n_moments> totals{};
                for (std::size_t run = 0; run < n_runs(); ++run)
                    for (double& total : totals) total += std::bit_cast<double>(*next++);
                for (std::size_t m = 0; m < n_moments; ++m) all[m] += totals[m];
                add(totals, n_of(kind));
            }
            add(all, static_cast<double>(discs_.n_discs()));
            lags_[lag].add(values);
            waiting_.add(lag, n_samples_ - scheme_.lag(lag), moved);
        }
    }

    std::size_t n_runs() const {
        return static_cast<std::size_t>((discs_.n_discs() + ids_of_run - 1) / ids_of_run);
    }

    double n_of(std::size_t kind) const {
        return static_cast<double>(kind == ends_.size() ? ends_.back()
                                   : kind == 0          ? ends_[0]
                                                        : ends_[kind] - ends_[kind - 1]);
    }

    MeasuredTable table_of(std::string name, std::size_t kind) const {
        MeasuredTable table{
            std::move(name),
            {fmt::format("means over discs and overlapping origins, with one standard error (nan "
                         "where there are too few): squares: of displacements; velocities: "
                         "v(0) v(steps); scattering: F_s at k = {:g}; alpha_2: "
                         "<r^4> / (2 <r^2>^2) - 1; overlap: share of discs that are within {:g} of "
                         "where they were; chi_4: N times its variance over origins; diffusion: "
                         "squares over four times the time; diffusion_slope: from their growth "
                         "since the lag before, which is the integral of velocities",
                         wavenumber_, overlap_),
             "lengths in the scene's unit, times in steps"},
            {"steps", "count", "squares", "squares_error", "velocities", "velocities_error",
             "scattering", "scattering_error", "alpha_2", "overlap", "overlap_error", "chi_4",
             "diffusion", "diffusion_error", "diffusion_slope"},
            {}};
        double square_before = 0, time_before = 0;
        for (std::size_t lag = 0; lag < lags_.size(); ++lag) {
            if (lags_[lag].n_samples() == 0) continue;
            const std::vector<SampledMean> means = lags_[lag].means();
            const SampledMean* const of = means.data() + (n_moments + 1) * kind;
            const double r2 = of[squares].value, q = of[overlaps].value;
            const double time = static_cast<double>(scheme_.lag(lag)) *
                                static_cast<double>(run_.output.every_steps);
            table.rows.push_back({time, static_cast<double>(lags_[lag].n_samples()), r2,
                                  of[squares].error, of[products].value, of[products].error,
                                  of[waves].value, of[waves].error,
                                  of[fourths].value / (2 * r2 * r2) - 1, q, of[overlaps].error,
                                  n_of(kind) * (of[n_moments].value - q * q), r2 / (4 * time),
                                  of[squares].error / (4 * time),
                                  (r2 - square_before) / (4 * (time - time_before))});
            square_before = r2, time_before = time;
        }
        return table;
    }

    FollowedDiscs discs_;
    MultipleTau scheme_;
    double wavenumber_, overlap_;
    std::vector<DiscId> ends_; ///< for each species, the id after its last one
    std::uint64_t n_samples_ = 0;
    std::vector<Level> levels_;      ///< earlier states of this rank's range of ids, by slot
    std::vector<VectorBlocks> lags_; ///< blocks of means over discs, the same on all ranks
    WaitingTimes waiting_;           ///< means by waiting time, the same on all ranks
};

bool needs_another_box(const SceneParameters& s) {
    return measures(s, "correlations") &&
           (s.effects.have_open_boundaries() || s.effects.are_sheared());
}

} // namespace

MeasuredQuantity correlations_quantity() {
    return {{.name = "correlations",
             .help = "Displacements, velocities, F_s, alpha_2 and chi_4 over decades of time.",
             .needs_lasting_sides = true,
             .keys = {correlation_points_key(), hdf5_key(),
                      correlation_wavenumber
                          .number("1/length", "Wave number of F_s.", "pi over the radius")
                          .within({.low = 0, .excludes_low = true}),
                      overlap_distance
                          .number("length",
                                  "Discs that are within it of where they were overlap "
                                  "with themselves.",
                                  "0.6 radii")
                          .within({.low = 0, .excludes_low = true})},
             .rules = {{.one = "\"correlations\"",
                        .other = "an open or a sheared side",
                        .why = "discs leave, or drift apart with the flow",
                        .keys = {quantities_key},
                        .is_broken = needs_another_box}},
             .check = check_correlations,
             .check_times =
                 [](const SceneDraft& draft) {
                     if (!measures(draft.scene, "transport")) warn_without_lags(draft);
                 }},
            make_measurement<Correlations>,
            {"correlations_waiting"}};
}

} // namespace carrom
