// SPDX-License-Identifier: BSD-3-Clause
// Checks positions of discs: in the box, in the domain and cell, clear of fixed bodies; or outside,
// after a departure through an open side.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "check/state_check.hpp"

namespace carrom {

namespace {

double beyond(double low, double place, double high) { return std::max(low - place, place - high); }

/// The region in which centres may lie. Through an open side discs fly until they are a radius
/// outside, or further in the time-stepped method, after a collision in the same micro-step.
Extent room_in(const Extent& box, const Effects& effects, double radius, Method method) {
    const double outside = method == Method::time_stepped ? std::numeric_limits<double>::infinity()
                                                          : radius;
    const auto inset = [&](std::size_t side) {
        return effects.boundaries[side].kind == BoundaryKind::open ? -outside : radius;
    };
    return {box.x_low + inset(0), box.x_high - inset(1), box.y_low + inset(2),
            box.y_high - inset(3)};
}

} // namespace

Finding StateCheck::first_out_of_place(const LocalView& now) const {
    const GridGeometry& geometry = now.grid->geometry();
    const double allowed = scene_.effects.are_any() ? blur(64) : blur(4);
    const Extent box = extent_at(effects_, box_, static_cast<double>(micro_steps_done_));
    std::optional<Finding> first;
    const auto add = [&](Invariant invariant, DiscId id, double value, double bound) {
        if (!first || invariant < first->invariant)
            first = Finding{invariant, communicator_.rank(), id, value, bound};
    };
    const bool is_filed = now.grid->is_valid(now.population.discs.size());
    for (std::size_t i = 0; i < now.population.n_own; ++i) {
        const DiscState& disc = now.population.discs[i];
        const double x = now.periods.x_of(disc, now.time), y = now.periods.y_of(disc, now.time);
        const DiscState seen = now.frame.in_box(disc, now.time);
        const double radius = species_.of(disc.id).radius * size_at(micro_steps_done_);
        // In a periodic box the centre of the disc's image must lie in the box.
        const Extent room = room_in(box, effects_, radius, scene_.method);
        const double outside = std::max(
            now.periods.x != 0 ? beyond(0, x, now.periods.x)
                               : beyond(room.x_low, seen.x, room.x_high),
            now.periods.y != 0 ? beyond(0, y, now.periods.y)
                               : beyond(room.y_low, seen.y, room.y_high));
        if (outside > allowed) add(Invariant::in_box, disc.id, outside, allowed);
        const auto [along, across] = turned(geometry.axis, x, y);
        if (const int owner = now.domains->owner(along, across); owner != communicator_.rank())
            add(Invariant::in_domain, disc.id, owner, 0);
        const auto index = static_cast<LocalIndex>(i);
        const CellGrid::Cell cell = is_filed ? now.grid->cell_of(index) : CellGrid::Cell{-1, -1};
        if (cell.column != geometry.column_of(along) || cell.row != geometry.row_of(across))
            add(Invariant::in_cell, disc.id, 0, 0);
    }
    return first.value_or(Finding{});
}

/// Distance of a departed disc from the nearest line that lies one radius outside an open side.
double StateCheck::from_departure(const DiscState& disc) const {
    const double radius = species_.of(disc.id).radius;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t side = 0; side < effects_.boundaries.size(); ++side) {
        if (effects_.boundaries[side].kind != BoundaryKind::open) continue;
        const double place = side < 2 ? disc.x : disc.y,
                     length = side < 2 ? scene_.box.x : scene_.box.y,
                     line = side % 2 == 0 ? -radius : length + radius;
        least = std::min(least, std::fabs(place - line));
    }
    return least;
}

double StateCheck::returns_of(std::size_t i) const {
    const auto is_outside = [](const Known& known) { return known.disc.has_departed() ? 1.0 : 0; };
    return is_outside(before_[i]) + static_cast<double>(known_[i].departures) -
           is_outside(known_[i]);
}

/// In the finding, `partner` is 1 if the number of departures and returns is wrong, else 0.
Finding StateCheck::first_wrong_departure() const {
    if (!have_open_sides_) return {};
    const bool may_return = have_inlets_ && n_syncs_since(micro_steps_before_) > 0;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Known& now = known_[i];
        const double returns = returns_of(i);
        if (returns < 0 || (returns > 0 && !may_return))
            return {Invariant::departed, now.owner, first_id_ + i, returns, 0, 1};
        if (!now.disc.has_departed()) continue;
        if (const double distance = from_departure(now.disc); distance > blur(4))
            return {Invariant::departed, now.owner, first_id_ + i, distance, blur(4), 0};
    }
    return {};
}

/// A disc may touch a fixed body but not enter it, because both methods stop it there. In the
/// finding, `partner` is the fixed body.
Finding StateCheck::first_in_fixed_body(const LocalView& now) const {
    if (!fixed_bodies_.are_any()) return {};
    const double bound = 2 * tolerance_ + blur(64);
    for (const DiscState& disc : now.population.discs.first(now.population.n_own)) {
        const DiscState seen = now.frame.in_box(disc, now.time);
        const double radius = species_.of(disc.id).radius * size_at(micro_steps_done_);
        const auto overlap = fixed_bodies_.deepest_overlap(seen.x, seen.y, radius, bound);
        if (overlap.body != BodyContact::no_body)
            return {Invariant::clear, communicator_.rank(), disc.id, overlap.depth, bound,
                    overlap.body};
    }
    return {};
}

} // namespace carrom
