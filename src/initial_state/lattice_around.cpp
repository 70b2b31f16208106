// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/lattice_around.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "dynamics/fixed_bodies.hpp"
#include "lattices/lattice.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

constexpr double per_row = 0.8660254037844386; ///< ratio of row height to spacing a: sqrt(3) / 2

/// The free sites of a lattice of m rows.
class FreeSites {
public:
    FreeSites(const SceneParameters& scene, std::uint64_t n_rows, const Communicator& ranks)
        : box_(scene.box), is_periodic_x_(scene.effects.is_periodic_x()),
          is_periodic_y_(scene.effects.is_periodic_y()), rows_(n_rows),
          height_(box_.y / (static_cast<double>(n_rows) + (is_periodic_y_ ? 0 : 2 * beside()))),
          y0_(is_periodic_y_ ? 0 : height_ / (2 * per_row)),
          columns_(static_cast<std::uint64_t>(box_.x * per_row / height_)),
          width_(box_.x / static_cast<double>(columns_)),
          // Half the spacing, minus 2^-30 of it, because positions are rounded.
          clearance_(height_ / (2 * per_row) * (1 - 0x1p-30)),
          fixed_bodies_(box_, clearance_, scene.effects),
          own_(slab_of_rank(ranks.rank(), n_rows, ranks.size())), free_in_rows_(n_rows) {
        for (std::uint64_t row = own_.begin; row < own_.end; ++row)
            for (std::uint64_t column = 0; column < columns_; ++column)
                free_in_rows_[row] += is_free(site(row, column)) ? 1 : 0;
        ranks.sum(free_in_rows_);
    }

    std::uint64_t number() const {
        return std::accumulate(free_in_rows_.begin(), free_in_rows_.end(), std::uint64_t{0});
    }
    double clearance() const { return clearance_; }

    /// Calls do_one(k, place) for each free site in the rank's rows; k numbers the free sites of
    /// all ranks.
    template <class DoOne> void visit(const DoOne& do_one) const {
        const auto first = free_in_rows_.begin();
        std::uint64_t k = std::accumulate(first, first + static_cast<std::ptrdiff_t>(own_.begin),
                                          std::uint64_t{0});
        for (std::uint64_t row = own_.begin; row < own_.end; ++row)
            for (std::uint64_t column = 0; column < columns_; ++column)
                if (const Point place = site(row, column); is_free(place)) do_one(k++, place);
    }

private:
    /// Additional height at each of two walls, in row heights: m rows between walls fill m + 2
    /// beside() row heights, because the outer rows are half a spacing from the walls.
    static double beside() { return 0.5 / per_row - 0.5; }

    Point site(std::uint64_t row, std::uint64_t column) const {
        const double shift = row % 2 == 0 ? 0.5 : is_periodic_x_ ? 0 : 1;
        return {(static_cast<double>(column) + shift) * width_,
                y0_ + static_cast<double>(row) * height_};
    }
    bool is_free(const Point& site) const {
        const auto is_inside = [this](double place, double edge) {
            return place >= clearance_ && place <= edge - clearance_;
        };
        return (is_periodic_x_ || is_inside(site.x, box_.x)) &&
               (is_periodic_y_ || is_inside(site.y, box_.y)) &&
               !fixed_bodies_.do_overlap(site.x, site.y, clearance_);
    }

    Box box_;
    bool is_periodic_x_, is_periodic_y_;
    std::uint64_t rows_;
    double height_, y0_; ///< height of a row, and y of the first row
    std::uint64_t columns_;
    double width_, clearance_;
    FixedBodies fixed_bodies_;
    Slab own_;
    std::vector<std::uint64_t> free_in_rows_;
};

/// Finds the smallest even number of rows with enough sites. Boxes that are periodic along y need
/// an even number.
class RowSearch {
public:
    RowSearch(const SceneParameters& scene, const Communicator& ranks)
        : scene_(scene), ranks_(ranks),
          most_(static_cast<std::uint64_t>(scene.box.y / (2 * scene.radius * per_row)) / 2 + 1) {}

    FreeSites run() const {
        std::uint64_t low = 0, high = std::max<std::uint64_t>(first_guess(), 1);
        while (number(high) < scene_.n_discs) {
            if (high >= most_) fail();
            low = high;
            high = std::min(most_, high + std::max<std::uint64_t>(high / 8, 1));
        }
        while (high - low > 1) {
            const std::uint64_t middle = low + (high - low) / 2;
            (number(middle) < scene_.n_discs ? low : high) = middle;
        }
        return {scene_, 2 * high, ranks_};
    }

private:
    /// The number of pairs of rows to try first: 90 % of the number needed without fixed bodies.
    std::uint64_t first_guess() const {
        const double area = scene_.area() / static_cast<double>(scene_.n_discs),
                     height = std::sqrt(area * per_row);
        return std::min(most_, static_cast<std::uint64_t>(scene_.box.y / height / 2 * 0.9));
    }
    /// The number of free sites in 2 `pairs` rows; 0 if discs are too large for the sites.
    std::uint64_t number(std::uint64_t pairs) const {
        const FreeSites sites(scene_, 2 * pairs, ranks_);
        return sites.clearance() > scene_.radius ? sites.number() : 0;
    }
    [[noreturn]] void fail() const {
        throw InputError(
            {{scene_.name, 0,
              fmt::format("no lattice of {} discs of radius {} has room between the obstacles; "
                          "take fewer or smaller discs, discs.generator = \"compressed\", or "
                          "freeze some of a start without obstacles (discs.freeze)",
                          scene_.n_discs, scene_.radius)}});
    }

    const SceneParameters& scene_;
    const Communicator& ranks_;
    std::uint64_t most_;
};

} // namespace

std::vector<InputDisc> lattice_around_fixed_bodies(const SceneParameters& scene,
                                                   const Communicator& communicator) {
    const FreeSites sites = RowSearch(scene, communicator).run();
    const std::uint64_t n = scene.n_discs, n_sites = sites.number(),
                        stride = scene.effects.species.empty() ? 1 : mixing_stride(n);
    const double free_radius = sites.clearance() - scene.radius;
    std::vector<InputDisc> discs;
    sites.visit([&](std::uint64_t k, const Point& site) {
        // Disc j takes site j n_sites / n, so that the n_sites - n empty sites are spread evenly.
        const std::uint64_t j = (k * n + n_sites - 1) / n_sites;
        if (j >= n || j * n_sites / n != k) return;
        const DiscId id = j * stride % n; // cannot overflow, as ids are below 2^32
        const Point place = shaken(site, free_radius, scene.seed, id);
        discs.push_back({id, place.x, place.y, 0, 0});
    });
    return discs;
}

} // namespace carrom
