// SPDX-License-Identifier: BSD-3-Clause
// Lets departed discs come back into the box at a sync. All ranks agree on which ones come in, and
// where, so the bits do not depend on the rank that holds a departed disc.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/disc_state.hpp"
#include "core/side_columns.hpp"
#include "domain/strip_discs.hpp"
#include "dynamics/species.hpp"
#include "dynamics/sync_effect.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// The data from which `admit` decides which discs come in, and where. All states are at the time
/// of the sync, in the box's own coordinates.
struct AdmissionGround {
    const Communicator& communicator;
    const Box& box;
    const SpeciesTable& species;
    double largest_radius;
    bool have_pairs; ///< if false, discs pass through each other and never block a place
    std::span<const DiscState> own, departed; ///< discs of this rank
    const SideColumns& departed_columns;      ///< side columns of `departed`, in the same order
    /// Whether no fixed body overlaps the disc at `from`, at `to` or on the straight flight between
    /// them, which takes `time` (in micro-steps).
    std::function<bool(const DiscState& from, const DiscState& to, double time)> has_room;
};

struct Admission {
    std::vector<ReturningDisc> discs;
    ArrivalCounts counts;
};

/// Assigns to each arrival the departed disc with the lowest id in its range that no earlier
/// arrival has taken. The disc does not come in if another disc or a fixed body blocks the place of
/// entry. It comes in at that place if only the place that it would have reached by the sync is
/// blocked, or if a fixed body lies between the two. **Collective.**
Admission admit(std::span<const Arrival> arrivals, const AdmissionGround& ground);

} // namespace carrom
