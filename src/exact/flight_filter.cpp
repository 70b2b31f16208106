// SPDX-License-Identifier: BSD-3-Clause
#include "flight_filter.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "flight_filter.cpp"
#include "hwy/foreach_target.h" // compiles this file once per instruction set
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace carrom::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

std::size_t FilterFlights(const FlightLanes& lanes, std::span<const SlotRange> runs, const Flight& flight,
                          float touching_squared, std::uint32_t* out) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto n_lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    const auto px = hn::Set(d, flight.x), py = hn::Set(d, flight.y);
    const auto pvx = hn::Set(d, flight.vx), pvy = hn::Set(d, flight.vy);
    const auto now = hn::Set(d, flight.now), rest = hn::Set(d, 1 - flight.now);
    const auto touching = hn::Set(d, touching_squared);
    const auto zero = hn::Zero(d);
    const auto steps = hn::Iota(du, 0);
    std::uint32_t* next = out;
    for (const SlotRange& run : runs) {
        for (std::uint32_t slot = run.begin; slot < run.end; slot += n_lanes) {
            const auto vx = hn::LoadU(d, lanes.vx + slot), vy = hn::LoadU(d, lanes.vy + slot);
            const auto dx = hn::Sub(hn::MulAdd(vx, now, hn::LoadU(d, lanes.x + slot)), px);
            const auto dy = hn::Sub(hn::MulAdd(vy, now, hn::LoadU(d, lanes.y + slot)), py);
            const auto wx = hn::Sub(vx, pvx), wy = hn::Sub(vy, pvy);
            const auto b = hn::MulAdd(dx, wx, hn::Mul(dy, wy));
            const auto a = hn::MulAdd(wx, wx, hn::Mul(wy, wy));
            const auto c = hn::Sub(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), touching);
            const auto near = hn::Le(c, zero);
            const auto meets = hn::And(hn::Lt(b, zero), hn::Ge(hn::Mul(b, b), hn::Mul(a, c)));
            const auto b_end = hn::MulAdd(a, rest, b); // b and c at the window's end
            const auto c_end = hn::MulAdd(hn::Add(b, b_end), rest, c);
            const auto in_time = hn::Or(hn::Ge(b_end, zero), hn::Le(c_end, zero));
            const auto inside = hn::FirstN(d, run.end - slot);
            const auto keep = hn::And(hn::Or(near, hn::And(meets, in_time)), inside);
            next += hn::CompressStore(hn::Add(steps, hn::Set(du, slot)), hn::RebindMask(du, keep), du, next);
        }
    }
    return static_cast<std::size_t>(next - out);
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

} // namespace carrom
#endif
