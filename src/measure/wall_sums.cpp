// SPDX-License-Identifier: BSD-3-Clause
#include "measure/wall_sums.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "measure/speeds.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

void WallMeasurement::begin() {
    speed_scale_ = std::max(usual_speed(run_), driven_speed(run_.scene));
    follow();
}

void WallMeasurement::follow() {
    clear();
    run_.system.engine().followers_of_walls().forget(*this);
    run_.system.engine().followers_of_walls().add(*this);
}

std::vector<MeasuredTable> WallMeasurement::tables() const {
    if (given_.empty()) return {};
    MeasuredTable over_time = history();
    MeasuredTable means = means_of(over_time);
    return {std::move(means), std::move(over_time)};
}

double length_of_side(const SceneParameters& scene, std::size_t side, double step) {
    const Extent box = extent_of_lines(scene.effects, scene.box, step);
    return side < 2 ? box.y_high - box.y_low : box.x_high - box.x_low;
}

std::vector<std::vector<double>> rows_over_time(const MeasuredRun& run,
                                                std::span<const double> given,
                                                std::size_t per_interval) {
    std::vector<std::vector<double>> rows;
    for (std::size_t k = 0; k < given.size() / per_interval; ++k) {
        const double from = run.step_of(k);
        const double to = from + static_cast<double>(run.output.every_steps);
        std::vector<double>& row = rows.emplace_back(std::vector<double>{from, to});
        for (std::size_t n = 0; n < per_interval; ++n) {
            const std::size_t side = n % 4;
            // Apart from vibrations walls move at constant speed, so the mean length of a side is
            // its length in the middle of the interval.
            const double length = length_of_side(run.scene, side, (from + to) / 2);
            row.push_back(run.scene.effects.boundaries[side].is_periodic()
                              ? std::nan("")
                              : given[per_interval * k + n] / (length * (to - from)));
        }
    }
    return rows;
}

std::vector<MeanAndError> means_over_time(const std::vector<std::vector<double>>& rows) {
    std::vector<MeanAndError> means;
    for (std::size_t column = 2; column < rows.front().size(); ++column) {
        std::vector<double> terms;
        double sum = 0;
        for (const std::vector<double>& row : rows) {
            terms.push_back(row[column]);
            sum += row[column];
        }
        means.push_back({sum / static_cast<double>(terms.size()), standard_error(terms)});
    }
    return means;
}

} // namespace carrom
