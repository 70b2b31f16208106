// SPDX-License-Identifier: BSD-3-Clause
// Fixed bodies in a box: discs, straight segments, and arcs of circles; segments and arcs have a
// disc of radius 0 at either end. A disc that meets one is reflected, as by a wall. They are the
// obstacles of a scene, its frozen discs, and the wall of a box that is not a rectangle
// (container.hpp).
//
// A disc of radius r touches a fixed disc of radius R when their centres are r + R apart
// (pair_contact.hpp, or falling_contact.hpp if discs fall). It touches a segment when its centre is
// at the distance r from the line, and an arc from either side (arc_contact.hpp). Discs may grow
// (growing_contact.hpp), but not if they fall. A contact depends only on the stored state. The
// bodies are sorted once into a grid of cells, and for each flight the cells along its path are
// searched up to the first contact. In a periodic box the grid repeats itself, and a body is also
// listed in the cells that its images cover. The position of a stored state may be many boxes away;
// the bodies are then shifted to it by whole box lengths.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/disc_state.hpp"
#include "core/extent.hpp"
#include "dynamics/arc_contact.hpp"
#include "dynamics/contact_guard.hpp"
#include "dynamics/container.hpp"
#include "dynamics/disc_size.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/surface_table.hpp"

namespace carrom {

/// A contact with a body, or none.
struct BodyContact {
    static constexpr std::uint32_t no_body = 0xffffffff;

    double time = std::numeric_limits<double>::infinity();
    /// Number of the body or of one of its nearest images; see FixedBodies::code_of
    std::uint32_t body = no_body;

    bool exists() const { return body != no_body; }
};

/// The range of times, since the last sync, in which contacts count.
struct ContactTimes {
    double from = 0, to = 0;
    bool hold_from = true;                       ///< whether a contact exactly at `from` counts
    std::uint32_t except = BodyContact::no_body; ///< the body that the disc has just left; no
                                                 ///< contact with it counts at the disc's own time
};

/// A place where a disc touches a body.
struct BodyTouch {
    std::uint32_t row = 0; ///< index in `rows_of` (container.hpp)
    double nx = 0, ny = 0; ///< normal that points away from the body
    double x = 0, y = 0;   ///< point of contact, relative to the centre of the row
};

class FixedBodies {
public:
    /// `effects` have times in micro-steps; `largest_radius` is that of discs before they grow.
    FixedBodies(const Box& box, double largest_radius, const Effects& effects);

    /// The first body that a disc of this size meets within these times. If the disc meets two
    /// bodies at the same time, the one with the lower number counts.
    BodyContact first_contact(const DiscState& disc, const DiscSize& size,
                              const ContactTimes& times) const;

    /// Reflects a disc at `time` from the fixed body with the number `code` (see
    /// BodyContact::body). The state has already been advanced to `time`; `since` is the time since
    /// the disc's last collision. The disc's radius grows at the rate `outwards`. Returns the loss
    /// of energy for a mass of 1.
    Loss rebound(DiscState& disc, std::uint32_t code, double time, double since, double outwards,
                 const Turning& turning) const;

    /// Where a disc, whose state is at `time`, touches the body with the number `code`.
    BodyTouch touch(const DiscState& disc, std::uint32_t code, double time, double radius) const;

    bool are_any() const { return !bodies_.empty(); }

    struct Overlap {
        double depth = 0;
        std::uint32_t body = BodyContact::no_body; ///< number of the body itself, not of an image
    };
    /// The body with which a disc of this radius at (x, y) in the box overlaps most, if the overlap
    /// is more than `least`; otherwise, or without bodies, `no_body`.
    Overlap deepest_overlap(double x, double y, double radius, double least) const;
    bool do_overlap(double x, double y, double radius) const {
        return are_any() && deepest_overlap(x, y, radius, 0).body != BodyContact::no_body;
    }
    /// Name for messages, such as "fixed disc 3" or "segment 1" (numbered as in the scene's lists)
    /// or "the round wall".
    std::string name_of(std::uint32_t body) const;

private:
    struct Body {
        double x, y;                       ///< the centre of a disc or an arc, or one end of a line
        double radius;                     ///< radius of a fixed disc or an arc; 0 for a line
        double ux = 0, uy = 0, length = 0; ///< direction and length of a line
        /// Velocity of the surface, counterclockwise, divided by the surface velocity of the scene
        double slides = 1;
        bool is_arc = false;
        ArcSpan span{}; ///< directions that an arc covers
        bool is_line() const { return length > 0; }
    };
    /// Ranges of cells along both axes. Cell numbers continue beyond a periodic side.
    struct Cells {
        std::int64_t first_column, last_column, first_row, last_row;
    };
    /// A body, or an image of it that is shifted by `x` and `y` whole boxes.
    struct Entry {
        std::uint32_t body;
        std::int16_t x, y;
    };

    /// The box's cells along one axis.
    struct CellAxis {
        double width = 1, period = 0;
        std::int64_t n = 1;

        std::int64_t cell_of(double place) const {
            const double cell = place / width;
            return static_cast<std::int64_t>(
                period != 0 ? std::floor(cell) : std::clamp(cell, 0.0, static_cast<double>(n - 1)));
        }
        /// The number of the periodic copy of the box that holds a cell; 0 is the box itself.
        std::int64_t box_of(std::int64_t cell) const {
            if (period == 0 || (cell >= 0 && cell < n)) return 0;
            return cell >= 0 ? cell / n : -((n - 1 - cell) / n);
        }
    };

    void add_line(const Segment& segment, double slides);
    void add_arc(const Arc& arc, bool is_of_box);
    void add_bodies(const FixedBodyList& fixed_bodies);
    void begin_row() { first_bodies_.push_back(static_cast<std::uint32_t>(bodies_.size())); }
    std::size_t row_of(std::uint32_t body) const;
    double overlap_of(const Body& body, double x, double y, double radius) const;
    double contact_time(const DiscState& disc, const Body& body, const DiscSize& size,
                        Shift shift) const;
    double line_delay(const Body& line, const DiscSize& size, double dx, double dy, double wx,
                      double wy) const;
    struct Normal {
        double x, y;    ///< normal that points away from the body
        bool is_hollow; ///< whether the disc is at the inner face of an arc
    };
    static Normal normal_of(const Body& body, double dx, double dy);
    Extent extent_of(const Body& body, double radius, Shift shift) const;
    Extent path_of(const DiscState& disc, double begin, double end) const;
    double slices_of(const DiscState& disc, double begin, double end) const;
    bool may_hold(const Body& body, std::int64_t column, std::int64_t row) const;
    Cells cells_of(const Extent& extent) const;
    Cells cells_near(const Extent& extent, double radius) const;
    void sort_into_cells();
    template <class What> void visit_cells(const Cells& cells, const What& what) const;
    std::uint32_t code_of(const Entry& image, double x, double y) const;
    Entry image_of(std::uint32_t code, double x, double y) const;
    Shift shift_of(const Entry& image) const {
        return {image.x * periods_.x, image.y * periods_.y};
    }
    double fallen(std::size_t axis, double time) const { return (0.5 * pull_[axis] * time) * time; }

    SurfaceTable surface_;
    ContactGuard guard_;
    std::array<double, 2> pull_;
    std::size_t n_fixed_discs_;
    Container container_;
    Periods periods_;
    double largest_radius_; ///< largest radius of a disc before it grows
    /// Fixed discs; then each segment or edge with its two ends, and each arc with its ends
    std::vector<Body> bodies_;
    /// Index of the first body of each row, beginning with the rows after those of the fixed discs
    std::vector<std::uint32_t> first_bodies_;
    std::vector<BodyRow> rows_of_bodies_;
    CellAxis columns_, rows_;
    double margin_ = 0;
    std::vector<std::uint32_t> cell_starts_;
    std::vector<Entry> in_cells_;
};

} // namespace carrom
