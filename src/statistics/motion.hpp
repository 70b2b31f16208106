// SPDX-License-Identifier: BSD-3-Clause
// Sums over all discs at one time, and the time integrals of stress and kinetic energy between
// two such times. Temperature and pressure follow from them (docs/understanding/pressure.md).
//
// All sums have the same bits for any number of ranks and threads. A sample takes two passes over
// the discs, which together take about five nanoseconds per disc.
#pragma once

#include <cstdint>
#include <span>

#include <carrom/box.hpp>

#include "core/disc_state.hpp"
#include "core/flight_integral.hpp"
#include "core/frame.hpp"
#include "dynamics/species.hpp"
#include "engine/stress_sums.hpp"
#include "parallel/communicator.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

/// A symmetric tensor of products of two vectors.
struct Tensor {
    double xx = 0, xy = 0, yy = 0;

    Tensor& operator+=(const Tensor& other);
    friend Tensor operator*(double factor, const Tensor& t) {
        return {factor * t.xx, factor * t.xy, factor * t.yy};
    }
};

/// Sums over discs at one time: collisions of all discs; all other sums and means are over the
/// discs in the box. Speeds are in units of `speed_unit`, a power of two, per micro-step.
struct MotionSample {
    std::uint64_t wall_collisions = 0,
                  /// Collisions since the scene's start; a collision of a pair counts once
        pair_collisions = 0;
    double speed_unit = 1;
    /// Means over the discs of the speed, its square and its fourth power
    double mean_speed = 0, mean_square = 0, mean_fourth = 0;
    double n_discs = 0;                              ///< number of discs in the box
    double mass = 0, momentum_x = 0, momentum_y = 0; ///< sums over all discs in the box
    Tensor motion;                                   ///< sum of m v v over all discs in the box
    /// Time integral of stress times area since the sums began, in mass length^2 per micro-step
    Tensor stress;
    double energy = 0; ///< the integral of the trace of `motion`, in the same unit
    double area = 0;   ///< area of the box
};

/// Samples everything except stress, energy and area. Each term is rounded to about N 2^-62 of its
/// largest value, so that the bits do not depend on ranks and threads. Without a species table all
/// masses are 1. **Collective.**
MotionSample sample_motion(std::span<const DiscState> own, const SpeciesTable* species_table,
                           double heaviest, std::uint64_t n_discs, int n_threads,
                           const Communicator& communicator);

/// Adds the integrals in `mine`, summed over all ranks, to `sample`. **Collective.**
void add_integrals(const StressSums& mine, const Communicator& communicator, MotionSample& sample);
/// Adds the integrals over flights since the last sync; `frame` is the frame of the stored discs.
void add_flights(const FlightIntegral& flights, const Frame& frame, MotionSample& sample);

/// Constants of the scene that averages need.
struct AveragedSystem {
    Box box;
    double n_discs = 0, radius = 0;
    double velocity_unit = 1; ///< converts stored velocities to velocities per step
    std::int64_t micro_steps = 1, sync_every = 1;
    bool is_plain = true; ///< discs and walls are elastic; otherwise pressures from counts are NaN
    bool keeps_discs = true; ///< no disc can leave; otherwise collisions per disc are NaN
    /// How temperature and pressure treat the mean velocity of all discs along each axis
    Drift drift_x = Drift::is_heat, drift_y = Drift::is_heat;
    bool has_flow = false; ///< the kinetic part is relative to a flow, and computed from samples
    /// Whether the kinetic energy is conserved; if not, samples are closer in time
    bool keeps_energy = true;
    std::int64_t last_step = 0; ///< the last step that the run is certain to reach
};

/// Integrals over the steps between two samples.
struct MotionIntegrals {
    double steps = 0, area = 0, n_discs = 0;
    /// Sum of m v v, without the drift along axes where the drift is not part of the temperature.
    /// Along those axes it is scaled by N / (N - 1) for the lost degree of freedom, so that its
    /// mean is N kT along each axis; for a single disc it is NaN.
    Tensor kinetic;
    Tensor stress; ///< stress times area

    MotionIntegrals& operator+=(const MotionIntegrals& other);
    double pressure(double Tensor::* part) const { return stress.*part / area; }
    double pressure() const { return (stress.xx + stress.yy) / (2 * area); }
    /// Integral of N kT over time, in steps.
    double energy() const { return (kinetic.xx + kinetic.yy) / 2; }
    double temperature() const { return energy() / n_discs; }
};
MotionIntegrals integrals_between(const AveragedSystem& system, const MotionSample& before,
                                  const MotionSample& after, double steps);
/// kT at the time of a sample.
double temperature_at(const AveragedSystem& system, const MotionSample& sample);

} // namespace carrom
