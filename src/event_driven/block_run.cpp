// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/block_run.hpp"

#include <algorithm>
#include <cmath>

#include "core/stop_request.hpp"
#include "event_driven/block_scratch.hpp"

namespace carrom {

double block_reach(const BlockWindow& window, double diameter, const Box& box) {
    const double travel = window.speed_bound * window.duration();
    return (diameter + 2 * travel) * (1 + 1e-6) + 64 * 0x1p-53 * box.longest() +
           0x1p-50 * window.speed_bound * window.end;
}

template <class Dynamics>
BlockRun<Dynamics>::BlockRun(const Dynamics& dynamics)
    : scratch_(std::make_unique<Scratch>(dynamics)) {}
template <class Dynamics> void BlockRun<Dynamics>::change_dynamics(const Dynamics& dynamics) {
    scratch_->dynamics = dynamics;
}
template <class Dynamics> BlockRun<Dynamics>::~BlockRun() = default;
template <class Dynamics> BlockRun<Dynamics>::BlockRun(BlockRun&&) noexcept = default;

template <class Dynamics>
void BlockRun<Dynamics>::run(const BlockGround& ground, const CellBlock& block, int halo,
                             std::span<std::uint64_t> histories, BlockOutcome& outcome) {
    scratch_->begin(ground, outcome);
    if constexpr (Scratch::has_sizes) {
        scratch_->list_levels(block, halo);
        scratch_->gather();
    } else {
        scratch_->list_discs(block, halo);
        scratch_->gather();
        scratch_->mark_own(block);
    }
    run_gathered(histories);
}

template <class Dynamics>
void BlockRun<Dynamics>::run_whole(const BlockGround& ground, const CellBlock& block,
                                   std::span<std::uint64_t> histories, BlockOutcome& outcome) {
    scratch_->begin(ground, outcome);
    if constexpr (Scratch::has_sizes)
        scratch_->list_levels_of_all();
    else
        scratch_->list_all_discs();
    scratch_->gather();
    scratch_->mark_own_of_all(block);
    run_gathered(histories);
}

template <class Dynamics>
void BlockRun<Dynamics>::run_gathered(std::span<std::uint64_t> histories) {
    scratch_->predict_all();
    for (const double stop : scratch_->ground.stops) {
        run_events(stop);
        scratch_->report_hits();
    }
    run_events(scratch_->ground.window.end);
    scratch_->report(histories);
}

/// Carries out the remaining events up to the time `end`.
template <class Dynamics> void BlockRun<Dynamics>::run_events(double end) {
    Scratch& s = *scratch_;
    const EventOrder before(s.discs);
    const auto is_current = [&s](const Event& event) {
        return s.versions_of(event) == event.versions;
    };
    // After a request to stop, the loop ends early. The result of this run is then invalid, and the
    // engine abandons the step.
    for (Event event; s.queue.pop(event, end, before, is_current) && !s.outcome->is_cascade &&
                      !s.is_void && !is_stop_overdue();)
        s.happen(event);
}

template <class Dynamics> void BlockRun<Dynamics>::Scratch::find_runs(const FlightBox& box) {
    const auto cell = [](float place, float last) {
        const float above = place > 0 ? place : 0;
        return static_cast<int>(above < last ? above : last);
    };
    const int left = cell(box.left, column_limit), right = cell(box.right, column_limit);
    const int bottom = cell(box.bottom * rows_per_cell, row_limit),
              top = cell(box.top * rows_per_cell, row_limit);
    list_runs(cell_starts.data(), cell_rows, {left, right, bottom, top});
}

template <class Dynamics> void BlockRun<Dynamics>::Scratch::predict_all() {
    queue.restart(ground.window.begin, ground.window.end, discs.size() / 2);
    if (dynamics.has_walls())
        for (std::uint32_t slot = 0; slot < discs.size(); ++slot)
            if (!ghost_at(slot)) predict_walls(slot);
    if (!dynamics.has_pairs()) return;
    if constexpr (has_sizes) return predict_levels();
    if (Dynamics::has_moving_images && is_whole) return predict_pairs_of_all();
    const CellTable table{cell_starts.data(),
                          cell_rows,
                          cells.end_column - cells.first_column,
                          cells.end_row - cells.first_row,
                          n_reach_columns,
                          n_reach_rows};
    for (int column = firsts.first_column; column < firsts.end_column; ++column) {
        later_ends.clear();
        flight_filters<FlightLanes>().column(lanes, table, column,
                                             {firsts.first_row, firsts.end_row}, touching_squared,
                                             later, later_ends);
        std::uint32_t slot = cell_run(column, firsts.first_row, firsts.first_row).begin, k = 0;
        for (const std::uint32_t end : later_ends) {
            for (; k < end; ++k) predict_pair(slot, later[k]);
            ++slot;
        }
    }
}

template <class Dynamics> void BlockRun<Dynamics>::Scratch::predict_pairs(const Flight& flight) {
    const std::uint32_t slot = flight.slot;
    find_runs(box_of(flight, farthest));
    const std::size_t n_partners = flight_filters<FlightLanes>().one(
        lanes, std::span(runs).first(n_runs), flight, touching_squared, partners.data());
    for (std::size_t k = 0; k < n_partners; ++k) predict_pair(slot, partners[k]);
}

/// Predicts contacts of two discs that have just collided. They touch, so one search of the box
/// around both flights is faster than two searches. The search leaves out the pair itself, so the
/// predicate alone decides whether these two discs meet again.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::predict_pairs_of(std::uint32_t p, std::uint32_t q) {
    if (!dynamics.has_pairs()) return;
    if constexpr (has_sizes) return predict_two_sized(p, q);
    const Flight p_flight = flight_of(p), q_flight = flight_of(q);
    const FlightBox a = box_of(p_flight, farthest), b = box_of(q_flight, farthest);
    const auto least = [](float u, float v) { return u < v ? u : v; };
    const auto most = [](float u, float v) { return u > v ? u : v; };
    find_runs({least(a.left, b.left), most(a.right, b.right), least(a.bottom, b.bottom),
               most(a.top, b.top)});
    const PartnerCounts n = flight_filters<FlightLanes>().two(
        lanes, std::span(runs).first(n_runs), p_flight, q_flight, touching_squared,
        touching_squared, partners.data(), others_partners.data());
    predict_pair(p, q);
    for (std::size_t k = 0; k < n.p; ++k) predict_pair(p, partners[k]);
    for (std::size_t k = 0; k < n.q; ++k) predict_pair(q, others_partners[k]);
}

/// Predicts the contact of disc `a` with disc `b`, to whose position `image` (whole boxes) is added
/// unless it is null.
template <class Dynamics>
[[gnu::always_inline]] inline void BlockRun<Dynamics>::Scratch::predict_shifted(
    std::uint32_t a, std::uint32_t b, const Image* image) {
    if (image) [[unlikely]]
        move_image(discs[b], *image);
    const auto contact = dynamics.contact(discs[a], discs[b], Dynamics::never);
    if (image) [[unlikely]]
        move_image(discs[b], -*image);
    if (!contact.exists()) return;
    const double time = contact.base + contact.delay;
    // Two discs that have just collided with each other do not collide again at the same time. If
    // they still approach, this is a rounding error, too small for an impulse.
    if (have_just_collided(a, b, time)) return;
    push(time, a, b, image);
}

template <class Dynamics>
void BlockRun<Dynamics>::Scratch::predict_pair(std::uint32_t a, std::uint32_t b) {
    if (const Ghost* const ghost = ghost_at(b)) [[unlikely]]
        return predict_shifted(a, ghost->disc, &ghost->image);
    predict_shifted(a, b, nullptr);
}

template <class Dynamics>
void BlockRun<Dynamics>::Scratch::predict_image(std::uint32_t a, std::uint32_t b,
                                                const Image& image) {
    predict_shifted(a, b, &image);
}

/// Predicts bounces off sides, and off the first fixed body that the disc meets before any side.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::predict_walls(std::uint32_t slot) {
    const double begin = ground.window.begin, end = ground.window.end;
    const DiscState& disc = discs[slot];
    const float x_end = x[slot] + vx[slot], y_end = y[slot] + vy[slot];
    float radius = 0; // stays 0 for equal discs: `x_inner_low` includes their radius
    if constexpr (has_sizes) radius = radii[slot];
    const bool is_inside = x_end - radius > x_inner_low && x_end + radius < x_inner_high &&
                           y_end - radius > y_inner_low && y_end + radius < y_inner_high;
    double until = end;
    if (!is_inside && dynamics.may_meet_wall(disc, end)) {
        const double x_time = dynamics.wall_time(disc, Axis::x),
                     y_time = dynamics.wall_time(disc, Axis::y);
        push(x_time, slot, x_wall);
        push(y_time, slot, y_wall);
        if (const double first = std::min(x_time, y_time); first > begin)
            until = std::min(first, end);
    }
    predict_fixed_body(slot, until);
}

/// Predicts the collision with the first fixed body that the disc meets before `until`, the time
/// when it meets a side or the window ends. The fixed body that the disc has just hit is ignored at
/// the time of that hit, because of rounding errors (see predict_shifted).
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::predict_fixed_body(std::uint32_t slot,
                                                     [[maybe_unused]] double until) {
    if constexpr (Dynamics::may_have_fixed_bodies) {
        if (!dynamics.has_fixed_bodies()) return;
        const BlockWindow& window = ground.window;
        const std::uint32_t last = past_events_of[slot].partner;
        const std::uint32_t left = is_fixed_body(last) && last != EventHistory::nobody
                                       ? last - first_fixed_body
                                       : BodyContact::no_body;
        const BodyContact contact = dynamics.first_fixed_body(
            discs[slot], {window.begin, until, window.holds_begin, left});
        if (contact.exists()) push(contact.time, slot, first_fixed_body + contact.body);
    }
}

template <class Dynamics>
void BlockRun<Dynamics>::Scratch::push(double time, std::uint32_t a, std::uint32_t b,
                                       [[maybe_unused]] const Image* image) {
    const BlockWindow& window = ground.window;
    if (!(time <= window.end) || time < window.begin ||
        (time == window.begin && !window.holds_begin))
        return;
    Event event;
    event.time = time;
    const auto raise = [&](std::uint32_t slot) {
        const EventHistory& past_events = past_events_of[slot];
        if (discs[slot].tau == time && past_events.history != 0) [[unlikely]]
            event.generation = std::max(event.generation, past_events.generation + 1);
    };
    raise(a);
    if (!is_wall(b)) {
        raise(b);
        const bool is_turned = discs[b].id < discs[a].id;
        if (is_turned) std::swap(a, b);
        if (Dynamics::is_periodic && image) [[unlikely]]
            event.set_image(is_turned ? -*image : *image);
    }
    event.p = a;
    event.q = b;
    event.versions = versions_of(event);
    queue.push(event, EventOrder(discs));
}

template <class Dynamics> void BlockRun<Dynamics>::Scratch::happen(const Event& event) {
    ++outcome->n_carried;
    if (cascade_watch.add(event.time, Dynamics::cascade_interval, discs.size(), is_wall(event.q)))
        [[unlikely]]
        give_up(event);
    const bool is_corner = event.q == x_wall &&
                           dynamics.wall_time(discs[event.p], Axis::y) == event.time;
    const double vy_before = discs[event.p].vy; // a thermal wall across x changes vy
    carry_out(event);
    const bool has_left = Dynamics::may_lose_discs &&
                          discs[event.p].has_departed(); // the disc left through the first side
    if (is_corner && !has_left &&
        (Dynamics::has_mirror_walls ||
         discs[event.p].vy == vy_before)) { // it also bounces off the other side, at this time
        Event other_side = event;
        other_side.q = y_wall;
        other_side.generation += 1;
        carry_out(other_side);
    }
    if (Dynamics::may_lose_discs && discs[event.p].has_departed()) return;
    if (dynamics.has_walls()) predict_walls(event.p);
    if (is_wall(event.q)) return predict_pairs(event.p);
    if (dynamics.has_walls()) predict_walls(event.q);
    if (event.has_image()) {
        predict_pairs(event.p);
        return predict_pairs(event.q);
    }
    predict_pairs_of(event.p, event.q);
}

/// Changes the states of an event's discs, and adds the event to their histories and the sums.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::carry_out(const Event& event) {
    DiscState& p = discs[event.p];
    const double vx_before = p.vx, vy_before = p.vy;
    const WallStress<Dynamics> before(p);
    Loss loss;
    if (event.q == x_wall) {
        loss = dynamics.bounce(p, Axis::x, event.time, spin_of(event.p));
    } else if (event.q == y_wall) {
        loss = dynamics.bounce(p, Axis::y, event.time, spin_of(event.p));
    } else if (Dynamics::may_have_fixed_bodies && is_wall(event.q)) {
        if constexpr (Dynamics::may_have_fixed_bodies)
            loss = dynamics.bounce_off(p, event.q - first_fixed_body, event.time,
                                       since_collision(p, event.time), spin_of(event.p));
    } else {
        if (is_own[event.p] != is_own[event.q] && !is_whole)
            check_partner(is_own[event.p] != 0 ? event.q : event.p);
        loss = collide(event);
        note(event.q, event.p, event);
    }
    if (is_wall(event.q) && is_own[event.p] != 0)
        before.add_to(stress_terms, part.stress, dynamics, p, event.time, ground.sums.flown_before);
    note(event.p, event.q, event);
    if (is_own[event.p] != 0) {
        outcome->n_events += 1;
        part.losses.add(loss, dynamics.slowing_at(event.time));
        const bool is_pushed = !Dynamics::may_lose_discs || !p.has_departed();
        if (ground.notes.log)
            log_event(event, is_pushed ? p.vx - vx_before : 0, is_pushed ? p.vy - vy_before : 0);
    }
}

/// Collides the two discs of an event. If the event is with an image of the second disc, that disc
/// is moved to its image before the collision, and back afterwards.
template <class Dynamics> Loss BlockRun<Dynamics>::Scratch::collide(const Event& event) {
    DiscState &p = discs[event.p], &q = discs[event.q];
    const PairStress<Dynamics> stress(p, q);
    // Times that would be equal without rounding count as equal. A disc that has not collided since
    // the last sync has tau = 0.
    const double last = std::max(p.tau, q.tau);
    const bool is_simultaneous = last > 0 && event.time - last <= 0x1p-48 * event.time;
    if (Dynamics::is_periodic && event.has_image()) move_image(q, event.image());
    const Loss loss = dynamics.collide(p, q, event.time,
                                       Dynamics::since_collision_of(p, q, event.time),
                                       {spin_of(event.p), spin_of(event.q)});
    if (is_own[event.p] != 0) {
        part.n_simultaneous += is_simultaneous;
        const Separation to = dynamics.separation(p, q);
        [[maybe_unused]] const double impulse = stress.add_to(
            stress_terms, part.stress, dynamics, p, q, to, event.time, ground.sums.flown_before);
        if constexpr (Dynamics::has_moving_images)
            part.work += impulse * periods().between(p, q, event.time).vx;
        if (ground.notes.pairs) record_pair(event, stress, to);
    }
    if (Dynamics::is_periodic && event.has_image()) move_image(q, -event.image());
    return loss;
}

/// Records that an own disc has met the disc in `slot`, if that disc is from beyond the ring, where
/// histories are not compared. Either that disc was faster than the bound, or this run is wrong.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::check_partner(std::uint32_t slot) {
    if (is_compared(slot)) return;
    outcome->far_partner = std::max({outcome->far_partner,
                                     std::sqrt(dynamics.squared_speed(discs[slot])),
                                     ground.window.speed_bound * (1 + 1e-6)});
}

/// Updates the history and the flight of one disc of an event. Adds own discs to `hit_slots`.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::note(std::uint32_t slot, std::uint32_t partner,
                                       const Event& event) {
    const DiscState& disc = discs[slot];
    EventHistory& past_events = past_events_of[slot];
    past_events.generation = event.generation;
    past_events.partner = partner;
    const std::uint64_t partner_id = is_wall(partner) ? ~std::uint64_t{0} : discs[partner].id;
    const double now = dynamics.squared_speed(disc);
    if (ground.is_alone)
        past_events.history = 1;
    else
        past_events.add(event.time, disc, partner_id, spin_of(slot), speed_class(now));
    if (now > void_squared) [[unlikely]]
        end_void_run(now);
    if (is_own[slot] != 0) {
        if (!std::exchange(is_hit[slot], true)) hit_slots.push_back(slot);
        largest_squared = std::max(largest_squared, now);
        const float before = lane_speed_squared(slot);
        if (now > bound_squared || before > bound_lane_squared) [[unlikely]]
            hold_to_schedule(slot, event.time);
    }
    place(slot, ground.window.begin);
    if (Dynamics::is_periodic && is_whole)
        layout.for_ghosts_of(slot, [this](const Ghost& ghost) { place_ghost(ghost); });
}

template <class Dynamics> std::size_t BlockRun<Dynamics>::bytes() const {
    const Scratch& s = *scratch_;
    return s.discs.capacity() * (sizeof(DiscState) + sizeof(EventHistory) + 4 * sizeof(float)) +
           s.queue.bytes();
}

#define CARROM_DEFINE(Dynamics) template class BlockRun<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
