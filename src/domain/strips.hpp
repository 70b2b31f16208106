// SPDX-License-Identifier: BSD-3-Clause
// Cuts an axis, by default x, into half-open strips, and lists owners that may exchange discs.
// Domains (domains.hpp) use strips in both directions. All of this is arithmetic without MPI.
//
// All lists are computed from numbers that are equal on all ranks, so both partners of an exchange
// compute the same lists without messages. Lists are symmetric: a lists b if and only if b lists a.
// No disc is missed if senders choose receivers with `meets(x - reach, x + reach)` or `owner(x)`,
// because all these comparisons round in the same way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/axis.hpp"
#include "core/disc_state.hpp"

namespace carrom {

/// The half-open interval [low, high).
struct Strip {
    double low = 0, high = 0;

    bool is_empty() const { return !(low < high); }
    bool holds(double place) const { return place >= low && place < high; }
    /// Whether the strip, which must not be empty, has a point in common with [from, to].
    bool meets(double from, double to) const { return from < high && to >= low; }
};

/// Half-open strips [low(k), high(k)) that together cover all x, from -infinity to +infinity. Two
/// equal cuts make an empty strip, which owns nothing and has no neighbours.
class Strips {
public:
    /// One strip that covers everything.
    Strips() = default;

    /// `cuts`: ascending and finite, one cut fewer than strips.
    explicit Strips(std::vector<double> cuts, Axis axis = Axis::x);

    Axis axis() const { return axis_; }
    /// The disc's coordinate along the strips' axis.
    double place_of(const DiscState& disc, double time) const {
        return axis_ == Axis::x ? disc.x_at(time) : disc.y_at(time);
    }

    int size() const { return static_cast<int>(cuts_.size()) + 1; }
    std::span<const double> cuts() const { return cuts_; }
    double low(int rank) const;
    double high(int rank) const;
    Strip of(int rank) const { return {low(rank), high(rank)}; }
    bool is_empty(int rank) const { return of(rank).is_empty(); }

    /// The rank whose strip holds `x`.
    int owner(double x) const;

    /// The other ranks, ascending, whose strips have points within `reach` >= 0 of the strip of
    /// `rank`. The cost is proportional to the number of strips within reach.
    std::vector<int> neighbours_within(int rank, double reach) const;

    /// The strips after the axis has been stretched by this positive factor.
    Strips stretched(double factor) const;

    friend bool operator==(const Strips&, const Strips&) = default;

private:
    std::vector<double> cuts_;
    Axis axis_ = Axis::x;
};

/// Whether a disc from the strip `before` can be in the strip `after` once it has moved by at most
/// `distance`. Neither strip may be empty.
bool can_move(const Strip& before, const Strip& after, double distance);

/// Whether points of two strips can be within `reach` >= 0 of each other. No strip may be empty.
bool are_within(const Strip& a, const Strip& b, double reach);

/// Returns cuts such that the fraction `below[k]` of the weight lies below cut k; `below` ascends
/// from 0 to 1. `weights[i]` is the weight in bin i of equal bins of [0, length]; inside a bin it
/// is assumed to be uniform. The cuts ascend, lie in the box, and depend on the arguments only.
std::vector<double> balanced_cuts(std::span<const std::uint64_t> weights, double length,
                                  std::span<const double> below);

} // namespace carrom
