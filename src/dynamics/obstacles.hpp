// SPDX-License-Identifier: BSD-3-Clause
// Bodies that stand fixed in a box: discs, straight segments, and arcs of circles, both with a disc
// of radius 0 at either end. A disc that comes to one is reflected from it, as from a wall. A box
// of another shape than a rectangle has arcs and segments for its walls (container.hpp).
//
// A disc of radius r touches a fixed disc of radius R if their centres are r + R apart (the
// predicate of pairs; a quartic under gravity: falling_contact.hpp), a segment if it is r from
// its line (a quadratic), and an arc from either side (arc_contact.hpp). The contact is a function
// of the stored state alone. A grid of cells holds the bodies for good; a flight searches the cells
// on its way, up to its first contact. In a periodic box the grid repeats itself, and a body is
// also in the cells that its images reach into. A stored state may be many boxes away: bodies are
// shifted to it by whole box lengths.
#pragma once

#include <array>
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
#include "dynamics/effects.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/rubbing.hpp"

namespace carrom {

/// A contact with a body, or none.
struct ObstacleContact {
    static constexpr std::uint32_t no_body = 0xffffffff;

    double time = std::numeric_limits<double>::infinity();
    std::uint32_t body = no_body; ///< a number for each body, or for each of its
                                  ///< nearest images; see Obstacles::code_of

    bool exists() const { return body != no_body; }
};

/// The times that count, since the last sync.
struct ContactTimes {
    double from = 0, to = 0;
    bool hold_from = true; ///< whether `from` itself counts
    std::uint32_t except =
        ObstacleContact::no_body; ///< does not count at the disc's own time: it has just been left
};

/// A place where a disc touches an obstacle.
struct ObstacleTouch {
    std::uint32_t row = 0; ///< of `rows_of` (container.hpp)
    double nx = 0, ny = 0; ///< away from the body
    double x = 0, y = 0;   ///< the place, from the row's centre
};

class Obstacles {
public:
    /// For discs of at most `largest_radius`; `effects` are per micro-step.
    Obstacles(const Box& box, double largest_radius, const Effects& effects);

    /// The first body that a disc of that radius meets at such a time; the one of the
    /// lower number if it meets two at once.
    ObstacleContact first_contact(const DiscState& disc, double radius,
                                  const ContactTimes& times) const;

    /// Turns round the velocity of a disc that has come to the body of a contact's number `code` at
    /// `time`, its own now; its last collision was `since` before. Returns the loss for a mass
    /// of 1.
    Loss rebound(DiscState& disc, std::uint32_t code, double time, double since,
                 const Turning& turning) const;

    /// Where a disc that has come to the body of `code` at `time`, its own now, touches it.
    ObstacleTouch touch(const DiscState& disc, std::uint32_t code, double time,
                        double radius) const;

    struct Overlap {
        double depth = 0;
        std::uint32_t body = ObstacleContact::no_body; ///< whatever the image
    };
    /// The body that a disc of that radius at (x, y) in the box overlaps deepest, by more than
    /// `least`, or `no_body`.
    Overlap deepest_overlap(double x, double y, double radius, double least) const;
    /// "fixed disc 3" or "segment 1", by their rows in the scene's lists, or "the round wall".
    std::string name_of(std::uint32_t body) const;

private:
    struct Body {
        double x, y;                       ///< its centre, or one end of a line
        double radius;                     ///< 0 for a line
        double ux = 0, uy = 0, length = 0; ///< for a line: direction and length
        double slides = 1; ///< the velocity of its surface over the scene's, counterclockwise
        bool is_arc = false;
        ArcSpan span{}; ///< for an arc
        bool is_line() const { return length > 0; }
    };
    /// Numbers go on beyond a periodic side.
    struct Cells {
        std::int64_t first_column, last_column, first_row, last_row;
    };
    /// A body, or an image of one, this many boxes from the cell's box.
    struct Entry {
        std::uint32_t body;
        std::int16_t x, y;
    };

    /// The box's cells along one axis.
    struct CellAxis {
        double width = 1, period = 0;
        std::int64_t n = 1;

        std::int64_t cell_of(double place) const;
        /// The number of boxes from the first one to a cell.
        std::int64_t box_of(std::int64_t cell) const;
    };

    void add_line(const Segment& segment, double slides);
    void add_arc(const Arc& arc, bool is_of_box);
    void add_bodies(const ObstacleList& obstacles);
    void begin_row() { first_bodies_.push_back(static_cast<std::uint32_t>(bodies_.size())); }
    std::size_t row_of(std::uint32_t body) const;
    double overlap_of(const Body& body, double x, double y, double radius) const;
    double contact_time(const DiscState& disc, const Body& body, double radius, Shift shift) const;
    double line_delay(const Body& line, double radius, double dx, double dy, double wx,
                      double wy) const;
    struct Normal {
        double x, y;    ///< away from the body
        bool is_hollow; ///< the inner face of an arc
    };
    static Normal normal_of(const Body& body, double dx, double dy);
    Extent extent_of(const Body& body, double radius, Shift shift) const;
    Extent path_of(const DiscState& disc, double begin, double end) const;
    double slices_of(const DiscState& disc, double begin, double end) const;
    bool may_hold(const Body& body, std::int64_t column, std::int64_t row) const;
    Cells cells_of(const Extent& extent) const;
    void sort_into_cells();
    template <class What> void visit_cells(const Cells& cells, const What& what) const;
    std::uint32_t code_of(const Entry& image, double x, double y) const;
    Entry image_of(std::uint32_t code, double x, double y) const;
    Shift shift_of(const Entry& image) const {
        return {image.x * periods_.x, image.y * periods_.y};
    }
    double fallen(std::size_t axis, double time) const {
        return (0.5 * gravity_[axis] * time) * time;
    }

    double restitution_;
    ContactGuard guard_;
    Rubbing rubbing_;
    std::array<double, 2> gravity_;
    std::size_t n_fixed_discs_;
    Container container_;
    Periods periods_;
    double largest_radius_;    ///< a disc's
    std::vector<Body> bodies_; ///< fixed discs, then a line or an arc and its two ends for each
                               ///< segment, edge and arc
    std::vector<std::uint32_t> first_bodies_; ///< of rows behind those of fixed discs
    std::vector<ObstacleRow> rows_of_bodies_;
    CellAxis columns_, rows_;
    double margin_ = 0;
    std::vector<std::uint32_t> cell_starts_;
    std::vector<Entry> in_cells_;
};

} // namespace carrom
