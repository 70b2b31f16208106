// SPDX-License-Identifier: BSD-3-Clause
// An axis, by default x, cut into half-open slabs, and the lists of owners that may exchange discs.
// Domains (domains.hpp) are strips in both directions. Pure arithmetic, no MPI.
//
// All lists follow from numbers that every rank knows, so both partners of an exchange compute the
// same lists without a message. Lists are symmetric: a lists b if and only if b lists a. They are
// complete to the last bit if senders pick receivers with `meets(x - reach, x + reach)` or
// `owner(x)`, because these comparisons round the same way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/axis.hpp"
#include "core/disc_state.hpp"

namespace carrom {

/// the half-open interval [low, high)
struct Strip {
    double low = 0, high = 0;

    bool is_empty() const { return !(low < high); }
    bool holds(double place) const { return place >= low && place < high; }
    /// Whether a strip that is not empty meets [from, to].
    bool meets(double from, double to) const { return from < high && to >= low; }
};

/// Half-open strips [low(k), high(k)) that cover all x; the first begins at -infinity, the last
/// ends at +infinity. Equal cuts make empty strips; those own nothing and have no neighbours.
class Strips {
public:
    /// One strip that covers everything.
    Strips() = default;

    /// `cuts`: ascending and finite, one fewer than strips.
    explicit Strips(std::vector<double> cuts, Axis axis = Axis::x);

    Axis axis() const { return axis_; }
    /// The disc's place along the strips' axis.
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

    /// The other ranks r, ascending, such that a disc in one of the strips r and `rank` can lie
    /// within `reach` >= 0 of the other. Cost: the number of strips within reach.
    std::vector<int> neighbours_within(int rank, double reach) const;

    friend bool operator==(const Strips&, const Strips&) = default;

private:
    std::vector<double> cuts_;
    Axis axis_ = Axis::x;
};

/// Whether a disc that was in the strip `before` can be in the strip `after` when it has moved by
/// at most `distance`. Neither strip is empty.
bool can_move(const Strip& before, const Strip& after, double distance);

/// Whether a disc in one of the strips can lie within `reach` >= 0 of the other. Neither is empty.
bool are_within(const Strip& a, const Strip& b, double reach);

/// Returns cuts such that the share `below[k]` of the weight is below cut k; the shares ascend from
/// 0 to 1. `weights` belong to equal bins of [0, length], and are assumed to be spread evenly
/// inside a bin. The cuts ascend, lie within the box, and are a function of the arguments alone.
std::vector<double> balanced_cuts(std::span<const std::uint64_t> weights, double length,
                                  std::span<const double> below);

} // namespace carrom
