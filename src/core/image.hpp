// SPDX-License-Identifier: BSD-3-Clause
// Images of discs in a box with periodic sides, and what an image is: a shift and a velocity, as
// functions of time. All code that needs the position of an image uses `Periods`.
//
// A stored state is never shifted: between syncs a disc may fly out of the box and on. What an
// engine works with is the state and the number of boxes, along x and along y, by which it is meant
// to be displaced: its image. Two entries of the same disc differ only in the image. A pair's
// contact depends on the difference of its two images, a pair of whole numbers, which is the same
// on every rank that has the pair. Images are part of the state's cache line, so that they move
// together with the disc. Only engines see them, and a scene without periodic sides has none.
//
// Usually boxes repeat themselves at rest, and an image is shifted by a whole number of box
// lengths. Under shear (Lees and Edwards, J. Phys. C 5, 1921 (1972)) the row of boxes above moves
// along x with a constant velocity, the next row with twice that, and so on. The kernels that have
// to be fast are compiled for boxes at rest, and call the functions without a time.
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

/// A displacement in numbers of boxes.
struct Image {
    int x = 0, y = 0;

    friend bool operator==(const Image&, const Image&) = default;
    CARROM_DEVICE friend Image operator-(Image image) { return {-image.x, -image.y}; }
};

/// The displacement from a disc to an image of it, or from one image to another one.
struct Shift {
    double x = 0, y = 0;
    double vx = 0; ///< rate at which the shift grows along x; along y it is constant
};

CARROM_DEVICE inline Image image_of(const DiscState& disc) {
    return {static_cast<int>(disc.image_x), static_cast<int>(disc.image_y)};
}

/// Whether the disc's image is the one at its stored place, as nearly all are.
CARROM_DEVICE inline bool is_unshifted(const DiscState& disc) {
    return disc.image_x == 0 && disc.image_y == 0;
}

/// Whether both discs' images are displaced by the same numbers of boxes, which is so for nearly
/// all pairs.
CARROM_DEVICE inline bool are_shifted_alike(const DiscState& p, const DiscState& q) {
    return p.image_x == q.image_x && p.image_y == q.image_y;
}

/// The image is less than 16000 boxes away along each axis (Periods::home).
CARROM_DEVICE inline void set_image(DiscState& disc, Image image) {
    disc.image_x = static_cast<std::int16_t>(image.x);
    disc.image_y = static_cast<std::int16_t>(image.y);
}

CARROM_DEVICE inline void move_image(DiscState& disc, Image by) {
    set_image(disc, {image_of(disc).x + by.x, image_of(disc).y + by.y});
}

/// The range of positions for which no image has to be considered. It has no ends along an axis
/// that is not periodic.
struct Inside {
    double x_low = 0, x_high = 0, y_low = 0, y_high = 0;

    bool holds(double x, double y) const {
        return x >= x_low && x < x_high && y >= y_low && y < y_high;
    }
};

/// Maps any coordinate into [0, period), with one rounding; the result depends on the two arguments
/// only. Returns it unchanged if there is no period. Adds the number of periods by which it moved
/// up to `lengths`, unless that is null.
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

/// How a box repeats itself. Times are micro-steps since the last sync.
struct Periods {
    double x = 0, y = 0; ///< the box repeats itself after these lengths; 0 if it does not
    double offset = 0;   ///< the row of boxes above is shifted by this along x at time 0
    double speed = 0;    ///< that row moves along x at this speed; 0 where boxes are at rest

    bool are_any() const { return x != 0 || y != 0; }
    CARROM_DEVICE bool are_moving() const { return speed != 0; }
    /// The shorter of the periods; 0 if there are none.
    double shortest() const { return x == 0 || y == 0 ? std::max(x, y) : std::min(x, y); }
    CARROM_DEVICE double along(Axis axis) const { return carrom::along(axis, x, y); }
    /// The shift of the row above the box.
    CARROM_DEVICE double offset_at(double time) const { return offset + speed * time; }

    /// From now on times count from micro-step `n` of the scene. The offset is exact except for one
    /// rounding of the box's length, however far the row has moved.
    void begin_interval(std::int64_t n) {
        if (!are_moving()) return;
        const double steps = static_cast<double>(n), gone = speed * steps,
                     rest = std::fma(speed, steps, -gone);
        offset = wrapped(wrapped(gone, x) + rest, x);
    }

    /// The shift and the velocity of an image.
    CARROM_DEVICE Shift shift_of(Image image, double time) const {
        return {image.x * x + image.y * offset_at(time), image.y * y, image.y * speed};
    }
    /// The shift from the image of `p` to that of `q`, in addition to the difference of their
    /// stored states. For (q, p) it has the opposite sign.
    CARROM_DEVICE Shift between(const DiscState& p, const DiscState& q, double time) const {
        return are_shifted_alike(p, q) ? Shift{} : shifted_between(p, q, time);
    }
    /// For boxes at rest.
    CARROM_DEVICE double x_between(const DiscState& p, const DiscState& q) const {
        return are_shifted_alike(p, q) ? 0 : (image_of(q).x - image_of(p).x) * x;
    }
    CARROM_DEVICE double y_between(const DiscState& p, const DiscState& q) const {
        return are_shifted_alike(p, q) ? 0 : (image_of(q).y - image_of(p).y) * y;
    }

    /// Where the disc's image is, and how fast it flies along x.
    [[gnu::always_inline]] CARROM_DEVICE double x_of(const DiscState& disc, double time) const {
        if (is_unshifted(disc)) return disc.x_at(time);
        const double at_rest = shifted_x(disc, time);
        return are_moving() ? moved(at_rest, disc, time) : at_rest;
    }
    /// For boxes at rest.
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

    /// The image whose position is in the box, to within rounding.
    CARROM_DEVICE Image home(const DiscState& disc, double time) const {
        const int up = lengths(disc.y_at(time), y);
        return {lengths(disc.x_at(time) + up * offset_at(time), x), up};
    }
    /// Replaces a state at `time` by that of the image in the box.
    CARROM_DEVICE void wrap(DiscState& disc, double time) const {
        double up = 0;
        disc.y = wrapped(disc.y, y, &up);
        if (up != 0 && are_moving()) {
            disc.x += up * offset_at(time);
            disc.vx += up * speed;
        }
        disc.x = wrapped(disc.x, x);
    }
    /// The shortest of the differences (dx, dy) between images of two discs.
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
    // Not inlined, because images are rarely shifted. So the common case stays short.
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
