// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/insertion_batch.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <unordered_map>

#include "initial_state/refused_places.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

// The smallest and the largest number of proposals of a rank in a batch, averaged over ranks. Fewer
// proposals would make the exchange dominate the time; more would need too much memory.
constexpr double least_proposals = 1 << 14, most_proposals = 1 << 20;
constexpr std::uint64_t most_rounds = 4096; ///< largest number of rounds in a batch
/// A batch should place at most this share of the unplaced discs, because later proposals of a
/// placed disc in the same batch are useless.
constexpr double most_placed_share = 0.25;

/// The largest number of discs that a batch should place. It is limited, because every rank tests
/// all of these discs, one after the other.
std::uint64_t most_found(std::uint64_t n_discs) {
    return std::max<std::uint64_t>(1024, n_discs / 1024);
}

} // namespace

std::uint64_t InsertionBatch::choose_rounds(std::uint64_t n_placed, std::uint64_t n_rounds,
                                            std::uint64_t n_left) const {
    if (n_left == 0) return 1;
    const double in_each = std::max(static_cast<double>(n_placed), 0.5) /
                           static_cast<double>(n_rounds);
    const auto left = static_cast<double>(n_left);
    const int n_ranks = communicator_.size();
    const double most = std::min(static_cast<double>(most_found(box_.n_discs())),
                                 most_placed_share * left);
    const double fitting = std::clamp(most / in_each, least_proposals * n_ranks / left,
                                      most_proposals * n_ranks / left);
    return std::min(
        {static_cast<std::uint64_t>(std::max(1.0, fitting)), 2 * n_rounds, most_rounds});
}

std::optional<std::uint64_t> InsertionBatch::judge(std::vector<std::uint32_t>& unplaced,
                                                   std::uint64_t n_left, std::uint64_t first_round,
                                                   std::uint64_t n_rounds) {
    box_.propose({unplaced, n_left, first_round, n_rounds}, {}, n_threads_, proposals_);
    find_free();
    find_rivals();
    gather_on_all(free_);
    gather_on_all(rivals_);
    std::vector<Notice> found = decide();
    if (found.empty()) return std::nullopt;
    const std::uint64_t last = found.back().round;
    take_out(found, unplaced);
    std::erase_if(found, [this](const Notice& notice) { return !box_.concerns_me(notice.x); });
    placed_.add(found);
    return last;
}

/// Removes the placed discs from the list of unplaced ones.
void InsertionBatch::take_out(std::vector<Notice> found, std::vector<std::uint32_t>& unplaced) {
    std::ranges::sort(found, {}, &Notice::id);
    const std::size_t n_marks = std::bit_ceil(64 * found.size());
    std::vector<std::uint8_t> may_be_found(n_marks, 0); // indexed by id modulo n_marks
    for (const Notice& notice : found) may_be_found[notice.id % n_marks] = 1;
    std::erase_if(unplaced, [&](std::uint32_t id) {
        return may_be_found[id % n_marks] != 0 &&
               std::ranges::binary_search(found, id, {}, &Notice::id);
    });
}

/// Lists the proposals in this rank's strip that overlap no placed disc and no fixed body.
void InsertionBatch::find_free() {
    free_.clear();
#pragma omp parallel num_threads(n_threads_)
    {
        constexpr std::size_t ahead = 24;
        std::vector<Notice> mine;
#pragma omp for schedule(dynamic, 4096) nowait
        for (std::size_t k = 0; k < proposals_.size(); ++k) {
            if (k + ahead < proposals_.size()) placed_.prefetch(proposals_[k + ahead]);
            if (box_.is_mine(proposals_[k]) && !placed_.overlaps(proposals_[k]))
                mine.push_back(proposals_[k]);
        }
#pragma omp critical
        free_.insert(free_.end(), mine.begin(), mine.end());
    }
}

/// Lists the proposals that overlap a free proposal of the same round with a higher id. They are
/// listed even if they are rejected themselves because they overlap other discs.
void InsertionBatch::find_rivals() {
    rivals_.clear();
    std::vector<Notice> images; // free proposals and their periodic images
    for (const Notice& notice : free_)
        box_.for_images(notice, [&](Point at) {
            images.push_back({at.x, at.y, notice.id, notice.round});
            return false;
        });
    if (images.empty()) return;
    PointGrid near = box_.grid(static_cast<double>(images.size()));
    near.add_rest(images, n_threads_);
    NearFew near_few(images.size(), box_.diameter());
    for (const Notice& image : images) near_few.add({image.x, image.y});
#pragma omp parallel num_threads(n_threads_)
    {
        std::vector<Rival> mine;
#pragma omp for schedule(dynamic, 4096) nowait
        for (std::size_t k = 0; k < proposals_.size(); ++k) {
            const Notice& one = proposals_[k];
            if (!near_few.may_be_near({one.x, one.y})) continue;
            near.any_near({one.x, one.y}, [&](std::uint32_t i) {
                const Notice& later = images[i];
                if (one.id < later.id && one.round == later.round &&
                    box_.overlaps(later.id, {later.x, later.y}, one))
                    mine.push_back({later.round, later.id, one.id});
                return false;
            });
        }
#pragma omp critical
        rivals_.insert(rivals_.end(), mine.begin(), mine.end());
    }
}

/// Replaces `items` on every rank by the items of all ranks. **Collective.**
template <class Item> void InsertionBatch::gather_on_all(std::vector<Item>& items) const {
    if (communicator_.size() == 1) return;
    items =
        send_to_owners(communicator_, std::vector<std::vector<Item>>(box_.n_ranks(), items)).items;
}

template <class Counts>
bool InsertionBatch::has_rival(const Notice& notice, const Counts& counts) const {
    auto rival = std::lower_bound(rivals_.begin(), rivals_.end(),
                                  Rival{notice.round, notice.id, 0});
    for (; rival != rivals_.end() && rival->round == notice.round && rival->id == notice.id;
         ++rival)
        if (counts(rival->earlier)) return true;
    return false;
}

/// Returns the proposals that place their disc, in order of round and id. Proposals that a disc
/// makes after its placement are ignored.
std::vector<Notice> InsertionBatch::decide() {
    std::sort(free_.begin(), free_.end(), [](const Notice& a, const Notice& b) {
        return std::tie(a.round, a.id) < std::tie(b.round, b.id);
    });
    std::sort(rivals_.begin(), rivals_.end());
    // The round in which each disc was placed; the key is its id
    std::unordered_map<std::uint32_t, std::uint32_t> round_of;
    std::vector<Notice> found;
    PointGrid near_found(0, box_.box().x, box_.box().y, box_.diameter(),
                         static_cast<double>(free_.size()));
    for (const Notice& notice : free_) {
        const auto proposes = [&](std::uint32_t id) {
            const auto at = round_of.find(id);
            return at == round_of.end() || at->second >= notice.round;
        };
        if (round_of.contains(notice.id) || has_rival(notice, proposes)) continue;
        const bool overlaps_found = box_.for_images(notice, [&](Point at) {
            return near_found.any_near(
                at, [&](std::uint32_t k) { return box_.overlaps(notice.id, at, found[k]); });
        });
        if (overlaps_found) continue;
        round_of.emplace(notice.id, notice.round);
        near_found.add({notice.x, notice.y});
        found.push_back(notice);
    }
    return found;
}

} // namespace carrom
