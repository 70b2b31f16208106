// SPDX-License-Identifier: BSD-3-Clause
#include "local_discs.hpp"

namespace carrom::test {

void LocalDiscs::sort_into_cells(double box_size, double radius) {
    const double reach = 2 * radius * (1 + 1e-6);
    const std::span<DiscState> all(discs);
    grid.sort(all.first(n_own),
              make_geometry({0, box_size, 0, box_size}, Axis::x, reach, discs.size(), 0), time,
              time, 1, 1);
    grid.add_halo(all.subspan(n_own));
}

LocalDiscs copy_of(const LocalView& local_view) {
    const std::span<const DiscState> discs = local_view.population.discs;
    return {{discs.begin(), discs.end()},
            local_view.population.n_own,
            *local_view.grid,
            *local_view.domains,
            local_view.time,
            local_view.frame};
}

LocalDiscs view_by_hand(const std::vector<DiscState>& discs, double time, double box_size,
                        double radius, int rank, int n_ranks) {
    std::vector<double> cuts;
    for (int k = 1; k < n_ranks; ++k) cuts.push_back(box_size * k / n_ranks);
    LocalDiscs local_view{{}, 0, {}, Domains(Strips(cuts)), time, {}};
    std::vector<DiscState> halo;
    for (const DiscState& disc : discs)
        (local_view.domains.owner(disc.x_at(time), disc.y_at(time)) == rank ? local_view.discs
                                                                            : halo)
            .push_back(disc);
    local_view.n_own = local_view.discs.size();
    local_view.discs.insert(local_view.discs.end(), halo.begin(), halo.end());
    local_view.sort_into_cells(box_size, radius);
    return local_view;
}

} // namespace carrom::test
