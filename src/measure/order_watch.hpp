// SPDX-License-Identifier: BSD-3-Clause
// Detects whether a run is still changing although its averages do not show it. It samples psi6 of
// dense discs, and the energy of discs that do not conserve it.
//
// A melting crystal has almost the pressure of the fluid, while its order falls by half. So psi6 is
// sampled in every run that is denser than `least_watched_packing` or measures psi6 as a quantity.
// In the mean time between samples a disc at a typical speed moves at least eight radii, and a run
// of the planned length has at most some 32 samples. When there are `most_samples` samples, every
// second one is dropped, and later samples are twice as far apart. Sample times are irregular, so
// that a periodic drive cannot look like a trend.
//
// A sample of psi6 costs a microsecond for each of at most 4096 discs, and an exchange of the halo.
// Five collisions of each disc take about the same time. Memory: 24 bytes a sample.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/measurement.hpp"
#include "simulation/advance.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

/// A number that is watched over the run.
struct WatchedNumber {
    std::string name; ///< one of OrderWatch::order_names, or
                      ///< "energy": kinetic, rotational and potential
    SampledMean mean;
    /// Means over the quarters of the run; NaN if there are fewer than eight samples
    std::array<double, 4> quarters{};
};

class OrderWatch : public StepAction {
public:
    static constexpr double least_watched_packing = 0.65;
    static constexpr std::size_t most_samples = 64;
    /// Names of |mean psi6| and mean |psi6|; both means are over discs
    static constexpr std::array<const char*, 2> order_names = {"psi6", "local_psi6"};

    /// All arguments must outlive this object.
    OrderWatch(const SceneParameters& scene, DiscSystem& system, const Communicator& ranks);
    OrderWatch(const OrderWatch&) = delete;
    OrderWatch& operator=(const OrderWatch&) = delete;

    /// Starts at the present step if the scene's averages begin at or before it, or continues from
    /// the data of a checkpoint. **Collective.**
    void begin(std::span<const std::int64_t> stored = {});
    std::int64_t next_due(std::int64_t step) const override;
    bool act() override;
    /// The data for a checkpoint; empty until the first step at which averages begin.
    std::vector<std::int64_t> stored();

    std::vector<WatchedNumber> watched() const;

private:
    struct Sample {
        double together = 0, local = 0, energy = 0; ///< |mean psi6|; mean |psi6|; energy
    };

    bool is_watching() const { return has_order_ || has_energy_; }
    void start();
    void keep(KeptNumbers& kept);
    std::int64_t step_of_next() const;
    Sample sampled() const;
    WatchedNumber number(std::string name, double Sample::* one) const;

    MeasuredRun run_;
    bool has_order_, has_energy_, has_begun_ = false;
    std::int64_t first_step_ = 0, interval_ = 1;
    std::vector<Sample> samples_;
};

/// The means of the quarters of a series; NaN if it has fewer than eight terms.
std::array<double, 4> quarters_of(std::span<const double> terms);

} // namespace carrom
