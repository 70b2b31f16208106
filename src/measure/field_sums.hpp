// SPDX-License-Identifier: BSD-3-Clause
// Sums over the cells of a grid, for fields such as density, flow and stress.
//
// All sums are exact, and ranks are joined only when somebody asks. So they have the same bits on
// any number of ranks, and the sum over all cells is that of all discs to the last bit. Memory: 424
// bytes for each cell on each rank.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/exact_sum.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// The sums of each cell. The first eight are over discs, the others over collisions: impulse
/// times distance, which over time and area is the collisions' part of the pressure tensor, and
/// energy times distance, which is that of the flow of energy.
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

/// Stress xx, xy, yy, and flow of energy along x and y.
inline constexpr std::size_t n_contact_moments = 5;
using ContactUnits = std::array<std::int64_t, n_contact_moments>;

class FieldSums {
public:
    /// `speed` and `length` are usual sizes, the same on all ranks: units follow from them.
    FieldSums(std::size_t n_cells, double speed, double length);

    std::size_t size() const { return counts_.size(); }
    void clear();

    void add_disc(std::size_t cell, double mass, double vx, double vy) {
        ++counts_[cell];
        ExactSum* const sums = &sums_[n_field_moments * cell];
        sums[field_mass].add(mass);
        sums[field_momentum_x].add(mass * vx);
        sums[field_momentum_y].add(mass * vy);
        sums[field_flux_xx].add(mass * vx * vx);
        sums[field_flux_xy].add(mass * vx * vy);
        sums[field_flux_yy].add(mass * vy * vy);
        const double energy = mass * (vx * vx + vy * vy) / 2;
        sums[field_energy_x].add(energy * vx);
        sums[field_energy_y].add(energy * vy);
    }
    /// What a collision adds, in whole units of the sums, so that its parts add up to it.
    ContactUnits in_units(const std::array<double, n_contact_moments>& of_contact) const {
        ContactUnits units{};
        for (std::size_t k = 0; k < n_contact_moments; ++k) {
            const double scaled = of_contact[k] * contact_scales_[k];
            const double above = scaled < -0x1p62 ? -0x1p62 : scaled; // std::clamp branches
            units[k] = static_cast<std::int64_t>(above > 0x1p62 ? 0x1p62 : above);
        } // the hardest blows are cut to 2^62 units
        return units;
    }
    void add_contact(std::size_t cell, const ContactUnits& units) {
        for (std::size_t k = 0; k < n_contact_moments; ++k)
            sums_[n_field_moments * cell + field_stress_xx + k].add_units(units[k]);
    }

    /// Counts and sums of all ranks. **Collective.**
    std::vector<std::uint64_t> joined_words(const Communicator& ranks) const;
    /// Adds such words, of as many cells. False where they are of another number.
    bool add_words(const std::vector<std::uint64_t>& words);
    /// Adds the cells of `other` that begin at `first`.
    void add(const FieldSums& other, std::size_t first);

    std::uint64_t count(std::size_t cell) const { return counts_[cell]; }
    double value(std::size_t cell, FieldMoment moment) const {
        return sums_[n_field_moments * cell + moment].value();
    }
    /// All cells in one.
    FieldSums total() const;

private:
    double speed_, length_;
    std::array<double, n_contact_moments> contact_scales_{};
    std::vector<std::uint64_t> counts_;
    std::vector<ExactSum> sums_;
};

/// Calls `act(column, row, from, to)` for each part of the line from (u, v) to (u + du, v + dv), in
/// widths of cells. `from` and `to` are shares of the line, in order; columns and rows may lie
/// outside the grid.
template <class Act> void for_each_part_of_line(double u, double v, double du, double dv, Act act) {
    const auto cell = [](double place) { // std::floor is a call
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
