// SPDX-License-Identifier: BSD-3-Clause
#include "settled_discs.hpp"

namespace carrom::test {

void SettledDiscs::sort_into_cells(double box_size, double radius) {
    const double reach = 2 * radius * (1 + 1e-6);
    const std::span<Disc> all(discs);
    grid.sort(all.first(n_own), make_frame(0, box_size, 0, box_size, reach, discs.size(), 0), time, time, 1, 1);
    grid.add_halo(all.subspan(n_own));
}

SettledDiscs copy_of(const Settled& settled) {
    const std::span<const Disc> discs = settled.population.discs;
    return {{discs.begin(), discs.end()}, settled.population.n_own, *settled.grid, *settled.strips, settled.time, settled.frame};
}

SettledDiscs settled_by_hand(const std::vector<Disc>& discs, double time, double box_size, double radius, int rank, int n_ranks) {
    std::vector<double> cuts;
    for (int k = 1; k < n_ranks; ++k) cuts.push_back(box_size * k / n_ranks);
    SettledDiscs settled{{}, 0, {}, Strips(cuts), time, {}};
    std::vector<Disc> halo;
    for (const Disc& disc : discs) (settled.strips.owner(disc.x_at(time)) == rank ? settled.discs : halo).push_back(disc);
    settled.n_own = settled.discs.size();
    settled.discs.insert(settled.discs.end(), halo.begin(), halo.end());
    settled.sort_into_cells(box_size, radius);
    return settled;
}

} // namespace carrom::test
