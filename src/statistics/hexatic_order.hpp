// SPDX-License-Identifier: BSD-3-Clause
// The hexatic order psi6 of discs over their Voronoi neighbours, from the discs of a rank and of
// its halo. Each disc's cell is computed separately, from its neighbours in order of distance and
// id, so its bits do not depend on ranks and threads.
//
// Discs of different radii have cells of the radical tessellation (B. J. Gellatly and J. L. Finney,
// J. Non-Cryst. Solids 50, 313 (1982)): from each point of the side between two discs, tangents to
// both are equally long. So a cell contains its disc, and two discs that touch are neighbours.
// Perpendicular bisectors would cut through large discs. For equal discs both are the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/exact_sum.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/species.hpp"
#include "engine/engine.hpp"

namespace carrom {

/// psi6 of one disc: the mean of exp(6 i angle) over its neighbours, each with the same weight.
struct BondOrder {
    double real = 0, imaginary = 0;
    /// Number of neighbours; -1 if the disc's centre is not in the box, so that it has no cell
    int n_neighbours = -1;

    bool has_cell() const { return n_neighbours >= 0; }
};

/// The radii of the discs. They affect the cells only if there are several species.
struct CellSizes {
    const SpeciesTable* species = nullptr; ///< null if all discs have one size
    double largest_radius = 0;             ///< at the scene's start, like the radii in `species`
    double size = 1;                       ///< the factor by which radii have grown

    double squared_radius_of(DiscId id) const {
        return species ? squared(species->of(id).radius) : 0;
    }
    double largest_squared_radius() const { return species ? squared(largest_radius) : 0; }

private:
    double squared(double radius) const { return (size * radius) * (size * radius); }
};

/// Fills `orders` with one entry for each disc of the view, in the same order. Walls of `box` bound
/// cells but are not neighbours. The view must extend by `reach` around each disc whose order is
/// computed. Returns whether `reach` was enough for all own discs; otherwise `orders` is invalid.
bool find_bond_orders(const LocalView& local_view, const Extent& box, const CellSizes& sizes,
                      double reach, int n_threads, std::vector<BondOrder>& orders);

/// Like the function above, but `orders` has entries only for own discs whose id is a multiple of
/// `ids_apart`. Uses one thread, because these discs are few.
bool find_bond_orders(const LocalView& local_view, const Extent& box, const CellSizes& sizes,
                      double reach, std::uint64_t ids_apart, std::vector<BondOrder>& orders);

/// Sums over discs at one time. They are exact, so ranks may add them in any order.
struct HexaticSums {
    static constexpr std::size_t most_neighbours = 12; ///< larger numbers count as this number

    HexaticSums(std::uint64_t n_discs, std::size_t n_bins);

    ExactSum real, imaginary, modulus;
    std::vector<std::uint64_t> neighbours; ///< number of discs by count of neighbours
    std::vector<std::uint64_t> moduli;     ///< number of discs by |psi6|, in bins from 0 to 1
    std::vector<std::uint64_t> pairs;      ///< number of pairs, in bins of distance
    std::vector<ExactSum> products;        ///< sums over these pairs of Re(conj(psi6_i) psi6_j)
};

/// Adds psi6 of these discs to the sums over discs, but adds no pairs.
void add_discs(std::span<const BondOrder> orders, HexaticSums& sums);
/// Adds this rank's discs and pairs; bins of distance are `bin_width` wide. A pair is counted once,
/// by the rank that owns the disc with the lower id.
void add_order(const LocalView& local_view, std::span<const BondOrder> orders, double bin_width,
               int n_threads, HexaticSums& sums);

} // namespace carrom
