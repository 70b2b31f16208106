// SPDX-License-Identifier: BSD-3-Clause
#include "measure/followed_discs.hpp"

#include <algorithm>
#include <array>

#include "core/exact_sum.hpp"
#include "measure/speeds.hpp"
#include "parallel/pieces.hpp"

namespace carrom {

FollowedDiscs::FollowedDiscs(MeasuredRun& run)
    : run_(run), species_(run.simulation.species_table()) {}

void FollowedDiscs::begin() {
    n_discs_ = run_.ranks.sum(std::uint64_t{run_.simulation.discs().size()});
    const Pieces pieces(n_discs_, run_.ranks.size());
    first_id_ = pieces.begin(pieces.first_of(run_.ranks.rank()));
    n_own_ = pieces.begin(pieces.first_of(run_.ranks.rank() + 1)) - first_id_;
    speed_ = std::max(usual_speed(run_), 0x1p-200);
    if (run_.scene.effects.are_periodic())
        lengths_.emplace(run_.scene.box, run_.simulation, run_.ranks);
}

const std::vector<FollowedDisc>& FollowedDiscs::now() {
    const double time = run_.simulation.clock(), unit = run_.simulation.velocity_unit();
    const std::vector<Disc> flown = lengths_ ? flown_on(run_.simulation) : std::vector<Disc>{};
    const std::span<const Disc> discs = lengths_ ? std::span<const Disc>(flown)
                                                 : run_.simulation.shown();
    const std::span<const DiscImage> lengths = lengths_ ? lengths_->counts()
                                                        : std::span<const DiscImage>{};
    PieceStream stream(run_.ranks, discs, n_discs_, [](const Disc& disc) { return disc.id; });
    discs_.clear();
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round)
        for (const Disc& disc : stream.next()) {
            FollowedDisc& one = discs_.emplace_back();
            one = {disc.x_at(time), disc.y_at(time), disc.vx * unit, disc.vy * unit};
            if (lengths.empty()) continue;
            one.x += lengths[discs_.size() - 1].x * run_.scene.box.x;
            one.y += lengths[discs_.size() - 1].y * run_.scene.box.y;
        }
    if (n_discs_ > 1 && !run_.scene.effects.obstacles.are_any()) subtract_mean();
    return discs_;
}

/// Nothing stops a common motion along a periodic axis, and it is no diffusion (see
/// centred_flights.hpp).
void FollowedDiscs::subtract_mean() {
    const double length = run_.scene.box.longest() * 0x1p70;
    std::array<ExactSum, 5> sums = {ExactSum(0x1p70), ExactSum(length), ExactSum(length),
                                    ExactSum(speed_ * 0x1p70), ExactSum(speed_ * 0x1p70)};
    for (std::size_t i = 0; i < discs_.size(); ++i) {
        const double mass = species_.of(first_id_ + i).mass;
        const FollowedDisc& disc = discs_[i];
        const std::array<double, 5> terms = {mass, mass * disc.x, mass * disc.y, mass * disc.vx,
                                             mass * disc.vy};
        for (std::size_t k = 0; k < terms.size(); ++k) sums[k].add(terms[k]);
    }
    for (ExactSum& sum : sums) run_.ranks.sum(sum);
    const double mass = sums[0].value();
    const bool along_x = run_.scene.effects.is_periodic_x(),
               along_y = run_.scene.effects.is_periodic_y();
    for (FollowedDisc& disc : discs_) {
        if (along_x) disc.x -= sums[1].value() / mass, disc.vx -= sums[3].value() / mass;
        if (along_y) disc.y -= sums[2].value() / mass, disc.vy -= sums[4].value() / mass;
    }
}

void FollowedDiscs::keep(KeptNumbers& kept) {
    if (kept.is_restored()) begin();
    kept(speed_);
    if (!lengths_) return;
    std::vector<double> x(n_own_), y(n_own_);
    if (!kept.is_restored()) {
        const std::span<const DiscImage> counts = lengths_->counts();
        for (std::size_t i = 0; i < n_own_; ++i) x[i] = counts[i].x, y[i] = counts[i].y;
    }
    keep(kept, x), keep(kept, y);
    if (!kept.is_restored()) return;
    std::vector<FirstPlace> places(n_own_);
    for (std::size_t i = 0; i < n_own_; ++i) {
        places[i].id = first_id_ + i;
        places[i].lengths_x = x[i], places[i].lengths_y = y[i];
    }
    lengths_->go_on(places, &FirstPlace::lengths_x, &FirstPlace::lengths_y);
}

/// Ranks add their words to zeros of the others, so that all have all.
void FollowedDiscs::keep(KeptNumbers& kept, std::vector<double>& of_discs) const {
    std::vector<std::uint64_t> words;
    if (!kept.is_restored()) {
        words.assign(n_discs_, 0);
        for (std::size_t i = 0; i < n_own_; ++i)
            words[first_id_ + i] = std::bit_cast<std::uint64_t>(of_discs[i]);
        run_.ranks.sum(std::span(words));
    }
    kept(words);
    if (!kept.is_restored()) return;
    if (words.size() != n_discs_) return kept.refuse();
    of_discs.resize(n_own_);
    for (std::size_t i = 0; i < n_own_; ++i)
        of_discs[i] = std::bit_cast<double>(words[first_id_ + i]);
}

} // namespace carrom
