// SPDX-License-Identifier: BSD-3-Clause
// "diffusion": the coefficient of diffusion and the autocorrelation of velocities,
// from successive windows of time.
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "measure/flights.hpp"
#include "measure/measurement.hpp"
#include "scene/limits.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

namespace {

constexpr QuantitySetting correlation_steps{"correlation_steps"};

std::int64_t window_of(const MeasurementOutput& output) {
    return static_cast<std::int64_t>(correlation_steps.of(output));
}

/// Warns if the run is too short for a window, so that it has no coefficient of diffusion. This is
/// not an error, because a restart may complete a window.
void warn_of_short_run(SceneParameters& scene) {
    const MeasurementOutput& output = *scene.measurements;
    const std::int64_t window = window_of(output), steps = scene.steps - output.from_step;
    if (scene.steps == 0 || steps < 0 || window <= steps) return;
    const std::int64_t longest = steps / output.every_steps * output.every_steps;
    const std::string remedy =
        longest >= 2 * output.every_steps
            ? fmt::format("output.measurements.correlation_steps = {} or less; an error takes four "
                          "windows",
                          longest)
        : steps >= 2 ? fmt::format("output.measurements.every_steps = {} or less", steps / 2)
                     : "a smaller output.measurements.from_step";
    scene.warnings.push_back(
        fmt::format("no table of diffusion: its first window takes {} steps, and from step {} to "
                    "the last one are {}; try: {}",
                    window, output.from_step, steps, remedy));
}

void check_window(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const std::string key = correlation_steps.key_name();
    const std::int64_t every = scene.measurements->every_steps;
    if (!draft.settings.has(key))
        scene.measurements->derive(std::string(correlation_steps.name),
                                   64 * static_cast<double>(every));
    if (draft.settings.has(key) && !draft.settings.is_right(key)) return;
    const std::int64_t window = window_of(*scene.measurements);
    if (window >= 2 * every && window % every == 0) return warn_of_short_run(scene);
    draft.refuse({key, quantities_key},
                 fmt::format("'{}' must be a multiple of 'output.measurements.every_steps' = {}, "
                             "from {} on, not {}",
                             key, every, 2 * every, window));
}

/// Successive windows. Each has three means for each of the times 0, every_steps, and so on up to
/// correlation_steps, counted from the start of the window.
class Windows {
public:
    Windows(const std::vector<double>& numbers, std::size_t n_times, std::int64_t every_steps)
        : numbers_(numbers), n_times_(n_times), every_steps_(every_steps) {}

    std::size_t n_times() const { return n_times_; }
    std::size_t n_whole() const { return numbers_.size() / 3 / n_times_; }
    double steps(std::size_t time) const {
        return static_cast<double>(static_cast<std::int64_t>(time) * every_steps_);
    }
    /// Calls `number` with the three means at the time with index `time`, for each window that has
    /// reached this time, and returns all values.
    template <class Number> std::vector<double> each(std::size_t time, const Number& number) const {
        std::vector<double> values;
        for (std::size_t k = time; 3 * k < numbers_.size(); k += n_times_)
            values.push_back(number(numbers_.data() + 3 * k));
        return values;
    }

private:
    const std::vector<double>& numbers_; ///< means of dx^2, dy^2 and v(0) . v(t) for each time t
    std::size_t n_times_;
    std::int64_t every_steps_;
};

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

MeasuredTable velocity_autocorrelation(const Windows& windows) {
    MeasuredTable table{
        "velocity_autocorrelation",
        {"velocities: mean of v(0) v(steps); squares: mean square displacement; "
         "over all discs and windows, with one standard error",
         "lengths in the scene's unit, times in steps; nan where there are too few "
         "windows for an error"},
        {"steps", "count", "velocities", "velocities_error", "squares", "squares_error"},
        {}};
    for (std::size_t time = 0; time < windows.n_times(); ++time) {
        const std::vector<double> products = windows.each(time,
                                                          [](const double* of) { return of[2]; });
        const std::vector<double> squares = windows.each(
            time, [](const double* of) { return of[0] + of[1]; });
        if (products.empty()) break;
        table.rows.push_back({windows.steps(time), static_cast<double>(products.size()),
                              mean_of(products), standard_error(products), mean_of(squares),
                              standard_error(squares)});
    }
    return table;
}

/// D, also along x and y alone, from the growth of mean square displacements in the second half of
/// each window.
MeasuredTable diffusion(const Windows& windows) {
    const std::size_t last = windows.n_times() - 1, middle = last / 2;
    MeasuredTable table{"diffusion",
                        {"D: growth of the mean square displacement from step `from` to `to` of a "
                         "window, over 4 (x, y: along one axis, over 2) and that time",
                         "with one standard error from the windows, nan where there are too few; "
                         "lengths squared per step"},
                        {"D", "D_error", "x", "x_error", "y", "y_error", "from", "to", "count"},
                        {{}}};
    const double twice = 2 * (windows.steps(last) - windows.steps(middle));
    const auto growth = [&](std::size_t axis) {
        const auto number = [axis](const double* of) { return of[axis]; };
        std::vector<double> ends = windows.each(last, number),
                            middles = windows.each(middle, number);
        for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = (ends[k] - middles[k]) / twice;
        return ends;
    };
    const std::vector<double> x = growth(0), y = growth(1);
    std::vector<double> both;
    for (std::size_t k = 0; k < x.size(); ++k) both.push_back((x[k] + y[k]) / 2);
    for (const std::vector<double>* values : std::array{&std::as_const(both), &x, &y}) {
        table.rows[0].push_back(mean_of(*values));
        table.rows[0].push_back(standard_error(*values));
    }
    table.rows[0].insert(table.rows[0].end(), {windows.steps(middle), windows.steps(last),
                                               static_cast<double>(x.size())});
    return table;
}

class Diffusion : public Measurement {
public:
    explicit Diffusion(MeasuredRun& run)
        : Measurement(run), flights_(run, true),
          n_times_(static_cast<std::size_t>(window_of(run.output) / run.output.every_steps) + 1) {}

    void begin() override { flights_.follow(); }

    bool has_velocities() const override { return true; }

    void sample(const SampledState& state) override {
        const std::span<const DiscState> discs = flights_.flown(state.shown);
        const auto add = [&] {
            const std::array<double, 3> means = flights_.means(discs, state.n_discs);
            numbers_.insert(numbers_.end(), means.begin(), means.end());
        };
        if (state.is_first) flights_.begin(discs);
        add();
        if (numbers_.size() / 3 % n_times_ != 0) return;
        flights_.begin(discs); // the end of a window is the start of the next
        add();
    }

    void keep(KeptNumbers& kept) override {
        kept.same(window_of(run_.output));
        kept(numbers_);
    }
    void store_discs(StoredSamples& stored) override { flights_.store(stored); }
    void restore_discs(const StoredSamples& stored) override { flights_.restore(stored); }

    std::vector<MeasuredTable> tables() const override {
        const Windows windows(numbers_, n_times_, run_.output.every_steps);
        std::vector<MeasuredTable> both = {velocity_autocorrelation(windows)};
        if (windows.n_whole() > 0) both.push_back(diffusion(windows));
        return both;
    }

private:
    Flights flights_;
    std::size_t n_times_;
    /// For each time of each window: mean squares of displacements along x and y, and the mean
    /// scalar product of first and present velocities
    std::vector<double> numbers_;
};

} // namespace

MeasuredQuantity diffusion_quantity() {
    return {{.name = "diffusion",
             .help = "Coefficient of diffusion, and autocorrelation of velocities.",
             .needs_lasting_sides = true,
             .keys = {correlation_steps
                          .integer("steps",
                                   "Longest time of diffusion and velocity autocorrelation; then "
                                   "they begin anew.",
                                   "64 samples")
                          .within({1, largest_steps})},
             .has_history = true,
             .rules = {{.one = "sheared sides",
                        .other = "\"diffusion\"",
                        .why = "discs drift apart with the flow",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "diffusion") && s.effects.are_sheared();
                            }},
                       {.one = "\"diffusion\"",
                        .other = "\"displacement\"",
                        .why = "a run keeps one first place of each disc; diffusion has "
                               "displacements in its table",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "diffusion") && measures(s, "displacement");
                            }},
                       {.one = "\"diffusion\"",
                        .other = "an open side",
                        .why = "with open sides velocities and densities alone are measured",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "diffusion") && s.effects.have_open_boundaries();
                            }}},
             .check_times = check_window},
            make_measurement<Diffusion>,
            {"velocity_autocorrelation"}};
}

} // namespace carrom
