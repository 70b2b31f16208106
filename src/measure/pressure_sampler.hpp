// SPDX-License-Identifier: BSD-3-Clause
// The mean pressure tensor between two samples, from the time integral of stress since the last one
// (docs/understanding/pressure.md).
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "measure/kept_numbers.hpp"
#include "measure/motion_interval.hpp"

namespace carrom {

class PressureSampler {
public:
    /// Number of values for each interval in `pressures`: xx, xy, yy, kT and N kT / A.
    static constexpr std::size_t n_numbers = 5;

    /// Starts at the present step. **Collective.**
    PressureSampler(DiscSystem& system, const Communicator& ranks)
        : system_(&system), interval_(system, ranks) {}

    /// Adds an interval of `steps` steps, and starts the next one. **Collective.**
    void sample(double steps);
    /// Starts the interval again at this step, with the velocities that effects have just changed.
    /// **Collective.**
    void begin_interval() { interval_.begin(interval_.now()); }
    const std::vector<double>& pressures() const { return pressures_; }
    void forget_pressures() { pressures_.clear(); }
    /// The last sample. A restart does not restore its mean speeds and counts of collisions.
    const MotionSample& last() const { return interval_.last(); }
    double temperature() const; ///< temperature at the last sample
    // Means over the last interval:
    double mean_temperature() const { return pressures_[pressures_.size() - n_numbers + 3]; }
    /// The mean kinetic energy; invalid between sheared sides, and after a restart until a sample.
    double mean_energy() const { return mean_energy_; }
    /// Integral of stress times area over the last interval, times in steps; drift is not removed.
    const Tensor& last_integral() const { return last_integral_; }

    /// Stores the data of `sampler`, or makes a sampler from stored data before any step.
    /// **Collective.**
    static void keep(KeptNumbers& kept, std::optional<PressureSampler>& sampler, DiscSystem& system,
                     const Communicator& ranks);

private:
    PressureSampler(DiscSystem& system, std::vector<double> pressures, MotionInterval interval)
        : system_(&system), pressures_(std::move(pressures)), interval_(interval) {}

    DiscSystem* system_;
    std::vector<double> pressures_;
    MotionInterval interval_;
    Tensor last_integral_;
    double mean_energy_ = 0;
};

} // namespace carrom
