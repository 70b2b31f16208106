// SPDX-License-Identifier: BSD-3-Clause
// The hexatic order psi6 of discs over their Voronoi neighbours, from the neighbourhood
// that a rank has. Each disc's cell is found by itself, from its neighbours in the
// order of distance and id, so its bits do not depend on ranks and threads.
//
// Discs of different radii have cells of the radical tessellation (B. J. Gellatly and J. L. Finney,
// J. Non-Cryst. Solids 50, 313 (1982)): the side between two discs is the line from which tangents
// to both are equally long. So a cell holds its disc, and two discs that touch are neighbours.
// Bisectors of centres would cut large discs. Between equal discs both are the same line.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/bond_order.hpp"
#include "core/exact_sum.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/species.hpp"
#include "engine/engine.hpp"

namespace carrom {

/// The radii of discs of several species, by which cells differ from those of points.
struct CellSizes {
    const SpeciesTable* species = nullptr; ///< none if all discs are of one size
    double largest_radius = 0;             ///< at the start, as those of the table
    double growth = 1;                     ///< by which radii have grown

    double squared_radius_of(DiscId id) const {
        return species ? squared(species->of(id).radius) : 0;
    }
    double largest_squared_radius() const { return species ? squared(largest_radius) : 0; }

private:
    double squared(double radius) const { return (growth * radius) * (growth * radius); }
};

/// Fills in `orders` along the view's discs. Walls of `box` cut cells and are no
/// neighbours. The view must extend by `reach` around each disc whose order is wanted.
/// Returns whether that was enough for all own discs; otherwise their orders mean nothing.
bool find_bond_orders(const LocalView& local_view, const Extent& box, const CellSizes& sizes,
                      double reach, int n_threads, std::vector<BondOrder>& orders);

/// The same for those own discs whose id is a multiple of `ids_apart`, in one list. One thread does
/// it, because they are few.
bool find_bond_orders(const LocalView& local_view, const Extent& box, const CellSizes& sizes,
                      double reach, std::uint64_t ids_apart, std::vector<BondOrder>& orders);

/// Sums over discs at one time. They are exact, so ranks may add them in any order.
struct HexaticSums {
    static constexpr std::size_t most_neighbours = 12; ///< the last count includes discs with more

    HexaticSums(std::uint64_t n_discs, std::size_t n_bins);

    ExactSum real, imaginary, modulus;
    std::vector<std::uint64_t> neighbours; ///< number of discs by count of neighbours
    std::vector<std::uint64_t> moduli;     ///< number of discs, in bins from 0 to 1
    std::vector<std::uint64_t> pairs;      ///< number of pairs, in bins of distance
    std::vector<ExactSum> products;        ///< sum of the real part of psi6* psi6 over these pairs
};

/// Adds discs alone.
void add_discs(std::span<const BondOrder> orders, HexaticSums& sums);
/// Adds this rank's discs and pairs; bins of distance are `bin_width` wide. A pair is counted once,
/// by the rank that owns its disc of the lower id.
void add_order(const LocalView& local_view, std::span<const BondOrder> orders, double bin_width,
               int n_threads, HexaticSums& sums);

} // namespace carrom
