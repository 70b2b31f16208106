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

/// The box, the discs and the obstacles that decide where a disc can come in. All states are those
/// of a sync, in the box's own coordinates.
struct AdmissionGround {
    const Communicator& communicator;
    const Box& box;
    const SpeciesTable& species;
    double largest_radius;
    bool have_pairs; ///< otherwise discs pass through each other, and are in nobody's way
    std::span<const DiscState> own, departed; ///< of this rank
    const SideColumns& departed_columns;      ///< along `departed`
    /// Whether fixed bodies leave room for a disc that has flown from the first state straight to
    /// the second one in this time.
    std::function<bool(const DiscState& from, const DiscState& to, double time)> has_room;
};

struct Admission {
    std::vector<ReturningDisc> discs;
    ArrivalCounts counts;
};

/// Each arrival gets the departed disc of the lowest id that it may have and no earlier one has
/// got. It is left out if another disc or a fixed body is where it came. If one is where it has
/// flown to, or on the way there, it stays where it came.
/// **Collective.**
Admission admit(std::span<const Arrival> arrivals, const AdmissionGround& ground);

} // namespace carrom
