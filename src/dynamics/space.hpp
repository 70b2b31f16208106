// SPDX-License-Identifier: BSD-3-Clause
// The space in which discs fly: which image of a disc another disc meets, where the image is, and
// how fast it moves. It is one part of a dynamics (dynamics.hpp); a space is plain data.
//
//   WalledSpace     discs have no images
//   PeriodicSpace   the box repeats itself, at rest, along one axis or both axes (core/image.hpp)
//   ShearedSpace    the rows of boxes above and below move along x (A. W. Lees and S. F. Edwards,
//                   J. Phys. C 5, 1921 (1972)), so that the gas flows with vx = rate (y - const)
//                   without any wall
//
// The separation of two discs is the difference of their stored positions plus a whole number of
// box lengths, added in one fixed order, so that all ranks find the same bits. Under shear the
// image also has a velocity of its own. A disc that leaves through a sheared side keeps its stored
// state until the next sync, which gives it the position and velocity of its image in the box.
// Cost: images beyond these sides are faster than discs in the box, by up to rate times the box's
// height, and searches have to allow for this.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "core/axis.hpp"
#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "core/image.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/encounter.hpp"

namespace carrom {

template <class S>
concept Space = std::is_trivially_copyable_v<S> &&
                requires(S changing, const S space, const DiscState& p, DiscState& q,
                         std::int64_t n, double d, Axis axis) {
                    { S::is_periodic } -> std::convertible_to<bool>; // whether discs have images
                    { S::has_moving_images } -> std::convertible_to<bool>; // whether images move
                    changing.begin_interval(n); // times are then relative to micro-step n
                    // see(p, q, dx, dy, time): position and velocity of q relative to p at `time`,
                    // where (dx, dy) is the difference of their positions, without images.
                    { space.see(p, p, d, d, d) } -> std::same_as<Encounter<double>>;
                    { space.is_periodic_along(axis) } -> std::same_as<bool>;
                    { space.has_sides() } -> std::same_as<bool>;
                    // half the largest gap that rounding leaves between discs at a contact
                    { space.slack() } -> std::convertible_to<double>;
                    // squared speeds that searches allow for: of the disc's stored image, and of
                    // its image in the box at a time
                    { space.squared_speed(p) } -> std::same_as<double>;
                    { space.squared_speed_at(p, d) } -> std::same_as<double>;
                    requires !S::is_periodic || requires {
                        { space.periods() } -> std::same_as<const Periods&>;
                        space.wrap(q); // brings the disc into the box, at a sync
                    };
                };

class WalledSpace {
public:
    static constexpr bool is_periodic = false, has_moving_images = false;

    WalledSpace(const Box& /*box*/, const Effects& /*effects*/) {}

    CARROM_DEVICE static void begin_interval(std::int64_t /*n*/) {}
    template <class State, class Real>
    [[gnu::always_inline]] CARROM_DEVICE static Encounter<Real> see(const State& p, const State& q,
                                                                    Real dx, Real dy,
                                                                    Real /*time*/) {
        return {dx, dy, q.vx - p.vx, q.vy - p.vy};
    }
    static constexpr bool is_periodic_along(Axis /*axis*/) { return false; }
    static constexpr bool has_sides() { return true; }
    static constexpr double slack() { return 0; }
    CARROM_DEVICE static double squared_speed(const DiscState& disc) {
        return squared_speed_of(disc);
    }
    CARROM_DEVICE static double squared_speed_at(const DiscState& disc, double /*time*/) {
        return squared_speed_of(disc);
    }
};

/// Each axis has walls or is periodic.
class PeriodicSpace {
public:
    static constexpr bool is_periodic = true, has_moving_images = false;

    /// `effects` have times in micro-steps.
    PeriodicSpace(const Box& box, const Effects& effects)
        : periods_(effects.periods(box)), slack_(0x1p-36 * box.longest()) {}

    CARROM_DEVICE static void begin_interval(std::int64_t /*n*/) {}
    [[gnu::always_inline]] CARROM_DEVICE Encounter<double> see(const DiscState& p,
                                                               const DiscState& q, double dx,
                                                               double dy, double /*time*/) const {
        return {dx + periods_.x_between(p, q), dy + periods_.y_between(p, q), q.vx - p.vx,
                q.vy - p.vy};
    }
    CARROM_DEVICE bool is_periodic_along(Axis axis) const { return periods_.along(axis) != 0; }
    CARROM_DEVICE bool has_sides() const { return periods_.x == 0 || periods_.y == 0; }
    CARROM_DEVICE double slack() const { return slack_; }
    CARROM_DEVICE static double squared_speed(const DiscState& disc) {
        return squared_speed_of(disc);
    }
    CARROM_DEVICE static double squared_speed_at(const DiscState& disc, double /*time*/) {
        return squared_speed_of(disc);
    }
    CARROM_DEVICE const Periods& periods() const { return periods_; }
    CARROM_DEVICE void wrap(DiscState& disc) const { periods_.wrap(disc, disc.tau); }
    /// Changes the side lengths of a box that is periodic along both axes.
    void reshape(const Box& box) {
        periods_.x = box.x;
        periods_.y = box.y;
        slack_ = 0x1p-36 * box.longest();
    }

private:
    Periods periods_;
    double slack_;
};

class ShearedSpace {
public:
    static constexpr bool is_periodic = true, has_moving_images = true;

    /// `effects` have times in micro-steps.
    ShearedSpace(const Box& box, const Effects& effects)
        : periods_(effects.periods(box)), slack_(0x1p-36 * box.longest()) {}

    void begin_interval(std::int64_t n) { periods_.begin_interval(n); }
    [[gnu::always_inline]] CARROM_DEVICE Encounter<double> see(const DiscState& p,
                                                               const DiscState& q, double dx,
                                                               double dy, double time) const {
        const Shift shift = periods_.between(p, q, time);
        return {dx + shift.x, dy + shift.y, (q.vx - p.vx) + shift.vx, q.vy - p.vy};
    }
    static constexpr bool is_periodic_along(Axis /*axis*/) { return true; }
    static constexpr bool has_sides() { return false; }
    CARROM_DEVICE double slack() const { return slack_; }
    /// An upper bound of the squared speeds of the disc's stored image and of the adjacent images.
    CARROM_DEVICE double squared_speed(const DiscState& disc) const {
        const double vx = std::fabs(periods_.vx_of(disc)) + std::fabs(periods_.speed);
        return vx * vx + disc.vy * disc.vy;
    }
    CARROM_DEVICE double squared_speed_at(const DiscState& disc, double time) const {
        DiscState at_home = disc;
        set_image(at_home, periods_.home(disc, time));
        return squared_speed(at_home);
    }
    CARROM_DEVICE const Periods& periods() const { return periods_; }
    CARROM_DEVICE void wrap(DiscState& disc) const { periods_.wrap(disc, disc.tau); }

private:
    Periods periods_;
    double slack_;
};

} // namespace carrom
