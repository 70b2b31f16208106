// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/disc_order.hpp"

#include <algorithm>
#include <cmath>

#include "engine/engine.hpp"

namespace carrom {

namespace {

double area_of(const Extent& box) { return (box.x_high - box.x_low) * (box.y_high - box.y_low); }

CellSizes cell_sizes(const DiscSystem& system) {
    const Effects& effects = system.effects();
    CellSizes sizes;
    sizes.species = system.species_if_mixed();
    for (const Species& one : effects.species)
        sizes.largest_radius = std::max(sizes.largest_radius, one.radius);
    sizes.size = system.engine().size() * effects.size_at(static_cast<double>(system.step()));
    return sizes;
}

/// Computes psi6 of all discs of the view that are at most `reach_beyond` from own discs or, if
/// `ids_apart` is not 0, only of own discs whose id is a multiple of it. The returned view is valid
/// until `forget_images`. **Collective.**
LocalView find_orders(DiscSystem& system, double reach_beyond, std::uint64_t ids_apart,
                      std::vector<BondOrder>& orders) {
    const Extent box = system.box();
    const CellSizes sizes = cell_sizes(system);
    // In a fluid, discs within three mean distances suffice to complete the Voronoi cells.
    for (double reach = 3 * std::sqrt(area_of(box) / static_cast<double>(system.n_discs()));;
         reach *= 2) {
        const LocalView now = system.engine().local_view(reach_beyond + reach);
        const bool are_whole = ids_apart == 0
                                   ? find_bond_orders(now, box, sizes, reach, system.n_threads(),
                                                      orders)
                                   : find_bond_orders(now, box, sizes, reach, ids_apart, orders);
        if (system.ranks().all(are_whole)) return now;
        system.engine().forget_images();
    }
}

} // namespace

HexaticSums hexatic_order(DiscSystem& system, double largest_distance, std::size_t n_bins) {
    HexaticSums sums(system.n_discs(), n_bins);
    std::vector<BondOrder> orders;
    const LocalView now = find_orders(system, largest_distance, 0, orders);
    add_order(now, orders, largest_distance / static_cast<double>(n_bins), system.n_threads(),
              sums);
    system.engine().forget_images();
    const Communicator& ranks = system.ranks();
    for (auto* counts : {&sums.neighbours, &sums.moduli, &sums.pairs})
        ranks.sum(std::span(*counts));
    for (ExactSum* sum : {&sums.real, &sums.imaginary, &sums.modulus}) ranks.sum(*sum);
    for (ExactSum& product : sums.products) ranks.sum(product);
    return sums;
}

HexaticSums sampled_order(DiscSystem& system, std::uint64_t most_discs) {
    const std::uint64_t n = system.n_discs(), ids_apart = (n + most_discs - 1) / most_discs;
    HexaticSums sums(n, 1);
    std::vector<BondOrder> orders;
    static_cast<void>(find_orders(system, 0, std::max<std::uint64_t>(ids_apart, 1), orders));
    system.engine().forget_images();
    add_discs(orders, sums);
    const Communicator& ranks = system.ranks();
    ranks.sum(std::span(sums.neighbours));
    for (ExactSum* sum : {&sums.real, &sums.imaginary, &sums.modulus}) ranks.sum(*sum);
    return sums;
}

std::vector<BondOrder> bond_orders(DiscSystem& system) {
    std::vector<BondOrder> orders;
    const LocalView now = find_orders(system, 0, 0, orders);
    orders.resize(now.population.n_own);
    system.engine().forget_images();
    orders.resize(system.discs().size()); // departed discs come last and have no order
    return orders;
}

std::vector<ComputedNumbers> computed_numbers(DiscSystem& system) {
    std::vector<ComputedNumbers> numbers;
    for (const BondOrder& order : bond_orders(system)) {
        ComputedNumbers& one = numbers.emplace_back();
        if (order.has_cell())
            one = {order.real, order.imaginary, static_cast<double>(order.n_neighbours)};
    }
    return numbers;
}

} // namespace carrom
