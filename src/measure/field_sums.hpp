// SPDX-License-Identifier: BSD-3-Clause
// Sums over the cells of a grid, for fields such as density, flow and stress.
//
// All sums are exact, and the sums of all ranks are added only when a result is needed. So results
// have the same bits on any number of ranks, and the sum over all cells is exactly the sum over all
// discs. Memory: 490 bytes for each cell on each rank.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exact_sum.hpp"
#include "core/extent.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// The sums of each cell: eight over discs, then five over collisions. Impulse times distance,
/// divided by time and area, is the collisional part of the pressure tensor. Transferred energy
/// times distance, divided by time and area, is the collisional flow of energy.
enum FieldMoment : std::uint8_t {
    field_mass,
    field_momentum_x,
    field_momentum_y,
    field_flux_xx,
    field_flux_xy,
    field_flux_yy,
    field_energy_x,
    field_energy_y,
    field_stress_xx,
    field_stress_xy,
    field_stress_yy,
    field_heat_x,
    field_heat_y,
    n_field_moments
};

/// The sums over collisions: stress xx, xy, yy, and flow of energy along x and y.
inline constexpr std::size_t n_contact_moments = 5;
inline constexpr std::size_t n_disc_moments = n_field_moments - n_contact_moments;
using ContactUnits = std::array<std::int64_t, n_contact_moments>;

/// x and y of a vector; GCC and Clang compute both at once.
using Pair [[gnu::vector_size(16)]] = double;
/// Pairs of 64-bit and of 32-bit integers.
using PairOfWords [[gnu::vector_size(16)]] = std::uint64_t;
using PairOfCells [[gnu::vector_size(8)]] = std::int32_t;

/// Terms of a collision: `normal` is stress xx and yy, both elements of `shear` are stress xy, and
/// `flow` is the flow of energy along x and y.
struct ContactTerms {
    Pair normal, shear, flow;
};

/// Converts a position r to columns and rows: r * `per_length` + `origin`. The first cell has
/// column 1 and row 1, so that the result is positive and rounding towards 0 finds the cell.
struct PlacedGrid {
    PlacedGrid(std::size_t n_x, std::size_t n_y, const Extent& box)
        : per_length{static_cast<double>(n_x) / (box.x_high - box.x_low),
                     static_cast<double>(n_y) / (box.y_high - box.y_low)},
          origin(1 - Pair{box.x_low, box.y_low} * per_length) {}

    Pair per_length, origin;
};

/// Column and row of a position in widths of cells, which must have absolute values below 2^31.
inline PairOfCells cell_at(Pair place) { return __builtin_convertvector(place, PairOfCells); }
inline bool are_same(PairOfCells a, PairOfCells b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

class FieldSums {
public:
    /// `speed` and `length` are typical values, which define the units of the sums. They must be
    /// the same on all ranks.
    FieldSums(std::size_t n_cells, double speed, double length);

    std::size_t size() const { return counts_.size(); }
    void clear();

    void add_disc(std::size_t cell, double mass, double vx, double vy) {
        ++counts_[cell];
        ExactSum* const sums = &sums_[n_field_moments * cell];
        const double px = mass * vx, py = mass * vy, xx = px * vx, yy = py * vy,
                     energy = (xx + yy) / 2;
        const std::array<double, n_disc_moments> terms = {mass,    px, py,          xx,
                                                          px * vy, yy, energy * vx, energy * vy};
        // One test of the whole disc is faster than a test for each term.
        const bool is_usual = vx * vx + vy * vy < usual_square_ && mass < usual_mass;
        if (is_usual) [[likely]]
            for (std::size_t k = 0; k < n_disc_moments; ++k)
                sums[k].add_units(static_cast<std::int64_t>(terms[k] * scales_[k]));
        else
            for (std::size_t k = 0; k < n_disc_moments; ++k) sums[k].add(terms[k]);
    }
    /// The terms that a collision of discs p and q adds, in units of the sums. `velocity` must be
    /// such that p gives q the energy -(`impulse_of_p` . `velocity`) / 2.
    ContactTerms terms_of(Pair impulse_of_p, Pair from_p_to_q, Pair velocity) const {
        const Pair twice = sum_of(impulse_of_p * velocity);
        return {impulse_of_p * from_p_to_q * normal_scales_,
                sum_of(impulse_of_p * turned(from_p_to_q)) * shear_scales_,
                twice * from_p_to_q * flow_scales_};
    }
    void add_contact(std::size_t cell, const ContactTerms& terms) {
        const Pair squares = sum_of(terms.normal * terms.normal + terms.shear * terms.shear +
                                    terms.flow * terms.flow);
        if (!(squares[0] < most_gathered * most_gathered)) [[unlikely]]
            return add_contact(cell, units_of(terms));
        Gathered& gathered = gathered_[cell];
        gathered.normal += rounded(terms.normal);
        gathered.shear += rounded(terms.shear);
        gathered.flow += rounded(terms.flow);
        if (++gathered.n == most_terms) [[unlikely]]
            hand_over(cell);
    }
    /// The terms as whole units: stress xx, xy, yy, and flow of energy along x and y. Terms of the
    /// hardest collisions are limited to 2^62 units.
    static ContactUnits units_of(const ContactTerms& terms);
    void add_contact(std::size_t cell, const ContactUnits& units) {
        for (std::size_t k = 0; k < n_contact_moments; ++k)
            sums_[n_field_moments * cell + field_stress_xx + k].add_units(units[k]);
    }

    /// Adds the sums over discs of `other`, which has the same number of cells. Does not change the
    /// sums over collisions.
    void add_discs(const FieldSums& other);
    void clear_discs();
    /// Replaces the sums over discs by the sums of all ranks. **Collective.**
    void join_discs(const Communicator& ranks);

    /// The counts and sums over all ranks, as words. **Collective.**
    std::vector<std::uint64_t> joined_words(const Communicator& ranks) const;
    /// Adds sums that `joined_words` has returned. Returns false if the number of words is wrong.
    bool add_words(const std::vector<std::uint64_t>& words);
    /// Adds to each cell k the sums of cell `first` + k of `other`.
    void add(const FieldSums& other, std::size_t first);

    std::uint64_t count(std::size_t cell) const { return counts_[cell]; }
    double value(std::size_t cell, FieldMoment moment) const {
        return sum_at(cell, moment).value();
    }
    /// The sums over `n_species` species, whose cells are stored one species after another.
    FieldSums over_species(std::size_t n_species) const;
    /// The sums over all cells, as a single cell.
    FieldSums total() const { return over_species(size()); }

private:
    /// Typical terms have 50 bits. The largest term of a disc with 8 times the typical speed and a
    /// mass of 4 is 2^10 times as large.
    static constexpr double usual_mass = 4, usual_speeds = 8;

    static Pair turned(Pair pair) { return Pair{pair[1], pair[0]}; }
    /// Both elements of the result are the sum of both elements of `pair`.
    static Pair sum_of(Pair pair) { return pair + turned(pair); }

    /// Doubles of this size are integers. If a smaller number is added, the low bits of the sum are
    /// that number, rounded to an integer. This takes a third of the time of a conversion.
    static constexpr double rounder = 0x1.8p52;
    static constexpr std::uint64_t bits_of_rounder = std::bit_cast<std::uint64_t>(rounder);
    /// Both elements of `units`, rounded to integers and with `bits_of_rounder` added.
    static PairOfWords rounded(Pair units) { return std::bit_cast<PairOfWords>(units + rounder); }

    /// Sums of some terms of collisions in 64 bits. They are added to the sums in 128 bits later,
    /// because one addition in 128 bits takes twice the time. The sum of `most_terms` terms below
    /// `most_gathered` is at most 2^62. Each term includes `bits_of_rounder`.
    struct Gathered {
        PairOfWords normal{}, shear{}, flow{}; ///< both words of `shear` are equal
        std::uint64_t n = 0;
    };
    static constexpr double most_gathered = 0x1p51;
    static constexpr std::uint64_t most_terms = 2048;
    static ContactUnits units_of(const Gathered& gathered);
    void hand_over(std::size_t cell);
    ExactSum sum_at(std::size_t cell, std::size_t moment) const;

    double speed_, length_;
    std::array<double, n_disc_moments> scales_{}; ///< scales of the sums over discs
    /// Scales of the sums over collisions, multiplied by the factors -1 and 1/2 of their terms.
    Pair normal_scales_{}, shear_scales_{}, flow_scales_{};
    double usual_square_ = 0; ///< if v^2 < this and mass < `usual_mass`, terms have up to 62 bits
    std::vector<std::uint64_t> counts_;
    std::vector<ExactSum> sums_;     ///< the sums without the terms in `gathered_`
    std::vector<Gathered> gathered_; ///< the latest terms of collisions in each cell
};

/// Cuts the line from (u, v) to (u + du, v + dv), in widths of cells, at the edges of cells and
/// calls `act(column, row, from, to)` for each part. The part begins and ends at the fractions
/// `from` and `to` of the line's length, in ascending order; columns and rows may lie outside the
/// grid.
template <class Act> void for_each_part_of_line(double u, double v, double du, double dv, Act act) {
    // Rounds down without std::floor, which would be a function call.
    const auto cell = [](double place) {
        const auto whole = static_cast<std::int64_t>(place);
        return static_cast<double>(whole) > place ? whole - 1 : whole;
    };
    std::int64_t column = cell(u), row = cell(v);
    const std::int64_t last_column = cell(u + du), last_row = cell(v + dv);
    double from = 0;
    while (column != last_column || row != last_row) {
        const bool goes_right = last_column > column, goes_up = last_row > row;
        const double next_x = column == last_column
                                  ? 2
                                  : (static_cast<double>(column + goes_right) - u) / du,
                     next_y = row == last_row ? 2 : (static_cast<double>(row + goes_up) - v) / dv;
        const double to = std::clamp(std::min(next_x, next_y), from, 1.0);
        act(column, row, from, to);
        from = to;
        if (next_x <= next_y)
            column += goes_right ? 1 : -1;
        else
            row += goes_up ? 1 : -1;
    }
    act(column, row, from, 1.0);
}

} // namespace carrom
