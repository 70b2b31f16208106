// SPDX-License-Identifier: BSD-3-Clause
// Boxes that are no rectangles. Discs move inside of a closed line of arcs and segments, which are
// obstacles as those that a scene lists. The rectangle around it stays what strips, cells and
// outputs refer to.
//
//   round      the largest circle in a square
//   stadium    two halves of a circle, joined by segments along the longer side
//
// The line is a billionth of the box away from the sides, so that discs meet it before the sides,
// whatever rounding does.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <carrom/box.hpp>

#include "dynamics/arc_contact.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

class Container {
public:
    Container(BoxShape shape, const Box& box);

    bool is_rectangle() const { return shape_ == BoxShape::rectangle; }
    double area() const;
    /// How far a place is outside of the line; negative inside. Not for rectangles.
    double outside(double x, double y) const;
    /// In the order of a walk counterclockwise.
    std::vector<Arc> arcs() const;
    std::vector<Segment> segments() const;
    /// "the round wall", for messages.
    std::string_view name() const;

private:
    BoxShape shape_;
    Box box_;
    double radius_ = 0;
    double x0_ = 0, y0_ = 0, x1_ = 0, y1_ = 0; ///< centres of the arcs; x0 <= x1, y0 <= y1
};

std::vector<Segment> edges_of(const Polygon& polygon);
/// The scene's segments, then the edges of its polygons, then those of the box's shape.
std::vector<Segment> all_segments(const ObstacleList& obstacles, const Box& box);
/// The scene's arcs, then those of the box's shape.
std::vector<Arc> all_arcs(const ObstacleList& obstacles, const Box& box);
/// The area in which discs move, obstacles inside of it included.
double area_of(const ObstacleList& obstacles, const Box& box);

/// A row of the scene's lists of obstacles, or the wall of the box's shape.
struct ObstacleRow {
    std::string_view kind;    ///< "fixed disc", "segment", "polygon", "arc", or Container::name()
    std::uint32_t number = 0; ///< from 1 on in its list; 0 for the box's wall
    double x = 0, y = 0;      ///< its centre: the mean of corners where it has none
    double length = 0;        ///< of its line; both faces of a segment or an arc share it

    std::string name() const; ///< "fixed disc 3", or "the round wall"
};
/// Discs first, then segments, polygons, arcs and the wall.
std::vector<ObstacleRow> rows_of(const ObstacleList& obstacles, const Box& box);
/// The places in `rows_of` of the discs, of `all_segments`, and of `all_arcs`, one after the other.
std::vector<std::uint32_t> rows_of_pieces(const ObstacleList& obstacles, const Box& box);

/// The point of an arc at an angle in degrees. Its bits are the same on every machine.
struct PointOfArc {
    double x = 0, y = 0;
};
PointOfArc direction_at(double degrees);
PointOfArc point_of(const Arc& arc, double degrees);
ArcSpan span_of(const Arc& arc);
/// Chords along the arc, none longer than `longest` unless there are 65536, for searches that
/// need no exact contacts.
std::vector<Segment> chords_of(const Arc& arc, double longest);

} // namespace carrom
