// SPDX-License-Identifier: BSD-3-Clause
#include "legacy.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace carrom::reference {

namespace {

/// The smaller root of |d + w t| = sigma, if they approach and meet.
std::optional<double> meeting_time(const DiscState& p, const DiscState& q, double sigma) {
    const double dx = p.x - q.x, dy = p.y - q.y;
    const double wx = p.vx - q.vx, wy = p.vy - q.vy;
    const double a = wx * wx + wy * wy;
    const double b = 2 * (dx * wx + dy * wy);
    const double c = dx * dx + dy * dy - sigma * sigma;
    const double discriminant = b * b - 4 * a * c;
    if (b >= 0 || discriminant <= 0) return std::nullopt;
    return (-b - std::sqrt(discriminant)) / (2 * a);
}

void exchange_normal_parts(DiscState& p, DiscState& q) {
    const double distance = std::hypot(q.x - p.x, q.y - p.y);
    const double nx = (q.x - p.x) / distance, ny = (q.y - p.y) / distance;
    const double p_normal = p.vx * nx + p.vy * ny, p_tangent = p.vy * nx - p.vx * ny;
    const double q_normal = q.vx * nx + q.vy * ny, q_tangent = q.vy * nx - q.vx * ny;
    p.vx = q_normal * nx - p_tangent * ny;
    p.vy = q_normal * ny + p_tangent * nx;
    q.vx = p_normal * nx - q_tangent * ny;
    q.vy = p_normal * ny + q_tangent * nx;
}

void move(DiscState& disc, double elapsed) {
    disc.x += disc.vx * elapsed;
    disc.y += disc.vy * elapsed;
}

} // namespace

LegacyReference::LegacyReference(const Setting& setting, std::span<const InputDisc> discs)
    : setting_(setting), low_(setting.radius), high_(setting.box_size - setting.radius),
      band_(1e-8 * setting.radius), discs_(stored_states(setting, discs)) {}

void LegacyReference::run_micro_steps(std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) run_micro_step();
}

LegacyReference::Walls LegacyReference::walls_of(const DiscState& disc) const {
    const auto time = [this](double x, double v) {
        if (v < 0 && x + v < low_ + band_) return std::clamp((low_ - x) / v, 0.0, 1.0);
        if (v > 0 && x + v > high_ - band_) return std::clamp((high_ - x) / v, 0.0, 1.0);
        return 2.0;
    };
    const double tx = time(disc.x, disc.vx), ty = time(disc.y, disc.vy);
    return {tx <= ty, ty <= tx, std::min(tx, ty)};
}

std::vector<Collision> LegacyReference::candidates() const {
    std::vector<Collision> found;
    for (const DiscState& p : discs_) {
        const Walls walls = walls_of(p);
        if (walls.t <= 1) found.push_back({micro_step_, walls.t, p.id, Collision::wall});
        for (DiscId id = p.id + 1; id < discs_.size(); ++id) {
            const std::optional<double> t = meeting_time(p, discs_[id], 2 * setting_.radius);
            if (t && *t >= 0 && *t <= 1) found.push_back({micro_step_, *t, p.id, id});
        }
    }
    std::sort(found.begin(), found.end(), [](const Collision& a, const Collision& b) {
        const auto place = [](const Collision& c) { return c.q == Collision::wall ? 0 : c.q + 1; };
        return std::make_tuple(a.t, a.p, place(a)) < std::make_tuple(b.t, b.p, place(b));
    });
    return found;
}

void LegacyReference::run_micro_step() {
    const std::vector<Collision> all = candidates();
    std::vector<bool> is_taken(discs_.size(), false);
    for (const Collision& candidate : all) {
        counters_.candidates += 1;
        const bool is_wall = candidate.q == Collision::wall;
        if (is_taken[candidate.p] || (!is_wall && is_taken[candidate.q])) {
            counters_.rejected_candidates += 1;
            continue;
        }
        log_.push_back(candidate);
        DiscState& p = discs_[candidate.p];
        is_taken[p.id] = true;
        if (is_wall) {
            bounce(p, walls_of(p));
            counters_.wall_collisions += 1;
            continue;
        }
        DiscState& q = discs_[candidate.q];
        is_taken[q.id] = true;
        move(p, candidate.t);
        move(q, candidate.t);
        exchange_normal_parts(p, q);
        p.pair_collisions += 1;
        q.pair_collisions += 1;
        counters_.pair_collisions += 1;
        finish(p, candidate.t);
        finish(q, candidate.t);
    }
    for (DiscState& disc : discs_) {
        if (!is_taken[disc.id]) move(disc, 1);
    }
    micro_step_ += 1;
}

void LegacyReference::bounce(DiscState& disc, const Walls& walls) const {
    move(disc, walls.t);
    const auto is_at_wall = [this](double x, double v) {
        return (v < 0 && x <= low_ + band_) || (v > 0 && x >= high_ - band_);
    };
    const bool x_reverses = walls.x || is_at_wall(disc.x, disc.vx);
    const bool y_reverses = walls.y || is_at_wall(disc.y, disc.vy);
    if (x_reverses) disc.vx = -disc.vx;
    if (y_reverses) disc.vy = -disc.vy;
    disc.wall_collisions += 1;
    finish(disc, walls.t);
}

/// Moves the disc for the rest of the micro-step, or to the wall that it would pass.
void LegacyReference::finish(DiscState& disc, double t) const {
    double rest = 1 - t;
    const auto shorten = [this, &rest, t](double x, double v) {
        if (v < 0 && x + v * (1 - t) < low_) rest = std::min(rest, std::max(0.0, (low_ - x) / v));
        if (v > 0 && x + v * (1 - t) > high_) rest = std::min(rest, std::max(0.0, (high_ - x) / v));
    };
    shorten(disc.x, disc.vx);
    shorten(disc.y, disc.vy);
    move(disc, rest);
}

} // namespace carrom::reference
