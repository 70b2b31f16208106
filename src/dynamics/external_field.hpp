// SPDX-License-Identifier: BSD-3-Clause
// A potential that does not change in time: a harmonic trap, a sine, or values on a grid.
//
// It acts only at syncs: discs get half a kick before each flight from sync to sync and half a kick
// after it (scene/effects/field.cpp). So collisions between syncs are computed as without it.
//
// Between the points of a grid the potential is the cubic spline through all values (C. de Boor, A
// Practical Guide to Splines (1978)), a sum of products of cubic B-splines along x and y. It has
// two continuous derivatives, and the force is its exact derivative, because otherwise a disc would
// lose or gain energy in each cell that it crosses. Along a periodic axis the spline is periodic.
// Between walls its second derivative is 0 at both ends, and it continues as a straight line beyond
// them.
//
// The code uses only + - * / and sqrt in a fixed order, so bits are the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <carrom/box.hpp>

#include "core/axis.hpp"
#include "core/disc_state.hpp"

namespace carrom {

/// The potential energy of a disc of strength 1 at some position, and its derivatives.
struct FieldPoint {
    double energy = 0, slope_x = 0, slope_y = 0;
};

/// The values of a potential, row by row: rows run along x, and the first one is at y = 0.
struct FieldValues {
    std::size_t columns = 0, rows = 0;
    std::vector<double> numbers{};

    friend bool operator==(const FieldValues&, const FieldValues&) = default;
};

/// The spline through values on a grid. Copies share the coefficients, which take 8 bytes each.
class FieldSpline {
public:
    /// A potential that is 0 everywhere.
    FieldSpline() = default;
    /// On a periodic axis of length L with n numbers, number i is at i L / n; between walls it is
    /// at i L / (n - 1). Along an axis with one number the potential is constant.
    FieldSpline(const FieldValues& values, bool is_periodic_x, bool is_periodic_y);

    bool is_on() const { return data_ != nullptr; }
    FieldPoint at(double x, double y, const Box& box) const;
    /// An upper bound, computed from the coefficients, of the second derivative in any direction.
    double largest_curvature(const Box& box) const;
    /// The difference between the largest and the smallest value on the grid.
    double depth() const;

    friend bool operator==(const FieldSpline& a, const FieldSpline& b) {
        return a.data_ == b.data_ || (a.data_ && b.data_ && *a.data_ == *b.data_);
    }

private:
    /// The grid points along an axis. `goes_round` is true for a periodic axis or a single point.
    struct Line {
        std::size_t n = 0;
        bool goes_round = false;

        /// The number of grid intervals between the two ends of the box.
        double n_intervals() const { return static_cast<double>(goes_round ? n : n - 1); }
        std::size_t n_padded() const { return n + 3; }

        friend bool operator==(const Line&, const Line&) = default;
    };
    struct Data {
        Line x, y;
        /// Rows of coefficients along x; each axis has one before its points and two after them
        std::vector<double> coefficients;
        double low = 0, high = 0;

        double at(std::size_t column, std::size_t row) const {
            return coefficients[row * x.n_padded() + column];
        }
        friend bool operator==(const Data&, const Data&) = default;
    };
    struct Weights;

    static std::vector<double> coefficients_of(const std::vector<double>& numbers,
                                               const Line& line);
    static Weights weights_of(const Line& line, double place, double length);

    std::shared_ptr<const Data> data_;
};

enum class FieldKind { none, trap, sine, grid };

/// The values of `[effects.field]`; times are in steps in a scene, in micro-steps in a dynamics.
struct ExternalField {
    FieldKind kind = FieldKind::none;
    double stiffness_x = 0, stiffness_y = 0; ///< stiffness of a trap: force per length
    /// Centre of a trap; by default the middle of the box
    std::optional<double> centre_x, centre_y;
    double amplitude = 0; ///< energy amplitude of a sine, or factor of the values on a grid
    Axis axis = Axis::x;  ///< the axis along which a sine varies
    std::int64_t waves = 1;
    double phase = 0;
    std::string file;   ///< file with the values on a grid; its path is relative to the scene
    FieldValues values; ///< values on a grid
    FieldSpline spline; ///< spline through the values; made when a scene is read
    /// The strength of each species, by which the potential is multiplied; empty if all strengths
    /// are 1. `ends` has the id after the last disc of each species. Both are filled when a scene
    /// is read.
    std::vector<double> strengths;
    std::vector<DiscId> ends;

    bool is_on() const { return kind != FieldKind::none; }
    bool acts_along(Axis along) const;
    double strength_of(DiscId id) const;
    /// The potential, and its derivatives, for a disc of strength 1.
    FieldPoint at(double x, double y, const Box& box) const;
    /// An upper bound of the second derivative in any direction, for a disc of strength 1.
    double largest_curvature(const Box& box) const;
    /// An estimate of the energy that a disc of strength 1 can gain. It assumes a trap at the
    /// middle of the box.
    double depth(const Box& box) const;
    double largest_strength() const;

    friend bool operator==(const ExternalField&, const ExternalField&) = default;

private:
    FieldPoint of_trap(double x, double y, const Box& box) const;
    FieldPoint of_sine(double place, double length) const;
};

} // namespace carrom
