// SPDX-License-Identifier: BSD-3-Clause
// The mean pressure tensor between two samples, from the time integral of stress between them
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

    /// Ends an interval of `steps` steps, appends its means to `pressures`, and starts the next
    /// interval. **Collective.**
    void sample(double steps);
    /// Restarts the interval at this step, because effects have just changed velocities.
    /// **Collective.**
    void begin_interval() { interval_.begin(interval_.now()); }
    const std::vector<double>& pressures() const { return pressures_; }
    void forget_pressures() { pressures_.clear(); }
    /// The last sample. A restart does not restore its mean speeds and counts of collisions.
    const MotionSample& last() const { return interval_.last(); }
    double temperature() const; ///< temperature at the last sample
    // Means over the last interval:
    double mean_temperature() const { return pressures_[pressures_.size() - n_numbers + 3]; }
    /// The mean kinetic energy. It is not valid between sheared sides, nor after a restart before
    /// the next sample.
    double mean_energy() const { return mean_energy_; }
    /// Time integral, in steps, of stress times area over the last interval. The drift of the
    /// centre of mass is not subtracted.
    const Tensor& last_integral() const { return last_integral_; }

    /// Stores the data of `sampler`, or sets `sampler` to one with stored data; call it before any
    /// step in this case. **Collective.**
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
