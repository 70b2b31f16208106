// SPDX-License-Identifier: BSD-3-Clause
#include "fixed_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carrom::reference {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

} // namespace

FixedBodies::FixedBodies(const Setting& setting) : setting_(setting) {
    const double k = static_cast<double>(setting.micro_steps);
    gx_ = setting.effects.gravity.x / (k * k);
    gy_ = setting.effects.gravity.y / (k * k);
    for (const FixedDisc& disc : setting.effects.fixed_bodies.discs)
        species_.push_back({disc.x, disc.y, disc.radius});
    for (const Segment& s : setting.effects.fixed_bodies.segments) {
        const double x = s.x1 - s.x0, y = s.y1 - s.y0, length = std::sqrt(x * x + y * y);
        species_.push_back({s.x0, s.y0, 0, x / length, y / length, length});
        species_.push_back({s.x0, s.y0, 0});
        species_.push_back({s.x1, s.y1, 0});
    }
}

/// The images that the flight may come near, and a few more.
std::vector<Copy> FixedBodies::copies(const DiscState& disc, const Body& body, double until) const {
    const auto range = [&](bool is_periodic, double length, double from, double to, double g) {
        if (!is_periodic) return std::pair(0, 0);
        const double fall = std::fabs(0.5 * g * until * until);
        const double away = 1.5 * (body.radius + setting_.radius) + body.length + fall;
        return std::pair(static_cast<int>(std::floor((std::min(from, to) - away) / length)) - 1,
                         static_cast<int>(std::ceil((std::max(from, to) + away) / length)));
    };
    const double time = until - disc.tau;
    const auto [x_low, x_high] = range(setting_.effects.is_periodic_x(), setting_.box().x, disc.x,
                                       disc.x + disc.vx * time, gx_);
    const auto [y_low, y_high] = range(setting_.effects.is_periodic_y(), setting_.box().y, disc.y,
                                       disc.y + disc.vy * time, gy_);
    std::vector<Copy> all;
    for (int x = x_low; x <= x_high; ++x)
        for (int y = y_low; y <= y_high; ++y) all.push_back({x, y});
    return all;
}

/// Computes the disc's place and velocity in the box at its own time, and from these the time at
/// which it meets the body.
double FixedBodies::meeting_time(const DiscState& disc, const Body& body, Copy copy) const {
    const Box box = setting_.box();
    const double reach = body.radius + setting_.radius_of(disc.id);
    const double x = ((disc.x + (0.5 * gx_ * disc.tau) * disc.tau) - body.x) - copy.x * box.x;
    const double y = ((disc.y + (0.5 * gy_ * disc.tau) * disc.tau) - body.y) - copy.y * box.y;
    const double vx = disc.vx + gx_ * disc.tau, vy = disc.vy + gy_ * disc.tau;
    if (body.length == 0 && (gx_ != 0 || gy_ != 0))
        return disc.tau + setting_.falling_contact(x, y, vx, vy, gx_, gy_, reach);
    if (body.length == 0) {
        DiscState fixed;
        fixed.x = body.x;
        fixed.y = body.y;
        fixed.tau = disc.tau;
        const Contact found = contact(disc, fixed, reach, never, copy, {box});
        return found.delay < 0 ? never : found.base + found.delay;
    }
    // Distance from the line to its left, position along it, and their rates of change.
    const double off = body.ux * y - body.uy * x, off_rate = body.ux * vy - body.uy * vx,
                 off_pull = body.ux * gy_ - body.uy * gx_;
    const double along = body.ux * x + body.uy * y, along_rate = body.ux * vx + body.uy * vy,
                 along_pull = body.ux * gx_ + body.uy * gy_;
    double first = never;
    for (const bool is_left : {true, false}) {
        const double gap = (is_left ? off : -off) - reach, rate = is_left ? off_rate : -off_rate,
                     pull = is_left ? off_pull : -off_pull;
        const bool is_here = is_left ? off >= 0 : off <= 0;
        const double square = rate * rate - 2 * pull * gap;
        double s = never;
        if (rate < 0 && gap <= 0) {
            if (is_here) s = 0;
        } else if (rate < 0 && pull == 0) {
            s = gap / -rate;
        } else if (rate < 0) {
            if (square > 0) s = 2 * gap / (std::sqrt(square) - rate);
        } else if (pull < 0 && (is_here || square > 0)) {
            s = (rate + std::sqrt(square > 0 ? square : 0)) / -pull;
        }
        if (s == never) continue;
        const double foot = along + along_rate * s + (0.5 * along_pull * s) * s;
        if (foot >= 0 && foot <= body.length && s < first) first = s;
    }
    return disc.tau + first;
}

BodyMeeting FixedBodies::first_meeting(const DiscState& disc, double from, double until,
                                       const BodyMeeting& left) const {
    BodyMeeting first{never, none};
    for (std::size_t k = 0; k < species_.size(); ++k) {
        for (const Copy copy : copies(disc, species_[k], until)) {
            const double time = meeting_time(disc, species_[k], copy);
            if (time < from || (k == left.body && copy == left.copy && time == disc.tau)) continue;
            if (time < first.time) first = {time, k, copy};
        }
    }
    return first;
}

void FixedBodies::reflect(DiscState& disc, const BodyMeeting& at, double time, double since) const {
    const Body& body = species_[at.body];
    const Box box = setting_.box();
    const double x = ((disc.x + (0.5 * gx_ * time) * time) - body.x) - at.copy.x * box.x;
    const double y = ((disc.y + (0.5 * gy_ * time) * time) - body.y) - at.copy.y * box.y;
    const bool is_line = body.length > 0, is_left = body.ux * y - body.uy * x >= 0;
    const double distance = std::sqrt(x * x + y * y);
    const double nx = is_line ? (is_left ? -body.uy : body.uy) : x / distance,
                 ny = is_line ? (is_left ? body.ux : -body.ux) : y / distance;
    const double normal = nx * (disc.vx + gx_ * time) + ny * (disc.vy + gy_ * time);
    const double radius = setting_.radius_of(disc.id);
    const bool is_touched = setting_.is_in_contact(since, std::fabs(normal), radius, 1e-4);
    const double restitution = is_touched ? 1 : setting_.effects.fixed_bodies.restitution;
    double away = restitution * std::fabs(normal);
    const double pull_back = -(nx * gx_ + ny * gy_);
    if (pull_back > 0) away = std::max(away, setting_.least_departure(pull_back, radius));
    disc.vx += (away - normal) * nx;
    disc.vy += (away - normal) * ny;
}

} // namespace carrom::reference
