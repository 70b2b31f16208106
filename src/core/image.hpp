// SPDX-License-Identifier: BSD-3-Clause
// Images of discs in a box with periodic sides. An image is displaced from the stored position of
// its disc, and under shear this displacement changes with time. All code that needs positions of
// images uses `Periods`.
//
// Stored states are never shifted: between syncs a disc may fly out of the box. Engines use the
// state together with its image, the numbers of boxes by which the disc is displaced along x and y.
// A rank may have several copies of a disc, which differ only in the image. The contact of a pair
// depends on the difference of the two images, two whole numbers that are equal on every rank that
// has the pair. The image is stored in the cache line of the state, so that it moves with the disc.
// Only engines use images. Without periodic sides all images are (0, 0).
//
// Usually all boxes are at rest, and an image is shifted by a whole number of box lengths. Under
// shear (Lees and Edwards, J. Phys. C 5, 1921 (1972)) the row of boxes above moves along x with a
// constant velocity, the next row with twice that velocity, and so on. Fast kernels are compiled
// separately for boxes at rest, and call functions such as x_at_rest, which ignore the motion.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/axis.hpp"
#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "core/errors.hpp"

namespace carrom {

/// A displacement in whole box lengths along x and y.
struct Image {
    int x = 0, y = 0;

    friend bool operator==(const Image&, const Image&) = default;
    CARROM_DEVICE friend Image operator-(Image image) { return {-image.x, -image.y}; }
};

/// The displacement from a disc to one of its images, or from one image to another.
struct Shift {
    double x = 0, y = 0;
    double vx = 0; ///< rate of change of x; y is constant
};

CARROM_DEVICE inline Image image_of(const DiscState& disc) {
    return {static_cast<int>(disc.image_x), static_cast<int>(disc.image_y)};
}

/// Whether the disc's image is at the stored position, which is so for nearly all discs.
CARROM_DEVICE inline bool is_unshifted(const DiscState& disc) {
    return disc.image_x == 0 && disc.image_y == 0;
}

/// Whether the images of both discs are displaced by the same numbers of boxes. This is so for
/// nearly all pairs.
CARROM_DEVICE inline bool are_shifted_alike(const DiscState& p, const DiscState& q) {
    return p.image_x == q.image_x && p.image_y == q.image_y;
}

/// Sets the image, which must be less than 16000 boxes away along each axis (Periods::home).
CARROM_DEVICE inline void set_image(DiscState& disc, Image image) {
    disc.image_x = static_cast<std::int16_t>(image.x);
    disc.image_y = static_cast<std::int16_t>(image.y);
}

CARROM_DEVICE inline void move_image(DiscState& disc, Image by) {
    set_image(disc, {image_of(disc).x + by.x, image_of(disc).y + by.y});
}

/// A rectangle of positions, such as the box. A bound may be infinite, for example along an axis
/// that is not periodic.
struct Inside {
    double x_low = 0, x_high = 0, y_low = 0, y_high = 0;

    bool holds(double x, double y) const {
        return x >= x_low && x < x_high && y >= y_low && y < y_high;
    }
};

/// Maps a coordinate into [0, period) with one rounding, or with two if the result is close to 0 or
/// to the period. With period 0 it returns `place` unchanged. Unless `lengths` is null, adds to
/// `*lengths` the number of periods that were added to the coordinate.
CARROM_DEVICE inline double wrapped(double place, double period, double* lengths = nullptr) {
    if (period == 0 || (place >= 0 && place < period)) return place;
    double up = -std::floor(place / period), inside = std::fma(up, period, place);
    if (inside < 0) { // the sum may round to the period itself
        inside += period;
        up += 1;
    }
    if (!(inside < period)) {
        inside -= period;
        up -= 1;
    }
    if (lengths) *lengths += up;
    return inside;
}

/// The periods of a box, and its shear. Times are in micro-steps since the last sync.
struct Periods {
    double x = 0, y = 0; ///< lengths of the periods; 0 along an axis without a period
    double offset = 0;   ///< shift along x, at time 0, of the row of boxes above the box
    double speed = 0;    ///< velocity of this row along x; 0 if boxes are at rest

    bool are_any() const { return x != 0 || y != 0; }
    CARROM_DEVICE bool are_moving() const { return speed != 0; }
    /// The shorter period; 0 if there is none.
    double shortest() const { return x == 0 || y == 0 ? std::max(x, y) : std::min(x, y); }
    CARROM_DEVICE double along(Axis axis) const { return carrom::along(axis, x, y); }
    /// The shift along x, at `time`, of the row of boxes above the box.
    CARROM_DEVICE double offset_at(double time) const { return offset + speed * time; }

    /// Sets time 0 to micro-step `n` of the scene. However far the row has moved, the error of the
    /// offset is about one rounding of the box length.
    void begin_interval(std::int64_t n) {
        if (!are_moving()) return;
        const double steps = static_cast<double>(n), gone = speed * steps,
                     rest = std::fma(speed, steps, -gone);
        offset = wrapped(wrapped(gone, x) + rest, x);
    }

    /// The displacement of an image from the stored position at `time`, and its rate of change.
    CARROM_DEVICE Shift shift_of(Image image, double time) const {
        return {image.x * x + image.y * offset_at(time), image.y * y, image.y * speed};
    }
    /// The shift from the image of `p` to the image of `q`. Callers add it to the stored state of q
    /// minus the stored state of p. It changes sign if p and q are exchanged.
    CARROM_DEVICE Shift between(const DiscState& p, const DiscState& q, double time) const {
        return are_shifted_alike(p, q) ? Shift{} : shifted_between(p, q, time);
    }
    /// The x component of between(), for boxes at rest.
    CARROM_DEVICE double x_between(const DiscState& p, const DiscState& q) const {
        return are_shifted_alike(p, q) ? 0 : (image_of(q).x - image_of(p).x) * x;
    }
    CARROM_DEVICE double y_between(const DiscState& p, const DiscState& q) const {
        return are_shifted_alike(p, q) ? 0 : (image_of(q).y - image_of(p).y) * y;
    }

    /// The x coordinate of the disc's image at `time`.
    [[gnu::always_inline]] CARROM_DEVICE double x_of(const DiscState& disc, double time) const {
        if (is_unshifted(disc)) return disc.x_at(time);
        const double at_rest = shifted_x(disc, time);
        return are_moving() ? moved(at_rest, disc, time) : at_rest;
    }
    /// Like x_of, for boxes at rest.
    [[gnu::always_inline]] double x_at_rest(const DiscState& disc, double time) const {
        return is_unshifted(disc) ? disc.x_at(time) : shifted_x(disc, time);
    }
    [[gnu::always_inline]] CARROM_DEVICE double y_of(const DiscState& disc, double time) const {
        return is_unshifted(disc) ? disc.y_at(time) : shifted_y(disc, time);
    }
    CARROM_DEVICE double vx_of(const DiscState& disc) const {
        return disc.vx + image_of(disc).y * speed;
    }

    double place_of(const DiscState& disc, Axis axis, double time) const {
        return axis == Axis::x ? x_of(disc, time) : y_of(disc, time);
    }

    /// The image of the disc that lies in the box, to within rounding.
    CARROM_DEVICE Image home(const DiscState& disc, double time) const {
        const int up = lengths(disc.y_at(time), y);
        return {lengths(disc.x_at(time) + up * offset_at(time), x), up};
    }
    /// Replaces a state at `time` by the state of the disc's image in the box.
    CARROM_DEVICE void wrap(DiscState& disc, double time) const {
        double up = 0;
        disc.y = wrapped(disc.y, y, &up);
        if (up != 0 && are_moving()) {
            disc.x += up * offset_at(time);
            disc.vx += up * speed;
        }
        disc.x = wrapped(disc.x, x);
    }
    /// Reduces a displacement (dx, dy) by whole boxes: first to the nearest row of images, then
    /// along x to the nearest image in this row.
    Shift nearest(double dx, double dy, double time) const {
        if (y != 0) {
            const double down = std::round(dy / y);
            dy -= down * y;
            dx -= down * offset_at(time);
        }
        return {x != 0 ? dx - x * std::round(dx / x) : dx, dy};
    }

    /// The bounds of the box; infinite along an axis without a period.
    Inside inside() const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return {x == 0 ? -infinity : 0, x == 0 ? infinity : x, y == 0 ? -infinity : 0,
                y == 0 ? infinity : y};
    }

    friend bool operator==(const Periods&, const Periods&) = default;

private:
    // Not inlined, so that the code for the common case, an image without a shift, stays short.
    [[gnu::noinline]] CARROM_DEVICE double shifted_x(const DiscState& disc, double time) const {
        return disc.x_at(time) + image_of(disc).x * x;
    }
    [[gnu::noinline, gnu::cold]] CARROM_DEVICE double moved(double at_rest, const DiscState& disc,
                                                            double time) const {
        return at_rest + image_of(disc).y * offset_at(time);
    }
    [[gnu::noinline]] CARROM_DEVICE double shifted_y(const DiscState& disc, double time) const {
        return disc.y_at(time) + image_of(disc).y * y;
    }
    [[gnu::noinline]] CARROM_DEVICE Shift shifted_between(const DiscState& p, const DiscState& q,
                                                          double time) const {
        return shift_of({image_of(q).x - image_of(p).x, image_of(q).y - image_of(p).y}, time);
    }
    CARROM_DEVICE static int lengths(double place, double period) {
        if (period == 0 || (place >= 0 && place < period)) return 0;
        const double n = std::floor(place / period);
        ensure(std::fabs(n) < 16000, "a disc flies through the box thousands of times from sync to "
                                     "sync; take a smaller time.sync_every");
        return -static_cast<int>(n);
    }
};

} // namespace carrom
