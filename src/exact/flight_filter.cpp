// SPDX-License-Identifier: BSD-3-Clause
#include "flight_filter.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "flight_filter.cpp"
#include "hwy/foreach_target.h" // compiles this file once per instruction set
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace carrom::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A flight spread over all lanes.
struct SpreadFlight {
    using Lanes = hn::ScalableTag<float>;
    using Vector = hn::Vec<Lanes>;

    Vector x, y, vx, vy, now, rest, touching;

    HWY_INLINE SpreadFlight(const Flight& flight, float touching_squared)
        : x(hn::Set(Lanes(), flight.x)), y(hn::Set(Lanes(), flight.y)), vx(hn::Set(Lanes(), flight.vx)),
          vy(hn::Set(Lanes(), flight.vy)), now(hn::Set(Lanes(), flight.now)), rest(hn::Set(Lanes(), 1 - flight.now)),
          touching(hn::Set(Lanes(), touching_squared)) {}
};

/// Appends to `next` the slots of `run` that might touch the flight; returns the new end. Writes whole vectors: what is
/// beyond the end says nothing. (Compressing into memory is microcode on some processors, a hundred cycles each.)
HWY_INLINE std::uint32_t* filter_run(const FlightLanes lanes, SlotRange run, const SpreadFlight& p, std::uint32_t* next) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto n_lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    const auto zero = hn::Zero(d);
    const auto steps = hn::Iota(du, 0);
    for (std::uint32_t slot = run.begin; slot < run.end; slot += n_lanes) {
        const auto vx = hn::LoadU(d, lanes.vx + slot), vy = hn::LoadU(d, lanes.vy + slot);
        const auto dx = hn::Sub(hn::MulAdd(vx, p.now, hn::LoadU(d, lanes.x + slot)), p.x);
        const auto dy = hn::Sub(hn::MulAdd(vy, p.now, hn::LoadU(d, lanes.y + slot)), p.y);
        const auto wx = hn::Sub(vx, p.vx), wy = hn::Sub(vy, p.vy);
        const auto b = hn::MulAdd(dx, wx, hn::Mul(dy, wy));
        const auto a = hn::MulAdd(wx, wx, hn::Mul(wy, wy));
        const auto c = hn::Sub(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), p.touching);
        const auto near = hn::Le(c, zero);
        const auto meets = hn::And(hn::Lt(b, zero), hn::Ge(hn::Mul(b, b), hn::Mul(a, c)));
        const auto b_end = hn::MulAdd(a, p.rest, b); // b and c at the window's end
        const auto c_end = hn::MulAdd(hn::Add(b, b_end), p.rest, c);
        const auto in_time = hn::Or(hn::Ge(b_end, zero), hn::Le(c_end, zero));
        const auto inside = hn::FirstN(d, run.end - slot);
        const auto keep = hn::And(hn::Or(near, hn::And(meets, in_time)), inside);
        const auto kept = hn::RebindMask(du, keep);
        hn::StoreU(hn::Compress(hn::Add(steps, hn::Set(du, slot)), kept), du, next);
        next += hn::CountTrue(du, kept);
    }
    return next;
}

std::size_t FilterFlights(const FlightLanes& all_lanes, std::span<const SlotRange> runs, const Flight& flight,
                          float touching_squared, std::uint32_t* out) {
    const FlightLanes lanes = all_lanes; // nothing else points to these pointers: they stay in registers
    const SpreadFlight spread(flight, touching_squared);
    std::uint32_t* next = out;
    for (const SlotRange& run : runs) next = filter_run(lanes, run, spread, next);
    return static_cast<std::size_t>(next - out);
}

void FilterColumn(const FlightLanes& all_lanes, const CellTable& cells, int column, int n_reach, float touching_squared,
                  std::vector<std::uint32_t>& partners, std::vector<std::uint32_t>& ends) {
    const FlightLanes lanes = all_lanes;
    const std::uint32_t* const own = cells.starts + static_cast<std::size_t>(column) * cells.column_length;
    const int n_right = HWY_MIN(n_reach, cells.n_columns - 1 - column);
    std::size_t n_partners = 0;
    for (int row = 0; row < cells.n_rows; ++row) {
        if (own[row] == own[row + 1]) continue;
        const int low = HWY_MAX(row - n_reach, 0), high = HWY_MIN(row + n_reach, cells.n_rows - 1);
        std::size_t n_slots = own[high + 1] - own[row];
        for (int k = 1; k <= n_right; ++k) {
            const std::uint32_t* const other = own + static_cast<std::size_t>(k) * cells.column_length;
            n_slots += other[high + 1] - other[low];
        }
        const std::size_t room = n_partners + n_slots * (own[row + 1] - own[row]) + filter_padding;
        if (partners.size() < room) partners.resize(2 * room);
        std::uint32_t* next = partners.data() + n_partners;
        for (std::uint32_t slot = own[row]; slot < own[row + 1]; ++slot) {
            const SpreadFlight spread({lanes.x[slot], lanes.y[slot], lanes.vx[slot], lanes.vy[slot], 0}, touching_squared);
            next = filter_run(lanes, {slot + 1, own[high + 1]}, spread, next);
            for (int k = 1; k <= n_right; ++k) {
                const std::uint32_t* const other = own + static_cast<std::size_t>(k) * cells.column_length;
                next = filter_run(lanes, {other[low], other[high + 1]}, spread, next);
            }
            ends.push_back(static_cast<std::uint32_t>(next - partners.data()));
        }
        n_partners = static_cast<std::size_t>(next - partners.data());
    }
}

} // namespace carrom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace carrom {

HWY_EXPORT(FilterFlights);

std::size_t filter_flights(const FlightLanes& lanes, std::span<const SlotRange> runs, const Flight& flight,
                           float touching_squared, std::uint32_t* out) {
    return HWY_DYNAMIC_DISPATCH(FilterFlights)(lanes, runs, flight, touching_squared, out);
}

HWY_EXPORT(FilterColumn);

void filter_column(const FlightLanes& lanes, const CellTable& cells, int column, int n_reach, float touching_squared,
                   std::vector<std::uint32_t>& partners, std::vector<std::uint32_t>& ends) {
    HWY_DYNAMIC_DISPATCH(FilterColumn)(lanes, cells, column, n_reach, touching_squared, partners, ends);
}

} // namespace carrom
#endif
