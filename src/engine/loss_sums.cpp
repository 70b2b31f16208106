// SPDX-License-Identifier: BSD-3-Clause
#include "engine/loss_sums.hpp"

namespace carrom {

void add_losses(const LossSums& mine, std::int64_t micro_steps, const Communicator& communicator,
                Totals& totals) {
    LossSums all = mine;
    communicator.sum(all.taken);
    communicator.sum(all.spared);
    const auto per_step = static_cast<double>(micro_steps);
    totals.guarded_collisions = communicator.sum(mine.n_guarded);
    totals.energy_taken = all.taken.value() * per_step * per_step;
    totals.energy_spared = all.spared.value() * per_step * per_step;
}

} // namespace carrom
