// SPDX-License-Identifier: BSD-3-Clause
#include "time_stepped/contact_filter.hpp"

#include <bit>
#include <cmath>
#include <type_traits>

#include "core/stop_request.hpp"

using std::isnan; // Highway 1.0 calls isnan without hn:: where it has no vectors

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "time_stepped/contact_filter.cpp"
#include "hwy/foreach_target.h" // compiles this file once per instruction set
#include "hwy/highway.h"

#include "cell_list/held_vector.hpp"

HWY_BEFORE_NAMESPACE();
namespace carrom::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One flight, copied into every lane of vectors.
template <class D> struct Broadcast {
    HeldVector<D> x, y, vx, vy, touching;

    HWY_INLINE Broadcast(D d, const FlightLanes& lanes, std::uint32_t slot, float touching_squared)
        : x(hold(d, lanes.x[slot])), y(hold(d, lanes.y[slot])), vx(hold(d, lanes.vx[slot])),
          vy(hold(d, lanes.vy[slot])), touching(hold(d, touching_squared)) {}
};

/// Returns bits that show which flights of the vector at `slot` might touch `flight`: those that
/// already touch it, and those that approach closely enough and arrive before the window ends. Let
/// d be the separation, w the relative velocity in lengths per window, b = d.w, a = w.w, and
/// c = d.d - touching^2. The rounding errors of b^2 - a c, and of a c at the window's end, are less
/// than 18 * 2^-24 a d.d. So no contact is lost if c is computed with d.d (1 - 2^-19).
template <class D>
HWY_INLINE std::uint64_t lanes_that_touch(D d, const FlightLanes& lanes, std::uint32_t slot,
                                          std::uint32_t n_inside, const Broadcast<D>& flight) {
    const auto dx = hn::Sub(hn::LoadU(d, lanes.x + slot), vector_of(d, flight.x));
    const auto dy = hn::Sub(hn::LoadU(d, lanes.y + slot), vector_of(d, flight.y));
    const auto wx = hn::Sub(hn::LoadU(d, lanes.vx + slot), vector_of(d, flight.vx));
    const auto wy = hn::Sub(hn::LoadU(d, lanes.vy + slot), vector_of(d, flight.vy));
    const auto b = hn::MulAdd(dx, wx, hn::Mul(dy, wy));
    const auto a = hn::MulAdd(wx, wx, hn::Mul(wy, wy));
    const auto c = hn::MulSub(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), hn::Set(d, 1 - 0x1p-19f),
                              vector_of(d, flight.touching));
    const auto b_end = hn::Add(b, a); // b at the window's end
    const auto c_end = hn::Add(hn::Add(b, b_end), c);
    // Each condition is a number that is at most 0 if the condition holds. So one comparison tests
    // all of them.
    const auto passes_by = hn::MulAdd(b, hn::Abs(b),
                                      hn::Mul(a, c)); // if c > 0: approaches, and b^2 >= a c
    const auto too_late = hn::Min(hn::Neg(b_end), c_end);
    const auto misses = hn::Min(c, hn::Max(passes_by, too_late));
    const auto keep = hn::Le(misses, hn::Zero(d));
    // Reads the mask in the width in which it was written. A wider load would wait for the store to
    // reach the cache.
    using Bits =
        std::conditional_t<hn::MaxLanes(d) <= 8, std::uint8_t,
                           std::conditional_t<hn::MaxLanes(d) <= 16, std::uint16_t, std::uint64_t>>;
    Bits stored = 0;
    hn::StoreMaskBits(d, keep, reinterpret_cast<std::uint8_t*>(&stored));
    const std::uint64_t bits = stored;
    return n_inside < 64 ? bits & ((std::uint64_t{1} << n_inside) - 1) : bits;
}

/// Writes (first, second) to `out`, after the first `n_pairs`, for each slot `second` of `run` in
/// `lanes` that might touch `flight`. If `is_one_of_them`, `run` may contain `first`, and the pair
/// (first, first) is omitted. Returns the new number of pairs. `out` must have room.
template <bool is_one_of_them, class D>
HWY_INLINE std::size_t write_pairs(D d, const Broadcast<D>& flight, std::uint32_t first,
                                   const FlightLanes& lanes, SlotRange run, DiscPair* out,
                                   std::size_t n_pairs) {
    const auto n_lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    for (std::uint32_t other = run.begin; other < run.end; other += n_lanes) {
        std::uint64_t bits = lanes_that_touch(d, lanes, other, run.end - other, flight);
        if (is_one_of_them && first - other < n_lanes)
            bits &= ~(std::uint64_t{1} << (first - other));
        for (; bits != 0; bits &= bits - 1)
            out[n_pairs++] = {first, other + static_cast<std::uint32_t>(std::countr_zero(bits))};
    }
    return n_pairs;
}

/// Makes room for `wanted` items after the first `size`. Memory is initialized only once.
template <class T> T* room(std::vector<T>& buffer, std::size_t size, std::size_t wanted) {
    if (buffer.size() < size + wanted) buffer.resize(2 * (size + wanted));
    return buffer.data();
}

/// The value of touching^2 for find_near_passes. It is enlarged, because the d x w of that function
/// has an error of up to 5 * 2^-24 |d| |w|.
float passing_squared(const CellGrid& grid, float touching_squared) {
    const float margin = 0x1p-21f * 4 * static_cast<float>(grid.geometry().n_reach + 2);
    const float passing = std::sqrt(touching_squared) + margin;
    return passing * passing * (1 + 0x1p-20f);
}

/// A vector of flights from slot `other` on. At least one of them passes the flight of `first` so
/// closely that the discs may touch.
struct NearPass {
    std::uint32_t first, other, n_inside;
};

/// Finds the vectors of `run` in which a flight passes one of the flights of `cell` so closely that
/// the discs may touch: (d x w)^2 <= touching^2 w.w (see lanes_that_touch). This test costs half as
/// much as the test of times, and rejects most vectors if discs fly much further than their
/// diameter. It has no branch that depends on the data. Writes to `out` after the first n entries,
/// and returns the new number of entries. `out` must have room.
template <class D>
HWY_INLINE std::size_t find_near_passes(D d, const FlightLanes& lanes, SlotRange cell,
                                        SlotRange run, float passing_squared, NearPass* out,
                                        std::size_t n) {
    const auto n_lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    const auto passing = hn::Set(d, passing_squared);
    for (std::uint32_t other = run.begin; other < run.end; other += n_lanes) {
        const auto x = hn::LoadU(d, lanes.x + other), y = hn::LoadU(d, lanes.y + other);
        const auto vx = hn::LoadU(d, lanes.vx + other), vy = hn::LoadU(d, lanes.vy + other);
        for (std::uint32_t slot = cell.begin; slot < cell.end; ++slot) {
            const auto dx = hn::Sub(x, hn::Set(d, lanes.x[slot])),
                       dy = hn::Sub(y, hn::Set(d, lanes.y[slot]));
            const auto wx = hn::Sub(vx, hn::Set(d, lanes.vx[slot])),
                       wy = hn::Sub(vy, hn::Set(d, lanes.vy[slot]));
            const auto cross = hn::MulSub(dx, wy, hn::Mul(dy, wx));
            const auto a = hn::MulAdd(wx, wx, hn::Mul(wy, wy));
            out[n] = {slot, other, run.end - other};
            n += !hn::AllFalse(d, hn::Le(hn::Mul(cross, cross), hn::Mul(a, passing)));
        }
    }
    return n;
}

/// The partners of at most this many discs of a cell are listed at a time, because a single cell
/// may contain all discs of the box.
constexpr std::uint32_t discs_in_piece = 256;

/// Finds the pairs of own discs for FilterColumn, if discs fly much further than their diameter.
template <class D>
HWY_INLINE std::size_t filter_long_flights(D d, const CellGrid& grid, int column,
                                           float touching_squared, std::vector<DiscPair>& pairs) {
    const FlightLanes lanes = grid.lanes();
    const auto n_lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    const int reach = grid.geometry().n_reach, n_rows = grid.geometry().n_rows;
    const int last_column = HWY_MIN(column + reach, grid.geometry().n_columns - 1);
    const float passing = passing_squared(grid, touching_squared);
    std::vector<NearPass> near;
    std::size_t n_pairs = 0;
    SlotRange cell = grid.run(column, 0, 0);
    for (int row = 0; row < n_rows && !is_stop_overdue(); cell.begin = cell.end) {
        const std::uint32_t end = grid.run(column, row, row).end;
        cell.end = HWY_MIN(cell.begin + discs_in_piece, end);
        const std::size_t n_in_cell = cell.end - cell.begin;
        if (n_in_cell == 0) {
            ++row;
            continue;
        }
        std::size_t n_near = 0;
        for (int other = column; other <= last_column; ++other) {
            const SlotRange run = other == column
                                      ? SlotRange{cell.end, grid.run(column, row, row + reach).end}
                                      : grid.run(other, row - reach, row + reach);
            const std::size_t n_vectors = (run.end - run.begin + n_lanes - 1) / n_lanes;
            n_near = find_near_passes(d, lanes, cell, run, passing,
                                      room(near, n_near, n_in_cell * n_vectors + 1), n_near);
        }
        DiscPair* out = room(pairs, n_pairs, n_in_cell * n_in_cell + n_near * n_lanes);
        for (std::uint32_t slot = cell.begin; slot < cell.end; ++slot) {
            n_pairs = write_pairs<false>(d, Broadcast(d, lanes, slot, touching_squared), slot,
                                         lanes, {slot + 1, cell.end}, out, n_pairs);
        }
        for (std::size_t k = 0; k < n_near; ++k) {
            const auto [first, other, n_inside] = near[k];
            const SlotRange vector{other, other + HWY_MIN(n_inside, n_lanes)};
            n_pairs = write_pairs<false>(d, Broadcast(d, lanes, first, touching_squared), first,
                                         lanes, vector, out, n_pairs);
        }
    }
    return n_pairs;
}

/// Finds the pairs of own discs for FilterColumn, if the reach is at most 8 contact distances.
template <class D>
HWY_INLINE std::size_t filter_short_flights(D d, const CellGrid& grid, int column,
                                            float touching_squared, std::vector<DiscPair>& pairs) {
    const FlightLanes lanes = grid.lanes();
    const int reach = grid.geometry().n_reach, n_rows = grid.geometry().n_rows;
    const int last_column = HWY_MIN(column + reach, grid.geometry().n_columns - 1);
    std::vector<SlotRange> runs(static_cast<std::size_t>(last_column - column));
    std::size_t n_pairs = 0;
    for (int row = 0; row < n_rows; ++row) {
        const SlotRange cell = grid.run(column, row, row);
        if (cell.begin == cell.end) continue;
        const std::uint32_t own_end = grid.run(column, row, row + reach).end;
        std::size_t n_in_runs = own_end - cell.begin;
        for (int other = column + 1; other <= last_column; ++other) {
            SlotRange& run = runs[static_cast<std::size_t>(other - column - 1)];
            run = grid.run(other, row - reach, row + reach);
            n_in_runs += run.end - run.begin;
        }
        DiscPair* out = room(pairs, n_pairs, (cell.end - cell.begin) * n_in_runs);
        for (std::uint32_t slot = cell.begin; slot < cell.end; ++slot) {
            const Broadcast flight(d, lanes, slot, touching_squared);
            n_pairs = write_pairs<false>(d, flight, slot, lanes, {slot + 1, own_end}, out, n_pairs);
            for (const SlotRange run : runs)
                n_pairs = write_pairs<false>(d, flight, slot, lanes, run, out, n_pairs);
        }
    }
    return n_pairs;
}

/// Like write_pairs, for discs of the halo; `run` contains slots of the halo.
template <class D>
HWY_INLINE std::size_t write_halo_pairs(D d, const Broadcast<D>& flight, std::uint32_t first,
                                        const CellGrid& grid, SlotRange run,
                                        std::vector<DiscPair>& pairs, std::size_t n_pairs) {
    DiscPair* out = room(pairs, n_pairs, run.end - run.begin);
    const std::size_t n_now = write_pairs<false>(d, flight, first, grid.halo_lanes(), run, out,
                                                 n_pairs);
    for (std::size_t k = n_pairs; k < n_now; ++k) out[k].second = grid.halo_index(out[k].second);
    return n_now;
}

/// Writes the pairs of the column's own discs with discs of the halo.
template <class D>
HWY_INLINE std::size_t filter_halo(D d, const CellGrid& grid, int column, float touching_squared,
                                   std::vector<DiscPair>& pairs, std::size_t n_pairs) {
    const FlightLanes lanes = grid.lanes();
    const int reach = grid.geometry().n_reach, n_rows = grid.geometry().n_rows;
    const int first_column = HWY_MAX(column - reach, 0),
              last_column = HWY_MIN(column + reach, grid.geometry().n_columns - 1);
    for (int other = first_column; other <= last_column; ++other) {
        if (!grid.has_halo_in(other)) continue;
        for (int row = 0; row < n_rows; ++row) {
            const SlotRange run = grid.halo_run(other, row - reach, row + reach);
            // in columns inside the domain, only rows near the ends of the box have halo discs
            if (run.begin == run.end) {
                const int next = grid.next_halo_row(other, row + reach + 1);
                if (next == n_rows) break;
                row = next - reach - 1;
                continue;
            }
            const SlotRange cell = grid.run(column, row, row);
            for (std::uint32_t slot = cell.begin; slot < cell.end; ++slot)
                n_pairs = write_halo_pairs(d, Broadcast(d, lanes, slot, touching_squared), slot,
                                           grid, run, pairs, n_pairs);
        }
    }
    return n_pairs;
}

std::size_t FilterColumn(const CellGrid& grid, int column, float touching_squared,
                         std::vector<DiscPair>& pairs) {
    const hn::ScalableTag<float> d;
    const auto reach = static_cast<float>(grid.geometry().n_reach);
    const std::size_t n_pairs = reach * reach > 64 * touching_squared
                                    ? filter_long_flights(d, grid, column, touching_squared, pairs)
                                    : filter_short_flights(d, grid, column, touching_squared,
                                                           pairs);
    return grid.has_halo() ? filter_halo(d, grid, column, touching_squared, pairs, n_pairs)
                           : n_pairs;
}

/// The rest of a flight from the fraction `from` of the window on, in cells.
struct Path {
    float x_begin, x_end, y_begin, y_end;

    Path(const FlightLanes& lanes, std::uint32_t slot, float from)
        : x_begin(lanes.x[slot] + from * lanes.vx[slot]), x_end(lanes.x[slot] + lanes.vx[slot]),
          y_begin(lanes.y[slot] + from * lanes.vy[slot]), y_end(lanes.y[slot] + lanes.vy[slot]) {}
};

/// The cells within `half_reach` of a path.
struct CellsAround {
    int first_column, last_column, first_row, last_row;

    CellsAround(const CellGrid& grid, const Path& path, float half_reach)
        : first_column(grid.clamped_column(HWY_MIN(path.x_begin, path.x_end) - half_reach)),
          last_column(grid.clamped_column(HWY_MAX(path.x_begin, path.x_end) + half_reach)),
          first_row(grid.clamped_row(HWY_MIN(path.y_begin, path.y_end) - half_reach)),
          last_row(grid.clamped_row(HWY_MAX(path.y_begin, path.y_end) + half_reach)) {}
};

/// Writes the pairs of a flight, which has the index `first` in pairs, with own discs in `cells`
/// and, if `with_halo`, with halo discs in `cells`.
template <bool is_one_of_them, class D>
HWY_INLINE std::size_t filter_cells(D d, const CellGrid& grid, const Broadcast<D>& flight,
                                    std::uint32_t first, const CellsAround& cells, bool with_halo,
                                    std::vector<DiscPair>& pairs, std::size_t n_pairs) {
    const FlightLanes lanes = grid.lanes();
    for (int column = cells.first_column; column <= cells.last_column; ++column) {
        const SlotRange run = grid.run(column, cells.first_row, cells.last_row);
        n_pairs = write_pairs<is_one_of_them>(d, flight, first, lanes, run,
                                              room(pairs, n_pairs, run.end - run.begin), n_pairs);
    }
    for (int column = cells.first_column; with_halo && column <= cells.last_column; ++column) {
        const SlotRange run = grid.halo_run(column, cells.first_row, cells.last_row);
        if (run.begin == run.end) continue; // nearly all cells have no halo disc
        n_pairs = write_halo_pairs(d, flight, first, grid, run, pairs, n_pairs);
    }
    return n_pairs;
}

std::size_t FilterAround(const CellGrid& grid, LocalIndex index, float from, float half_reach,
                         float touching_squared, std::vector<DiscPair>& pairs,
                         std::size_t n_pairs) {
    const hn::ScalableTag<float> d;
    const bool is_own = index < grid.n_own();
    const FlightLanes lanes = is_own ? grid.lanes() : grid.halo_lanes();
    const std::uint32_t slot = is_own ? index : grid.halo_slot(index);
    const Broadcast flight(d, lanes, slot, touching_squared);
    const CellsAround cells(grid, Path(lanes, slot, from), half_reach);
    return filter_cells<true>(d, grid, flight, index, cells, is_own && grid.has_halo(), pairs,
                              n_pairs);
}

std::size_t FilterAlong(const CellGrid& grid, const FlightLanes& lanes, std::uint32_t k, float from,
                        float half_reach, float touching_squared, std::vector<DiscPair>& pairs,
                        std::size_t n_pairs) {
    const hn::ScalableTag<float> d;
    const CellsAround cells(grid, Path(lanes, k, from), half_reach);
    return filter_cells<false>(d, grid, Broadcast(d, lanes, k, touching_squared), k, cells,
                               grid.has_halo(), pairs, n_pairs);
}

std::size_t FilterLanes(const FlightLanes& lanes, std::uint32_t k, const FlightLanes& others,
                        SlotRange run, float touching_squared, std::vector<DiscPair>& pairs,
                        std::size_t n_pairs) {
    const hn::ScalableTag<float> d;
    return write_pairs<false>(d, Broadcast(d, lanes, k, touching_squared), k, others, run,
                              room(pairs, n_pairs, run.end - run.begin), n_pairs);
}

const char* FilterTarget() { return hwy::TargetName(HWY_TARGET); }

} // namespace carrom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace carrom {

HWY_EXPORT(FilterColumn);
HWY_EXPORT(FilterAround);
HWY_EXPORT(FilterAlong);
HWY_EXPORT(FilterLanes);
HWY_EXPORT(FilterTarget);

std::size_t filter_column(const CellGrid& grid, int column, float touching_squared,
                          std::vector<DiscPair>& pairs) {
    return HWY_DYNAMIC_DISPATCH(FilterColumn)(grid, column, touching_squared, pairs);
}

std::size_t filter_around(const CellGrid& grid, LocalIndex index, float from, float half_reach,
                          float touching_squared, std::vector<DiscPair>& pairs,
                          std::size_t n_pairs) {
    return HWY_DYNAMIC_DISPATCH(FilterAround)(grid, index, from, half_reach, touching_squared,
                                              pairs, n_pairs);
}

std::size_t filter_along(const CellGrid& grid, const FlightLanes& lanes, std::uint32_t k,
                         float from, float half_reach, float touching_squared,
                         std::vector<DiscPair>& pairs, std::size_t n_pairs) {
    return HWY_DYNAMIC_DISPATCH(FilterAlong)(grid, lanes, k, from, half_reach, touching_squared,
                                             pairs, n_pairs);
}

std::size_t filter_lanes(const FlightLanes& lanes, std::uint32_t k, const FlightLanes& others,
                         SlotRange run, float touching_squared, std::vector<DiscPair>& pairs,
                         std::size_t n_pairs) {
    return HWY_DYNAMIC_DISPATCH(FilterLanes)(lanes, k, others, run, touching_squared, pairs,
                                             n_pairs);
}

const char* filter_target() { return HWY_DYNAMIC_DISPATCH(FilterTarget)(); }

} // namespace carrom
#endif
