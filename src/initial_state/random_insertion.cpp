// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/random_insertion.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/stop_request.hpp"
#include "initial_state/insertion_batch.hpp"
#include "initial_state/insertion_box.hpp"
#include "initial_state/placed_discs.hpp"
#include "initial_state/point_grid.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

/// Insertion starts again after this many successive rounds that place no disc
constexpr std::uint64_t most_idle_rounds = 10000;
constexpr std::uint64_t most_starts = 10;

/// While a larger share of proposals is accepted, ranks exchange proposals in every round.
constexpr double most_placed_in_batches = 0.25;

class Insertion {
public:
    Insertion(const SceneParameters& scene, const Communicator& communicator, std::uint64_t start,
              int n_threads, const std::vector<InputDisc>& given)
        : scene_(scene), communicator_(communicator), n_threads_(n_threads),
          box_(scene, communicator, start), placed_(box_, n_threads) {
        if (!scene.groups.empty()) placed_.add(box_.gather(given));
    }

    /// Returns the placed discs, or nothing if insertion has jammed. **Collective.**
    std::optional<std::vector<InputDisc>> run() {
        std::vector<double> radii{scene_.radius};
        for (const Species& one : scene_.effects.species) radii.push_back(one.radius);
        std::sort(radii.begin(), radii.end(), std::greater<>());
        radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
        // The largest discs are placed first, because few gaps between smaller discs can hold them.
        for (std::size_t first = 0, end = 0; first < radii.size(); first = end) {
            while (end < radii.size() && is_placed_with(radii[end], radii[first], radii.size()))
                ++end;
            if (!place_all_of(radii[end - 1], radii[first])) return std::nullopt;
        }
        return placed_.take_own();
    }

private:
    /// Whether discs of `radius` are placed together with those of radius `largest`. If there are
    /// few radii, each is placed separately; many are grouped, because each group needs at least
    /// one round.
    static bool is_placed_with(double radius, double largest, std::size_t n_radii) {
        constexpr std::size_t few_radii = 8;
        return radius == largest || (n_radii > few_radii && radius > 0.9 * largest);
    }

    /// Places the discs with radii in [smallest, largest]; false if insertion jams. **Collective.**
    bool place_all_of(double smallest, double largest) {
        const auto [first, last] = slab_of_rank(communicator_.rank(), scene_.n_discs,
                                                communicator_.size());
        for (std::uint64_t id = first; id < last; ++id)
            if (const double radius = box_.radius_of(id);
                radius >= smallest && radius <= largest && box_.is_random(id))
                unplaced_.push_back(static_cast<std::uint32_t>(id));
        placed_.forget_map();
        Rounds rounds;
        rounds.n_left = n_unplaced();
        judge_one_by_one(rounds);
        judge_in_batches(rounds, smallest);
        unplaced_.clear();
        return rounds.n_left == 0;
    }

    struct Rounds {
        /// Number of the next round, and number of rounds since the last round that placed a disc
        std::uint64_t next = 0, n_idle = 0;
        std::uint64_t n_left = 0; ///< unplaced discs on all ranks

        bool are_over() const { return n_left == 0 || n_idle >= most_idle_rounds; }
    };

    /// Runs single rounds while each places at least 25 % of the unplaced discs. **Collective.**
    void judge_one_by_one(Rounds& rounds) {
        proposal_grid_.emplace(box_.grid(box_.share()));
        for (double share_placed = 1;
             !rounds.are_over() && share_placed >= most_placed_in_batches;) {
            propose({unplaced_, rounds.n_left, rounds.next++});
            judge();
            const std::uint64_t n_before = std::exchange(rounds.n_left, n_unplaced());
            const std::uint64_t n_placed = n_before - rounds.n_left;
            rounds.n_idle = n_placed > 0 ? 0 : rounds.n_idle + 1;
            share_placed = static_cast<double>(n_placed) / static_cast<double>(n_before);
        }
        proposal_grid_.reset();
        propose({}); // no proposals; sends the last updates
        RawVector<Notice>().swap(proposals_);
    }

    /// Runs many rounds together. They need only one exchange, and give all threads enough work.
    /// **Collective.**
    void judge_in_batches(Rounds& rounds, double smallest) {
        if (rounds.are_over()) return;
        placed_.map_refused(smallest);
        InsertionBatch batch(box_, communicator_, n_threads_, placed_);
        std::uint64_t n_rounds = 1;
        while (!rounds.are_over()) {
            const auto last_found = batch.judge(unplaced_, rounds.n_left, rounds.next, n_rounds);
            rounds.next += n_rounds;
            rounds.n_idle = last_found ? n_rounds - 1 - *last_found : rounds.n_idle + n_rounds;
            const std::uint64_t n_before = std::exchange(rounds.n_left, n_unplaced());
            n_rounds = batch.choose_rounds(n_before - rounds.n_left, n_rounds, rounds.n_left);
            n_rounds = std::clamp<std::uint64_t>(most_idle_rounds - rounds.n_idle, 1, n_rounds);
        }
    }

    /// The number of unplaced discs on all ranks. Throws StopRequested if a requested stop is
    /// overdue. **Collective.**
    std::uint64_t n_unplaced() const {
        std::array<std::uint64_t, 2> sums = {unplaced_.size(), is_stop_overdue() ? 1u : 0u};
        communicator_.sum(sums);
        if (sums[1] > 0)
            throw StopRequested("stopped on request while discs are placed at random; nothing is "
                                "kept to go on from");
        return sums[0];
    }

    /// Sends proposals, together with the last round's updates, to the ranks that need them.
    /// **Collective.**
    void propose(const Proposers& proposers) {
        box_.propose(proposers, updates_, n_threads_, proposals_);
        updates_.clear();
        const auto first_update = std::partition(proposals_.begin(), proposals_.end(),
                                                 [](const Notice& n) { return !n.is_placed(); });
        placed_.add({first_update, proposals_.end()});
        proposals_.erase(first_update, proposals_.end());
    }

    /// Accepts or rejects the proposals of a round. Each thread first sorts its share of them by
    /// x, because neighbouring columns of cells are close in memory. The order does not affect the
    /// result.
    void judge() {
        const auto n_shares = static_cast<std::size_t>(n_threads_);
        std::vector<std::vector<std::uint32_t>> refused(n_shares);
        std::vector<std::span<const Notice>> found(n_shares);
        const auto share_of = [&](std::size_t k) {
            const auto [first, last] = slab_of_rank(static_cast<int>(k), proposals_.size(),
                                                    n_threads_);
            return std::span(proposals_).subspan(first, last - first);
        };
#pragma omp parallel for num_threads(n_threads_) schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) std::ranges::sort(share_of(k), {}, &Notice::x);
        proposal_grid_->add_rest(proposals_, n_threads_);
#pragma omp parallel for num_threads(n_threads_) schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            for (Notice& notice : share_of(k)) {
                if (!box_.is_mine(notice)) continue;
                if (placed_.overlaps(notice) || overlaps_earlier(notice))
                    refused[k].push_back(notice.id);
                else
                    notice.round = Notice::placed; // safe, because no other thread reads it
            }
        }
        proposal_grid_->clear(proposals_, n_threads_);
#pragma omp parallel for num_threads(n_threads_) schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            const std::span<Notice> share = share_of(k);
            found[k] = {share.begin(),
                        std::partition(share.begin(), share.end(),
                                       [](const Notice& n) { return n.is_placed(); })};
        }
        unplaced_.clear();
        for (std::size_t k = 0; k < n_shares; ++k) {
            unplaced_.insert(unplaced_.end(), refused[k].begin(), refused[k].end());
            placed_.add(found[k]);
            if (communicator_.size() > 1) record_updates(found[k]);
        }
    }

    /// Whether another proposal of the round, with a lower id, overlaps this one.
    bool overlaps_earlier(const Notice& notice) const {
        return box_.for_images(notice, [&](Point at) {
            return proposal_grid_->any_near(at, [&](std::uint32_t k) {
                return proposals_[k].id < notice.id && box_.overlaps(notice.id, at, proposals_[k]);
            });
        });
    }

    /// Appends to `updates_` those placed discs that other ranks also need.
    void record_updates(std::span<const Notice> found) {
        for (const Notice& notice : found) {
            std::size_t n_concerned = 0;
            box_.visit_concerned(notice.x, [&n_concerned](std::size_t) { ++n_concerned; });
            if (n_concerned > 1) updates_.push_back(notice);
        }
    }

    const SceneParameters& scene_;
    const Communicator& communicator_;
    int n_threads_;
    InsertionBox box_;
    PlacedDiscs placed_;
    /// Grid of the proposals of a round; empty when rounds run in batches
    std::optional<PointGrid> proposal_grid_;
    std::vector<std::uint32_t> unplaced_; ///< ids of this rank's discs without a position
    RawVector<Notice> proposals_;
    std::vector<Notice> updates_; ///< discs placed in the previous round that other ranks also need
};

} // namespace

std::vector<InputDisc> insert_at_random(const SceneParameters& scene,
                                        const Communicator& communicator, int n_threads,
                                        const std::vector<InputDisc>& given) {
    for (std::uint64_t start = 0; start < most_starts; ++start)
        if (auto discs = Insertion(scene, communicator, start, n_threads, given).run())
            return std::move(*discs);
    const std::string remedy = scene.effects.fixed_bodies.are_any()
                                   ? "leave more room beside the obstacles"
                               : !scene.groups.empty()
                                   ? "leave more room in the regions of groups of random discs"
                                   : "set discs.generator to \"lattice\"";
    throw InputError({{scene.name, 0,
                       fmt::format("random insertion of {} discs (packing {:.4g}) found no "
                                   "arrangement in {} tries; {}, or "
                                   "set another discs.seed",
                                   scene.n_discs, scene.packing(), most_starts, remedy)}});
}

} // namespace carrom
