// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/narrow_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/container.hpp"

namespace carrom {

namespace {

/// A gap counts as wide enough if it is narrower than a diameter by less than this share of it
constexpr double rounding = 1e-9;

/// All points within `radius` of a segment. A fixed disc has a segment of length 0.
struct Body {
    Segment line;
    double radius = 0;
    bool is_image = false;

    double x_low() const { return std::min(line.x0, line.x1) - radius; }
    double x_high() const { return std::max(line.x0, line.x1) + radius; }
    double y_low() const { return std::min(line.y0, line.y1) - radius; }
    double y_high() const { return std::max(line.y0, line.y1) + radius; }
};

double length_of(const Segment& line) { return std::hypot(line.x1 - line.x0, line.y1 - line.y0); }

/// The line from a point to the nearest point of a segment.
Segment shortest(double x, double y, const Segment& to) {
    const double ex = to.x1 - to.x0, ey = to.y1 - to.y0, square = ex * ex + ey * ey;
    const double along = square > 0
                             ? std::clamp(((x - to.x0) * ex + (y - to.y0) * ey) / square, 0.0, 1.0)
                             : 0;
    return {x, y, to.x0 + along * ex, to.y0 + along * ey};
}

/// The shortest line between two segments that do not cross. It starts at an end of one of them.
Segment shortest(const Segment& a, const Segment& b) {
    Segment best = shortest(a.x0, a.y0, b);
    for (const Segment& other :
         {shortest(a.x1, a.y1, b), shortest(b.x0, b.y0, a), shortest(b.x1, b.y1, a)})
        if (length_of(other) < length_of(best)) best = other;
    return best;
}

/// Fixed bodies, and their periodic images that lie less than `width` outside of the box.
std::vector<Body> bodies_of(const SceneParameters& scene, double width) {
    const Box& box = scene.box;
    const bool is_x = scene.effects.is_periodic_x(), is_y = scene.effects.is_periodic_y();
    std::vector<Body> bodies;
    const auto add = [&](const Segment& s, double radius) {
        for (const double dx : {0.0, -box.x, box.x})
            for (const double dy : {0.0, -box.y, box.y}) {
                const bool is_image = dx != 0 || dy != 0;
                if ((dx != 0 && !is_x) || (dy != 0 && !is_y)) continue;
                const Body body{{s.x0 + dx, s.y0 + dy, s.x1 + dx, s.y1 + dy}, radius, is_image};
                if (!is_image || (body.x_high() > -width && body.x_low() < box.x + width &&
                                  body.y_high() > -width && body.y_low() < box.y + width))
                    bodies.push_back(body);
            }
    };
    for (const FixedDisc& disc : scene.effects.fixed_bodies.discs)
        add({disc.x, disc.y, disc.x, disc.y}, disc.radius);
    for (const Segment& segment : all_segments(scene.effects.fixed_bodies, box)) add(segment, 0);
    for (const Arc& arc : all_arcs(scene.effects.fixed_bodies, box))
        for (const Segment& chord : chords_of(arc, width)) add(chord, 0);
    return bodies;
}

/// Adds lines from ends of fixed bodies to walls at rest, across gaps narrower than `width`.
void add_walls(const SceneParameters& scene, const std::vector<Body>& bodies, double width,
               std::vector<Segment>& lines) {
    const Box& box = scene.box;
    const auto is_wall = [&](std::size_t side) {
        const BoundaryKind kind = scene.effects.boundaries[side].kind;
        return kind == BoundaryKind::wall || kind == BoundaryKind::thermal;
    };
    for (const Body& body : bodies)
        for (const auto& [x, y] :
             {std::pair(body.line.x0, body.line.y0), std::pair(body.line.x1, body.line.y1)}) {
            const double most = width + body.radius;
            if (is_wall(0) && x < most) lines.push_back({0, y, x, y});
            if (is_wall(1) && box.x - x < most) lines.push_back({x, y, box.x, y});
            if (is_wall(2) && y < most) lines.push_back({x, 0, x, y});
            if (is_wall(3) && box.y - y < most) lines.push_back({x, y, x, box.y});
        }
}

} // namespace

std::vector<Segment> lines_across_narrow_gaps(const SceneParameters& scene, double radius) {
    const double width = 2 * radius * (1 - rounding);
    std::vector<Body> bodies = bodies_of(scene, width);
    std::vector<Segment> lines;
    add_walls(scene, bodies, width, lines);
    std::ranges::sort(bodies, {}, &Body::x_low);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        const Body& one = bodies[k];
        const double end = one.x_high() + width;
        for (std::size_t l = k + 1; l < bodies.size() && bodies[l].x_low() < end; ++l) {
            const Body& other = bodies[l];
            const bool are_far = other.y_low() > one.y_high() + width ||
                                 one.y_low() > other.y_high() + width;
            if (are_far || (one.is_image && other.is_image)) continue;
            const Segment line = shortest(one.line, other.line);
            if (length_of(line) - one.radius - other.radius < width) lines.push_back(line);
        }
    }
    return lines;
}

} // namespace carrom
