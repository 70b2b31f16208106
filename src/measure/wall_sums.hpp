// SPDX-License-Identifier: BSD-3-Clause
// Functions for all quantities of walls: sums over collisions with the four sides of the box,
// tables of these sums over time, and rules for scenes. The sums are exact, so they do not depend
// on the order of collisions or on the ranks that carry them out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/exact_sum.hpp"
#include "engine/engine.hpp"
#include "measure/measurement.hpp"

namespace carrom {

/// One sum for each side, in the order of `boundary_names`.
class WallSums {
public:
    /// `largest_sum` is an upper bound of each side's absolute sum over all ranks. It must be the
    /// same on all ranks.
    explicit WallSums(double largest_sum)
        : sums_{ExactSum(largest_sum), ExactSum(largest_sum), ExactSum(largest_sum),
                ExactSum(largest_sum)} {}

    void add(std::size_t side, double term) { sums_[side].add(term); }

    /// The sums over all ranks. **Collective.**
    std::array<double, 4> values(const Communicator& ranks) const {
        std::array<double, 4> all{};
        for (std::size_t side = 0; side < 4; ++side) all[side] = joined(side, ranks).value();
        return all;
    }
    /// Two words for the sum of each side, over all ranks. **Collective.**
    std::vector<std::uint64_t> words(const Communicator& ranks) const {
        std::vector<std::uint64_t> all;
        for (std::size_t side = 0; side < 4; ++side) {
            const ExactSum sum = joined(side, ranks);
            all.insert(all.end(), {sum.low_word(), sum.high_word()});
        }
        return all;
    }
    void add_words(const std::uint64_t* words) {
        for (std::size_t side = 0; side < 4; ++side)
            sums_[side].add_words(words[2 * side], words[2 * side + 1]);
    }

private:
    ExactSum joined(std::size_t side, const Communicator& ranks) const {
        ExactSum sum = sums_[side];
        ranks.sum(sum);
        return sum;
    }

    std::array<ExactSum, 4> sums_;
};

/// A quantity of collisions with the sides of the box. Each sample is the momentum or the energy
/// that discs and each side have exchanged since the last sample.
class WallMeasurement : public Measurement, public WallFollower {
public:
    using Measurement::Measurement;
    ~WallMeasurement() override { run_.system.engine().followers_of_walls().forget(*this); }

    void begin() override;
    std::vector<MeasuredTable> tables() const override;

protected:
    /// Empties the sums and adds all later collisions with walls to them.
    void follow();
    /// Empties the sums since the last sample; their unit follows from `speed_scale_`.
    virtual void clear() = 0;
    virtual MeasuredTable history() const = 0;
    virtual MeasuredTable means_of(const MeasuredTable& history) const = 0;

    double speed_scale_ = 0;    ///< typical speed, which defines the units of sums
    std::vector<double> given_; ///< momentum or energy exchanged at each side in each interval
};

/// The length of a side at a step; between vibrating walls its mean length.
double length_of_side(const SceneParameters& scene, std::size_t side, double step);

/// A row for each interval between samples: its first and last step, then its elements of `given`,
/// divided by the length of their side and by the time; NaN for a periodic side. `given` has
/// `per_interval` elements for each interval, and every four of them belong to the four sides.
std::vector<std::vector<double>> rows_over_time(const MeasuredRun& run,
                                                std::span<const double> given,
                                                std::size_t per_interval);

struct MeanAndError {
    double mean = 0;
    double error = 0; ///< one standard error; NaN if there are too few intervals
};
/// Means of all columns of `rows_over_time` except the two steps.
std::vector<MeanAndError> means_over_time(const std::vector<std::vector<double>>& rows);

/// Rules for a scene with a quantity of walls: no side may be open, and the box may not be periodic
/// along both axes.
template <bool (*is_measured)(const SceneParameters&)>
std::vector<Rule> rules_of_walls(std::string_view quantity) {
    return {{.one = quantity,
             .other = "a box that is periodic all round",
             .why = "it has no walls",
             .keys = {quantities_key},
             .is_broken =
                 [](const SceneParameters& s) {
                     return is_measured(s) && s.effects.is_periodic_x() &&
                            s.effects.is_periodic_y();
                 }},
            {.one = quantity,
             .other = "an open side",
             .why = "with open sides velocities and densities alone are measured",
             .keys = {quantities_key},
             .is_broken = [](const SceneParameters& s) {
                 return is_measured(s) && s.effects.have_open_boundaries();
             }}};
}

} // namespace carrom
