// SPDX-License-Identifier: BSD-3-Clause
// The hexatic order psi6 of discs over their Voronoi neighbours, from the neighbourhood that a rank
// sees. Each disc's cell is found by itself, from its neighbours in the order of distance and id.
// So its bits do not depend on ranks and threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/bond_order.hpp"
#include "core/exact_sum.hpp"
#include "dynamics/effects.hpp"
#include "engine/engine.hpp"

namespace carrom {

/// Fills in `orders` along the view's discs. Walls of `box` cut cells and are no neighbours. The
/// view must reach as far as `reach` around each disc whose order is looked at. Returns whether
/// that was enough for all own discs; else their orders mean nothing.
bool find_bond_orders(const LocalView& local_view, const Extent& box, double reach, int n_threads,
                      std::vector<BondOrder>& orders);

/// Sums over discs, at one time: exact ones, which ranks may add in any order.
struct HexaticSums {
    static constexpr std::size_t most_neighbours = 12; ///< the last count is of more, too

    HexaticSums(std::uint64_t n_discs, std::size_t n_bins);

    ExactSum real, imaginary, modulus;
    std::vector<std::uint64_t> neighbours; ///< discs of so many
    std::vector<std::uint64_t> moduli;     ///< discs, in bins from 0 to 1
    std::vector<std::uint64_t> pairs;      ///< in bins of distance
    std::vector<ExactSum> products;        ///< over these: the real part of psi6* psi6
};

/// Adds this rank's discs and pairs; bins of distance are `bin_width` wide. A pair is counted once,
/// by the rank that owns its disc of the lower id.
void add_order(const LocalView& local_view, std::span<const BondOrder> orders, double bin_width,
               int n_threads, HexaticSums& sums);

} // namespace carrom
