// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/lasting_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamics/arc_contact.hpp"
#include "dynamics/container.hpp"

namespace carrom {

namespace {

double friction_of(ContactKind kind, const PairFactors& pair) {
    return kind == ContactKind::rough && pair.tangential != 0 ? pair.friction : 0;
}

} // namespace

/// The cells along one axis. `visit` calls a function with the number of each cell between the
/// positions `low` and `high`, once for each cell even if the range wraps around a periodic box.
class CellLine {
public:
    CellLine(double length, double width, double most, bool is_periodic)
        : n_(static_cast<int>(std::clamp(std::floor(length / width), 1.0, most))),
          per_length_(n_ / length), is_periodic_(is_periodic) {}

    int size() const { return n_; }
    int cell_of(double place) const {
        return static_cast<int>(std::clamp(std::floor(place * per_length_), 0.0, n_ - 1.0));
    }
    template <class Visit> void visit(double low, double high, const Visit& visit) const {
        int first = static_cast<int>(std::floor(std::max(low * per_length_, -1.0 * n_))),
            last = static_cast<int>(std::floor(std::min(high * per_length_, 2.0 * n_)));
        if (!is_periodic_) {
            first = std::clamp(first, 0, n_ - 1);
            last = std::clamp(last, 0, n_ - 1);
        }
        last = std::min(last, first + n_ - 1);
        for (int cell = first; cell <= last; ++cell) visit((cell + n_) % n_);
    }

private:
    int n_;
    double per_length_;
    bool is_periodic_;
};

namespace {

/// The point of a segment that is nearest to (x, y).
std::array<double, 2> nearest_point(const Segment& line, double x, double y) {
    const double ux = line.x1 - line.x0, uy = line.y1 - line.y0, square = ux * ux + uy * uy;
    const double share = square > 0 ? std::clamp(((x - line.x0) * ux + (y - line.y0) * uy) / square,
                                                 0.0, 1.0)
                                    : 0;
    return {line.x0 + share * ux, line.y0 + share * uy};
}

} // namespace

struct LastingContactFinder::Search {
    std::span<const HeapDisc> discs;
    std::span<const double> radii;
    double widest_gap, largest_radius;
    CellLine columns, rows;
    std::vector<std::uint32_t> starts, sorted; ///< where cells begin in `sorted`; discs by cell
    std::vector<LastingContact> found;

    Search(const Box& box, const Effects& effects, std::span<const HeapDisc> all,
           std::span<const double> all_radii, double gap)
        : discs(all), radii(all_radii), widest_gap(gap),
          largest_radius(*std::max_element(all_radii.begin(), all_radii.end())),
          columns(box.x, width(), most_cells(), effects.is_periodic_x()),
          rows(box.y, width(), most_cells(), effects.is_periodic_y()) {
        sort();
    }

    double width() const { return 2 * largest_radius + widest_gap; }
    /// Largest number of cells along one axis, so that a dilute gas in a large box has only a few
    /// cells per disc.
    double most_cells() const {
        return std::ceil(4 * std::sqrt(static_cast<double>(discs.size()))) + 1;
    }
    std::size_t cell_of(const HeapDisc& disc) const {
        return static_cast<std::size_t>(rows.cell_of(disc.y) * columns.size() +
                                        columns.cell_of(disc.x));
    }
    void sort() {
        starts.assign(static_cast<std::size_t>(columns.size() * rows.size()) + 1, 0);
        for (const HeapDisc& disc : discs) ++starts[cell_of(disc) + 1];
        for (std::size_t cell = 1; cell < starts.size(); ++cell) starts[cell] += starts[cell - 1];
        std::vector<std::uint32_t> next(starts);
        sorted.resize(discs.size());
        for (std::uint32_t i = 0; i < discs.size(); ++i) sorted[next[cell_of(discs[i])]++] = i;
    }
    /// Calls visit(i) for the index i of each disc in the cells that the rectangle touches.
    template <class Visit>
    void in_rectangle(double x0, double x1, double y0, double y1, const Visit& visit) const {
        rows.visit(y0, y1, [&](int row) {
            columns.visit(x0, x1, [&](int column) {
                const auto cell = static_cast<std::size_t>(row * columns.size() + column);
                for (std::uint32_t k = starts[cell]; k < starts[cell + 1]; ++k) visit(sorted[k]);
            });
        });
    }
    /// Adds a contact if its gap is below `widest_gap`. (dx, dy) points from the centre of disc
    /// `contact.a` to the centre of a body of this radius.
    void add(LastingContact contact, double dx, double dy, double radius) {
        const double square = dx * dx + dy * dy, touching = radii[contact.a] + radius,
                     reach = touching + widest_gap;
        if (!(square < reach * reach) || square == 0) return;
        const double distance = std::sqrt(square);
        contact.nx = dx / distance;
        contact.ny = dy / distance;
        contact.gap = distance - touching;
        contact.distance = distance;
        found.push_back(contact);
    }
};

LastingContactFinder::LastingContactFinder(const Box& box, const Effects& effects)
    : box_(box), effects_(effects),
      pair_friction_(friction_of(effects.contact.kind, PairFactors::common(effects.contact))),
      pairs_(effects.contact) {
    for (std::size_t k = 0; k < surfaces_.size(); ++k) surfaces_[k] = SurfaceTable(effects, k);
}

std::vector<LastingContact> LastingContactFinder::find(std::span<const HeapDisc> discs,
                                                       std::span<const double> radii,
                                                       double widest_gap) const {
    if (discs.empty()) return {};
    Search search(box_, effects_, discs, radii, widest_gap);
    add_pairs(search);
    add_walls(search);
    add_fixed_bodies(search);
    return std::move(search.found);
}

void LastingContactFinder::add_pairs(Search& search) const {
    const Periods periods = effects_.periods(box_);
    const auto nearest = [](double far, double period) {
        return period == 0 ? far : far - period * std::round(far / period);
    };
    const PairView pairs = pairs_.view();
    LastingContact contact;
    contact.friction = pair_friction_;
    for (std::uint32_t i = 0; i < search.discs.size(); ++i) {
        const HeapDisc& disc = search.discs[i];
        const double reach = search.radii[i] + search.largest_radius + search.widest_gap;
        contact.a = i;
        search.in_rectangle(
            disc.x - reach, disc.x + reach, disc.y - reach, disc.y + reach, [&](std::uint32_t j) {
                if (j <= i) return;
                contact.b = j;
                if (pairs.are_any())
                    contact.friction = friction_of(effects_.contact.kind,
                                                   pairs.of(disc.id, search.discs[j].id));
                search.add(contact, nearest(search.discs[j].x - disc.x, periods.x),
                           nearest(search.discs[j].y - disc.y, periods.y), search.radii[j]);
            });
    }
}

/// Sets the disc's index i and the friction of a contact with a wall or a fixed body.
void LastingContactFinder::begin_at(const SurfaceTable& surface, std::uint32_t i,
                                    const HeapDisc& disc, LastingContact& contact) {
    contact.a = i;
    contact.friction = surface.of(disc.id).rubbing.friction();
}

/// Only sides of the kind `wall` have lasting contacts. In a box that is not a rectangle discs do
/// not reach the sides.
void LastingContactFinder::add_walls(Search& search) const {
    if (effects_.fixed_bodies.has_shape()) return;
    for (std::int64_t side = 0; side < 4; ++side) {
        const Boundary& wall = effects_.boundaries[static_cast<std::size_t>(side)];
        if (wall.kind != BoundaryKind::wall) continue;
        LastingContact contact;
        contact.body = side;
        const double sign = side % 2 == 0 ? -1 : 1;
        (side < 2 ? contact.nx : contact.ny) = sign;
        const SurfaceTable& surface = surfaces_[static_cast<std::size_t>(side)];
        // A side's velocity is along +x or +y, a contact's velocity along its tangent.
        contact.velocity = wall.surface.velocity * (side < 2 ? contact.nx : -contact.ny);
        for (std::uint32_t i = 0; i < search.discs.size(); ++i) {
            const double place = side < 2 ? search.discs[i].x : search.discs[i].y,
                         length = side < 2 ? box_.x : box_.y;
            contact.gap = (side % 2 == 0 ? place : length - place) - search.radii[i];
            begin_at(surface, i, search.discs[i], contact);
            if (contact.gap < search.widest_gap) search.found.push_back(contact);
        }
    }
}

/// The surface of a fixed body moves counterclockwise around it.
void LastingContactFinder::add_fixed_bodies(Search& search) const {
    const FixedBodyList& fixed_bodies = effects_.fixed_bodies;
    const SurfaceTable& surface = surfaces_[SurfaceContacts::fixed_bodies];
    LastingContact contact;
    contact.velocity = -fixed_bodies.surface.velocity;
    contact.body = 3;
    const double reach = search.largest_radius + search.widest_gap;
    for (const FixedDisc& body : fixed_bodies.discs) {
        const double far = reach + body.radius;
        ++contact.body;
        search.in_rectangle(body.x - far, body.x + far, body.y - far, body.y + far,
                            [&](std::uint32_t i) {
                                begin_at(surface, i, search.discs[i], contact);
                                search.add(contact, body.x - search.discs[i].x,
                                           body.y - search.discs[i].y, body.radius);
                            });
    }
    const std::vector<Segment> lines = all_segments(fixed_bodies, box_);
    const std::size_t n_turning = Container(fixed_bodies.shape, box_).segments().size();
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const Segment& line = lines[k];
        // The surface of the box's own wall moves counterclockwise around the inside of the box.
        contact.velocity = fixed_bodies.surface.velocity * (k + n_turning < lines.size() ? -1 : 1);
        ++contact.body;
        search.in_rectangle(std::min(line.x0, line.x1) - reach, std::max(line.x0, line.x1) + reach,
                            std::min(line.y0, line.y1) - reach, std::max(line.y0, line.y1) + reach,
                            [&](std::uint32_t i) {
                                const HeapDisc& disc = search.discs[i];
                                const auto [x, y] = nearest_point(line, disc.x, disc.y);
                                begin_at(surface, i, disc, contact);
                                search.add(contact, x - disc.x, y - disc.y, 0);
                            });
    }
    for (const Arc& arc : all_arcs(fixed_bodies, box_)) add_arc(search, arc, contact);
}

/// The tangent of a contact points counterclockwise along the arc only for discs inside it.
void LastingContactFinder::add_arc(Search& search, const Arc& arc, LastingContact& contact) const {
    ++contact.body;
    const double far = arc.radius + search.largest_radius + search.widest_gap,
                 velocity = effects_.fixed_bodies.surface.velocity;
    const SurfaceTable& surface = surfaces_[SurfaceContacts::fixed_bodies];
    const ArcSpan span = span_of(arc);
    const PointOfArc from = point_of(arc, arc.from), to = point_of(arc, arc.to);
    search.in_rectangle(arc.x - far, arc.x + far, arc.y - far, arc.y + far, [&](std::uint32_t i) {
        const double dx = search.discs[i].x - arc.x, dy = search.discs[i].y - arc.y,
                     distance = std::sqrt(dx * dx + dy * dy);
        begin_at(surface, i, search.discs[i], contact);
        contact.velocity = distance < arc.radius ? velocity : -velocity;
        if (span.holds(dx, dy, distance)) {
            const double far_off = distance > 0 ? arc.radius / distance - 1 : 0;
            return search.add(contact, far_off * dx, far_off * dy, 0);
        }
        for (const PointOfArc& end : {from, to})
            search.add(contact, end.x - search.discs[i].x, end.y - search.discs[i].y, 0);
    });
}

} // namespace carrom
