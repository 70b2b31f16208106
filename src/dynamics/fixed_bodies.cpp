// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/fixed_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/falling_contact.hpp"
#include "dynamics/growing_contact.hpp"
#include "dynamics/never.hpp"

namespace carrom {

namespace {

/// A disc in the box may touch the body or one of its eight images in neighbouring boxes.
constexpr std::uint32_t n_images = 9;

/// The least ratio of normal to tangential velocity of discs that leave the inner face of an arc,
/// as discs along it would collide without end. This changes energies by at most 1e-12 of them.
constexpr double least_slope = 1e-6;

/// The first time at which a distance with the initial `rate` and a constant acceleration `pull`
/// falls to 0. A disc on this side that overlaps the body meets it at once if it approaches, else
/// when it returns. On the other side the distance must become positive first.
double fall_delay(double distance, double rate, double pull, bool is_on_side) {
    if (rate < 0) {
        if (!(distance > 0)) return is_on_side ? 0 : never;
        if (pull == 0) return distance / -rate;
        const double square = rate * rate - 2 * pull * distance;
        return square > 0 ? 2 * distance / (-rate + std::sqrt(square)) : never;
    }
    if (!(pull < 0)) return never;
    const double square = rate * rate - 2 * pull * distance;
    if (!is_on_side && !(square > 0)) return never;
    return (rate + std::sqrt(std::max(square, 0.0))) / -pull;
}

} // namespace

FixedBodies::FixedBodies(const Box& box, double largest_radius, const Effects& effects)
    : surface_(effects, SurfaceContacts::fixed_bodies), guard_(effects, largest_radius),
      pull_{effects.acceleration().x, effects.acceleration().y},
      n_fixed_discs_(effects.fixed_bodies.discs.size()),
      container_(effects.fixed_bodies.shape, box), periods_(effects.periods(box)),
      largest_radius_(largest_radius), rows_of_bodies_(rows_of(effects.fixed_bodies, box)) {
    add_bodies(effects.fixed_bodies);
    const auto n = static_cast<double>(bodies_.size());
    // Cells are nearly square. Their total number hardly depends on the shape of the box.
    const double stretch = std::sqrt(box.x / box.y);
    const auto cells = [n](double length, double factor, double period) {
        const double number = std::floor(std::clamp(std::sqrt(2 * n), 4.0, 4096.0) * factor);
        const auto count = static_cast<std::int64_t>(std::clamp(number, 1.0, 65536.0));
        return CellAxis{length / static_cast<double>(count), period, count};
    };
    columns_ = cells(box.x, stretch, periods_.x);
    rows_ = cells(box.y, 1 / stretch, periods_.y);
    // The margin is much larger than the rounding of positions and times.
    margin_ = 1e-6 * std::max(columns_.width, rows_.width) + 1e-9 * box.longest();
    sort_into_cells();
}

void FixedBodies::add_line(const Segment& segment, double slides) {
    const double dx = segment.x1 - segment.x0, dy = segment.y1 - segment.y0,
                 length = std::sqrt(dx * dx + dy * dy);
    bodies_.push_back({segment.x0, segment.y0, 0, dx / length, dy / length, length, slides});
    bodies_.push_back({segment.x0, segment.y0, 0});
    bodies_.push_back({segment.x1, segment.y1, 0});
}

/// The ends of a scene's arcs are at rest. The ends of the box's arcs move like its lines.
void FixedBodies::add_arc(const Arc& arc, bool is_of_box) {
    Body face{arc.x, arc.y, arc.radius};
    face.is_arc = true;
    face.span = span_of(arc);
    bodies_.push_back(face);
    if (arc.is_whole()) return;
    for (const double angle : {arc.from, arc.to}) {
        const PointOfArc end = point_of(arc, angle);
        bodies_.push_back({end.x, end.y, 0});
        bodies_.back().slides = is_of_box ? -1 : 0;
    }
}

void FixedBodies::add_bodies(const FixedBodyList& fixed_bodies) {
    for (const FixedDisc& one : fixed_bodies.discs) bodies_.push_back({one.x, one.y, one.radius});
    for (const Segment& segment : fixed_bodies.segments) {
        begin_row();
        add_line(segment, 1);
    }
    for (const Polygon& polygon : fixed_bodies.polygons) {
        begin_row();
        for (const Segment& edge : edges_of(polygon)) add_line(edge, 1);
    }
    for (const Arc& arc : fixed_bodies.arcs) {
        begin_row();
        add_arc(arc, false);
    }
    if (!fixed_bodies.has_shape()) return;
    begin_row();
    for (const Segment& segment : container_.segments()) add_line(segment, -1);
    for (const Arc& arc : container_.arcs()) add_arc(arc, true);
}

FixedBodies::Cells FixedBodies::cells_of(const Extent& extent) const {
    return {columns_.cell_of(extent.x_low - margin_), columns_.cell_of(extent.x_high + margin_),
            rows_.cell_of(extent.y_low - margin_), rows_.cell_of(extent.y_high + margin_)};
}

/// The cells whose bodies a disc of this radius may touch while its centre is in `extent`. Cells
/// list bodies for discs of the largest initial radius; grown discs need a larger extent.
FixedBodies::Cells FixedBodies::cells_near(const Extent& extent, double radius) const {
    const double more = std::max(radius - largest_radius_, 0.0);
    return cells_of(
        {extent.x_low - more, extent.x_high + more, extent.y_low - more, extent.y_high + more});
}

/// A rectangle that contains the centres of all discs that touch the body's image.
Extent FixedBodies::extent_of(const Body& body, double radius, Shift shift) const {
    const double reach = body.radius + radius, x = body.x + shift.x, y = body.y + shift.y;
    const double x_end = x + body.length * body.ux, y_end = y + body.length * body.uy;
    return {std::min(x, x_end) - reach, std::max(x, x_end) + reach, std::min(y, y_end) - reach,
            std::max(y, y_end) + reach};
}

/// False only if the line, or the circle of an arc, is too far from the cell for a disc there to
/// touch it. Cells at the border of the box are also used for positions beyond it.
bool FixedBodies::may_hold(const Body& body, std::int64_t column, std::int64_t row) const {
    const bool is_at_border = std::min(column, row) == 0 || column + 1 == columns_.n ||
                              row + 1 == rows_.n;
    if (!(body.is_line() || body.is_arc) || is_at_border) return true;
    const double dx = (static_cast<double>(column) + 0.5) * columns_.width - body.x,
                 dy = (static_cast<double>(row) + 0.5) * rows_.width - body.y;
    const double distance = body.is_arc ? std::sqrt(dx * dx + dy * dy) - body.radius
                                        : body.ux * dy - body.uy * dx;
    return std::fabs(distance) <= largest_radius_ + std::max(columns_.width, rows_.width) + margin_;
}

void FixedBodies::sort_into_cells() {
    cell_starts_.assign(static_cast<std::size_t>(columns_.n * rows_.n + 1), 0);
    const auto visit = [this](const auto& what) {
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            const Cells cells = cells_of(extent_of(bodies_[k], largest_radius_, {0, 0}));
            for (std::int64_t column = cells.first_column; column <= cells.last_column; ++column)
                for (std::int64_t row = cells.first_row; row <= cells.last_row; ++row) {
                    if (!may_hold(bodies_[k], column, row)) continue;
                    const std::int64_t x = columns_.box_of(column), y = rows_.box_of(row);
                    const auto cell = static_cast<std::size_t>((column - x * columns_.n) * rows_.n +
                                                               (row - y * rows_.n));
                    what(cell, Entry{static_cast<std::uint32_t>(k), static_cast<std::int16_t>(-x),
                                     static_cast<std::int16_t>(-y)});
                }
        }
    };
    visit([this](std::size_t cell, const Entry&) { ++cell_starts_[cell + 1]; });
    for (std::size_t cell = 1; cell < cell_starts_.size(); ++cell)
        cell_starts_[cell] += cell_starts_[cell - 1];
    in_cells_.resize(cell_starts_.back());
    std::vector<std::uint32_t> ends = cell_starts_;
    visit([this, &ends](std::size_t cell, const Entry& entry) { in_cells_[ends[cell]++] = entry; });
}

/// Calls what(image) for the images of bodies in the cells; some images may occur repeatedly.
template <class What> void FixedBodies::visit_cells(const Cells& cells, const What& what) const {
    for (std::int64_t column = cells.first_column; column <= cells.last_column; ++column) {
        const std::int64_t x = columns_.box_of(column);
        const std::uint32_t* const starts = cell_starts_.data() +
                                            (column - x * columns_.n) * rows_.n;
        const std::int64_t last_y = rows_.box_of(cells.last_row);
        for (std::int64_t y = rows_.box_of(cells.first_row); y <= last_y; ++y) {
            const std::int64_t first_row = std::max(cells.first_row - y * rows_.n, std::int64_t{0});
            const std::int64_t last_row = std::min(cells.last_row - y * rows_.n, rows_.n - 1);
            for (std::uint32_t place = starts[first_row]; place < starts[last_row + 1]; ++place) {
                Entry image = in_cells_[place];
                image.x = static_cast<std::int16_t>(image.x + x);
                image.y = static_cast<std::int16_t>(image.y + y);
                what(image);
            }
        }
    }
}

/// The number of the touched image of the body; without periodic sides the number of the body.
/// Images are numbered relative to the box that contains the disc's centre (x, y) at the contact,
/// so the number is the same in whichever box the disc's state is stored.
std::uint32_t FixedBodies::code_of(const Entry& image, double x, double y) const {
    if (!periods_.are_any()) return image.body;
    const int dx = periods_.x == 0 ? 0 : image.x - static_cast<int>(std::floor(x / periods_.x));
    const int dy = periods_.y == 0 ? 0 : image.y - static_cast<int>(std::floor(y / periods_.y));
    return image.body * n_images + static_cast<std::uint32_t>(3 * (dx + 1) + (dy + 1));
}

/// The image with the number `code`, for a disc whose centre is at (x, y).
FixedBodies::Entry FixedBodies::image_of(std::uint32_t code, double x, double y) const {
    if (!periods_.are_any()) return {code, 0, 0};
    const auto image = static_cast<int>(code % n_images);
    const int boxes_x = periods_.x == 0
                            ? 0
                            : image / 3 - 1 + static_cast<int>(std::floor(x / periods_.x));
    const int boxes_y = periods_.y == 0
                            ? 0
                            : image % 3 - 1 + static_cast<int>(std::floor(y / periods_.y));
    return {code / n_images, static_cast<std::int16_t>(boxes_x),
            static_cast<std::int16_t>(boxes_y)};
}

/// (dx, dy) is the disc's position relative to the line's first end, (wx, wy) its velocity.
double FixedBodies::line_delay(const Body& line, const DiscSize& size, double dx, double dy,
                               double wx, double wy) const {
    const auto [gx, gy] = pull_;
    const double place = line.ux * dy - line.uy * dx, rate = line.ux * wy - line.uy * wx,
                 pull = line.ux * gy - line.uy * gx;
    double first = never;
    for (const double side : {1.0, -1.0}) {
        const double s = fall_delay(side * place - size.radius, side * rate - size.rate,
                                    side * pull, side * place >= 0);
        if (!(s < first)) continue;
        const double along = (line.ux * dx + line.uy * dy) + (line.ux * wx + line.uy * wy) * s +
                             (0.5 * (line.ux * gx + line.uy * gy) * s) * s;
        if (along >= 0 && along <= line.length) first = s;
    }
    return first;
}

/// The time of the next contact with an image of the body. It depends on the stored state alone.
double FixedBodies::contact_time(const DiscState& disc, const Body& body, const DiscSize& size,
                                 Shift shift) const {
    const bool falls = pull_[0] != 0 || pull_[1] != 0;
    const double dx = ((disc.x + fallen(0, disc.tau)) - body.x) - shift.x,
                 dy = ((disc.y + fallen(1, disc.tau)) - body.y) - shift.y;
    const double wx = disc.vx + pull_[0] * disc.tau, wy = disc.vy + pull_[1] * disc.tau;
    if (body.is_line()) return disc.tau + line_delay(body, size, dx, dy, wx, wy);
    if (body.is_arc) {
        const ArcFlight flight{dx, dy, wx, wy};
        return disc.tau + (falls ? falling_arc_contact(flight, pull_[0], pull_[1], size.radius,
                                                       body.radius, body.span)
                                 : arc_contact(flight, size, body.radius, body.span));
    }
    const double reach = body.radius + size.radius;
    if (falls) return disc.tau + falling_contact(dx, dy, wx, wy, pull_[0], pull_[1], reach);
    const double delay = growing_contact_delay(-dx, -dy, -wx, -wy, reach, size.rate_of(reach),
                                               never);
    return delay < 0 ? never : disc.tau + delay;
}

/// A rectangle that contains the path of the disc's centre. A parabola deviates from its chord by
/// at most an eighth of its acceleration times the squared time.
Extent FixedBodies::path_of(const DiscState& disc, double begin, double end) const {
    const double x0 = disc.x_at(begin) + fallen(0, begin), x1 = disc.x_at(end) + fallen(0, end);
    const double y0 = disc.y_at(begin) + fallen(1, begin), y1 = disc.y_at(end) + fallen(1, end);
    const double eighth = (end - begin) * (end - begin) / 8;
    const double x_bend = std::fabs(pull_[0]) * eighth, y_bend = std::fabs(pull_[1]) * eighth;
    return {std::min(x0, x1) - x_bend, std::max(x0, x1) + x_bend, std::min(y0, y1) - y_bend,
            std::max(y0, y1) + y_bend};
}

/// The number of parts of a flight in each of which the disc moves by about one cell at most.
double FixedBodies::slices_of(const DiscState& disc, double begin, double end) const {
    const auto speed = [&](double v, std::size_t axis) {
        return std::max(std::fabs(v + pull_[axis] * begin), std::fabs(v + pull_[axis] * end));
    };
    const double way = std::max(speed(disc.vx, 0), speed(disc.vy, 1)) * (end - begin);
    return std::clamp(std::ceil(way / std::min(columns_.width, rows_.width)), 1.0, 1e6);
}

BodyContact FixedBodies::first_contact(const DiscState& disc, const DiscSize& size,
                                       const ContactTimes& times) const {
    const double begin = std::max(times.from, disc.tau);
    BodyContact best;
    if (!(begin <= times.to)) return best;
    const double n_slices = slices_of(disc, begin, times.to);
    double from = begin;
    for (double k = 1; k <= n_slices; ++k) {
        const double to = k == n_slices ? times.to : begin + (times.to - begin) * (k / n_slices);
        const Extent path = path_of(disc, from, to);
        const double radius = size.after(to - disc.tau);
        visit_cells(cells_near(path, radius), [&](const Entry& image) {
            const Body& body = bodies_[image.body];
            const Shift shift = shift_of(image);
            const Extent extent = extent_of(body, radius, shift);
            if (extent.x_low > path.x_high + margin_ || extent.x_high < path.x_low - margin_ ||
                extent.y_low > path.y_high + margin_ || extent.y_high < path.y_low - margin_)
                return;
            const double time = contact_time(disc, body, size, shift);
            if (!(time <= times.to) || time < times.from ||
                (time == times.from && !times.hold_from) || time > best.time)
                return;
            const std::uint32_t code = code_of(image, disc.x_at(time) + fallen(0, time),
                                               disc.y_at(time) + fallen(1, time));
            if (code == times.except && time == disc.tau) return;
            if (time < best.time || code < best.body) best = {time, code};
        });
        if (best.time <= to) return best;
        from = to;
    }
    return best;
}

FixedBodies::Normal FixedBodies::normal_of(const Body& body, double dx, double dy) {
    if (body.is_line()) {
        const double side = body.ux * dy - body.uy * dx < 0 ? -1 : 1;
        return {-side * body.uy, side * body.ux, false};
    }
    const double distance = std::sqrt(dx * dx + dy * dy);
    if (body.is_arc && distance < body.radius) return {-(dx / distance), -(dy / distance), true};
    return {dx / distance, dy / distance, false};
}

BodyTouch FixedBodies::touch(const DiscState& disc, std::uint32_t code, double time,
                             double radius) const {
    const double x = disc.x + fallen(0, time), y = disc.y + fallen(1, time);
    const Entry image = image_of(code, x, y);
    const Body& at = bodies_[image.body];
    const Shift shift = shift_of(image);
    const Normal normal = normal_of(at, (x - at.x) - shift.x, (y - at.y) - shift.y);
    const std::size_t row = row_of(image.body);
    return {static_cast<std::uint32_t>(row), normal.x, normal.y,
            (x - radius * normal.x) - shift.x - rows_of_bodies_[row].x,
            (y - radius * normal.y) - shift.y - rows_of_bodies_[row].y};
}

Loss FixedBodies::rebound(DiscState& disc, std::uint32_t code, double time, double since,
                          double outwards, const Turning& turning) const {
    const double x = disc.x + fallen(0, time), y = disc.y + fallen(1, time);
    const Entry image = image_of(code, x, y);
    const Body& at = bodies_[image.body];
    const Shift shift = shift_of(image);
    const double dx = (x - at.x) - shift.x, dy = (y - at.y) - shift.y;
    const Normal from_body = normal_of(at, dx, dy);
    const double nx = from_body.x, ny = from_body.y;
    const double slides = from_body.is_hollow ? -at.slides : at.slides;
    const auto& [restitution, rubbing] = surface_.of(disc.id);
    const double normal = nx * (disc.vx + pull_[0] * time) + ny * (disc.vy + pull_[1] * time);
    // A disc that grows bounces as if the body moved towards it at the speed `outwards`.
    const double closing = std::fabs(outwards - normal);
    const bool is_guarded = guard_.holds_at_wall(since, closing, turning.radius);
    double away = outwards + (is_guarded ? 1 : restitution) * closing;
    // A disc that is pulled back leaves fast enough for its next collision to be unguarded.
    double pull = -(nx * pull_[0] + ny * pull_[1]);
    const auto speed_along = [&] {
        return nx * (disc.vy + pull_[1] * time) - ny * (disc.vx + pull_[0] * time);
    };
    if (from_body.is_hollow) {
        const double along = speed_along();
        if (restitution < 1) pull += along * along / (at.radius - turning.radius);
        away = std::max(away, outwards + least_slope * std::fabs(along));
    }
    if (pull > 0) away = std::max(away, outwards + guard_.least_departure(pull, turning.radius));
    disc.vx += (away - normal) * nx;
    disc.vy += (away - normal) * ny;
    const double square = closing * closing;
    const Loss loss = guard_.loss(0.5 * (1 - restitution * restitution) * square, square,
                                  is_guarded);
    if (!rubbing.acts()) return loss;
    const double change = rubbing.rub(speed_along() - slides * rubbing.velocity(),
                                      std::fabs(away - normal), turning);
    disc.vx -= change * ny;
    disc.vy += change * nx;
    return loss;
}

/// The overlap is minus infinity beyond the ends of an arc, because these are separate bodies.
double FixedBodies::overlap_of(const Body& body, double x, double y, double radius) const {
    if (body.is_arc) {
        const double dx = x - body.x, dy = y - body.y, distance = std::sqrt(dx * dx + dy * dy);
        return body.span.holds(dx, dy, distance) ? radius - std::fabs(distance - body.radius)
                                                 : -never;
    }
    const double along = std::clamp(body.ux * (x - body.x) + body.uy * (y - body.y), 0.0,
                                    body.length);
    const double dx = x - (body.x + along * body.ux), dy = y - (body.y + along * body.uy);
    return (body.radius + radius) - std::sqrt(dx * dx + dy * dy);
}

FixedBodies::Overlap FixedBodies::deepest_overlap(double x, double y, double radius,
                                                  double least) const {
    Overlap deepest;
    double most = least;
    visit_cells(cells_near({x, x, y, y}, radius), [&](const Entry& image) {
        const Shift shift = shift_of(image);
        const double overlap = overlap_of(bodies_[image.body], x - shift.x, y - shift.y, radius);
        if (!(overlap > most)) return;
        most = overlap;
        deepest = {overlap, image.body};
    });
    // A disc outside the container counts as overlapping the wall.
    const double overlap = container_.is_rectangle() ? -never : container_.outside(x, y) + radius;
    return overlap > most ? Overlap{overlap, first_bodies_.back()} : deepest;
}

std::size_t FixedBodies::row_of(std::uint32_t body) const {
    if (body < n_fixed_discs_) return body;
    const auto next = std::ranges::upper_bound(first_bodies_, body);
    return n_fixed_discs_ + static_cast<std::size_t>(next - first_bodies_.begin()) - 1;
}

std::string FixedBodies::name_of(std::uint32_t body) const {
    return rows_of_bodies_[row_of(body)].name();
}

} // namespace carrom
