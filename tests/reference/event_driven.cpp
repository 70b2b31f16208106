// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace carrom::reference {

EventDrivenReference::EventDrivenReference(const Setting& setting, std::span<const InputDisc> discs,
                                           std::size_t most_events)
    : setting_(setting), species_(std::make_shared<FixedBodies>(setting)),
      discs_(stored_states(setting, discs)), spins_(stored_spins(setting, discs.size())),
      history_of_(discs.size()), most_events_(most_events) {
    predict_all();
}

void EventDrivenReference::run_micro_steps(std::int64_t count) {
    const std::int64_t last = micro_step_ + count;
    while (micro_step_ < last) {
        const std::int64_t next_sync = (micro_step_ / setting_.sync_every + 1) *
                                       setting_.sync_every;
        const std::int64_t until = std::min(last, next_sync);
        run_until(setting_.clock_at(until - (next_sync - setting_.sync_every)));
        micro_step_ = until;
        if (until < next_sync) continue;
        for (DiscState& disc : discs_) {
            if (has_left(disc)) continue;
            advance(disc, setting_.clock_at(setting_.sync_every));
            if (setting_.drag_clock) {
                disc.vx *= setting_.slowing_at(disc.tau);
                disc.vy *= setting_.slowing_at(disc.tau);
            }
            restart_frame(disc, disc.tau);
            bring_inside(setting_, disc, setting_.tiles(next_sync - setting_.sync_every));
            disc.tau = 0;
        }
        predict_all();
    }
}

bool EventDrivenReference::comes_later(const Prediction& a, const Prediction& b) {
    const auto key = [](const Event& e) {
        return std::make_tuple(e.time, e.generation, e.p, e.is_pair, !e.is_fixed_body, e.q);
    };
    return key(a.event) > key(b.event);
}

void EventDrivenReference::run_until(double time) {
    while (!heap_.empty() && heap_.front().event.time <= time) {
        std::pop_heap(heap_.begin(), heap_.end(), comes_later);
        const Prediction next = heap_.back();
        heap_.pop_back();
        if (is_valid(next)) happen(next.event);
    }
}

void EventDrivenReference::predict_all() {
    heap_.clear();
    for (EventHistory& past_events : history_of_) {
        past_events.time = -1;
        past_events.partner = EventHistory::no_partner;
        past_events.body = FixedBodies::none;
    }
    for (DiscId p = 0; p < discs_.size(); ++p) {
        predict_walls(p);
        for (DiscId q = p + 1; q < discs_.size(); ++q) predict_pair(p, q);
    }
}

void EventDrivenReference::predict_walls(DiscId p) {
    const DiscState& disc = discs_[p];
    if (has_left(disc)) return;
    for (const DiscId axis : {Event::wall_x, Event::wall_y})
        push({meeting(disc, axis).time, 0, p, false, axis, 0});
    predict_fixed_body(p);
}

void EventDrivenReference::predict_fixed_body(DiscId p) {
    if (species_->are_none()) return;
    const EventHistory& past_events = history_of_[p];
    const bool has_just_left = past_events.time == discs_[p].tau;
    const BodyMeeting first = species_->first_meeting(
        discs_[p], discs_[p].tau, setting_.clock_at(setting_.sync_every),
        {0, has_just_left ? past_events.body : FixedBodies::none, past_events.copy});
    if (first.body == FixedBodies::none) return;
    Event event{first.time, 0, p, false, first.body, 0};
    event.is_fixed_body = true;
    event.copy = first.copy;
    push(event);
}

/// The position of the low or the high wall of an axis for a disc's centre, and its velocity, in
/// the frame that falls since the sync.
EventDrivenReference::Wall EventDrivenReference::wall_at(DiscId disc, DiscId axis, bool is_high,
                                                         double time) const {
    const double k = static_cast<double>(setting_.micro_steps), g = gravity(axis);
    const double speed = setting_.effects.boundaries[2 * axis + (is_high ? 1 : 0)].speed / k;
    const bool is_open = setting_.effects.boundaries[2 * axis + (is_high ? 1 : 0)].kind ==
                         BoundaryKind::open;
    const double from_line = is_open ? -setting_.radius_of(disc) : setting_.radius_of(disc);
    const double start = is_high ? setting_.edge(2 * axis) - from_line : from_line;
    const double at_sync = start + speed * static_cast<double>(micro_step_ / setting_.sync_every *
                                                               setting_.sync_every);
    const double pull = g - setting_.effects.drag / k * speed;
    return {(at_sync + speed * time) - fallen(pull, time),
            speed - pull * (setting_.drag_clock ? time / setting_.slowing_at(time) : time)};
}

double EventDrivenReference::fallen(double pull, double time) const {
    if (setting_.drag_clock && pull != 0) return pull * setting_.dragged_fall(time);
    return (0.5 * pull * time) * time;
}

double EventDrivenReference::gravity(DiscId axis) const {
    const double k = static_cast<double>(setting_.micro_steps);
    return (axis == Event::wall_x ? setting_.effects.gravity.x : setting_.effects.gravity.y) /
           (k * k);
}

/// The first time at which the disc is at one of the two walls, or beyond, and approaches it.
EventDrivenReference::Meeting EventDrivenReference::meeting(const DiscState& disc,
                                                            DiscId axis) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    Meeting first{never, false};
    if (axis == Event::wall_x ? setting_.effects.is_periodic_x() : setting_.effects.is_periodic_y())
        return first;
    if (discs_grow()) return growing_meeting(disc, axis);
    for (const bool is_high : {false, true}) {
        const Wall wall = wall_at(disc.id, axis, is_high, disc.tau);
        const double x = axis == Event::wall_x ? disc.x : disc.y,
                     v = axis == Event::wall_x ? disc.vx : disc.vy;
        const double gap = is_high ? wall.place - x : x - wall.place;
        const double rate = is_high ? wall.speed - v : v - wall.speed;
        const double moving = setting_.effects.boundaries[2 * axis + (is_high ? 1 : 0)].speed /
                              static_cast<double>(setting_.micro_steps);
        const double at_wall = gravity(axis) - setting_.effects.drag /
                                                   static_cast<double>(setting_.micro_steps) *
                                                   moving;
        const double pull = is_high ? -at_wall : at_wall;
        double delay = never;
        const std::size_t side = 2 * axis + (is_high ? 1 : 0);
        if (oscillates(side)) {
            const double speed = wall.speed + setting_.oscillation(side, last_sync(), disc.tau)[1];
            delay = setting_.oscillating_delay(side, last_sync(), gap, rate,
                                               is_high ? speed - v : v - speed, disc.tau);
        } else if (setting_.drag_clock && pull != 0) {
            const double left = setting_.slowing_at(disc.tau);
            delay = left * setting_.dragged_fall_delay(gap, left * rate, pull);
        } else if (rate < 0 && gap <= 0) {
            delay = 0;
        } else if (rate < 0 && pull == 0) {
            delay = gap / -rate;
        } else if (rate < 0) {
            const double square = rate * rate - 2 * pull * gap;
            if (square > 0) delay = 2 * gap / (std::sqrt(square) - rate);
        } else if (pull < 0) {
            const double square = rate * rate - 2 * pull * gap;
            delay = (rate + std::sqrt(square > 0 ? square : 0)) / -pull;
        }
        if (disc.tau + delay < first.time) first = {disc.tau + delay, is_high};
    }
    return first;
}

/// The time since the disc's last collision; infinite if it has not collided since the sync.
double EventDrivenReference::time_since_collision(DiscId id, double time) const {
    const double last = history_of_[id].time;
    return last < 0 ? std::numeric_limits<double>::infinity() : time - last;
}

/// The speed at which the surfaces of two touching discs approach, scaled to their first radii.
double EventDrivenReference::approach(const DiscState& p, const DiscState& q, Copy copy) const {
    const Tiles tiles = setting_.tiles(last_sync());
    const double ex = (q.x - p.x) + tiles.x_to(copy, p.tau), ey = (q.y - p.y) + tiles.y_to(copy);
    const double wx = (q.vx - p.vx) + tiles.vx_of(copy), wy = q.vy - p.vy;
    const double grows = discs_grow() ? growth_rate() / growth_at(p.tau) : 0;
    const double radii = setting_.radius_of(p.id) + setting_.radius_of(q.id);
    return std::fabs((wx * ex + wy * ey) / (ex * ex + ey * ey) - grows) * radii;
}

/// Reverses the velocity at the wall that the disc has reached; its last collision was `since` ago.
void EventDrivenReference::rebound(DiscState& disc, DiscId axis, bool is_high, double time,
                                   double since) const {
    double& v = axis == Event::wall_x ? disc.vx : disc.vy;
    const std::size_t number = 2 * axis + (is_high ? 1 : 0);
    Wall wall = wall_at(disc.id, axis, is_high, time);
    if (oscillates(number)) wall.speed += setting_.oscillation(number, last_sync(), time)[1];
    const double radius = setting_.radius_of(disc.id),
                 in = discs_grow() ? growth_of_radius(disc.id) : 0,
                 size = discs_grow() ? growth_at(time) : 1;
    const bool is_touched = setting_.is_in_contact(
        since, std::fabs((is_high ? v : -v) + (is_high ? -wall.speed : wall.speed) + in),
        radius * size, 1e-4);
    const double restitution = is_touched ? 1 : setting_.effects.boundaries[number].restitution;
    if (discs_grow()) { // as if the wall came in
        const double leaving = in + restitution * (in - (is_high ? -v : v));
        v = is_high ? -leaving : leaving;
        return;
    }
    double away = restitution * std::fabs(v - wall.speed);
    if (setting_.effects.boundaries[number].kind == BoundaryKind::thermal) {
        const auto [fast, sideways] = setting_.leaving(disc, number);
        const double left = setting_.slowing_at(time);
        away = fast / left;
        (axis == Event::wall_x ? disc.vy : disc.vx) =
            sideways / left - gravity(1 - axis) * (setting_.drag_clock ? time / left : time);
    }
    const double moving = setting_.effects.boundaries[number].speed /
                          static_cast<double>(setting_.micro_steps);
    const double at_wall = gravity(axis) - setting_.effects.drag /
                                               static_cast<double>(setting_.micro_steps) * moving;
    double pull_back = is_high ? at_wall : -at_wall;
    if (oscillates(number)) pull_back = setting_.oscillation(number, last_sync(), time)[2];
    if (pull_back > 0)
        away = std::max(away,
                        setting_.least_departure(pull_back, radius) / setting_.slowing_at(time));
    v = is_high ? wall.speed - away : wall.speed + away;
}

/// Begins a frame that is at rest in the box at this time and falls from then on.
void EventDrivenReference::restart_frame(DiscState& disc, double time) const {
    const double gx = gravity(Event::wall_x), gy = gravity(Event::wall_y);
    if (gx == 0 && gy == 0) return;
    disc.x = disc.x + fallen(gx, time);
    disc.y = disc.y + fallen(gy, time);
    disc.vx = disc.vx + gx * time;
    disc.vy = disc.vy + gy * time;
}

void EventDrivenReference::predict_pair(DiscId p, DiscId q) {
    if (!setting_.discs_meet() || has_left(discs_[p]) || has_left(discs_[q])) return;
    if (p > q) std::swap(p, q);
    const Tiles tiles = setting_.tiles(last_sync());
    const auto inspect = [&](Copy copy) {
        const Contact found = discs_grow()
                                  ? growing_contact(discs_[p], discs_[q], copy)
                                  : contact(discs_[p], discs_[q],
                                            setting_.radius_of(p) + setting_.radius_of(q),
                                            std::numeric_limits<double>::infinity(), copy, tiles);
        if (found.delay < 0) return;
        const double time = found.base + found.delay;
        if (history_of_[p].partner == q && history_of_[q].partner == p &&
            time == history_of_[p].time)
            return;
        push({time, 0, p, true, q, 0, false, copy});
    };
    if (!setting_.effects.are_periodic()) return inspect({});
    const double begin = std::max(discs_[p].tau, discs_[q].tau),
                 end = static_cast<double>(setting_.sync_every);
    for (const Copy copy : copies_near(setting_, discs_[p], discs_[q], begin, end, tiles))
        inspect(copy);
}

/// Events later than the next sync are dropped, because the sync rewrites the states from which
/// they follow.
void EventDrivenReference::push(Event event) {
    if (!(event.time <= static_cast<double>(setting_.sync_every))) return;
    const auto raise = [&event, this](DiscId id) {
        if (history_of_[id].time == event.time)
            event.generation = std::max(event.generation, history_of_[id].generation + 1);
    };
    raise(event.p);
    if (event.is_pair) raise(event.q);
    heap_.push_back(
        {event, history_of_[event.p].version, event.is_pair ? history_of_[event.q].version : 0});
    std::push_heap(heap_.begin(), heap_.end(), comes_later);
    if (heap_.size() > most_predictions_) forget_invalid();
}

/// Removes void predictions, because those of fast discs would otherwise fill the memory.
void EventDrivenReference::forget_invalid() {
    std::erase_if(heap_, [this](const Prediction& prediction) { return !is_valid(prediction); });
    std::make_heap(heap_.begin(), heap_.end(), comes_later);
    most_predictions_ = std::max(most_predictions_, 2 * heap_.size());
}

bool EventDrivenReference::is_valid(const Prediction& prediction) const {
    const Event& event = prediction.event;
    return history_of_[event.p].version == prediction.p_version &&
           (!event.is_pair || history_of_[event.q].version == prediction.q_version);
}

void EventDrivenReference::happen(const Event& event) {
    if (log_.size() >= most_events_)
        throw std::runtime_error("more collisions than a test should have");
    const DiscState& first = discs_[event.p];
    const bool is_corner = !event.is_pair && !event.is_fixed_body && event.q == Event::wall_x &&
                           meeting(first, Event::wall_y).time == event.time;
    const double vy_before = first.vy;
    carry_out(event);
    if (is_corner && !has_left(first) && first.vy == vy_before) {
        Event other_side = event;
        other_side.q = Event::wall_y;
        other_side.generation += 1;
        carry_out(other_side);
    }
    predict_walls(event.p);
    if (event.is_pair) predict_walls(event.q);
    for (DiscId other = 0; other < discs_.size(); ++other) {
        if (other != event.p) predict_pair(event.p, other);
        if (event.is_pair && other != event.q && other != event.p) predict_pair(event.q, other);
    }
}

void EventDrivenReference::carry_out(const Event& event) {
    DiscState& p = discs_[event.p];
    const double since = std::min(time_since_collision(event.p, event.time),
                                  event.is_pair ? time_since_collision(event.q, event.time)
                                                : std::numeric_limits<double>::infinity());
    const bool is_high = !event.is_pair && !event.is_fixed_body && meeting(p, event.q).is_high;
    advance(p, event.time);
    if (event.is_pair) {
        DiscState& q = discs_[event.q];
        advance(q, event.time);
        const bool is_touched = setting_.is_in_contact(
            since, approach(p, q, event.copy), setting_.radius_of(p.id) + setting_.radius_of(q.id),
            1e-6);
        if (setting_.are_rough())
            collide_rough(setting_, p, q, spins_[event.p], spins_[event.q], is_touched, event.copy,
                          setting_.tiles(last_sync()));
        else if (discs_grow())
            push_growing(p, q, is_touched ? 1 : setting_.restitution(), event.copy);
        else
            exchange_momentum(setting_, p, q, is_touched ? 1 : setting_.restitution(), event.copy,
                              setting_.tiles(last_sync()));
        p.pair_collisions += 1;
        q.pair_collisions += 1;
        pair_collisions_ += 1;
        note(event.q, event.p, event);
    } else {
        if (event.is_fixed_body) {
            species_->reflect(p, {event.time, event.q, event.copy}, event.time, since);
        } else if (setting_.effects.boundaries[2 * event.q + (is_high ? 1 : 0)].kind ==
                   BoundaryKind::open) {
            restart_frame(p, event.time);
            set_left(setting_, p, 2 * event.q + (is_high ? 1 : 0));
            if (setting_.are_rough()) spins_[event.p] = 0;
        } else
            rebound(p, event.q, is_high, event.time, since);
        p.wall_collisions += 1;
        wall_collisions_ += 1;
    }
    note(event.p, event.is_pair ? event.q : EventHistory::no_partner, event);
    if (event.is_fixed_body) {
        history_of_[event.p].body = event.q;
        history_of_[event.p].copy = event.copy;
    }
    log_.push_back(event);
    log_.back().sync = micro_step_ / setting_.sync_every;
}

void EventDrivenReference::note(DiscId id, DiscId partner, const Event& event) {
    history_of_[id].partner = partner;
    history_of_[id].body = FixedBodies::none;
    history_of_[id].time = event.time;
    history_of_[id].generation = event.generation;
    history_of_[id].version += 1;
}

} // namespace carrom::reference
