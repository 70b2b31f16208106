// SPDX-License-Identifier: BSD-3-Clause
// How far discs have come since sampling began: first places are kept by id, on any rank.
#include <cmath>

#include "measure/sampler.hpp"
#include "parallel/pieces.hpp"

namespace carrom {

namespace {

/// The own discs where they would be had nothing brought them back since the last sync.
std::vector<Disc> flown_on(const Simulation& simulation) {
    Frame frame = simulation.frame();
    frame.period_x = frame.period_y = 0;
    std::vector<Disc> discs;
    for (const Disc& disc : simulation.discs())
        discs.push_back(frame.in_box(disc, simulation.clock()));
    return discs;
}

} // namespace

/// Where discs fly on through periodic boundaries, syncs bring them back. That is part of their
/// displacement.
void Sampler::follow_crossings() {
    if (output_.displacement && scene_.effects.are_periodic())
        simulation_.note_crossings_in(&crossings_);
}

void Sampler::sample_displacement(std::span<const Disc> shown, std::uint64_t n_discs,
                                  bool is_first) {
    const double time = simulation_.clock();
    std::vector<Disc> flown;
    if (scene_.effects.are_periodic()) flown = flown_on(simulation_);
    const std::span<const Disc> discs = scene_.effects.are_periodic() ? std::span<const Disc>(flown)
                                                                      : shown;
    if (is_first) {
        std::vector<FirstPlace> places;
        for (const Disc& disc : discs)
            places.push_back({disc.id, disc.x_at(time), disc.y_at(time)});
        crossings_.clear(); // of before
        place_first(places);
    }
    take_crossings();
    const double farthest = (scene_.effects.are_periodic() ? 0x1p22 : 4) * scene_.box.longest();
    const double bound = static_cast<double>(n_discs) * farthest * farthest;
    ExactSum x(bound), y(bound);
    PieceStream stream(ranks_, discs, n_discs, [](const Disc& disc) { return disc.id; });
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round) {
        for (const Disc& disc : stream.next()) {
            const auto& [x0, y0] = first_places_[disc.id - first_id_];
            double dx = disc.x_at(time) - x0, dy = disc.y_at(time) - y0;
            if (!lengths_.empty())
                dx += lengths_[disc.id - first_id_][0] * scene_.box.x,
                    dy += lengths_[disc.id - first_id_][1] * scene_.box.y;
            ensure(std::fabs(dx) <= farthest && std::fabs(dy) <= farthest,
                   "a disc has gone round a periodic box millions of times; measure "
                   "\"displacement\" over fewer steps");
            x.add(dx * dx);
            y.add(dy * dy);
        }
    }
    for (ExactSum* sum : {&x, &y}) {
        ranks_.sum(*sum);
        sums_.displacements.push_back(sum->value() / static_cast<double>(n_discs));
    }
}

/// Brings each first place to the rank whose run of ids has it.
void Sampler::place_first(std::span<const FirstPlace> places) {
    const std::uint64_t n = ranks_.sum(std::uint64_t{places.size()});
    PieceStream stream(ranks_, places, n, [](const FirstPlace& place) { return place.id; });
    const Pieces& pieces = stream.pieces();
    first_id_ = pieces.begin(pieces.first_of(ranks_.rank()));
    first_places_.clear();
    lengths_.clear();
    for (std::uint64_t round = 0; round < pieces.n_rounds(); ++round) {
        for (const FirstPlace& place : stream.next()) {
            first_places_.push_back({place.x, place.y});
            if (scene_.effects.are_periodic())
                lengths_.push_back({place.lengths_x, place.lengths_y});
        }
    }
}

/// Reports to the ranks that keep first places how far discs have been brought back. Whole numbers:
/// their order does not matter. **Collective.**
void Sampler::take_crossings() const {
    if (!output_.displacement || !scene_.effects.are_periodic()) return;
    const Pieces pieces(scene_.n_discs, ranks_.size());
    std::vector<std::vector<Crossing>> out(static_cast<std::size_t>(ranks_.size()));
    for (const Crossing& crossing : crossings_)
        out[static_cast<std::size_t>(
                slab_of(pieces.of(crossing.disc), pieces.count(), ranks_.size()))]
            .push_back(crossing);
    crossings_.clear();
    for (const Crossing& crossing : send_to_owners(ranks_, out).items) {
        std::array<double, 2>& lengths = lengths_[crossing.disc - first_id_];
        lengths[0] += crossing.x;
        lengths[1] += crossing.y;
    }
}

} // namespace carrom
