// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/random_insertion.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/stop_request.hpp"
#include "initial_state/insertion_box.hpp"
#include "initial_state/point_grid.hpp"
#include "initial_state/refused_places.hpp"
#include "parallel/exchange.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t most_idle_rounds =
    10000; ///< without a place for any disc, before all starts anew
constexpr std::uint64_t most_starts = 10;
constexpr DiscId copy_mark = DiscId{1}
                             << 63; ///< set in the id of a neighbour's disc among the placed discs

/// Places that are found in a batch of rounds, at most: all ranks hear of them, and one after the
/// other they are decided on each rank.
std::uint64_t most_found_at_once(std::uint64_t n_discs) {
    return std::max<std::uint64_t>(1024, n_discs / 1024);
}
constexpr double most_proposals = 1 << 20;     ///< of a rank in a batch
constexpr std::uint64_t most_rounds = 4096;    ///< in a batch
constexpr double most_placed_share = 0.25;      ///< of the discs without a place, in a batch
constexpr std::uint64_t least_placed_share = 4; ///< below a 4th placed in a round, most are refused

class Insertion {
public:
    Insertion(const Scene& scene, const Communicator& communicator, std::uint64_t start,
              int n_threads)
        : scene_(scene), communicator_(communicator), n_threads_(n_threads),
          box_(scene, communicator, start), placed_grid_(grid(box_.share())) {
        placed_.reserve(static_cast<std::size_t>(1.1 * box_.share()) + 100);
    }

    /// Returns the places, or nothing if the discs have jammed. **Collective.**
    std::optional<std::vector<InputDisc>> run() {
        std::vector<double> radii{scene_.radius};
        for (const Species& one : scene_.effects.species) radii.push_back(one.radius);
        std::sort(radii.begin(), radii.end(), std::greater<>());
        radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
        // The largest come first, because they find no room among smaller ones.
        for (std::size_t first = 0, end = 0; first < radii.size(); first = end) {
            while (end < radii.size() && is_placed_with(radii[end], radii[first], radii.size()))
                ++end;
            if (!place_all_of(radii[end - 1], radii[first])) return std::nullopt;
        }
        placed_.erase(std::remove_if(placed_.begin(), placed_.end(),
                                     [](const InputDisc& d) { return (d.id & copy_mark) != 0; }),
                      placed_.end());
        for (InputDisc& disc : placed_) std::tie(disc.x, disc.y) = turned(box_.axis(), disc.x, disc.y);
        return std::move(placed_);
    }

private:
    /// A few radii are placed one after the other. Many would need a round or more each, so those
    /// that differ little are placed together.
    static bool is_placed_with(double radius, double largest, std::size_t n_radii) {
        constexpr std::size_t few_radii = 8;
        return radius == largest || (n_radii > few_radii && radius > 0.9 * largest);
    }

    /// Returns false if the discs have jammed. **Collective.**
    bool place_all_of(double smallest, double largest) {
        const auto [first, last] = slab_of_rank(communicator_.rank(), scene_.n_discs,
                                                communicator_.size());
        for (std::uint64_t id = first; id < last; ++id)
            if (const double radius = box_.radius_of(id);
                radius >= smallest && radius <= largest)
                unplaced_.push_back(static_cast<std::uint32_t>(id));
        refused_places_.reset();
        is_batch_ = false;
        std::uint64_t n_left = n_unplaced(), n_idle = 0, n_rounds = 1;
        for (std::uint64_t round = 0; n_left > 0 && n_idle < most_idle_rounds;) {
            const std::uint64_t n_before = n_left;
            exchange(round, n_rounds);
            find_free();
            find_rivals();
            const std::uint64_t last_found = is_batch_ ? decide_together() : decide_by_strips();
            n_left = n_unplaced();
            n_idle = n_left < n_before ? n_rounds - 1 - last_found : n_idle + n_rounds;
            round += n_rounds;
            n_rounds = choose_rounds(n_before - n_left, n_rounds, n_left, smallest);
            n_rounds = std::clamp<std::uint64_t>(most_idle_rounds - n_idle, 1, n_rounds);
        }
        unplaced_.clear();
        return n_left == 0;
    }

    /// Returns how many rounds the next batch has. Many rounds at once take one exchange, and
    /// enough work for all threads. That pays once few proposals are left that are not refused.
    std::uint64_t choose_rounds(std::uint64_t n_placed, std::uint64_t n_rounds,
                                std::uint64_t n_left, double smallest) {
        if (!refused_places_ && n_placed < (n_placed + n_left) / least_placed_share) {
            refused_places_.emplace(box_.strip_low(), box_.strip_high(), box_.box().y, smallest,
                                    box_.share());
            for (const InputDisc& disc : placed_)
                refused_places_->add({disc.x, disc.y}, box_.radius_of(disc.id & ~copy_mark));
        }
        const std::uint64_t most_found = most_found_at_once(scene_.n_discs);
        is_batch_ = refused_places_ && n_placed <= most_found * n_rounds;
        if (!is_batch_ || n_left == 0) return 1;
        const double each = std::max(static_cast<double>(n_placed), 0.5) /
                            static_cast<double>(n_rounds);
        // Discs that find a place in the batch propose for the rest of it in vain, so only some do.
        const auto left = static_cast<double>(n_left);
        const double most = std::min(static_cast<double>(most_found), most_placed_share * left);
        const double fitting = std::min(most / each, most_proposals * communicator_.size() / left);
        return std::min(static_cast<std::uint64_t>(std::max(1.0, fitting)),
                        std::min(2 * n_rounds, most_rounds));
    }

    /// Over all ranks. Ends the start after a request to stop if it takes long. **Collective.**
    std::uint64_t n_unplaced() const {
        std::array<std::uint64_t, 2> sums = {unplaced_.size(), is_stop_overdue() ? 1u : 0u};
        communicator_.sum(sums);
        if (sums[1] > 0)
            throw StopRequested("stopped on request while discs are placed at random; nothing is "
                                "kept to go on from");
        return sums[0];
    }

    PointGrid grid(double n_points) const {
        return {box_.strip_low(), box_.strip_high(), box_.box().y, box_.diameter(), n_points};
    }
    /// Sends the proposals of `n_rounds` rounds, together with the last round's updates, to the
    /// ranks that they concern. **Collective.**
    void exchange(std::uint64_t first_round, std::uint64_t n_rounds) {
        const std::size_t n = unplaced_.size();
        std::vector<Notice> made(n * n_rounds);
#pragma omp parallel for num_threads(n_threads_) schedule(static)
        for (std::size_t k = 0; k < made.size(); ++k) {
            const std::uint32_t id = unplaced_[k % n];
            const Point place = box_.proposal(id, first_round + k / n);
            made[k] = {place.x, place.y, id, static_cast<std::uint32_t>(k / n)};
        }
        if (!is_batch_) unplaced_.clear(); // ranks that refuse them take them over
        if (communicator_.size() == 1) {
            proposals_ = std::move(made);
            return;
        }
        std::vector<std::vector<Notice>> out(box_.n_ranks());
        for (const Notice& updates : updates_)
            box_.visit_concerned(updates.x, [&](std::size_t k) {
                if (!box_.is_me(k)) out[k].push_back(updates);
            });
        updates_.clear();
        for (const Notice& one : made)
            box_.visit_concerned(one.x, [&](std::size_t k) { out[k].push_back(one); });
        proposals_ = send_to_owners(communicator_, out).items;
    }

    /// Lists the proposals in the own strip that overlap no placed disc.
    void find_free() {
        const auto first_proposal = std::partition(proposals_.begin(), proposals_.end(),
                                                   [](const Notice& n) { return n.is_placed(); });
        for (auto updates = proposals_.begin(); updates != first_proposal; ++updates)
            place({copy_mark | updates->id, updates->x, updates->y, 0, 0});
        proposals_.erase(proposals_.begin(), first_proposal);
        // The verdicts do not depend on the order. It serves memory: columns of cells
        // that are near in x are near in memory.
        if (!refused_places_)
            std::sort(proposals_.begin(), proposals_.end(),
                      [](const Notice& a, const Notice& b) { return a.x < b.x; });
        std::vector<std::uint8_t> is_free(proposals_.size());
#pragma omp parallel for num_threads(n_threads_) schedule(dynamic, 4096)
        for (std::size_t k = 0; k < proposals_.size(); ++k) {
            const Notice& notice = proposals_[k];
            is_free[k] = box_.is_me(box_.owner(notice.x)) &&
                         !(refused_places_ && refused_places_->holds({notice.x, notice.y})) &&
                         !overlaps_placed(notice);
        }
        free_.clear();
        for (std::size_t k = 0; k < proposals_.size(); ++k) {
            if (is_free[k])
                free_.push_back(proposals_[k]);
            else if (!is_batch_ && box_.is_me(box_.owner(proposals_[k].x)))
                unplaced_.push_back(proposals_[k].id);
        }
    }

    /// Lists what overlaps a free proposal in its round and has a lower id.
    void find_rivals() {
        rivals_.clear();
        std::vector<Notice> images; // those of free proposals, with themselves
        for (const Notice& notice : free_)
            box_.for_images(notice, [&](Point at) {
                images.push_back({at.x, at.y, notice.id, notice.round});
                return false;
            });
        if (images.empty()) return;
        PointGrid near = grid(static_cast<double>(images.size()));
        std::optional<NearFew> near_few;
        if (refused_places_) near_few.emplace(images.size(), box_.diameter());
        for (const Notice& image : images) {
            near.add({image.x, image.y});
            if (near_few) near_few->add({image.x, image.y});
        }
#pragma omp parallel num_threads(n_threads_)
        {
            std::vector<Rival> mine;
#pragma omp for schedule(dynamic, 4096)
            for (std::size_t k = 0; k < proposals_.size(); ++k) {
                const Notice& one = proposals_[k];
                if (near_few && !near_few->may_be_near({one.x, one.y})) continue;
                near.any_near({one.x, one.y}, [&](std::uint32_t i) {
                    const Notice& later = images[i];
                    if (one.id < later.id && one.round == later.round &&
                        box_.overlaps(later, one.id, one.x, one.y))
                        mine.push_back({later.round, later.id, one.id});
                    return false;
                });
            }
#pragma omp critical
            rivals_.insert(rivals_.end(), mine.begin(), mine.end());
        }
        std::sort(rivals_.begin(), rivals_.end());
    }

    static bool has_rival(const std::vector<Rival>& rivals, const Notice& notice, auto counts) {
        auto rival = std::lower_bound(rivals.begin(), rivals.end(),
                                      Rival{notice.round, notice.id, 0});
        for (; rival != rivals.end() && rival->round == notice.round && rival->id == notice.id;
             ++rival)
            if (counts(rival->earlier)) return true;
        return false;
    }

    /// Decides a single round, in which all discs without a place have proposed. So no rank has to
    /// know what others decide. Returns the last round in which a place was found.
    std::uint64_t decide_by_strips() {
        for (const Notice& notice : free_) {
            if (has_rival(rivals_, notice, [](std::uint32_t) { return true; })) {
                unplaced_.push_back(notice.id);
                continue;
            }
            place({notice.id, notice.x, notice.y, 0, 0});
            if (communicator_.size() > 1) note_updates(notice);
        }
        return 0;
    }

    /// Decides several rounds, on all ranks alike: a disc that has found its place makes no more
    /// proposals, wherever they are. Returns the last round in which a place was found.
    /// **Collective.**
    std::uint64_t decide_together() {
        const auto from_all = [this]<class Item>(std::vector<Item>& items) {
            if (communicator_.size() > 1)
                items = send_to_owners(communicator_,
                                       std::vector<std::vector<Item>>(box_.n_ranks(), items))
                            .items;
        };
        from_all(free_);
        from_all(rivals_);
        std::sort(free_.begin(), free_.end(), [](const Notice& a, const Notice& b) {
            return std::tie(a.round, a.id) < std::tie(b.round, b.id);
        });
        std::sort(rivals_.begin(), rivals_.end());
        std::unordered_map<std::uint32_t, std::uint32_t> found; // rounds by id
        std::vector<Notice> taken;
        PointGrid near_taken(0, box_.box().x, box_.box().y, box_.diameter(),
                             static_cast<double>(free_.size()));
        for (const Notice& notice : free_) {
            const auto still_proposes = [&](std::uint32_t id) {
                const auto at = found.find(id);
                return at == found.end() || at->second >= notice.round;
            };
            if (found.contains(notice.id) || has_rival(rivals_, notice, still_proposes)) continue;
            const bool overlaps_taken = box_.for_images(notice, [&](Point at) {
                const Notice image{at.x, at.y, notice.id, notice.round};
                return near_taken.any_near(at, [&](std::uint32_t k) {
                    return box_.overlaps(image, taken[k].id, taken[k].x, taken[k].y);
                });
            });
            if (overlaps_taken) continue;
            found.emplace(notice.id, notice.round);
            near_taken.add({notice.x, notice.y});
            taken.push_back(notice);
        }
        for (const Notice& notice : taken)
            if (box_.is_me(box_.owner(notice.x)))
                place({notice.id, notice.x, notice.y, 0, 0});
            else if (box_.concerns_me(notice.x))
                place({copy_mark | notice.id, notice.x, notice.y, 0, 0});
        std::erase_if(unplaced_, [&](std::uint32_t id) { return found.contains(id); });
        return taken.empty() ? 0 : taken.back().round;
    }

    bool overlaps_placed(const Notice& notice) const {
        if (box_.overlaps_obstacle(notice)) return true;
        return box_.for_images(notice, [&](Point at) {
            const Notice image{at.x, at.y, notice.id, notice.round};
            return placed_grid_.any_near(at, [&](std::uint32_t k) {
                return box_.overlaps(image, placed_[k].id & ~copy_mark, placed_[k].x, placed_[k].y);
            });
        });
    }

    void place(const InputDisc& disc) {
        placed_grid_.add({disc.x, disc.y});
        placed_.push_back(disc);
        if (refused_places_)
            refused_places_->add({disc.x, disc.y}, box_.radius_of(disc.id & ~copy_mark));
    }

    void note_updates(Notice notice) {
        std::size_t n_concerned = 0;
        box_.visit_concerned(notice.x, [&n_concerned](std::size_t) { ++n_concerned; });
        if (n_concerned == 1) return;
        notice.round = Notice::placed;
        updates_.push_back(notice);
    }

    const Scene& scene_;
    const Communicator& communicator_;
    int n_threads_;
    InsertionBox box_;
    PointGrid placed_grid_;
    std::optional<RefusedPlaces> refused_places_; ///< once most proposals are refused
    bool is_batch_ = false; ///< discs without a place stay on their rank; all ranks decide
    std::vector<InputDisc>
        placed_; ///< own discs and, with the mark, those within a diameter of the strip
    std::vector<std::uint32_t> unplaced_; ///< discs whose last proposal was rejected here
    std::vector<Notice> proposals_, updates_;
    std::vector<Notice> free_;  ///< proposals that overlap no placed disc
    std::vector<Rival> rivals_; ///< of these
};

} // namespace

std::vector<InputDisc> insert_at_random(const Scene& scene, const Communicator& communicator,
                                        int n_threads) {
    for (std::uint64_t start = 0; start < most_starts; ++start)
        if (auto discs = Insertion(scene, communicator, start, n_threads).run()) return std::move(*discs);
    const std::string remedy = scene.effects.obstacles.are_any()
                                   ? "leave more room beside the obstacles"
                                   : "set discs.generator to \"lattice\"";
    throw InputError({{scene.name, 0,
                       fmt::format("random insertion of {} discs (packing {:.4g}) found no "
                                   "arrangement in {} tries; {}, or "
                                   "set another discs.seed",
                                   scene.n_discs, scene.packing(), most_starts, remedy)}});
}

} // namespace carrom
