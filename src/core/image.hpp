// SPDX-License-Identifier: BSD-3-Clause
// Images of discs in a box with periodic sides.
//
// A stored state is never shifted: between syncs a disc may fly out of the box and on. What an
// engine looks at is the state and by how many box lengths it is meant to be displaced, its image.
// Two entries of the same disc differ in that alone. A pair's contact depends on the difference of
// its two images, a whole number, which is the same for everybody who sees the pair. Images are
// part of the state's cache line, so that they go where the disc goes. Only engines see them, and a
// scene without periodic sides has none.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/axis.hpp"
#include "core/disc.hpp"
#include "core/errors.hpp"

namespace carrom {

/// In box lengths.
struct Image {
    int x = 0, y = 0;

    friend bool operator==(const Image&, const Image&) = default;
    friend Image operator-(Image image) { return {-image.x, -image.y}; }
};

inline Image image_of(const Disc& disc) {
    return {static_cast<int>(disc.image_x), static_cast<int>(disc.image_y)};
}

/// Whether the disc's image is the one at its stored place, as nearly all are.
inline bool is_unshifted(const Disc& disc) { return disc.image_x == 0 && disc.image_y == 0; }

/// Whether the two discs' images are displaced by the same, as nearly all pairs' are.
inline bool are_shifted_alike(const Disc& p, const Disc& q) {
    return p.image_x == q.image_x && p.image_y == q.image_y;
}

/// Less than 16000 box lengths along each axis (Periods::home).
inline void set_image(Disc& disc, Image image) {
    disc.image_x = static_cast<std::int16_t>(image.x);
    disc.image_y = static_cast<std::int16_t>(image.y);
}

inline void move_image(Disc& disc, Image by) {
    set_image(disc, {image_of(disc).x + by.x, image_of(disc).y + by.y});
}

/// Places at which nothing has to be done about images, without end where a box does not repeat
/// itself.
struct Inside {
    double x_low = 0, x_high = 0, y_low = 0, y_high = 0;

    bool holds(double x, double y) const {
        return x >= x_low && x < x_high && y >= y_low && y < y_high;
    }
};

/// The lengths after which a box repeats itself along x and y; 0 where it does not.
struct Periods {
    double x = 0, y = 0;

    bool are_any() const { return x != 0 || y != 0; }
    /// 0 where there are none.
    double shortest() const { return x == 0 || y == 0 ? std::max(x, y) : std::min(x, y); }
    double along(Axis axis) const { return carrom::along(axis, x, y); }

    /// Where the disc's image is.
    [[gnu::always_inline]] double x_of(const Disc& disc, double time) const {
        return is_unshifted(disc) ? disc.x_at(time) : shifted_x(disc, time);
    }
    [[gnu::always_inline]] double y_of(const Disc& disc, double time) const {
        return is_unshifted(disc) ? disc.y_at(time) : shifted_y(disc, time);
    }

    double place_of(const Disc& disc, Axis axis, double time) const {
        return axis == Axis::x ? x_of(disc, time) : y_of(disc, time);
    }

    /// How much further the difference of two stored places is for their images: the same number
    /// with the other sign for (q, p).
    double x_between(const Disc& p, const Disc& q) const {
        return are_shifted_alike(p, q) ? 0 : (image_of(q).x - image_of(p).x) * x;
    }
    double y_between(const Disc& p, const Disc& q) const {
        return are_shifted_alike(p, q) ? 0 : (image_of(q).y - image_of(p).y) * y;
    }

    /// The image that is in the box, to within a rounding.
    Image home(const Disc& disc, double time) const {
        return {lengths(disc.x_at(time), x), lengths(disc.y_at(time), y)};
    }

    /// The box.
    Inside inside() const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return {x == 0 ? -infinity : 0, x == 0 ? infinity : x, y == 0 ? -infinity : 0,
                y == 0 ? infinity : y};
    }

private:
    // Not inlined, so that what nearly all discs need is.
    [[gnu::noinline]] double shifted_x(const Disc& disc, double time) const {
        return disc.x_at(time) + image_of(disc).x * x;
    }
    [[gnu::noinline]] double shifted_y(const Disc& disc, double time) const {
        return disc.y_at(time) + image_of(disc).y * y;
    }
    static int lengths(double place, double period) {
        if (period == 0 || (place >= 0 && place < period)) return 0;
        const double n = std::floor(place / period);
        ensure(std::fabs(n) < 16000, "a disc flies through the box thousands of times from sync to "
                                     "sync; take a smaller time.sync_every");
        return -static_cast<int>(n);
    }
};

/// A place in [0, period) for one anywhere: a function of the two alone, one rounding away.
/// Unchanged where there is no period.
inline double wrapped(double place, double period) {
    if (period == 0 || (place >= 0 && place < period)) return place;
    double inside = std::fma(-std::floor(place / period), period, place);
    if (inside < 0)
        inside += period; // what is left of it may be less than a rounding of the period
    return inside < period ? inside : inside - period;
}

} // namespace carrom
