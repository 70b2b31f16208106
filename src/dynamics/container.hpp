// SPDX-License-Identifier: BSD-3-Clause
// Boxes that are not rectangles. Discs move inside a closed line of arcs and segments, which are
// fixed bodies like those in a scene's lists. The strips, cells and outputs are still those of the
// rectangle around the line.
//
//   round      the largest circle in a square
//   stadium    two half circles, joined by two segments along the longer side
//
// The line is about half a billionth of the box's shorter edge away from the sides, so that discs
// meet the line before the sides, in spite of rounding.
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
    /// How far a position is outside the line; negative inside. Not defined for rectangles.
    double outside(double x, double y) const;
    /// The arcs, in counterclockwise order.
    std::vector<Arc> arcs() const;
    std::vector<Segment> segments() const;
    /// Name for messages, such as "the round wall".
    std::string_view name() const;

private:
    BoxShape shape_;
    Box box_;
    double radius_ = 0;
    double x0_ = 0, y0_ = 0, x1_ = 0, y1_ = 0; ///< centres of the arcs; x0 <= x1, y0 <= y1
};

std::vector<Segment> edges_of(const Polygon& polygon);
/// The scene's segments, then the edges of its polygons, then the segments of the box's shape.
std::vector<Segment> all_segments(const FixedBodyList& fixed_bodies, const Box& box);
/// The scene's arcs, then the arcs of the box's shape.
std::vector<Arc> all_arcs(const FixedBodyList& fixed_bodies, const Box& box);
/// The area of the region in which discs move, including the area of fixed bodies inside it.
double area_of(const FixedBodyList& fixed_bodies, const Box& box);

/// One fixed body as a scene lists it, or the wall of a box that is not a rectangle.
struct BodyRow {
    std::string_view kind;    ///< "fixed disc", "segment", "polygon", "arc", or Container::name()
    std::uint32_t number = 0; ///< position in its list, counted from 1; 0 for the box's wall
    double x = 0, y = 0;      ///< its centre, or the mean of its corners if it has no centre
    double length = 0;        ///< length of its outline; the two faces of a line count once

    std::string name() const; ///< name for messages, such as "fixed disc 3" or "the round wall"
};
/// Rows of all fixed bodies: discs first, then segments, polygons, arcs and the wall.
std::vector<BodyRow> rows_of(const FixedBodyList& fixed_bodies, const Box& box);
/// The index in `rows_of` of each fixed disc, then of the row that each element of `all_segments`
/// belongs to, then the same for `all_arcs`.
std::vector<std::uint32_t> rows_of_pieces(const FixedBodyList& fixed_bodies, const Box& box);

/// A point of an arc, or a unit vector, at an angle in degrees. Its bits are the same on every
/// machine.
struct PointOfArc {
    double x = 0, y = 0;
};
PointOfArc direction_at(double degrees);
PointOfArc point_of(const Arc& arc, double degrees);
ArcSpan span_of(const Arc& arc);
/// Chords along the arc, each at most `longest` long unless that takes more than 65536 chords. For
/// searches that need no exact contacts.
std::vector<Segment> chords_of(const Arc& arc, double longest);

} // namespace carrom
