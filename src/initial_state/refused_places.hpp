// SPDX-License-Identifier: BSD-3-Clause
// Two bit maps, each of which replaces most tests of pairs in random insertion by one read of
// memory. When little free space is left, nearly all proposals lie well inside a placed disc.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lattices/lattice.hpp"

namespace carrom {

/// Squares in which every position is too close to a placed disc.
class RefusedPlaces {
public:
    /// Covers [x_low, x_high] x [0, height] for discs of at least this radius. Squares are an
    /// eighth of the smallest diameter wide, or wider if there would be over 256 squares for each
    /// of `n_discs`; so the map takes at most 32 bytes a disc.
    RefusedPlaces(double x_low, double x_high, double height, double smallest_radius,
                  double n_discs)
        : x_low_(x_low), smallest_radius_(smallest_radius) {
        const double width = std::max(x_high - x_low, smallest_radius);
        const double side = std::max(smallest_radius / 4,
                                     std::sqrt(width * height / (256 * n_discs + 1)));
        per_length_ = 1 / side;
        n_columns_ = static_cast<std::int64_t>(width * per_length_) + 1;
        n_rows_ = static_cast<std::int64_t>(height * per_length_) + 1;
        words_per_column_ = static_cast<std::size_t>(n_rows_ / 64 + 1);
        words_.assign(static_cast<std::size_t>(n_columns_) * words_per_column_, 0);
    }

    /// Marks the squares that lie wholly in the circle around `place` in which no other centre may
    /// lie. Several threads may call this at the same time.
    void add(Point place, double radius) {
        const double reach = (radius + smallest_radius_) * per_length_ * (1 - margin);
        const double x = (place.x - x_low_) * per_length_, y = place.y * per_length_;
        const auto first = static_cast<std::int64_t>(std::floor(x - reach)),
                   last = static_cast<std::int64_t>(std::floor(x + reach));
        for (std::int64_t column = std::max<std::int64_t>(first, 0);
             column <= std::min(last, n_columns_ - 1); ++column) {
            const auto left = static_cast<double>(column) - margin,
                       right = static_cast<double>(column + 1) + margin;
            const double dx = std::max(std::abs(left - x), std::abs(right - x));
            if (dx >= reach) continue;
            const double dy = std::sqrt(reach * reach - dx * dx);
            mark(column, static_cast<std::int64_t>(std::ceil(y - dy + margin)),
                 static_cast<std::int64_t>(std::floor(y + dy - margin)));
        }
    }

    /// Returns true only if every disc of at least the smallest radius would overlap a placed disc
    /// at this position. If it returns false, a disc may overlap or not.
    bool holds(Point place) const {
        const std::uint64_t* const word = word_of(place);
        return word && (*word >> (row_of(place) % 64) & 1) != 0;
    }
    /// Prefetches the memory that `holds` reads, because positions are random. It must be inlined:
    /// GCC otherwise drops the call, because it only prefetches.
    [[gnu::always_inline]] void prefetch(Point place) const {
        if (const std::uint64_t* const word = word_of(place)) __builtin_prefetch(word);
    }

private:
    /// A length in units of a square's width. It is larger than the rounding of a position, because
    /// a box has fewer than 10^7 squares along an axis.
    static constexpr double margin = 1e-7;

    // Avoids std::floor, which is a function call on baseline processors.
    std::int64_t row_of(Point place) const {
        return static_cast<std::int64_t>(place.y * per_length_);
    }
    const std::uint64_t* word_of(Point place) const {
        const double along = (place.x - x_low_) * per_length_;
        const auto column = static_cast<std::int64_t>(along);
        const std::int64_t row = row_of(place);
        if (!(along >= 0 && place.y >= 0) || column >= n_columns_ || row >= n_rows_) return nullptr;
        return words_.data() + static_cast<std::size_t>(column) * words_per_column_ +
               static_cast<std::size_t>(row / 64);
    }

    void mark(std::int64_t column, std::int64_t first_row, std::int64_t end_row) {
        first_row = std::max<std::int64_t>(first_row, 0);
        end_row = std::min(end_row, n_rows_);
        std::uint64_t* const words = words_.data() +
                                     static_cast<std::size_t>(column) * words_per_column_;
        for (std::int64_t row = first_row; row < end_row;) {
            // The bits of the squares from `row` up to `end` are in one word
            const std::int64_t end = std::min(end_row, (row / 64 + 1) * 64);
            const std::uint64_t bits = ~std::uint64_t{0} >> (64 - (end - row)) << (row % 64);
            std::atomic_ref word(words[row / 64]);
            if ((word.load(std::memory_order_relaxed) & bits) != bits)
                word.fetch_or(bits, std::memory_order_relaxed);
            row = end;
        }
    }

    double x_low_, smallest_radius_, per_length_ = 1;
    std::int64_t n_columns_ = 0, n_rows_ = 0;
    std::size_t words_per_column_ = 0;
    std::vector<std::uint64_t> words_;
};

/// Cells near a few points, in a hash table. `may_be_near` returns true for all positions within
/// `reach` of a point, and for few other positions.
class NearFew {
public:
    NearFew(std::size_t n_points, double reach) : per_length_(1 / (reach * (1 + 1e-9))) {
        n_bits_ = static_cast<int>(std::bit_width(64 * n_points + 64));
        words_.assign((std::size_t{1} << n_bits_) / 64 + 1, 0);
    }
    void add(Point place) {
        const std::int64_t column = cell(place.x), row = cell(place.y);
        for (std::int64_t dx = -1; dx <= 1; ++dx)
            for (std::int64_t dy = -1; dy <= 1; ++dy) {
                const std::size_t bit = bit_of(column + dx, row + dy);
                words_[bit / 64] |= std::uint64_t{1} << (bit % 64);
            }
    }
    bool may_be_near(Point place) const {
        const std::size_t bit = bit_of(cell(place.x), cell(place.y));
        return (words_[bit / 64] >> (bit % 64) & 1) != 0;
    }

private:
    /// The column or row of a cell, without std::floor. Points lie at most one reach outside of the
    /// box, so adding 2 cells makes all numbers positive.
    std::int64_t cell(double length) const {
        return static_cast<std::int64_t>(length * per_length_ + 2);
    }
    std::size_t bit_of(std::int64_t column, std::int64_t row) const {
        const std::uint64_t mixed = (static_cast<std::uint64_t>(column) * 0x9e3779b97f4a7c15 +
                                     static_cast<std::uint64_t>(row)) *
                                    0xbf58476d1ce4e5b9;
        return static_cast<std::size_t>(mixed >> (64 - n_bits_));
    }

    double per_length_;
    int n_bits_ = 0;
    std::vector<std::uint64_t> words_;
};

} // namespace carrom
