// SPDX-License-Identifier: BSD-3-Clause
#include "troubled_bodies.hpp"
#include "scene/effects/effect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "drawn_surroundings.hpp"

namespace carrom::test {

namespace {

class Drawing : DrawnSurroundings {
public:
    Drawing(std::uint64_t seed, Method method) : DrawnSurroundings(seed, method) {}

    TestScene drawn() {
        draw_kinds();
        draw_obstacles();
        draw_effects();
        const std::size_t most = 1 + random_.index(12);
        for (int tries = 0; tries < 150 && scene_.discs.size() < most; ++tries) try_disc();
        if (scene_.discs.empty()) {
            effects().fixed_bodies = {};
            add({scene_.setting.box_size / 2, scene_.setting.box_size / 2}, {0, largest_},
                kinds_[0]);
        }
        decide_species();
        hand_to_reference(scene_.setting);
        scene_.name += ", with " +
                       (summary_of(effects()).empty() ? "no effect" : summary_of(effects()));
        return std::move(scene_);
    }

private:
    Point velocity() {
        const double size = largest_ * of({0.5, 1, 2, 6, 1e-9});
        switch (random_.index(5)) {
        case 0: return {0, 0};
        case 1:
            if (!scene_.discs.empty()) return {scene_.discs.back().vx, scene_.discs.back().vy};
            break;
        case 2:
            if (!scene_.discs.empty()) return {-scene_.discs.back().vx, -scene_.discs.back().vy};
            break;
        case 3: return {random_.uniform(-size, size), random_.uniform(-size, size)};
        default: break;
        }
        return size * direction();
    }

    /// A disc, a fixed disc or an end of a segment, beside which a disc can be placed.
    struct Round {
        Point at, velocity;
        double radius;
    };
    Round round_thing() {
        const FixedBodyList& list = effects().fixed_bodies;
        std::size_t k = random_.index(scene_.discs.size() + list.discs.size() +
                                      list.segments.size());
        if (k < scene_.discs.size()) {
            const InputDisc& disc = scene_.discs[k];
            return {place_of(disc), {disc.vx, disc.vy}, species_list_[k].radius};
        }
        k -= scene_.discs.size();
        if (k < list.discs.size())
            return {{list.discs[k].x, list.discs[k].y}, {}, list.discs[k].radius};
        const Segment& segment = list.segments[k - list.discs.size()];
        return one_in(2) ? Round{{segment.x0, segment.y0}, {}, 0}
                         : Round{{segment.x1, segment.y1}, {}, 0};
    }
    bool has_round_things() { return !scene_.discs.empty() || effects().fixed_bodies.are_any(); }

    void try_disc() {
        const Species kind = !species_list_.empty() && one_in(2)
                                 ? species_list_.back()
                                 : kinds_[random_.index(kinds_.size())];
        Point at = anywhere(kind.radius), going = velocity();
        switch (random_.index(8)) {
        case 0: break;
        case 1:
        case 2:
            if (has_round_things()) beside_one(kind.radius, at);
            break;
        case 3:
            if (has_round_things()) beside_two(kind.radius, at);
            break;
        case 4: on_segment(kind.radius, at); break;
        case 5:
            if (has_round_things()) on_its_way(kind.radius, at, going);
            break;
        case 6: leaving(kind.radius, at, going); break;
        default: in_wedge(kind.radius, at, going); break;
        }
        at = Room(scene_).inside(at);
        if (!Room(scene_).holds(at, kind.radius) || !is_clear_of_obstacles(scene_, at, kind.radius))
            return;
        for (std::size_t k = 0; k < scene_.discs.size(); ++k)
            if (!Room(scene_).are_apart(place_of(scene_.discs[k]) - at,
                                        kind.radius + species_list_[k].radius))
                return;
        add(at, going, kind);
    }
    void beside_one(double radius, Point& at) {
        const Round other = round_thing();
        const double away = touching(radius + other.radius);
        at = other.at + away * direction();
        if (!one_in(4)) return; // one in four also touches the floor or the ceiling
        at.y = one_in(2) ? radius : scene_.setting.box_size - radius;
        const double reach = radius + other.radius,
                     square = reach * reach - (at.y - other.at.y) * (at.y - other.at.y);
        if (square >= 0) at.x = other.at.x + of({-1, 1}) * std::sqrt(square);
    }
    /// Moves the disc to where it touches both.
    void beside_two(double radius, Point& at) {
        const Round a = round_thing(), b = round_thing();
        const double ra = touching(radius + a.radius), rb = touching(radius + b.radius);
        const Point d = Room(scene_).nearest(b.at - a.at);
        const double apart = length(d);
        if (!(apart > 0)) return;
        const double along = (apart * apart + ra * ra - rb * rb) / (2 * apart),
                     square = ra * ra - along * along;
        if (square >= 0)
            at = a.at + (along / apart) * d +
                 (of({-1, 1}) * std::sqrt(square) / apart) * Point{-d.y, d.x};
    }
    void on_segment(double radius, Point& at) {
        const auto& segments = effects().fixed_bodies.segments;
        if (segments.empty()) return;
        const Segment& s = segments[random_.index(segments.size())];
        const Point along{s.x1 - s.x0, s.y1 - s.y0};
        const double share = of({0, 1, 0.5, 0.25, random_.uniform(-0.1, 1.1)}),
                     off = touching(radius), side = of({-1, 1});
        at = Point{s.x0, s.y0} + share * along +
             (side * off / length(along)) * Point{-along.y, along.x};
    }
    /// Chooses a flight that at a boundary of micro-steps meets another body, head-on or nearly,
    /// grazes it, or goes along it.
    void on_its_way(double radius, Point& at, Point& going) {
        const Round other = round_thing();
        const Point e = direction();
        const double reach = radius + other.radius, speed = largest_ * of({0.5, 1, 2}),
                     steps = of({0, 1, 1, 2, 0.5}) /
                             static_cast<double>(scene_.setting.micro_steps);
        const bool is_graze = one_in(2);
        const double off = is_graze
                               ? reach * (1 + of({0, 0, -0x1p-52, 0x1p-52, -1e-12, 1e-9, -1e-9}))
                               : 0,
                     before = is_graze ? 0 : reach;
        at = other.at + (before + speed * steps) * e + off * Point{-e.y, e.x};
        going = other.velocity - speed * e;
    }
    /// Chooses a flight through a side, at the end of which the disc is exactly outside at a
    /// boundary of micro-steps, or an ulp away from that.
    void leaving(double radius, Point& at, Point& going) {
        const std::size_t number = random_.index(4);
        const double time = of({1, 2, 3}) / static_cast<double>(scene_.setting.micro_steps),
                     size = scene_.setting.box_size;
        double speed = std::max(largest_ * of({0.5, 1, 2}),
                                2 * radius / time); // at the start it must be inside
        double place = number % 2 == 0 ? speed * time - radius : size + radius - speed * time;
        if (one_in(3)) place = std::nextafter(place, of({-1, 1}) * 2 * size);
        if (number % 2 == 0) speed = -speed;
        (number < 2 ? at.x : at.y) = place;
        (number < 2 ? going.x : going.y) = speed;
        if (one_in(2)) (number < 2 ? going.y : going.x) = 0;
    }
    void in_wedge(double radius, Point& at, Point& going) {
        if (wedges_.empty()) return;
        const Wedge& wedge = wedges_[random_.index(wedges_.size())];
        if (!(wedge.sine > 0)) return;
        at = wedge.apex + (touching(radius) / wedge.sine) * wedge.axis;
        if (one_in(2)) going = -largest_ * of({0, 0.5, 1}) * wedge.axis;
    }

    void add(Point at, Point going, const Species& kind) {
        add_disc(scene_, at.x, at.y, going.x, going.y);
        species_list_.push_back({1, kind.radius, kind.mass});
        const double speed = length(going);
        const double spin = of({0, 0, 1, -1, 0.5}) * (speed > 0 ? speed : largest_) / kind.radius;
        if (effects().contact.kind == ContactKind::rough)
            scene_.setting.first_spins.push_back(spin);
    }
    void decide_species() {
        if (!has_species_) return;
        scene_.setting.radius = 0;
        for (const Species& one : species_list_) {
            auto& all = effects().species;
            scene_.setting.radius = std::max(scene_.setting.radius, one.radius);
            if (!all.empty() && all.back().radius == one.radius && all.back().mass == one.mass)
                ++all.back().count;
            else
                all.push_back(one);
        }
    }

    std::vector<Species> species_list_; ///< the species of each disc
};

} // namespace

TestScene troubled_bodies(std::uint64_t seed, Method method) {
    return Drawing(seed, method).drawn();
}

bool is_clear(const TestScene& scene) {
    const Room room(scene);
    for (const InputDisc& disc : scene.discs) {
        const double radius = scene.setting.radius_of(disc.id);
        if (!room.holds(place_of(disc), radius) ||
            !is_clear_of_obstacles(scene, place_of(disc), radius))
            return false;
        for (const InputDisc& other : scene.discs)
            if (other.id < disc.id && !room.are_apart(place_of(other) - place_of(disc),
                                                      radius + scene.setting.radius_of(other.id)))
                return false;
    }
    return true;
}

} // namespace carrom::test
