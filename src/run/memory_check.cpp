// SPDX-License-Identifier: BSD-3-Clause
#include "run/memory_check.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"
#include "machine/machine.hpp"

namespace carrom {

void check_memory(const SceneParameters& scene, const Communicator& ranks,
                  double bytes_for_crowds) {
    // The bytes per disc were measured on one to three ranks by tests/studies/memory.py. Several
    // ranks need more, for halos and for discs that they send to each other.
    const bool are_many = ranks.size() > 1;
    const double bytes_per_disc = scene.method == Method::event_driven ? (are_many ? 110 : 106)
                                                                       : (are_many ? 97 : 92);
    const double needed = static_cast<double>(scene.n_discs) * (bytes_per_disc + bytes_for_crowds) /
                          ranks.size();
    const auto available = static_cast<double>(ranks.min(memory_per_rank(ranks)));
    if (needed <= available) return;
    throw InputError({{scene.name, 0,
                       fmt::format("discs.count = {} needs at least {:.3g} GB of memory on each of "
                                   "{} ranks, and one has only {:.3g} GB; take "
                                   "fewer discs, or ranks on more nodes",
                                   scene.n_discs, needed / 1e9, ranks.size(), available / 1e9)}});
}

} // namespace carrom
