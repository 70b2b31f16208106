// SPDX-License-Identifier: BSD-3-Clause
#include "contact_filter.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact_filter.cpp"
#include "hwy/foreach_target.h" // compiles this file once per instruction set
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace carrom::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Writes the slots of `range` that might touch the flight (x, y, vx, vy); returns how many. `out` holds the range's
/// length and a vector more.
HWY_INLINE std::size_t filter_run(const FlightLanes& lanes, SlotRange range, float x, float y, float vx, float vy,
                                  float touching_squared, std::uint32_t* out) {
    const hn::ScalableTag<float> d;
    const std::size_t n_lanes = hn::Lanes(d);
    const auto px = hn::Set(d, x), py = hn::Set(d, y), pvx = hn::Set(d, vx), pvy = hn::Set(d, vy);
    const auto touching = hn::Set(d, touching_squared);
    const auto zero = hn::Zero(d);
    std::size_t n_kept = 0;
    for (std::uint32_t slot = range.begin; slot < range.end; slot += static_cast<std::uint32_t>(n_lanes)) {
        const auto dx = hn::Sub(hn::LoadU(d, lanes.x + slot), px);
        const auto dy = hn::Sub(hn::LoadU(d, lanes.y + slot), py);
        const auto wx = hn::Sub(hn::LoadU(d, lanes.vx + slot), pvx);
        const auto wy = hn::Sub(hn::LoadU(d, lanes.vy + slot), pvy);
        const auto b = hn::MulAdd(dx, wx, hn::Mul(dy, wy));
        const auto a = hn::MulAdd(wx, wx, hn::Mul(wy, wy));
        const auto c = hn::Sub(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), touching);
        const auto near = hn::Le(c, zero);
        const auto meets = hn::And(hn::Lt(b, zero), hn::Ge(hn::Mul(b, b), hn::Mul(a, c)));
        const auto b_end = hn::Add(b, a); // b and c at the window's end
        const auto c_end = hn::Add(hn::Add(b, b_end), c);
        const auto in_time = hn::Or(hn::Ge(b_end, zero), hn::Le(c_end, zero));
        const auto inside = hn::FirstN(d, range.end - slot);
        const auto keep = hn::And(hn::Or(near, hn::And(meets, in_time)), inside);
        if (hn::AllFalse(d, keep)) continue;
        std::uint64_t lanes_kept = 0; // at most 64 lanes: a vector of 256 bytes
        hn::StoreMaskBits(d, keep, reinterpret_cast<std::uint8_t*>(&lanes_kept));
        for (; lanes_kept != 0; lanes_kept &= lanes_kept - 1) {
            out[n_kept++] = slot + static_cast<std::uint32_t>(std::countr_zero(lanes_kept));
        }
    }
    return n_kept;
}

void FilterColumn(const CellGrid& grid, int column, float touching_squared, std::vector<SlotPair>& pairs) {
    const FlightLanes lanes = grid.lanes();
    const int reach = grid.frame().n_reach;
    const int last_column = HWY_MIN(column + reach, grid.frame().n_columns - 1);
    std::vector<std::uint32_t> kept;
    for (int row = 0; row < grid.frame().n_rows; ++row) {
        const SlotRange cell = grid.run(column, row, row);
        if (cell.begin == cell.end) continue;
        const SlotRange own_column = grid.run(column, row, row + reach);
        for (std::uint32_t slot = cell.begin; slot < cell.end; ++slot) {
            const float x = lanes.x[slot], y = lanes.y[slot], vx = lanes.vx[slot], vy = lanes.vy[slot];
            const auto filter = [&](SlotRange range) HWY_ATTR {
                if (range.begin >= range.end) return;
                const std::size_t room = range.end - range.begin + filter_padding;
                if (kept.size() < room) kept.resize(2 * room);
                const std::size_t n = filter_run(lanes, range, x, y, vx, vy, touching_squared, kept.data());
                for (std::size_t k = 0; k < n; ++k) pairs.push_back({slot, kept[k]});
            };
            filter({slot + 1, own_column.end});
            for (int other = column + 1; other <= last_column; ++other) filter(grid.run(other, row - reach, row + reach));
        }
    }
}

void FilterAround(const CellGrid& grid, LocalIndex index, float touching_squared, std::vector<std::uint32_t>& partners) {
    const FlightLanes lanes = grid.lanes();
    const int reach = grid.frame().n_reach;
    const std::uint32_t slot = grid.slot_of(index);
    const int column = grid.column_of(index), row = grid.row_of(index);
    const int first_column = HWY_MAX(column - reach, 0), last_column = HWY_MIN(column + reach, grid.frame().n_columns - 1);
    for (int other = first_column; other <= last_column; ++other) {
        const SlotRange range = grid.run(other, row - reach, row + reach);
        const std::size_t old_size = partners.size();
        partners.resize(old_size + (range.end - range.begin) + filter_padding);
        const std::size_t n = filter_run(lanes, range, lanes.x[slot], lanes.y[slot], lanes.vx[slot], lanes.vy[slot],
                                         touching_squared, partners.data() + old_size);
        partners.resize(old_size + n);
        for (std::size_t k = old_size; k < partners.size(); ++k) {
            if (partners[k] != slot) continue;
            partners[k] = partners.back();
            partners.pop_back();
            break;
        }
    }
}

const char* FilterTarget() { return hwy::TargetName(HWY_TARGET); }

} // namespace carrom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace carrom {

HWY_EXPORT(FilterColumn);
HWY_EXPORT(FilterAround);
HWY_EXPORT(FilterTarget);

void filter_column(const CellGrid& grid, int column, float touching_squared, std::vector<SlotPair>& pairs) {
    HWY_DYNAMIC_DISPATCH(FilterColumn)(grid, column, touching_squared, pairs);
}

void filter_around(const CellGrid& grid, LocalIndex index, float touching_squared, std::vector<std::uint32_t>& partners) {
    HWY_DYNAMIC_DISPATCH(FilterAround)(grid, index, touching_squared, partners);
}

const char* filter_target() { return HWY_DYNAMIC_DISPATCH(FilterTarget)(); }

} // namespace carrom
#endif
