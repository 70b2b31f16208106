// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/flight_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

using std::isnan; // Highway 1.0 calls isnan without hn:: where it has no vectors

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "event_driven/flight_filter.cpp"
#include "hwy/foreach_target.h" // compiles this file once per instruction set
#include "hwy/highway.h"

#include "cell_list/held_vector.hpp"

HWY_BEFORE_NAMESPACE();
namespace carrom::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::ScalableTag<float>;
using Slots = hn::RebindToSigned<Lanes>;
using Vector = hn::Vec<Lanes>;
using SlotVector = hn::Vec<Slots>;

/// One flight, copied into every lane of vectors.
struct SpreadFlight {
    HeldVector<Lanes> x, y, vx, vy, rest, touching;

    HWY_INLINE SpreadFlight(const Flight& flight, float touching_squared)
        : x(hold(Lanes(), flight.x)), y(hold(Lanes(), flight.y)), vx(hold(Lanes(), flight.vx)),
          vy(hold(Lanes(), flight.vy)), rest(hold(Lanes(), 1 - flight.now)),
          touching(hold(Lanes(), touching_squared)) {}
};

/// Returns which of the discs at x and y with velocities vx and vy might touch the flight before
/// the window ends: those that already touch it, and those that approach it closely enough and
/// arrive in time. Each condition is a number that is negative if the condition holds, so one
/// comparison tests all of them. `touching` is a squared distance.
HWY_INLINE hn::Mask<Lanes> might_touch(Vector x, Vector y, Vector vx, Vector vy, Vector touching,
                                       const SpreadFlight& p) {
    const Lanes d;
    const auto dx = hn::Sub(x, vector_of(d, p.x)), dy = hn::Sub(y, vector_of(d, p.y));
    const auto wx = hn::Sub(vx, vector_of(d, p.vx)), wy = hn::Sub(vy, vector_of(d, p.vy));
    const auto rest = vector_of(d, p.rest);
    const auto b = hn::MulAdd(dx, wx, hn::Mul(dy, wy));
    const auto a = hn::MulAdd(wx, wx, hn::Mul(wy, wy));
    const auto c = hn::MulAdd(dx, dx, hn::MulSub(dy, dy, touching));
    // if c > 0, negative for discs that approach and have b^2 > a c
    const auto passes_by = hn::MulAdd(b, hn::Abs(b), hn::Mul(a, c));
    const auto minus_b_end = hn::NegMulSub(a, rest, b); // b and c at the window's end
    const auto c_end = hn::MulAdd(hn::Sub(b, minus_b_end), rest, c);
    const auto misses = hn::Min(c, hn::Max(passes_by, hn::Min(minus_b_end, c_end)));
    return hn::Lt(misses, hn::Zero(d));
}

/// The squared distance at which the flight touches each disc of a vector of lanes. It is the same
/// for discs of one size; otherwise it comes from the sum of radii.
HWY_INLINE Vector touching_of(const FlightLanes&, std::uint32_t, const SpreadFlight& p) {
    return vector_of(Lanes(), p.touching);
}
HWY_INLINE Vector touching_of(const SizedLanes& lanes, std::uint32_t slot, const SpreadFlight& p) {
    const auto sum = hn::Add(vector_of(Lanes(), p.touching),
                             hn::LoadU(Lanes(), lanes.radii + slot));
    return hn::Mul(sum, sum);
}

#if HWY_TARGET == HWY_AVX2
/// For each mask of eight lanes, the numbers of its set lanes in ascending order, one per byte.
constexpr auto set_lanes = [] {
    std::array<std::uint64_t, 256> lanes{};
    for (std::size_t mask = 0; mask < lanes.size(); ++mask) {
        int n_set = 0;
        for (std::uint64_t lane = 0; lane < 8; ++lane)
            if ((mask >> lane & 1) != 0) lanes[mask] |= lane << 8 * n_set++;
    }
    return lanes;
}();

/// Replaces Highway's Compress, which in 1.0.3 copies a table of a kilobyte to the stack each time.
HWY_INLINE SlotVector compress(SlotVector slots, hn::Mask<Slots> kept) {
    const hn::Rebind<std::uint8_t, Slots> bytes;
    std::uint8_t mask[8];
    hn::StoreMaskBits(Slots(), kept, mask);
    const auto lanes = hn::LoadU(bytes, reinterpret_cast<const std::uint8_t*>(&set_lanes[mask[0]]));
    return hn::TableLookupLanes(slots, hn::IndicesFromVec(Slots(), hn::PromoteTo(Slots(), lanes)));
}
#else
HWY_INLINE SlotVector compress(SlotVector slots, hn::Mask<Slots> kept) {
    return hn::Compress(slots, kept);
}
#endif

HWY_INLINE SlotVector spread_slot(std::uint32_t slot) {
    return hn::Set(Slots(), static_cast<std::int32_t>(slot));
}

/// Appends the kept slots to `next`, and returns the new end. It writes a whole vector, so memory
/// beyond the new end is overwritten. (The instruction that writes only kept lanes takes a hundred
/// cycles on some processors.)
HWY_INLINE std::uint32_t* append(SlotVector slots, hn::Mask<Slots> kept, std::uint32_t* next) {
    const hn::RebindToUnsigned<Lanes> d;
    hn::StoreU(hn::BitCast(d, compress(slots, kept)), d, next);
    return next + hn::CountTrue(Slots(), kept);
}

/// The positions of a vector of flights at the time `now`.
HWY_INLINE Vector places(const float* at_start, const float* velocity, Vector now) {
    return hn::MulAdd(hn::LoadU(Lanes(), velocity), now, hn::LoadU(Lanes(), at_start));
}

/// Replaces the argument `now` at time 0, at which positions need no computation.
struct AtStart {};
HWY_INLINE Vector places(const float* at_start, const float* /*velocity*/, AtStart) {
    return hn::LoadU(Lanes(), at_start);
}

/// Returns which slots of a vector, from `slot` on, might touch the flight. `now` is a vector or
/// AtStart.
template <class SomeLanes, class Time>
HWY_INLINE hn::Mask<Slots> touching_slots(const SomeLanes& lanes, std::uint32_t slot,
                                          const SpreadFlight& p, Time now) {
    const auto x = places(lanes.x + slot, lanes.vx + slot, now),
               y = places(lanes.y + slot, lanes.vy + slot, now);
    const auto vx = hn::LoadU(Lanes(), lanes.vx + slot), vy = hn::LoadU(Lanes(), lanes.vy + slot);
    return hn::RebindMask(Slots(), might_touch(x, y, vx, vy, touching_of(lanes, slot, p), p));
}

/// Appends to `next` the slots of `run` that might touch the flight; returns the new end.
template <class SomeLanes, class Time>
HWY_INLINE std::uint32_t* filter_run(const SomeLanes lanes, SlotRange run, const SpreadFlight& p,
                                     Time now, std::uint32_t* next) {
    const auto steps = hn::Iota(Slots(), 0);
    const auto end = spread_slot(run.end);
    for (std::uint32_t slot = run.begin; slot < run.end;
         slot += static_cast<std::uint32_t>(hn::Lanes(Lanes()))) {
        const auto slots = hn::Add(steps, spread_slot(slot));
        const auto touch = touching_slots(lanes, slot, p, now);
        next = append(slots, hn::And(touch, hn::Lt(slots, end)), next);
    }
    return next;
}

template <class SomeLanes>
std::size_t filter_runs(const SomeLanes& all_lanes, std::span<const SlotRange> runs,
                        const Flight& flight, float touching, std::uint32_t* out) {
    const SomeLanes lanes =
        all_lanes; // a local copy, so that the compiler can keep the pointers in registers
    const SpreadFlight spread(flight, touching);
    const auto now = hn::Set(Lanes(), flight.now);
    std::uint32_t* next = out;
    for (const SlotRange& run : runs) next = filter_run(lanes, run, spread, now, next);
    return static_cast<std::size_t>(std::remove(out, next, flight.slot) - out);
}

template <class SomeLanes>
PartnerCounts filter_two_runs(const SomeLanes& all_lanes, std::span<const SlotRange> runs,
                              const Flight& p, const Flight& q, float p_touching, float q_touching,
                              std::uint32_t* p_out, std::uint32_t* q_out) {
    const SomeLanes lanes = all_lanes;
    const SpreadFlight p_spread(p, p_touching), q_spread(q, q_touching);
    const auto now = hn::Set(Lanes(), p.now);
    const auto p_slot = spread_slot(p.slot), q_slot = spread_slot(q.slot);
    const auto steps = hn::Iota(Slots(), 0);
    std::uint32_t *p_next = p_out, *q_next = q_out;
    for (const SlotRange& run : runs) {
        const auto end = spread_slot(run.end);
        for (std::uint32_t slot = run.begin; slot < run.end;
             slot += static_cast<std::uint32_t>(hn::Lanes(Lanes()))) {
            const auto slots = hn::Add(steps, spread_slot(slot));
            const auto is_one_of_them = hn::Or(hn::Eq(slots, p_slot), hn::Eq(slots, q_slot));
            const auto inside = hn::AndNot(is_one_of_them, hn::Lt(slots, end));
            // Both masks are computed before the first store, so that each slot's data is loaded
            // once.
            const auto p_touch = touching_slots(lanes, slot, p_spread, now),
                       q_touch = touching_slots(lanes, slot, q_spread, now);
            p_next = append(slots, hn::And(p_touch, inside), p_next);
            q_next = append(slots, hn::And(q_touch, inside), q_next);
        }
    }
    return {static_cast<std::size_t>(p_next - p_out), static_cast<std::size_t>(q_next - q_out)};
}

/// The `touching` of the flight in a slot: for one size the given value, for several sizes its
/// radius plus the margin.
HWY_INLINE float touching_in(const FlightLanes&, std::uint32_t, float touching_squared) {
    return touching_squared;
}
HWY_INLINE float touching_in(const SizedLanes& lanes, std::uint32_t slot, float margin) {
    return lanes.radii[slot] + margin;
}

template <class SomeLanes>
void filter_cells_of_column(const SomeLanes& all_lanes, const CellTable& cells, int column,
                            CellRows rows, float touching, std::vector<std::uint32_t>& partners,
                            std::vector<std::uint32_t>& ends) {
    const SomeLanes lanes = all_lanes;
    const std::uint32_t* const own = cells.starts +
                                     static_cast<std::size_t>(column) * cells.column_length;
    const int n_right = HWY_MIN(cells.n_reach_columns, cells.n_columns - 1 - column);
    constexpr AtStart start;
    std::size_t n_partners = 0;
    for (int row = rows.first; row < rows.end; ++row) {
        if (own[row] == own[row + 1]) continue;
        const int low = HWY_MAX(row - cells.n_reach_rows, 0),
                  high = HWY_MIN(row + cells.n_reach_rows, cells.n_rows - 1);
        std::size_t n_slots = own[high + 1] - own[row];
        for (int k = 1; k <= n_right; ++k) {
            const std::uint32_t* const other = own +
                                               static_cast<std::size_t>(k) * cells.column_length;
            n_slots += other[high + 1] - other[low];
        }
        const std::size_t room = n_partners + n_slots * (own[row + 1] - own[row]) + filter_padding;
        if (partners.size() < room) partners.resize(2 * room);
        std::uint32_t* next = partners.data() + n_partners;
        for (std::uint32_t slot = own[row]; slot < own[row + 1]; ++slot) {
            const SpreadFlight spread(
                {lanes.x[slot], lanes.y[slot], lanes.vx[slot], lanes.vy[slot]},
                touching_in(lanes, slot, touching));
            next = filter_run(lanes, {slot + 1, own[high + 1]}, spread, start, next);
            for (int k = 1; k <= n_right; ++k) {
                const std::uint32_t* const other = own + static_cast<std::size_t>(k) *
                                                             cells.column_length;
                next = filter_run(lanes, {other[low], other[high + 1]}, spread, start, next);
            }
            ends.push_back(static_cast<std::uint32_t>(next - partners.data()));
        }
        n_partners = static_cast<std::size_t>(next - partners.data());
    }
}

template <class SomeLanes> FlightFilters<SomeLanes> filters() {
    return {filter_runs<SomeLanes>, filter_two_runs<SomeLanes>, filter_cells_of_column<SomeLanes>};
}
FlightFilters<FlightLanes> FiltersOfEqual() { return filters<FlightLanes>(); }
FlightFilters<SizedLanes> FiltersOfSized() { return filters<SizedLanes>(); }

} // namespace carrom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace carrom {

HWY_EXPORT(FiltersOfEqual);
HWY_EXPORT(FiltersOfSized);

template <> const FlightFilters<FlightLanes>& flight_filters() {
    static const FlightFilters<FlightLanes> filters = HWY_DYNAMIC_DISPATCH(FiltersOfEqual)();
    return filters;
}
template <> const FlightFilters<SizedLanes>& flight_filters() {
    static const FlightFilters<SizedLanes> filters = HWY_DYNAMIC_DISPATCH(FiltersOfSized)();
    return filters;
}

} // namespace carrom
#endif
