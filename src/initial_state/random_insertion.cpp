// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/random_insertion.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/random_numbers.hpp"
#include "core/stop_request.hpp"
#include "dynamics/obstacles.hpp"
#include "initial_state/point_grid.hpp"
#include "lattices/lattice.hpp"
#include "parallel/exchange.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t most_idle_rounds =
    10000; ///< without a place for any disc, before all starts anew
constexpr std::uint64_t most_starts = 10;
constexpr DiscId copy_mark = DiscId{1}
                             << 63; ///< set in the id of a neighbour's disc among the placed discs

/// A proposal, or the update of a place taken near a strip's edge.
struct Notice {
    double x = 0, y = 0;
    std::uint32_t id = 0;
    std::uint32_t is_placed = 0;
};

/// Works in a box that lies down: x is along the longer side, which strips cut.
class Insertion {
public:
    Insertion(const SceneParameters& scene, const Communicator& communicator, std::uint64_t start)
        : scene_(scene), communicator_(communicator), start_(start), diameter_(2 * scene.radius),
          species_(scene.effects.species, scene.radius), axis_(longer_axis(scene.box)),
          box_(scene.box.longest(), scene.box.shortest()),
          periods_(lying(scene.effects.periods(scene.box))), placed_grid_(grid()),
          proposal_grid_(grid()) {
        if (scene.effects.obstacles.are_any())
            obstacles_.emplace(scene.box, scene.radius, scene.effects);
        placed_.reserve(static_cast<std::size_t>(1.1 * share()) + 100);
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
        for (InputDisc& disc : placed_) std::tie(disc.x, disc.y) = turned(axis_, disc.x, disc.y);
        return std::move(placed_);
    }

private:
    Periods lying(const Periods& periods) const {
        const auto [x, y] = turned(axis_, periods.x, periods.y);
        return {x, y};
    }

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
            if (const double radius = species_.of(id).radius;
                radius >= smallest && radius <= largest)
                unplaced_.push_back(static_cast<std::uint32_t>(id));
        std::uint64_t n_left = n_unplaced(), idle_rounds = 0;
        for (std::uint64_t round = 0; n_left > 0 && idle_rounds < most_idle_rounds; ++round) {
            exchange(round);
            judge();
            const std::uint64_t n_before = std::exchange(n_left, n_unplaced());
            idle_rounds = n_left < n_before ? 0 : idle_rounds + 1;
        }
        return n_left == 0;
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

    double share() const { return static_cast<double>(scene_.n_discs) / communicator_.size(); }

    PointGrid grid() const {
        const double strip = box_.x / communicator_.size();
        const double low = strip * communicator_.rank() - margin(),
                     high = strip * (communicator_.rank() + 1) + margin();
        return {low, high, box_.y, diameter_, share()};
    }

    double margin() const { return diameter_ * (1 + 1e-9); }

    std::size_t owner(double x) const {
        const double strip = x / box_.x * communicator_.size();
        return static_cast<std::size_t>(
            std::clamp(static_cast<int>(strip), 0, communicator_.size() - 1));
    }

    Point proposal(DiscId id, std::uint64_t round) const {
        const auto words = random_words(scene_.seed, Purpose::position, id, round, start_);
        const double radius = species_.of(id).radius;
        const auto place = [radius](double period, double length, double number) {
            const double low = period == 0 ? radius : 0,
                         high = period == 0 ? length - radius : period;
            return std::min(low + (high - low) * number, high);
        };
        return {place(periods_.x, box_.x, unit_number(words[0])),
                place(periods_.y, box_.y, unit_number(words[1]))};
    }

    /// Calls `visit(rank)` for each rank whose strip is within the margin of `x` or one of its
    /// images.
    template <class Visit> void visit_concerned(double x, const Visit& visit) const {
        const std::size_t first = owner(x - margin()), last = owner(x + margin());
        for (std::size_t k = first; k <= last; ++k) visit(k);
        if (periods_.x == 0) return;
        if (x < margin())
            for (std::size_t k = std::max(last + 1, owner(x + periods_.x - margin()));
                 k < n_ranks(); ++k)
                visit(k);
        if (x > periods_.x - margin())
            for (std::size_t k = 0; k < first && k <= owner(x - periods_.x + margin()); ++k)
                visit(k);
    }
    std::size_t n_ranks() const { return static_cast<std::size_t>(communicator_.size()); }

    /// Sends the round's proposals, together with the last round's updates, to the
    /// ranks that they concern. **Collective.**
    void exchange(std::uint64_t round) {
        std::vector<std::vector<Notice>> out(static_cast<std::size_t>(communicator_.size()));
        const auto me = static_cast<std::size_t>(communicator_.rank());
        if (out.size() == 1) out[0].reserve(unplaced_.size());
        for (const Notice& updates : updates_)
            visit_concerned(updates.x, [&](std::size_t k) {
                if (k != me) out[k].push_back(updates);
            });
        updates_.clear();
        for (const std::uint32_t id : unplaced_) {
            const Point place = proposal(id, round);
            visit_concerned(place.x,
                            [&](std::size_t k) { out[k].push_back({place.x, place.y, id, 0}); });
        }
        proposals_ = out.size() == 1 ? std::move(out[0]) : send_to_owners(communicator_, out).items;
        unplaced_.clear();
    }

    void judge() {
        const auto first_proposal = std::partition(proposals_.begin(), proposals_.end(),
                                                   [](const Notice& n) { return n.is_placed; });
        for (auto updates = proposals_.begin(); updates != first_proposal; ++updates)
            place({copy_mark | updates->id, updates->x, updates->y, 0, 0});
        proposals_.erase(proposals_.begin(), first_proposal);
        // The verdicts do not depend on the order. It serves memory: columns of cells
        // that are near in x are near in memory.
        std::sort(proposals_.begin(), proposals_.end(),
                  [](const Notice& a, const Notice& b) { return a.x < b.x; });
        for (const Notice& notice : proposals_) proposal_grid_.add({notice.x, notice.y});
        for (const Notice& notice : proposals_) {
            if (owner(notice.x) != static_cast<std::size_t>(communicator_.rank())) continue;
            if (is_refused(notice)) {
                unplaced_.push_back(notice.id);
            } else {
                place({notice.id, notice.x, notice.y, 0, 0});
                if (communicator_.size() > 1) note_updates(notice);
            }
        }
        proposal_grid_.clear(proposals_);
    }

    /// Whether discs accepted earlier in this round are seen here makes no difference: they have
    /// lower ids and overlap, or they do not overlap.
    bool is_refused(const Notice& notice) const {
        const auto [x, y] = turned(axis_, notice.x, notice.y);
        if (obstacles_ &&
            obstacles_->deepest_overlap(x, y, species_.of(notice.id).radius, 0).body !=
                ObstacleContact::no_body)
            return true;
        if (is_refused_at({notice.x, notice.y}, notice)) return true;
        if (!periods_.are_any()) return false;
        // Discs across a seam are near its images. A grid files places beyond its ends
        // in its last cells.
        for (const double dx : {-periods_.x, 0.0, periods_.x}) {
            for (const double dy : {-periods_.y, 0.0, periods_.y}) {
                const Point image{notice.x + dx, notice.y + dy};
                const bool is_near = image.x > -margin() && image.x < box_.x + margin() &&
                                     image.y > -margin() && image.y < box_.y + margin();
                if ((dx != 0 || dy != 0) && is_near && is_refused_at(image, notice)) return true;
            }
        }
        return false;
    }

    bool is_refused_at(Point at, Notice notice) const {
        notice.x = at.x;
        notice.y = at.y;
        return placed_grid_.any_near(at, [&](std::uint32_t k) {
            return overlaps(notice, placed_[k].id & ~copy_mark, placed_[k].x, placed_[k].y);
        }) || proposal_grid_.any_near(at, [&](std::uint32_t k) {
            return proposals_[k].id < notice.id &&
                   overlaps(notice, proposals_[k].id, proposals_[k].x, proposals_[k].y);
        });
    }

    bool overlaps(const Notice& a, DiscId other, double x, double y) const {
        const double dx = x - a.x, dy = y - a.y,
                     distance = species_.of(a.id).radius + species_.of(other).radius;
        return dx * dx + dy * dy < distance * distance;
    }

    void place(const InputDisc& disc) {
        placed_grid_.add({disc.x, disc.y});
        placed_.push_back(disc);
    }

    void note_updates(Notice notice) {
        std::size_t n_concerned = 0;
        visit_concerned(notice.x, [&n_concerned](std::size_t) { ++n_concerned; });
        if (n_concerned == 1) return;
        notice.is_placed = 1;
        updates_.push_back(notice);
    }

    const SceneParameters& scene_;
    std::optional<Obstacles> obstacles_;
    const Communicator& communicator_;
    std::uint64_t start_;
    double diameter_; ///< the largest discs'
    SpeciesTable species_;
    Axis axis_;
    Box box_;
    Periods periods_;
    PointGrid placed_grid_, proposal_grid_;
    std::vector<InputDisc>
        placed_; ///< own discs and, with the mark, those within a diameter of the strip
    std::vector<std::uint32_t> unplaced_; ///< discs whose last proposal was rejected here
    std::vector<Notice> proposals_, updates_;
};

} // namespace

std::vector<InputDisc> insert_at_random(const SceneParameters& scene,
                                        const Communicator& communicator) {
    for (std::uint64_t start = 0; start < most_starts; ++start)
        if (auto discs = Insertion(scene, communicator, start).run()) return std::move(*discs);
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
