// SPDX-License-Identifier: BSD-3-Clause
#include "measure/flights.hpp"

#include <algorithm>
#include <cmath>

#include "core/exact_sum.hpp"
#include "parallel/pieces.hpp"

namespace carrom {

/// Where discs fly on through periodic sides, syncs bring them back. That is part of their
/// displacement.
void Flights::follow() {
    if (follows_lengths()) lengths_.emplace(run_.scene.box, run_.simulation, run_.ranks);
}

std::span<const Disc> Flights::flown(std::span<const Disc> shown) {
    if (!follows_lengths()) return shown;
    flown_ = flown_on(run_.simulation);
    return flown_;
}

/// From now on flights are those from here.
void Flights::begin(std::span<const Disc> discs) {
    const double time = run_.simulation.clock(), unit = run_.simulation.velocity_unit();
    std::vector<FirstPlace> places;
    for (const Disc& disc : discs)
        places.push_back(
            {disc.id, disc.x_at(time), disc.y_at(time), 0, 0, disc.vx * unit, disc.vy * unit});
    place_first(places);
    if (lengths_) lengths_->begin_anew();
}

/// Largest component of a velocity now, or when flights began.
double Flights::fastest_of(std::span<const Disc> discs) const {
    const double unit = run_.simulation.velocity_unit();
    double fastest = 0;
    for (const auto& [vx, vy] : first_velocities_)
        fastest = std::max({fastest, std::fabs(vx), std::fabs(vy)});
    for (const Disc& disc : discs)
        fastest = std::max({fastest, std::fabs(disc.vx * unit), std::fabs(disc.vy * unit)});
    return run_.ranks.max(fastest);
}

/// Mean squares of displacements along x and y since then, and the mean product of velocities.
std::array<double, 3> Flights::means(std::span<const Disc> discs, std::uint64_t n_discs) {
    const double time = run_.simulation.clock(), unit = run_.simulation.velocity_unit();
    const std::span<const DiscImage> lengths = lengths_ ? lengths_->counts()
                                                        : std::span<const DiscImage>{};
    const double n = static_cast<double>(n_discs),
                 farthest = (follows_lengths() ? 0x1p22 : 4) * run_.scene.box.longest();
    const double fastest = have_velocities_ ? fastest_of(discs) : 0;
    ExactSum x(n * farthest * farthest), y = x, products(2 * n * fastest * fastest);
    PieceStream stream(run_.ranks, discs, n_discs, [](const Disc& disc) { return disc.id; });
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round) {
        for (const Disc& disc : stream.next()) {
            const std::size_t place = disc.id - first_id_;
            const auto& [x0, y0] = first_places_[place];
            double dx = disc.x_at(time) - x0, dy = disc.y_at(time) - y0;
            if (!lengths.empty())
                dx += lengths[place].x * run_.scene.box.x,
                    dy += lengths[place].y * run_.scene.box.y;
            ensure(std::fabs(dx) <= farthest && std::fabs(dy) <= farthest,
                   "a disc has gone round a periodic box millions of times; measure "
                   "displacements over fewer steps");
            x.add(dx * dx);
            y.add(dy * dy);
            if (first_velocities_.empty()) continue;
            const auto& [vx, vy] = first_velocities_[place];
            products.add(vx * (disc.vx * unit) + vy * (disc.vy * unit));
        }
    }
    std::array<double, 3> means{};
    ExactSum* const sums[] = {&x, &y, &products};
    for (std::size_t k = 0; k < 3; ++k) {
        run_.ranks.sum(*sums[k]);
        means[k] = sums[k]->value() / n;
    }
    return means;
}

/// Brings each first place to the rank whose run of ids has it.
void Flights::place_first(std::span<const FirstPlace> places) {
    const std::uint64_t n = run_.ranks.sum(std::uint64_t{places.size()});
    PieceStream stream(run_.ranks, places, n, [](const FirstPlace& place) { return place.id; });
    const Pieces& pieces = stream.pieces();
    first_id_ = pieces.begin(pieces.first_of(run_.ranks.rank()));
    first_places_.clear();
    first_velocities_.clear();
    for (std::uint64_t round = 0; round < pieces.n_rounds(); ++round) {
        for (const FirstPlace& place : stream.next()) {
            first_places_.push_back({place.x, place.y});
            if (have_velocities_) first_velocities_.push_back({place.vx, place.vy});
        }
    }
}

void Flights::store(StoredSamples& stored) {
    stored.have_first_places = true;
    stored.have_lengths = follows_lengths();
    stored.have_velocities = have_velocities_;
    for (std::size_t i = 0; i < first_places_.size(); ++i) {
        FirstPlace& place = stored.first_places.emplace_back(
            FirstPlace{first_id_ + i, first_places_[i][0], first_places_[i][1]});
        if (have_velocities_)
            place.vx = first_velocities_[i][0], place.vy = first_velocities_[i][1];
    }
    if (lengths_)
        lengths_->store(stored.first_places, &FirstPlace::lengths_x, &FirstPlace::lengths_y);
}

void Flights::restore(const StoredSamples& stored) {
    follow();
    place_first(stored.first_places);
    if (lengths_)
        lengths_->go_on(stored.first_places, &FirstPlace::lengths_x, &FirstPlace::lengths_y);
}

} // namespace carrom
