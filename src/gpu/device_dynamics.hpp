// SPDX-License-Identifier: BSD-3-Clause
// The dynamics on a device: a scene's motion (dynamics/motion.hpp) between walls that only reverse
// a velocity. DeviceDynamics is plain data with the functions that StepWalls and the sums of stress
// need.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/device.hpp"
#include "dynamics/all_dynamics.hpp"
#include "dynamics/mirror_sides.hpp"

namespace carrom {

template <class OfMotion> class DeviceDynamics : public OfMotion {
    using Flight = RestingFrame;

public:
    using Motion = OfMotion;
    using typename Motion::Arithmetic;
    static constexpr bool may_lose_discs = false, may_have_fixed_bodies = false;

    explicit DeviceDynamics(const Motion& motion)
        : Motion(motion), sides_(this->box_, this->radius_, {}) {}

    CARROM_DEVICE static constexpr bool has_fixed_bodies() { return false; }
    CARROM_DEVICE const MirrorSides<Arithmetic>& sides() const { return sides_; }
    /// Whether the disc may meet a wall in a micro-step that ends by `time`; if false, it cannot. A
    /// disc also meets a wall if it flies towards it and ends a micro-step within 1e-8 radii of it.
    CARROM_DEVICE bool may_meet_wall(const DiscState& disc, double time) const {
        if (!this->space_.has_sides()) return false;
        const double fastest = std::max(std::fabs(disc.vx), std::fabs(disc.vy));
        const double margin = this->tolerance_ + this->arithmetic_.place_rounding() +
                              2 * this->band_ + Arithmetic::time_rounding * time * fastest;
        return sides_.may_meet(disc, time, margin, {});
    }

    CARROM_DEVICE static constexpr double slowing_at(double time) {
        return Flight::slowing_at(time);
    }
    CARROM_DEVICE static constexpr FlightIntegral flight_integral_at(double time) {
        return Flight::flight_integral_at(time);
    }
    CARROM_DEVICE static constexpr double pair_weight_at(double time) {
        return Flight::pair_weight_at(time);
    }

private:
    MirrorSides<Arithmetic> sides_;
};

/// Whether a GPU can run scenes with these dynamics.
template <class OfDynamics>
constexpr bool is_dynamics_of_gpus = !OfDynamics::has_moving_images &&
                                     !std::is_same_v<OfDynamics, GrowingDynamics>;

/// The type of the motion of a dynamics.
template <class OfDynamics>
using MotionOf = std::remove_cvref_t<decltype(std::declval<const OfDynamics&>().motion())>;

// Calls make(dynamics) for each dynamics whose scenes a GPU can run.
#define CARROM_FOR_EACH_DYNAMICS_OF_GPUS(make)                                                     \
    make(PlainDynamics) make(StudyDynamics<double>) make(StudyDynamics<float>)                     \
        make(WalledDynamics) make(WalledMixedDynamics) make(PeriodicDynamics)                      \
            make(PeriodicMixedDynamics)

} // namespace carrom
