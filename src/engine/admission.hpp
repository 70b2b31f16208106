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

/// The box, the discs and the fixed bodies that decide where a disc can come in. All states are
/// those of a sync, in the box's own coordinates.
struct AdmissionGround {
    const Communicator& communicator;
    const Box& box;
    const SpeciesTable& species;
    double largest_radius;
    bool have_pairs; ///< if false, discs pass through each other and never block a place
    std::span<const DiscState> own, departed; ///< discs of this rank
    const SideColumns& departed_columns;      ///< columns in the order of `departed`
    /// Whether fixed bodies leave room for a disc that has flown from the first state straight to
    /// the second one in this time.
    std::function<bool(const DiscState& from, const DiscState& to, double time)> has_room;
};

struct Admission {
    std::vector<ReturningDisc> discs;
    ArrivalCounts counts;
};

/// Each arrival gets the departed disc of the lowest id in its range that is still free. The
/// arrival is left out if another disc or a fixed body is at its place of entry. If only the place
/// to which the disc has flown is blocked, or the way there, the disc stays at its place of entry.
/// **Collective.**
Admission admit(std::span<const Arrival> arrivals, const AdmissionGround& ground);

} // namespace carrom
