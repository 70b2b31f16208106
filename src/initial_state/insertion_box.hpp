// SPDX-License-Identifier: BSD-3-Clause
// The box of random insertion: how positions are proposed, which discs overlap, which ranks need a
// position. Its x axis is along the box's longer side, which is cut into one strip a rank.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>

#include "core/axis.hpp"
#include "core/random_numbers.hpp"
#include "core/raw_vector.hpp"
#include "dynamics/fixed_bodies.hpp"
#include "dynamics/species.hpp"
#include "initial_state/point_grid.hpp"
#include "lattices/lattice.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"
#include "scene/start_region.hpp"

namespace carrom {

/// A proposed position, or the final position of a disc.
struct Notice {
    static constexpr std::uint32_t placed = 0xffffffff;

    double x = 0, y = 0;
    std::uint32_t id = 0;
    std::uint32_t round = 0; ///< number of the round in the batch, or `placed`

    bool is_placed() const { return round == placed; }
};

/// The discs that still need a position, and the rounds in which they propose one.
struct Proposers {
    std::span<const std::uint32_t> ids; ///< lists of different ranks have no common id
    std::uint64_t n_of_all = 0;         ///< number of these discs on all ranks
    std::uint64_t first_round = 0, n_rounds = 1;
};

class InsertionBox {
public:
    InsertionBox(const SceneParameters& scene, const Communicator& communicator,
                 std::uint64_t start)
        : scene_(scene), communicator_(communicator), start_(start), diameter_(2 * scene.radius),
          species_(scene.effects.species, scene.radius), axis_(longer_axis(scene.box)),
          box_(scene.box.longest(), scene.box.shortest()),
          periods_(lying(scene.effects.periods(scene.box))), has_regions_(has_regions(scene)),
          fixed_bodies_(scene.box, scene.radius, scene.effects) {}

    double diameter() const { return diameter_; } ///< diameter of the largest disc
    std::uint64_t n_discs() const { return scene_.n_discs; }
    double radius_of(DiscId id) const { return species_.of(id).radius; }
    const Box& box() const { return box_; }
    Axis axis() const { return axis_; }
    /// Mean number of discs per rank.
    double share() const { return static_cast<double>(scene_.n_discs) / communicator_.size(); }

    double strip_low() const {
        return box_.x / communicator_.size() * communicator_.rank() - margin();
    }
    double strip_high() const {
        return box_.x / communicator_.size() * (communicator_.rank() + 1) + margin();
    }

    /// Makes a grid over this rank's strip and its margins, for about `n_points` points.
    PointGrid grid(double n_points) const {
        return {strip_low(), strip_high(), box_.y, diameter_, n_points};
    }
    /// Distance between two centres beyond which discs of any radius in the scene cannot overlap.
    double margin() const { return diameter_ * (1 + 1e-9); }

    std::size_t owner(double x) const {
        const double strip = x / box_.x * communicator_.size();
        return static_cast<std::size_t>(
            std::clamp(static_cast<int>(strip), 0, communicator_.size() - 1));
    }

    Point proposal(DiscId id, std::uint64_t round) const {
        const auto words = random_words(scene_.seed, Purpose::position, id, round, start_);
        const double radius = species_.of(id).radius;
        if (const auto region = has_regions_ ? region_of(scene_, id) : std::nullopt)
            return place_in(*region, radius, {unit_number(words[0]), unit_number(words[1])});
        const auto place = [radius](double period, double length, double number) {
            const double low = period == 0 ? radius : 0,
                         high = period == 0 ? length - radius : period;
            return std::min(low + (high - low) * number, high);
        };
        return {place(periods_.x, box_.x, unit_number(words[0])),
                place(periods_.y, box_.y, unit_number(words[1]))};
    }

    /// Calls `visit(rank)` for each rank whose strip is within margin() of `x`, or of one of the
    /// periodic images of `x`.
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

    bool is_mine(const Notice& notice) const { return is_me(owner(notice.x)); }
    bool concerns_me(double x) const {
        bool does = false;
        visit_concerned(x, [&](std::size_t k) { does = does || is_me(k); });
        return does;
    }
    bool is_me(std::size_t rank) const {
        return rank == static_cast<std::size_t>(communicator_.rank());
    }

    bool overlaps_fixed_body(const Notice& notice) const {
        if (!fixed_bodies_.are_any()) return false;
        const auto [x, y] = turned(axis_, notice.x, notice.y);
        return fixed_bodies_.do_overlap(x, y, radius_of(notice.id));
    }

    /// Whether the disc is placed by random insertion; groups may have other generators.
    bool is_random(DiscId id) const {
        DiscId end = 0;
        for (const DiscGroup& group : scene_.groups)
            if (id < (end += group.count)) return group.generator == Generator::random;
        return true;
    }

    /// Returns those `given` discs, of all ranks, that this rank's strip needs. **Collective.**
    std::vector<Notice> gather(const std::vector<InputDisc>& given) const;

    /// Each rank makes its proposals. Fills `concerning` with the proposals of all ranks that this
    /// rank needs, and with those `updates` of other ranks that it needs. **Collective.**
    void propose(const Proposers& proposers, std::span<const Notice> updates, int n_threads,
                 RawVector<Notice>& concerning) const;

    /// Calls `visit(place)` for the position of a notice and for each of its images near the box,
    /// and stops once `visit` returns true. Grids assign images outside of them to their outermost
    /// cells.
    template <class Visit> bool for_images(const Notice& notice, const Visit& visit) const {
        if (visit(Point{notice.x, notice.y})) return true;
        if (!periods_.are_any()) return false;
        for (const double dx : {-periods_.x, 0.0, periods_.x}) {
            for (const double dy : {-periods_.y, 0.0, periods_.y}) {
                const Point image{notice.x + dx, notice.y + dy};
                const bool is_near = image.x > -margin() && image.x < box_.x + margin() &&
                                     image.y > -margin() && image.y < box_.y + margin();
                if ((dx != 0 || dy != 0) && is_near && visit(image)) return true;
            }
        }
        return false;
    }

    /// Whether disc `id` with its centre at `at` overlaps the disc of `other`.
    bool overlaps(DiscId id, Point at, const Notice& other) const {
        const double dx = other.x - at.x, dy = other.y - at.y,
                     distance = species_.of(id).radius + species_.of(other.id).radius;
        return dx * dx + dy * dy < distance * distance;
    }

private:
    /// The position of a disc in a region, from two random numbers between 0 and 1. Along an axis
    /// on which the region covers a whole period, discs may lie across its ends.
    Point place_in(const StartRegion& region, double radius, Point numbers) const {
        const auto [x_low, y_low] = turned(axis_, region.x_low, region.y_low);
        const auto [x_high, y_high] = turned(axis_, region.x_high, region.y_high);
        const auto place = [radius](double low, double high, double period, double number) {
            const double inset = period != 0 && high - low == period ? 0 : radius;
            return std::min((low + inset) + ((high - inset) - (low + inset)) * number,
                            high - inset);
        };
        return {place(x_low, x_high, periods_.x, numbers.x),
                place(y_low, y_high, periods_.y, numbers.y)};
    }
    void make_proposals(const Proposers& proposers, std::uint64_t first, std::uint64_t end,
                        int n_threads, RawVector<Notice>& made) const;
    void deliver(std::span<const Notice> notices, std::span<const Notice> updates, int n_threads,
                 RawVector<Notice>& concerning) const;
    Periods lying(const Periods& periods) const {
        const auto [x, y] = turned(axis_, periods.x, periods.y);
        return {x, y};
    }

    const SceneParameters& scene_;
    const Communicator& communicator_;
    std::uint64_t start_;
    double diameter_;
    SpeciesTable species_;
    Axis axis_;
    Box box_;
    Periods periods_;
    bool has_regions_;
    FixedBodies fixed_bodies_;
};

} // namespace carrom
