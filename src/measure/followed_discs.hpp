// SPDX-License-Identifier: BSD-3-Clause
// The positions and velocities of discs in order of id, continued through periodic sides. Along
// axes where nothing stops the common motion, they are relative to the centre of mass
// (centred_flights.hpp). Measurements use them to compare discs with their own earlier states.
//
// Each rank stores a range of ids (pieces.hpp). Each sample sends each disc once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dynamics/species.hpp"
#include "measure/image_counts.hpp"
#include "measure/kept_numbers.hpp"
#include "measure/measurement.hpp"

namespace carrom {

/// Positions, and velocities in lengths per step, in order of id. Each component is an array, so
/// that loops over discs are vectorised.
struct FollowedStates {
    std::vector<double> x, y, vx, vy;

    std::size_t size() const { return x.size(); }
    std::array<std::vector<double>*, 4> columns() { return {&x, &y, &vx, &vy}; }
};

class FollowedDiscs {
public:
    explicit FollowedDiscs(MeasuredRun& run);

    /// Follows discs from the present step on. **Collective.**
    void begin();
    /// The present states of this rank's range of ids. **Collective.**
    const FollowedStates& now();
    DiscId first_id() const { return first_id_; }
    std::uint64_t n_discs() const { return n_discs_; }

    /// Stores or restores how many box lengths discs have crossed, so that a restart can continue
    /// to follow the discs. **Collective.**
    void keep(KeptNumbers& kept);
    /// Stores one number for each disc of all ranks, or restores
    /// the numbers of this rank's range of ids. **Collective.**
    void keep(KeptNumbers& kept, std::vector<double>& of_discs) const;

private:
    void subtract_mean(const std::array<bool, 2>& is_apart);

    MeasuredRun& run_;
    SpeciesTable species_;
    std::uint64_t n_discs_ = 0;
    DiscId first_id_ = 0;
    std::size_t n_own_ = 0;
    double speed_ = 0; ///< typical speed, which defines the units of sums
    std::optional<ImageCounts> lengths_;
    FollowedStates states_;
};

} // namespace carrom
