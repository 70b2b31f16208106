// SPDX-License-Identifier: BSD-3-Clause
#include "measure/followed_discs.hpp"

#include <algorithm>
#include <array>

#include "core/exact_sum.hpp"
#include "measure/centred_flights.hpp"
#include "measure/speeds.hpp"
#include "parallel/pieces.hpp"

namespace carrom {

FollowedDiscs::FollowedDiscs(MeasuredRun& run) : run_(run), species_(run.system.species_table()) {}

void FollowedDiscs::begin() {
    n_discs_ = run_.ranks.sum(std::uint64_t{run_.system.discs().size()});
    const Pieces pieces(n_discs_, run_.ranks.size());
    first_id_ = pieces.begin(pieces.first_of(run_.ranks.rank()));
    n_own_ = pieces.begin(pieces.first_of(run_.ranks.rank() + 1)) - first_id_;
    speed_ = std::max(usual_speed(run_), 0x1p-200);
    if (run_.scene.effects.are_periodic()) lengths_.emplace(run_.system, run_.ranks);
}

const FollowedStates& FollowedDiscs::now() {
    const double time = run_.system.clock(), unit = run_.system.velocity_unit();
    const DiscStates flown = lengths_ ? flown_on(run_.system) : DiscStates{};
    const std::span<const DiscState> discs = lengths_ ? std::span<const DiscState>(flown)
                                                      : run_.system.shown();
    const std::span<const DiscImage> lengths = lengths_ ? lengths_->counts()
                                                        : std::span<const DiscImage>{};
    PieceStream stream(run_.ranks, discs, n_discs_, [](const DiscState& disc) { return disc.id; });
    for (std::vector<double>* column : states_.columns()) column->resize(n_own_);
    std::size_t i = 0;
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round)
        for (const DiscState& disc : stream.next()) {
            states_.x[i] = disc.x_at(time), states_.y[i] = disc.y_at(time);
            states_.vx[i] = disc.vx * unit, states_.vy[i] = disc.vy * unit;
            if (!lengths.empty()) {
                states_.x[i] += lengths[i].x * run_.scene.box.x;
                states_.y[i] += lengths[i].y * run_.scene.box.y;
            }
            ++i;
        }
    const std::array<bool, 2> is_apart = is_centred(run_.scene, static_cast<double>(n_discs_));
    if (is_apart[0] || is_apart[1]) subtract_mean(is_apart);
    return states_;
}

/// Subtracts the common motion, which is not diffusion (see centred_flights.hpp).
void FollowedDiscs::subtract_mean(const std::array<bool, 2>& is_apart) {
    const double length = run_.scene.box.longest() * 0x1p70;
    std::array<ExactSum, 5> sums = {ExactSum(0x1p70), ExactSum(length), ExactSum(length),
                                    ExactSum(speed_ * 0x1p70), ExactSum(speed_ * 0x1p70)};
    const std::array<std::vector<double>*, 4> columns = states_.columns();
    for (std::size_t i = 0; i < states_.size(); ++i) {
        const double mass = species_.of(first_id_ + i).mass;
        sums[0].add(mass);
        for (std::size_t k = 0; k < columns.size(); ++k) sums[1 + k].add(mass * (*columns[k])[i]);
    }
    for (ExactSum& sum : sums) run_.ranks.sum(sum);
    for (std::size_t k = 0; k < columns.size(); ++k) {
        if (!is_apart[k % 2]) continue;
        const double mean = sums[1 + k].value() / sums[0].value();
        for (double& number : *columns[k]) number -= mean;
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

/// Each rank has the words of its own ids and zeros for all other ids, so the sum over ranks has
/// the words of all ids.
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
