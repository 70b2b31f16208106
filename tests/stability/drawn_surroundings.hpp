// SPDX-License-Identifier: BSD-3-Clause
// Random surroundings of discs: sides, obstacles and effects, with values at which errors are
// likely.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scene_tools.hpp"
#include "troubled_effects.hpp"

namespace carrom::test {

struct Point {
    double x = 0, y = 0;

    friend Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
    friend Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
    friend Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
};

inline double length(Point a) { return std::sqrt(a.x * a.x + a.y * a.y); }
inline Point place_of(const InputDisc& disc) { return {disc.x, disc.y}; }

/// Positions in a box. With periodic sides a difference is that to the nearest image.
struct Room {
    double size;
    bool is_periodic_x, is_periodic_y;

    explicit Room(const TestScene& scene)
        : size(scene.setting.box_size), is_periodic_x(scene.setting.effects.is_periodic_x()),
          is_periodic_y(scene.setting.effects.is_periodic_y()) {}

    Point nearest(Point d) const {
        if (is_periodic_x) d.x -= size * std::round(d.x / size);
        if (is_periodic_y) d.y -= size * std::round(d.y / size);
        return d;
    }
    Point inside(Point p) const {
        const auto wrapped = [this](double x) {
            const double rest = x - size * std::floor(x / size);
            return rest < size ? rest : 0.0;
        };
        return {is_periodic_x ? wrapped(p.x) : p.x, is_periodic_y ? wrapped(p.y) : p.y};
    }
    bool holds(Point p, double radius) const {
        const auto is_within = [&](double x, bool is_periodic) {
            return is_periodic ? x >= 0 && x < size : x >= radius && x <= size - radius;
        };
        return is_within(p.x, is_periodic_x) && is_within(p.y, is_periodic_y);
    }
    /// The overlap that rounding of positions can make between two bodies.
    double slack(double reach) const { return 0x1p-50 * reach + 0x1p-50 * size; }
    bool are_apart(Point d, double reach) const {
        return length(nearest(d)) >= reach - slack(reach);
    }
};

inline double distance_to(const Segment& segment, Point p, const Room& room) {
    double least = std::numeric_limits<double>::infinity();
    const Point along{segment.x1 - segment.x0, segment.y1 - segment.y0};
    for (const double i : {-1.0, 0.0, 1.0}) {
        for (const double j : {-1.0, 0.0, 1.0}) {
            const Point d = p - Point{segment.x0, segment.y0} +
                            Point{room.is_periodic_x ? i * room.size : 0,
                                  room.is_periodic_y ? j * room.size : 0};
            const double share = std::clamp((d.x * along.x + d.y * along.y) /
                                                (along.x * along.x + along.y * along.y),
                                            0.0, 1.0);
            least = std::min(least, length(d - share * along));
        }
    }
    return least;
}

inline bool is_clear_of_obstacles(const TestScene& scene, Point p, double radius) {
    const Room room(scene);
    const FixedBodyList& list = scene.setting.effects.fixed_bodies;
    return std::all_of(list.discs.begin(), list.discs.end(),
                       [&](const FixedDisc& fixed) {
                           return room.are_apart(p - Point{fixed.x, fixed.y},
                                                 radius + fixed.radius);
                       }) &&
           std::all_of(list.segments.begin(), list.segments.end(), [&](const Segment& segment) {
               return distance_to(segment, p, room) >= radius - room.slack(radius);
           });
}

/// A scene without discs, and the kinds of discs to choose from.
class DrawnSurroundings {
protected:
    DrawnSurroundings(std::uint64_t seed, Method method)
        : random_(seed ^ 0x517cc1b727220a95u), is_all_(method == Method::event_driven),
          largest_(of({0.5, 0.25, 0.3, 1})),
          scene_(empty_scene("troubled bodies " + std::to_string(seed),
                             largest_ * of({8, 8, 12, 14.6, 30}), largest_, 6)) {
        scene_.setting.sync_every = std::array{1, 2, 3, 64}[random_.index(4)];
        scene_.setting.micro_steps = std::array{1, 1, 2, 3, 4}[random_.index(5)];
    }

    /// Only one draw in each expression, because compilers evaluate in different orders.
    double of(std::initializer_list<double> choices) {
        return choices.begin()[random_.index(choices.size())];
    }
    bool one_in(std::size_t n) { return random_.index(n) == 0; }
    Effects& effects() { return scene_.setting.effects; }
    double interval() const {
        return static_cast<double>(scene_.setting.sync_every) /
               static_cast<double>(scene_.setting.micro_steps);
    }

    /// A direction: an axis, an exact diagonal, a hexagonal neighbour, or any other.
    Point direction() {
        const double h = std::sqrt(0.75);
        const std::array<Point, 8> known = {
            {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {0.6, 0.8}, {-0.8, 0.6}, {0.5, h}, {-h, -0.5}}};
        if (!one_in(4)) return known[random_.index(known.size())];
        const auto [x, y] = random_.direction();
        return {x, y};
    }
    /// A distance from slightly more than touching to less than touching by a rounding error.
    double touching(double reach) {
        return reach * (1 + of({0, 0, 0, 0x1p-52, 0x1p-50, 1e-12, 1e-9, 0.25}));
    }
    Point anywhere(double radius) {
        const double low = radius, high = scene_.setting.box_size - radius;
        const auto one = [&] {
            switch (random_.index(5)) {
            case 0: return low;
            case 1: return high;
            case 2: return random_.uniform(low, high);
            default:
                return std::clamp(largest_ / 2 *
                                      std::floor(2 * random_.uniform(low, high) / largest_),
                                  low, high);
            }
        };
        const double x = one();
        return {x, one()};
    }

    void draw_kinds() {
        kinds_ = {{1, largest_, 1}};
        if (one_in(5)) return;            // all discs are equal
        const bool are_heavy = one_in(2); // masses from 1 to 1e6
        kinds_[0].mass = are_heavy ? of({1, 1, 1e6}) : of({1, 1, 0.3});
        for (std::size_t n = one_in(6) ? 12 : 1 + random_.index(4); kinds_.size() < n;) {
            const double mass = are_heavy ? of({1, 1, 2, 1e3, 1e6})
                                          : of({1, 1, 2, 0.5, 0.3, 1e-3, 1e3});
            kinds_.push_back(
                {1, largest_ * of({1, 1, 0.5, 0.25, 0.3, 1.0 / 3, 0.1, 1e-2, 1e-3}), mass});
        }
        has_species_ = true;
    }

    void add_segment(Point from, Point to) {
        const auto is_inside = [&](Point p) {
            return p.x >= 0 && p.x <= scene_.setting.box_size && p.y >= 0 &&
                   p.y <= scene_.setting.box_size;
        };
        if (is_inside(from) && is_inside(to))
            effects().fixed_bodies.segments.push_back({from.x, from.y, to.x, to.y});
    }
    void draw_obstacles() {
        if (one_in(3)) return;
        for (std::size_t n = 1 + random_.index(3); n > 0; --n) {
            const Point at = anywhere(one_in(4) ? 0 : largest_);
            const double reach = largest_ * of({1, 2, 3, 4});
            switch (random_.index(5)) {
            case 0:
            case 1:
                effects().fixed_bodies.discs.push_back(
                    {at.x, at.y, largest_ * of({0, 0, 1e-3, 0.5, 1, 2})});
                break;
            case 2: add_segment(at, at + reach * direction()); break;
            case 3: draw_wedge(at, reach); break;
            default: { // two obstacles with a gap through which a disc may or may not fit
                const double radius = largest_ * of({0, 0.5, 1}),
                             apart = 2 * radius +
                                     largest_ * of({1, 2, 2 * (1 + 0x1p-50), 2 * (1 - 1e-9), 3});
                const Point other = at + apart * direction();
                if (Room(scene_).holds(other, 0))
                    effects().fixed_bodies.discs.insert(
                        effects().fixed_bodies.discs.end(),
                        {{at.x, at.y, radius}, {other.x, other.y, radius}});
            }
            }
        }
        if (effects().fixed_bodies.are_any())
            effects().fixed_bodies.restitution = of({1, 1, 1, 0.5, 0});
    }
    /// Two segments from one point, upwards or downwards.
    void draw_wedge(Point apex, double reach) {
        const Point a = std::array<Point, 4>{
            {{0.6, 0.8}, {1, 0}, {0.8, 0.6}, {0.5, std::sqrt(0.75)}}}[random_.index(4)];
        const Point b = one_in(3) ? Point{0, 1} : Point{-a.x, a.y};
        const double up = of({1, 1, -1});
        const Point tip_a = apex + reach * Point{a.x, up * a.y},
                    tip_b = apex + reach * Point{b.x, up * b.y};
        if (!Room(scene_).holds(tip_a, 0) || !Room(scene_).holds(tip_b, 0)) return;
        add_segment(apex, tip_a);
        add_segment(tip_b, apex);
        const Point middle = Point{a.x, up * a.y} + Point{b.x, up * b.y};
        const double size = length(middle);
        if (!(size > 0.01)) return; // the segments are a straight line
        const Point axis = (1 / size) * middle;
        wedges_.push_back({apex, axis, std::fabs(axis.x * up * a.y - axis.y * a.x)});
    }

    void draw_effects() {
        ContactEffect& contact = effects().contact;
        const bool is_rough = !one_in(3);
        if (is_rough)
            contact = {ContactKind::rough,
                       of({0, 0.5, 1 - 0x1p-53, 1, 1}),
                       0.001,
                       of({-1, 0, 0.5, 1, 1}),
                       std::numeric_limits<double>::infinity(),
                       of({0.5, 0.5, 1, 0.1, 1e-6})};
        else if (one_in(2))
            contact = {ContactKind::restitution, of({0, 0.5, 0.9, 1 - 0x1p-53, 1}), 0.001};
        else if (!has_species_ && one_in(2))
            contact.kind = ContactKind::none;
        if (is_rough && one_in(3)) contact.friction = of({0, 0.3});
        draw_sides();
        if (effects().are_periodic()) tame_masses();
        const double most = 0.2 * scene_.setting.box_size / (interval() * interval());
        if (is_all_ && one_in(2)) {
            if (!effects().is_periodic_y())
                effects().gravity.y = -std::min(largest_ * of({0.1, 1}), most);
            if (!effects().is_periodic_x() && one_in(2))
                effects().gravity.x = of({-1, 1}) * std::min(largest_ * 0.1, most);
        }
        if (is_all_ && !is_rough && one_in(4) &&
            !(effects().gravity.is_on() && effects().fixed_bodies.are_any()))
            effects().drag = std::min(0.2, 1 / interval());
        if (effects().gravity.is_on()) contact.contact_time = of({0.01, 0.05});
        contact.contact_time = std::min(contact.contact_time, interval() / 4);
    }
    /// Heavy discs can make light ones faster by the root of the ratio of masses, and in periodic
    /// boxes each image that a disc passes takes time. So masses are limited.
    void tame_masses() {
        double least = 1, most = 1;
        for (Species& kind : kinds_) {
            kind.mass = std::clamp(kind.mass, 1e-2, 1e2);
            least = std::min(least, kind.mass);
            most = std::max(most, kind.mass);
        }
        for (Boundary& side : effects().boundaries)
            side.temperature = std::min(side.temperature, largest_ * largest_ * least);
        if (most > 10 * least)
            scene_.setting.sync_every = std::min<std::int64_t>(scene_.setting.sync_every, 3);
    }
    double lightest() const {
        return std::min_element(kinds_.begin(), kinds_.end(),
                                [](const Species& a, const Species& b) { return a.mass < b.mass; })
            ->mass;
    }
    void draw_sides() {
        const bool has_open = one_in(3);
        for (const std::size_t low : {0u, 2u}) {
            const bool is_periodic = !has_open && one_in(3);
            for (const std::size_t number : {low, low + 1})
                effects().boundaries[number] = is_periodic
                                                   ? Boundary{BoundaryKind::periodic, 1, 0, 0}
                                                   : drawn_side(number, has_open);
        }
    }
    Boundary drawn_side(std::size_t number, bool has_open) {
        if (has_open && one_in(2)) return {BoundaryKind::open, 1, 0, 0};
        const bool may_move = is_all_ && !has_open && !effects().fixed_bodies.are_any();
        switch (random_.index(6)) {
        case 0: return {BoundaryKind::wall, of({0, 0.5, 0.9}), 0, 0};
        case 1:
            return {BoundaryKind::thermal, 1, largest_ * largest_ * lightest(),
                    0}; // a light disc must not fly through the box hundreds of times
        case 2:
            if (may_move)
                return {BoundaryKind::moving, of({1, 0.5}), 0,
                        largest_ *
                            (number % 2 == 0 ? of({0.01, 0.125}) : of({-0.125, -0.01, 0.01}))};
            break;
        default: break;
        }
        return {};
    }

    struct Wedge {
        Point apex, axis; ///< apex, and direction of the bisector
        double sine;      ///< sine of half the angle
    };

    Random random_;
    bool is_all_;
    double largest_; ///< largest radius
    TestScene scene_;
    std::vector<Species> kinds_; ///< species to choose from
    bool has_species_ = false;
    std::vector<Wedge> wedges_;
};

} // namespace carrom::test
