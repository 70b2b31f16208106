// SPDX-License-Identifier: BSD-3-Clause
// How far discs have come since sampling began: first places are kept by id, on any rank.
#include <algorithm>
#include <cmath>

#include "measure/sampler.hpp"
#include "parallel/pieces.hpp"

namespace carrom {

/// Where discs fly on through periodic boundaries, syncs bring them back. That is part of their
/// displacement.
void Sampler::follow_crossings() {
    if (follows_lengths()) lengths_.emplace(scene_.box, simulation_, ranks_);
}

void Sampler::sample_displacement(std::span<const Disc> shown, std::uint64_t n_discs,
                                  bool is_first) {
    const std::vector<Disc> flown = follows_lengths() ? flown_on(simulation_) : std::vector<Disc>{};
    const std::span<const Disc> discs = follows_lengths() ? std::span<const Disc>(flown) : shown;
    if (is_first) begin_flights(discs);
    const std::array<double, 3> means = flights_of(discs, n_discs);
    if (output_.displacement)
        sums_.displacements.insert(sums_.displacements.end(), means.begin(), means.begin() + 2);
    if (!output_.diffusion) return;
    const auto add = [this](const std::array<double, 3>& numbers) {
        sums_.flights.insert(sums_.flights.end(), numbers.begin(), numbers.end());
    };
    add(means);
    const std::size_t per_window = static_cast<std::size_t>(sums_.correlation_steps /
                                                            sums_.every_steps) +
                                   1;
    if (sums_.flights.size() / 3 % per_window != 0) return;
    begin_flights(discs); // the end of a window is the start of the next
    add(flights_of(discs, n_discs));
}

/// From now on flights are those from here.
void Sampler::begin_flights(std::span<const Disc> discs) {
    const double time = simulation_.clock(), unit = simulation_.velocity_unit();
    std::vector<FirstPlace> places;
    for (const Disc& disc : discs)
        places.push_back(
            {disc.id, disc.x_at(time), disc.y_at(time), 0, 0, disc.vx * unit, disc.vy * unit});
    place_first(places);
    if (lengths_) lengths_->begin_anew();
}

/// Largest component of a velocity now, or when flights began.
double Sampler::fastest_of(std::span<const Disc> discs) const {
    const double unit = simulation_.velocity_unit();
    double fastest = 0;
    for (const auto& [vx, vy] : first_velocities_)
        fastest = std::max({fastest, std::fabs(vx), std::fabs(vy)});
    for (const Disc& disc : discs)
        fastest = std::max({fastest, std::fabs(disc.vx * unit), std::fabs(disc.vy * unit)});
    return ranks_.max(fastest);
}

/// Mean squares of displacements along x and y since then, and the mean product of velocities.
std::array<double, 3> Sampler::flights_of(std::span<const Disc> discs, std::uint64_t n_discs) {
    const double time = simulation_.clock(), unit = simulation_.velocity_unit();
    const std::span<const DiscImage> lengths = lengths_ ? lengths_->counts()
                                                        : std::span<const DiscImage>{};
    const double n = static_cast<double>(n_discs),
                 farthest = (follows_lengths() ? 0x1p22 : 4) * scene_.box.longest();
    const double fastest = output_.diffusion ? fastest_of(discs) : 0;
    ExactSum x(n * farthest * farthest), y = x, products(2 * n * fastest * fastest);
    PieceStream stream(ranks_, discs, n_discs, [](const Disc& disc) { return disc.id; });
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round) {
        for (const Disc& disc : stream.next()) {
            const std::size_t place = disc.id - first_id_;
            const auto& [x0, y0] = first_places_[place];
            double dx = disc.x_at(time) - x0, dy = disc.y_at(time) - y0;
            if (!lengths.empty())
                dx += lengths[place].x * scene_.box.x, dy += lengths[place].y * scene_.box.y;
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
        ranks_.sum(*sums[k]);
        means[k] = sums[k]->value() / n;
    }
    return means;
}

/// Brings each first place to the rank whose run of ids has it.
void Sampler::place_first(std::span<const FirstPlace> places) {
    const std::uint64_t n = ranks_.sum(std::uint64_t{places.size()});
    PieceStream stream(ranks_, places, n, [](const FirstPlace& place) { return place.id; });
    const Pieces& pieces = stream.pieces();
    first_id_ = pieces.begin(pieces.first_of(ranks_.rank()));
    first_places_.clear();
    first_velocities_.clear();
    for (std::uint64_t round = 0; round < pieces.n_rounds(); ++round) {
        for (const FirstPlace& place : stream.next()) {
            first_places_.push_back({place.x, place.y});
            if (output_.diffusion) first_velocities_.push_back({place.vx, place.vy});
        }
    }
}

} // namespace carrom
