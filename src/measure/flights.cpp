// SPDX-License-Identifier: BSD-3-Clause
#include "measure/flights.hpp"

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "dynamics/species.hpp"
#include "measure/centred_flights.hpp"
#include "parallel/pieces.hpp"

namespace carrom {

/// Starts to count the box lengths by which syncs move discs back into the box, because these
/// lengths are part of displacements.
void Flights::follow() {
    if (follows_lengths()) lengths_.emplace(run_.system, run_.ranks);
}

std::span<const DiscState> Flights::flown(std::span<const DiscState> shown) {
    if (!follows_lengths()) return shown;
    flown_ = flown_on(run_.system);
    return flown_;
}

/// Starts all displacements at the present positions.
void Flights::begin(std::span<const DiscState> discs) {
    const double time = run_.system.clock(), unit = run_.system.velocity_unit();
    std::vector<FirstPlace> places;
    for (const DiscState& disc : discs)
        places.push_back(
            {disc.id, disc.x_at(time), disc.y_at(time), 0, 0, disc.vx * unit, disc.vy * unit});
    place_first(places);
    if (lengths_) lengths_->begin_anew();
}

/// The largest absolute value of a velocity component of any disc, now or at the start.
double Flights::fastest_of(std::span<const DiscState> discs) const {
    const double unit = run_.system.velocity_unit();
    double fastest = 0;
    for (const auto& [vx, vy] : first_velocities_)
        fastest = std::max({fastest, std::fabs(vx), std::fabs(vy)});
    for (const DiscState& disc : discs)
        fastest = std::max({fastest, std::fabs(disc.vx * unit), std::fabs(disc.vy * unit)});
    return run_.ranks.max(fastest);
}

/// Mean squares of displacements along x and y, and the mean of the scalar product of the
/// velocities at the start and now.
std::array<double, 3> Flights::means(std::span<const DiscState> discs, std::uint64_t n_discs) {
    const double time = run_.system.clock(), unit = run_.system.velocity_unit();
    const std::span<const DiscImage> lengths = lengths_ ? lengths_->counts()
                                                        : std::span<const DiscImage>{};
    const FlightBounds bounds{(follows_lengths() ? 0x1p22 : 4) * run_.scene.box.longest(),
                              have_velocities_ ? fastest_of(discs) : 0};
    const SpeciesTable& species = run_.system.species_table();
    std::vector<Flight> flights;
    PieceStream stream(run_.ranks, discs, n_discs, [](const DiscState& disc) { return disc.id; });
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round) {
        for (const DiscState& disc : stream.next()) {
            const std::size_t place = disc.id - first_id_;
            const auto& [x0, y0] = first_places_[place];
            double dx = disc.x_at(time) - x0, dy = disc.y_at(time) - y0;
            if (!lengths.empty())
                dx += lengths[place].x * run_.scene.box.x,
                    dy += lengths[place].y * run_.scene.box.y;
            ensure(std::fabs(dx) <= bounds.way && std::fabs(dy) <= bounds.way,
                   "a disc has gone round a periodic box millions of times; measure "
                   "displacements over fewer steps");
            flights.push_back({.way = {dx, dy}, .mass = species.of(disc.id).mass});
            if (first_velocities_.empty()) continue;
            flights.back().first_velocity = first_velocities_[place];
            flights.back().velocity = {disc.vx * unit, disc.vy * unit};
        }
    }
    return mean_flights(flights, bounds, run_.scene, run_.ranks);
}

/// Sends each first position to the rank whose range of ids contains the disc.
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
