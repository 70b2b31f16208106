// SPDX-License-Identifier: BSD-3-Clause
#include "time_stepped.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "fixed_bodies.hpp"

namespace carrom::reference {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

bool before(const Collision& a, const Collision& b) {
    const auto key = [](const Collision& c) {
        return std::make_tuple(c.t, c.p, c.q != Collision::wall, c.q);
    };
    return key(a) < key(b);
}

} // namespace

Contact contact(const DiscState& p, const DiscState& q, double sigma, double tolerance, Copy copy,
                const Tiles& tiles) {
    const double base = p.tau > q.tau ? p.tau : q.tau;
    const double px = p.x + p.vx * (base - p.tau), py = p.y + p.vy * (base - p.tau);
    const double qx = q.x + q.vx * (base - q.tau), qy = q.y + q.vy * (base - q.tau);
    const double dx = (qx - px) + tiles.x_to(copy, base), dy = (qy - py) + tiles.y_to(copy);
    const double wx = (q.vx - p.vx) + tiles.vx_of(copy), wy = q.vy - p.vy;

    const double b = dx * wx + dy * wy;
    if (b >= 0) return {base, -1};
    const double a = wx * wx + wy * wy;
    const double p1 = dx * wy, e1 = std::fma(dx, wy, -p1);
    const double p2 = dy * wx, e2 = std::fma(dy, wx, -p2);
    const double cross = std::fabs((p1 - p2) + (e1 - e2));
    const double span = std::sqrt(a) * sigma;
    const double discriminant = (span - cross) * (span + cross);
    if (discriminant <= 0) return {base, -1};
    const double distance = std::sqrt(dx * dx + dy * dy);
    const double gap = distance - sigma;
    if (gap < -tolerance) return {base, -1};
    if (gap <= 0) return {base, 0};
    const double c = gap * (distance + sigma);
    return {base, c / (std::sqrt(discriminant) - b)};
}

bool has_left(const DiscState& disc) { return disc.is_departed != 0; }

void set_left(const Setting& setting, DiscState& disc, std::size_t side) {
    const double radius = setting.radius_of(disc.id),
                 line = side % 2 == 0 ? -radius : setting.edge(side) + radius;
    (side < 2 ? disc.x : disc.y) = line;
    disc.vx = disc.vy = disc.tau = 0;
    disc.is_departed = 1;
}

void advance(DiscState& disc, double time) {
    const double elapsed = time - disc.tau;
    disc.x = disc.x + disc.vx * elapsed;
    disc.y = disc.y + disc.vy * elapsed;
    disc.tau = time;
}

void exchange_momentum(const Setting& setting, DiscState& p, DiscState& q, double restitution,
                       Copy copy, const Tiles& tiles) {
    const double ex = (q.x - p.x) + tiles.x_to(copy, p.tau), ey = (q.y - p.y) + tiles.y_to(copy);
    const double wx = (q.vx - p.vx) + tiles.vx_of(copy), wy = q.vy - p.vy;
    const double k = (1 + restitution) / 2 * ((wx * ex + wy * ey) / (ex * ex + ey * ey));
    const double mp = setting.mass_of(p.id), mq = setting.mass_of(q.id), mean = (mp + mq) / 2;
    p.vx += k * (mq / mean) * ex;
    p.vy += k * (mq / mean) * ey;
    q.vx -= k * (mp / mean) * ex;
    q.vy -= k * (mp / mean) * ey;
}

void collide_rough(const Setting& setting, DiscState& p, DiscState& q, double& p_spin,
                   double& q_spin, bool is_touched, Copy copy, const Tiles& tiles) {
    const ContactEffect& contact = setting.effects.contact;
    const double ex = (q.x - p.x) + tiles.x_to(copy, p.tau), ey = (q.y - p.y) + tiles.y_to(copy);
    const double wx = (q.vx - p.vx) + tiles.vx_of(copy), wy = q.vy - p.vy;
    const double rp = setting.radius_of(p.id), rq = setting.radius_of(q.id);
    const double mp = setting.mass_of(p.id), mq = setting.mass_of(q.id), mean = (mp + mq) / 2;
    const double square = ex * ex + ey * ey, distance = std::sqrt(square);
    double k = (wx * ex + wy * ey) / square, s = 0;
    if (!is_touched) {
        k = (1 + contact.restitution) / 2 * k;
        const double slip = (wy * ex - wx * ey) / square - (p_spin * rp + q_spin * rq) / distance;
        s = (1 + contact.tangential_restitution) / 2 * (contact.inertia / (1 + contact.inertia)) *
            slip;
        const double most = contact.friction * std::fabs(k);
        if (s > most) s = most;
        if (s < -most) s = -most;
    }
    const double to_p = mq / mean, to_q = mp / mean;
    p.vx += k * to_p * ex - s * to_p * ey;
    p.vy += k * to_p * ey + s * to_p * ex;
    q.vx -= k * to_q * ex - s * to_q * ey;
    q.vy -= k * to_q * ey + s * to_q * ex;
    p_spin += s * distance / contact.inertia * to_p / rp;
    q_spin += s * distance / contact.inertia * to_q / rq;
}

Species Setting::species_of(DiscId id) const {
    for (const Species& one : effects.species) {
        if (id < one.count) return one;
        id -= one.count;
    }
    return {0, radius, 1};
}

std::array<double, 2> Setting::leaving(const DiscState& disc, std::size_t number) const {
    Boundary side = effects.boundaries[number];
    side.temperature /= static_cast<double>(micro_steps) * static_cast<double>(micro_steps);
    side.temperature /= mass_of(disc.id);
    return thermal_draw(side, disc.id, disc.wall_collisions, number);
}

std::vector<DiscState> stored_states(const Setting& setting, std::span<const InputDisc> discs) {
    const double micro_steps = static_cast<double>(setting.micro_steps);
    std::vector<DiscState> states(discs.size());
    std::vector<bool> is_given(discs.size(), false);
    for (const InputDisc& disc : discs) {
        if (disc.id >= discs.size() || is_given[disc.id])
            throw std::invalid_argument("ids are not 0 .. N-1");
        is_given[disc.id] = true;
        DiscState& state = states[disc.id];
        state.id = disc.id;
        state.x = disc.x;
        state.y = disc.y;
        state.vx = disc.vx / micro_steps;
        state.vy = disc.vy / micro_steps;
    }
    return states;
}

std::vector<double> stored_spins(const Setting& setting, std::size_t n_discs) {
    std::vector<double> spins(setting.are_rough() ? n_discs : 0, 0.0);
    for (std::size_t i = 0; i < setting.first_spins.size(); ++i)
        spins.at(i) = setting.first_spins[i] / static_cast<double>(setting.micro_steps);
    return spins;
}

TimeSteppedReference::TimeSteppedReference(const Setting& setting, std::span<const InputDisc> discs)
    : setting_(setting), species_(std::make_shared<FixedBodies>(setting)),
      band_(1e-8 * setting.radius),
      tolerance_(std::max(1e-12 * (2 * setting.radius), 32 * 0x1p-53 * setting.longest())),
      discs_(stored_states(setting, discs)), spins_(stored_spins(setting, discs.size())) {}

void TimeSteppedReference::run_micro_steps(std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) run_micro_step();
}

void TimeSteppedReference::run_micro_step() {
    const double m = clock();
    find_candidates(m);
    std::sort(candidates_.begin(), candidates_.end(), before);
    counters_.candidates += candidates_.size();

    std::vector<bool> is_taken(discs_.size(), false);
    for (const Collision& candidate : candidates_) {
        const bool is_wall = candidate.q == Collision::wall;
        if (is_taken[candidate.p] || (!is_wall && is_taken[candidate.q])) {
            counters_.rejected_candidates += 1;
            continue;
        }
        is_taken[candidate.p] = true;
        if (!is_wall) is_taken[candidate.q] = true;
        keep(candidate, m);
    }

    micro_step_ += 1;
    if (micro_step_ % setting_.sync_every == 0) synchronize();
}

void TimeSteppedReference::find_candidates(double m) {
    candidates_.clear();
    const Tiles tiles = setting_.tiles(last_sync());
    for (const DiscState& p : discs_) {
        if (has_left(p)) continue;
        const double t = wall_time(p, m);
        if (t != never) candidates_.push_back({micro_step_, t, p.id, Collision::wall});
        for (DiscId id = p.id + 1; id < discs_.size() && setting_.discs_meet(); ++id) {
            if (has_left(discs_[id])) continue;
            const auto inspect = [&](Copy copy) {
                const Contact found = contact(p, discs_[id],
                                              setting_.radius_of(p.id) + setting_.radius_of(id),
                                              tolerance_, copy, tiles);
                if (found.delay < 0) return;
                const double in_step = (found.base - m) + found.delay;
                if (in_step >= 0 && in_step <= 1)
                    candidates_.push_back({micro_step_, in_step, p.id, id, copy});
            };
            if (!setting_.effects.are_periodic())
                inspect({});
            else
                for (const Copy copy : copies_near(setting_, p, discs_[id], m, m + 1, tiles))
                    inspect(copy);
        }
    }
}

void TimeSteppedReference::keep(const Collision& candidate, double m) {
    log_.push_back(candidate);
    DiscState& p = discs_[candidate.p];
    if (candidate.q == Collision::wall) {
        counters_.wall_collisions += 1;
        if (candidate.t != axes_time(p, m)) return bounce_off(p, m, candidate.t);
        bounce(p, m, candidate.t);
        p.wall_collisions += 1;
        if (has_left(p) && setting_.are_rough()) spins_[p.id] = 0;
        if (has_left(p)) return;
        stop_at_wall(p, m, candidate.t, FixedBodies::nowhere());
        return;
    }
    DiscState& q = discs_[candidate.q];
    advance(p, m + candidate.t);
    advance(q, m + candidate.t);
    if (setting_.are_rough())
        collide_rough(setting_, p, q, spins_[p.id], spins_[q.id], false, candidate.copy,
                      setting_.tiles(last_sync()));
    else
        exchange_momentum(setting_, p, q, setting_.restitution(), candidate.copy,
                          setting_.tiles(last_sync()));
    p.pair_collisions += 1;
    q.pair_collisions += 1;
    counters_.pair_collisions += 1;
    stop_at_wall(p, m, candidate.t, FixedBodies::nowhere());
    stop_at_wall(q, m, candidate.t, FixedBodies::nowhere());
}

void TimeSteppedReference::bounce_off(DiscState& disc, double m, double t) const {
    const BodyMeeting meeting = species_->first_meeting(disc, m, m + 1, FixedBodies::nowhere());
    advance(disc, meeting.time);
    species_->reflect(disc, meeting, 0, std::numeric_limits<double>::infinity());
    disc.wall_collisions += 1;
    stop_at_wall(disc, m, t, meeting);
}

void TimeSteppedReference::synchronize() {
    for (DiscState& disc : discs_) {
        if (has_left(disc)) continue;
        advance(disc, static_cast<double>(setting_.sync_every));
        bring_inside(setting_, disc, setting_.tiles(micro_step_ - setting_.sync_every));
        disc.tau = 0;
    }
}

bool TimeSteppedReference::leads_out(double v, std::size_t low_side) const {
    return v != 0 && setting_.effects.boundaries[low_side + (v > 0)].kind == BoundaryKind::open;
}

double TimeSteppedReference::axis_time(DiscId id, double x, double v, double tau, double m,
                                       std::size_t low_side) const {
    double wall = 0;
    if (leads_out(v, low_side)) {
        wall = v < 0 ? -setting_.radius_of(id) : setting_.edge(low_side) + setting_.radius_of(id);
        const double at_end = x + v * ((m + 1) - tau);
        if (v < 0 ? at_end >= wall : at_end <= wall) return never;
    } else if (v < 0 && x + v * ((m + 1) - tau) < low(id) + band_) {
        wall = low(id);
    } else if (v > 0 && x + v * ((m + 1) - tau) > high(id, low_side) - band_) {
        wall = high(id, low_side);
    } else {
        return never;
    }
    const double t = (tau - m) + (wall - x) / v;
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

double TimeSteppedReference::wall_time(const DiscState& disc, double m) const {
    const double at_wall = axes_time(disc, m);
    if (species_->are_none()) return at_wall;
    const double at_body = species_->first_meeting(disc, m, m + 1, FixedBodies::nowhere()).time;
    return at_body <= m + 1 && at_body - m < at_wall ? at_body - m : at_wall;
}

double TimeSteppedReference::axes_time(const DiscState& disc, double m) const {
    const double tx = setting_.effects.is_periodic_x()
                          ? never
                          : axis_time(disc.id, disc.x, disc.vx, disc.tau, m, 0);
    const double ty = setting_.effects.is_periodic_y()
                          ? never
                          : axis_time(disc.id, disc.y, disc.vy, disc.tau, m, 2);
    return tx < ty ? tx : ty;
}

void TimeSteppedReference::bounce(DiscState& disc, double m, double t) const {
    const bool has_x = !setting_.effects.is_periodic_x(), has_y = !setting_.effects.is_periodic_y();
    const bool x_is_due = has_x && axis_time(disc.id, disc.x, disc.vx, disc.tau, m, 0) == t;
    const bool y_is_due = has_y && axis_time(disc.id, disc.y, disc.vy, disc.tau, m, 2) == t;
    advance(disc, m + t);
    if (x_is_due && leads_out(disc.vx, 0)) return set_left(setting_, disc, disc.vx < 0 ? 0 : 1);
    if (y_is_due && leads_out(disc.vy, 2)) return set_left(setting_, disc, disc.vy < 0 ? 2 : 3);
    const auto is_at_wall = [&](double x, double v, std::size_t low_side) {
        if (leads_out(v, low_side)) return false;
        return (v < 0 && x <= low(disc.id) + band_) ||
               (v > 0 && x >= high(disc.id, low_side) - band_);
    };
    const bool x_reverses = x_is_due || (has_x && is_at_wall(disc.x, disc.vx, 0));
    const bool y_reverses = y_is_due || (has_y && is_at_wall(disc.y, disc.vy, 2));
    const auto& boundaries = setting_.effects.boundaries;
    const auto reverse = [&](std::size_t number, double& normal, double& along) {
        const double away = number % 2 == 0 ? 1 : -1;
        if (boundaries[number].kind == BoundaryKind::thermal) {
            const auto [fast, sideways] = setting_.leaving(disc, number);
            normal = away * fast;
            along = sideways;
        } else
            normal = -(boundaries[number].restitution * normal);
    };
    const double vy = disc.vy;
    if (x_reverses) reverse(disc.vx < 0 ? 0 : 1, disc.vx, disc.vy);
    const bool still_comes = vy < 0 ? disc.vy < 0
                                    : disc.vy > 0; // unless the first wall has changed the velocity
    if (y_reverses && still_comes) reverse(disc.vy < 0 ? 2 : 3, disc.vy, disc.vx);
}

double TimeSteppedReference::stop_time(DiscId id, double x, double v, double t,
                                       std::size_t low_side) const {
    double ts = never;
    if (leads_out(v, low_side)) return never;
    if (v < 0 && x + v * (1 - t) < low(id)) ts = (low(id) - x) / v;
    if (v > 0 && x + v * (1 - t) > high(id, low_side)) ts = (high(id, low_side) - x) / v;
    return ts < 0 ? 0 : ts;
}

/// `left` is the body from which the disc has just been reflected.
void TimeSteppedReference::stop_at_wall(DiscState& disc, double m, double t,
                                        const BodyMeeting& left) const {
    const double sx = setting_.effects.is_periodic_x() ? never
                                                       : stop_time(disc.id, disc.x, disc.vx, t, 0);
    const double sy = setting_.effects.is_periodic_y() ? never
                                                       : stop_time(disc.id, disc.y, disc.vy, t, 2);
    const double ts = sx < sy ? sx : sy;
    const BodyMeeting meeting = species_->first_meeting(disc, disc.tau, m + 1, left);
    if (meeting.time < m + 1 && meeting.time - disc.tau < ts) {
        advance(disc, meeting.time);
        disc.tau = m + 1;
        return;
    }
    if (ts == never) return;
    disc.x = disc.x + disc.vx * ts;
    disc.y = disc.y + disc.vy * ts;
    disc.tau = m + 1;
}

} // namespace carrom::reference
