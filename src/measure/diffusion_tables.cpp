// SPDX-License-Identifier: BSD-3-Clause
#include "measure/diffusion_tables.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "statistics/block_averages.hpp"

namespace carrom {

namespace {

/// Windows follow each other; each has its numbers at times 0, every_steps ... correlation_steps.
class Windows {
public:
    explicit Windows(const SampleSums& sums)
        : sums_(sums),
          n_times_(static_cast<std::size_t>(sums.correlation_steps / sums.every_steps) + 1) {}

    std::size_t n_times() const { return n_times_; }
    std::size_t n_whole() const { return sums_.flights.size() / 3 / n_times_; }
    double steps(std::size_t time) const {
        return static_cast<double>(static_cast<std::int64_t>(time) * sums_.every_steps);
    }
    /// A number of each window that has come to that time.
    template <class Number> std::vector<double> each(std::size_t time, const Number& number) const {
        std::vector<double> values;
        for (std::size_t k = time; 3 * k < sums_.flights.size(); k += n_times_)
            values.push_back(number(sums_.flights.data() + 3 * k));
        return values;
    }

private:
    const SampleSums& sums_;
    std::size_t n_times_;
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

/// From half of the squares' growth in the second half of each window; along one axis for each.
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

} // namespace

void add_diffusion_tables(const SampleSums& sums, std::vector<MeasuredTable>& tables) {
    const Windows windows(sums);
    tables.push_back(velocity_autocorrelation(windows));
    if (windows.n_whole() > 0) tables.push_back(diffusion(windows));
}

} // namespace carrom
