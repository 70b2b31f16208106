// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/container.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "dynamics/sine_series.hpp"

namespace carrom {

namespace {

/// Distance of the closed line from the sides of the box, relative to half the shorter edge
constexpr double inset = 0x1p-30;

double length_of(const Segment& one) {
    const double dx = one.x1 - one.x0, dy = one.y1 - one.y0;
    return std::sqrt(dx * dx + dy * dy);
}
double length_of(const Arc& arc) {
    return std::min(arc.to - arc.from, 360.0) / 180 * std::numbers::pi * arc.radius;
}

} // namespace

Container::Container(BoxShape shape, const Box& box) : shape_(shape), box_(box) {
    const double half = box.shortest() / 2;
    radius_ = half * (1 - inset);
    x0_ = half;
    y0_ = half;
    x1_ = box.x - half;
    y1_ = box.y - half;
}

double Container::area() const {
    if (is_rectangle()) return box_.area();
    const double length = (x1_ - x0_) + (y1_ - y0_);
    return (std::numbers::pi * radius_ + 2 * length) * radius_;
}

double Container::outside(double x, double y) const {
    const double dx = x - std::clamp(x, x0_, x1_), dy = y - std::clamp(y, y0_, y1_);
    return std::sqrt(dx * dx + dy * dy) - radius_;
}

std::vector<Arc> Container::arcs() const {
    if (is_rectangle()) return {};
    if (shape_ == BoxShape::round) return {{x0_, y0_, radius_}};
    if (x1_ - x0_ >= y1_ - y0_) return {{x1_, y1_, radius_, -90, 90}, {x0_, y0_, radius_, 90, 270}};
    return {{x1_, y1_, radius_, 0, 180}, {x0_, y0_, radius_, 180, 360}};
}

std::vector<Segment> Container::segments() const {
    if (shape_ != BoxShape::stadium) return {};
    const double r = radius_;
    if (x1_ - x0_ >= y1_ - y0_) return {{x0_, y0_ - r, x1_, y1_ - r}, {x1_, y1_ + r, x0_, y0_ + r}};
    return {{x1_ + r, y0_, x1_ + r, y1_}, {x0_ - r, y1_, x0_ - r, y0_}};
}

std::string_view Container::name() const {
    return shape_ == BoxShape::round ? "the round wall" : "the stadium's wall";
}

std::vector<Segment> edges_of(const Polygon& corners) {
    std::vector<Segment> edges;
    for (std::size_t k = 0; k + 1 < corners.size(); k += 2) {
        const std::size_t next = k + 2 < corners.size() ? k + 2 : 0;
        edges.push_back({corners[k], corners[k + 1], corners[next], corners[next + 1]});
    }
    return edges;
}

std::vector<Segment> all_segments(const FixedBodyList& fixed_bodies, const Box& box) {
    std::vector<Segment> all = fixed_bodies.segments;
    for (const Polygon& polygon : fixed_bodies.polygons)
        for (const Segment& edge : edges_of(polygon)) all.push_back(edge);
    for (const Segment& segment : Container(fixed_bodies.shape, box).segments())
        all.push_back(segment);
    return all;
}

std::vector<Arc> all_arcs(const FixedBodyList& fixed_bodies, const Box& box) {
    std::vector<Arc> all = fixed_bodies.arcs;
    for (const Arc& arc : Container(fixed_bodies.shape, box).arcs()) all.push_back(arc);
    return all;
}

double area_of(const FixedBodyList& fixed_bodies, const Box& box) {
    return Container(fixed_bodies.shape, box).area();
}

std::string BodyRow::name() const {
    return number > 0 ? fmt::format("{} {}", kind, number) : std::string(kind);
}

std::vector<BodyRow> rows_of(const FixedBodyList& fixed_bodies, const Box& box) {
    std::vector<BodyRow> rows;
    std::uint32_t number = 0;
    for (const FixedDisc& disc : fixed_bodies.discs)
        rows.push_back(
            {"fixed disc", ++number, disc.x, disc.y, 2 * std::numbers::pi * disc.radius});
    number = 0;
    for (const Segment& one : fixed_bodies.segments)
        rows.push_back(
            {"segment", ++number, (one.x0 + one.x1) / 2, (one.y0 + one.y1) / 2, length_of(one)});
    number = 0;
    for (const Polygon& polygon : fixed_bodies.polygons) {
        BodyRow row{"polygon", ++number};
        for (const Segment& edge : edges_of(polygon)) {
            row.x += 2 * edge.x0 / static_cast<double>(polygon.size());
            row.y += 2 * edge.y0 / static_cast<double>(polygon.size());
            row.length += length_of(edge);
        }
        rows.push_back(row);
    }
    number = 0;
    for (const Arc& arc : fixed_bodies.arcs)
        rows.push_back({"arc", ++number, arc.x, arc.y, length_of(arc)});
    if (!fixed_bodies.has_shape()) return rows;
    const Container container(fixed_bodies.shape, box);
    BodyRow wall{container.name(), 0, box.x / 2, box.y / 2};
    for (const Segment& one : container.segments()) wall.length += length_of(one);
    for (const Arc& arc : container.arcs()) wall.length += length_of(arc);
    rows.push_back(wall);
    return rows;
}

std::vector<std::uint32_t> rows_of_pieces(const FixedBodyList& fixed_bodies, const Box& box) {
    std::vector<std::uint32_t> rows;
    std::uint32_t row = 0;
    for (std::size_t k = 0; k < fixed_bodies.discs.size() + fixed_bodies.segments.size(); ++k)
        rows.push_back(row++);
    for (const Polygon& polygon : fixed_bodies.polygons) {
        rows.insert(rows.end(), polygon.size() / 2, row);
        ++row;
    }
    const auto n_arcs = static_cast<std::uint32_t>(fixed_bodies.arcs.size()), wall = row + n_arcs;
    const Container container(fixed_bodies.shape, box);
    rows.insert(rows.end(), container.segments().size(), wall);
    for (std::uint32_t k = 0; k < n_arcs; ++k) rows.push_back(row++);
    rows.insert(rows.end(), container.arcs().size(), wall);
    return rows;
}

PointOfArc direction_at(double degrees) {
    const SineAndCosine at = sine_of_turns(degrees / 360);
    return {at.cosine, at.sine};
}

PointOfArc point_of(const Arc& arc, double degrees) {
    const PointOfArc to = direction_at(degrees);
    return {arc.x + arc.radius * to.x, arc.y + arc.radius * to.y};
}

ArcSpan span_of(const Arc& arc) {
    if (arc.is_whole()) return {};
    const double half = (arc.to - arc.from) / 2;
    const PointOfArc middle = direction_at(arc.from + half);
    return {middle.x, middle.y, direction_at(half).x};
}

std::vector<Segment> chords_of(const Arc& arc, double longest) {
    const double angle = std::min(arc.to - arc.from, 360.0);
    const double n = std::clamp(std::ceil(length_of(arc) / longest), 8.0, 65536.0);
    std::vector<Segment> chords;
    PointOfArc last = point_of(arc, arc.from);
    for (double k = 1; k <= n; ++k) {
        const PointOfArc next = point_of(arc, arc.from + angle * (k / n));
        chords.push_back({last.x, last.y, next.x, next.y});
        last = next;
    }
    return chords;
}

} // namespace carrom
