// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/hexatic_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "engine/near_pairs.hpp"
#include "statistics/voronoi_cell.hpp"

namespace carrom {

namespace {

/// A side of a Voronoi cell that is shorter than this, relative to the distance between the two
/// discs that it separates, counts as a corner where more than three cells meet, as in a square
/// lattice.
constexpr double shortest_side = 1e-9;

/// Discs within this fraction of the reach are enough to complete most cells.
constexpr double usual_part = 0.6;

/// Position and size of another disc, relative to the disc whose cell is computed.
struct Seen {
    double dx = 0, dy = 0, squared = 0;
    DiscId id = 0;
    double larger = 0; ///< squared radius of the cell's own disc minus that of the other disc

    friend bool operator<(const Seen& a, const Seen& b) {
        return std::tie(a.squared, a.id, a.dx, a.dy) < std::tie(b.squared, b.id, b.dx, b.dy);
    }
};

/// Computes the Voronoi cells of single discs. Each thread has a finder of its own.
class CellFinder {
public:
    CellFinder(const LocalView& local_view, const Extent& box, const CellSizes& sizes, double reach)
        : view_(local_view), box_(box), sizes_(sizes), reach_(reach) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        if (view_.periods.x != 0) box_.x_low = -infinity, box_.x_high = infinity;
        if (view_.periods.y != 0) box_.y_low = -infinity, box_.y_high = infinity;
    }

    /// Computes psi6 of one disc. Returns true if its cell is complete, which means that no disc
    /// beyond the reach could cut it, or if the disc has no cell.
    bool find(LocalIndex index, BondOrder& order) {
        const DiscState& disc = view_.population.discs[index];
        const double x = x_in_box(disc), y = y_in_box(disc);
        order = {};
        if (!is_in_box(disc)) return true;
        const double smaller = sizes_.largest_squared_radius() - sizes_.squared_radius_of(disc.id);
        // Most cells are complete within a part of the reach, which has fewer discs to sort. Discs
        // cut the cell in order of distance, so both ranges give such a cell the same bits.
        for (const double range : {usual_part * reach_, reach_}) {
            find_neighbours(index, range);
            cell_.begin(std::max(-reach_, box_.x_low - x), std::min(reach_, box_.x_high - x),
                        std::max(-reach_, box_.y_low - y), std::min(reach_, box_.y_high - y));
            double squared_reach = squared_reach_of_cell(smaller);
            for (std::size_t k = 0; k < seen_.size() && seen_[k].squared < squared_reach; ++k) {
                cell_.cut(seen_[k].dx, seen_[k].dy, static_cast<int>(k), seen_[k].larger);
                squared_reach = squared_reach_of_cell(smaller);
            }
            if (squared_reach <= range * range) {
                order = order_of_cell();
                return true;
            }
        }
        return false;
    }

private:
    double x_in_box(const DiscState& disc) const { return disc.x_at(view_.time) + view_.frame.x; }
    double y_in_box(const DiscState& disc) const { return disc.y_at(view_.time) + view_.frame.y; }
    bool is_in_box(const DiscState& disc) const {
        const double x = x_in_box(disc), y = y_in_box(disc);
        return x >= box_.x_low && x <= box_.x_high && y >= box_.y_low && y <= box_.y_high;
    }

    /// A disc at the distance d cuts nothing if (d - c)^2 - c^2 > `smaller`. Here c is the distance
    /// of the farthest corner, and `smaller` the squared radius of the largest disc minus that of
    /// the cell's own disc. Returns the square of the smallest such d.
    double squared_reach_of_cell(double smaller) const {
        const double squared = cell_.squared_radius();
        if (smaller == 0) return 4 * squared;
        const double reach = std::sqrt(squared) + std::sqrt(squared + smaller);
        return reach * reach;
    }

    void find_neighbours(LocalIndex index, double range) {
        const CellGrid& grid = *view_.grid;
        const GridGeometry& geometry = grid.geometry();
        const DiscState& disc = view_.population.discs[index];
        const auto [along, across] = turned(geometry.axis, view_.periods.x_of(disc, view_.time),
                                            view_.periods.y_of(disc, view_.time));
        const double far = range * (1 + 1e-6);
        const int low = geometry.row_of(across - far), high = geometry.row_of(across + far),
                  last = geometry.column_of(along + far);
        squared_range_ = range * range;
        seen_.clear();
        for (int column = geometry.column_of(along - far); column <= last; ++column) {
            const SlotRange own = grid.run(column, low, high),
                            halo = grid.halo_run(column, low, high);
            for (LocalIndex other = own.begin; other < own.end; ++other)
                if (other != index) see(disc, view_.population.discs[other]);
            for (std::uint32_t slot = halo.begin; slot < halo.end; ++slot)
                if (const LocalIndex other = grid.halo_index(slot); other != index)
                    see(disc, view_.population.discs[other]);
        }
        std::sort(seen_.begin(), seen_.end());
    }

    void see(const DiscState& disc, const DiscState& other) {
        const Shift shift = view_.periods.between(disc, other, view_.time);
        Seen seen{(other.x_at(view_.time) - disc.x_at(view_.time)) + shift.x,
                  (other.y_at(view_.time) - disc.y_at(view_.time)) + shift.y, 0, other.id,
                  sizes_.squared_radius_of(disc.id) - sizes_.squared_radius_of(other.id)};
        seen.squared = seen.dx * seen.dx + seen.dy * seen.dy;
        if (seen.squared < squared_range_ && is_in_box(other)) seen_.push_back(seen);
    }

    BondOrder order_of_cell() const {
        BondOrder order{0, 0, 0};
        cell_.for_each_side([&](int point, double squared_length) {
            if (point == VoronoiCell::no_point) return;
            const Seen& other = seen_[static_cast<std::size_t>(point)];
            if (squared_length <= shortest_side * shortest_side * other.squared) return;
            const double c = (other.dx * other.dx - other.dy * other.dy) / other.squared,
                         s = 2 * other.dx * other.dy / other.squared; // sine of twice the angle
            order.real += c * (c * c - 3 * s * s);
            order.imaginary += s * (3 * c * c - s * s);
            ++order.n_neighbours;
        });
        const double n = std::max(order.n_neighbours, 1);
        order.real /= n;
        order.imaginary /= n;
        return order;
    }

    const LocalView& view_;
    Extent box_; ///< infinite along periodic axes
    CellSizes sizes_;
    double reach_;
    double squared_range_ = 0; ///< squared range of the present search
    std::vector<Seen> seen_;
    VoronoiCell cell_;
};

} // namespace

bool find_bond_orders(const LocalView& local_view, const Extent& box, const CellSizes& sizes,
                      double reach, int n_threads, std::vector<BondOrder>& orders) {
    const auto n = static_cast<std::int64_t>(local_view.population.discs.size()),
               n_own = static_cast<std::int64_t>(local_view.population.n_own);
    orders.resize(static_cast<std::size_t>(n));
    bool are_whole = true;
#pragma omp parallel num_threads(n_threads)
    {
        CellFinder finder(local_view, box, sizes, reach);
#pragma omp for schedule(dynamic, 256) reduction(&& : are_whole)
        for (std::int64_t i = 0; i < n; ++i) {
            const bool is_whole = finder.find(static_cast<LocalIndex>(i),
                                              orders[static_cast<std::size_t>(i)]);
            are_whole = are_whole && (is_whole || i >= n_own);
        }
    }
    return are_whole;
}

bool find_bond_orders(const LocalView& local_view, const Extent& box, const CellSizes& sizes,
                      double reach, std::uint64_t ids_apart, std::vector<BondOrder>& orders) {
    CellFinder finder(local_view, box, sizes, reach);
    orders.clear();
    for (std::size_t i = 0; i < local_view.population.n_own; ++i)
        if (local_view.population.discs[i].id % ids_apart == 0 &&
            !finder.find(static_cast<LocalIndex>(i), orders.emplace_back()))
            return false;
    return true;
}

HexaticSums::HexaticSums(std::uint64_t n_discs, std::size_t n_bins)
    : real(2 * static_cast<double>(n_discs)), imaginary(real), modulus(real),
      neighbours(most_neighbours + 1, 0), moduli(n_bins, 0), pairs(n_bins, 0),
      products(n_bins, ExactSum(2 * static_cast<double>(n_discs) * static_cast<double>(n_discs))) {}

namespace {

/// Adds the pairs whose first disc is in the grid column `column`.
void add_pairs_of(int column, const LocalView& view, std::span<const BondOrder> orders,
                  double bins_per_length, HexaticSums& sums) {
    const double n_bins = static_cast<double>(sums.pairs.size());
    const std::span<const DiscState> discs = view.population.discs;
    visit_near_pairs_of(*view.grid, column, [&](LocalIndex a, LocalIndex b) {
        if (discs[b].id < discs[a].id) std::swap(a, b);
        if (a >= view.population.n_own || !orders[a].has_cell() || !orders[b].has_cell()) return;
        const DiscState &p = discs[a], &q = discs[b];
        const Shift shift = view.periods.between(p, q, view.time);
        const double dx = (q.x_at(view.time) - p.x_at(view.time)) + shift.x,
                     dy = (q.y_at(view.time) - p.y_at(view.time)) + shift.y;
        const double bin = std::sqrt(dx * dx + dy * dy) * bins_per_length;
        if (!(bin < n_bins)) return;
        ++sums.pairs[static_cast<std::size_t>(bin)];
        sums.products[static_cast<std::size_t>(bin)].add(orders[a].real * orders[b].real +
                                                         orders[a].imaginary * orders[b].imaginary);
    });
}

} // namespace

void add_discs(std::span<const BondOrder> orders, HexaticSums& sums) {
    for (const BondOrder& order : orders) {
        if (!order.has_cell()) continue;
        const double modulus = std::sqrt(order.real * order.real +
                                         order.imaginary * order.imaginary);
        const std::size_t bin = static_cast<std::size_t>(modulus *
                                                         static_cast<double>(sums.moduli.size()));
        sums.real.add(order.real);
        sums.imaginary.add(order.imaginary);
        sums.modulus.add(modulus);
        ++sums.moduli[std::min(bin, sums.moduli.size() - 1)];
        ++sums.neighbours[std::min(static_cast<std::size_t>(order.n_neighbours),
                                   HexaticSums::most_neighbours)];
    }
}

void add_order(const LocalView& local_view, std::span<const BondOrder> orders, double bin_width,
               int n_threads, HexaticSums& sums) {
    add_discs(orders.first(local_view.population.n_own), sums);
    const int n_columns = local_view.grid->geometry().n_columns;
#pragma omp parallel num_threads(n_threads)
    {
        HexaticSums mine = sums;
        std::fill(mine.pairs.begin(), mine.pairs.end(), 0);
        for (ExactSum& product : mine.products) product.clear();
#pragma omp for schedule(dynamic, 1)
        for (int column = 0; column < n_columns; ++column)
            add_pairs_of(column, local_view, orders, 1 / bin_width, mine);
#pragma omp critical(hexatic_order)
        for (std::size_t k = 0; k < mine.pairs.size(); ++k) {
            sums.pairs[k] += mine.pairs[k];
            sums.products[k] += mine.products[k];
        }
    }
}

} // namespace carrom
