// SPDX-License-Identifier: BSD-3-Clause
// Each disc's place and velocity by id, on through periodic sides and as seen from the centre of
// mass along these. For whoever compares discs with themselves at other times.
//
// Discs are kept by runs of ids (pieces.hpp). Price of a sample: each disc is sent once.
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

/// Places, and velocities per step, by id. Each is an array of its own, so that loops over discs
/// run in vectors.
struct FollowedStates {
    std::vector<double> x, y, vx, vy;

    std::size_t size() const { return x.size(); }
    std::array<std::vector<double>*, 4> columns() { return {&x, &y, &vx, &vy}; }
};

class FollowedDiscs {
public:
    explicit FollowedDiscs(MeasuredRun& run);

    /// From the present step on. **Collective.**
    void begin();
    /// Present states of the discs of this rank's run of ids. **Collective.**
    const FollowedStates& now();
    DiscId first_id() const { return first_id_; }
    std::uint64_t n_discs() const { return n_discs_; }

    /// Box lengths that discs have gone, so that a restart follows them on. **Collective.**
    void keep(KeptNumbers& kept);
    /// A number of each disc of this rank's run, stored for all ranks, or taken from what is
    /// stored. **Collective.**
    void keep(KeptNumbers& kept, std::vector<double>& of_discs) const;

private:
    void subtract_mean(const std::array<bool, 2>& is_apart);

    MeasuredRun& run_;
    SpeciesTable species_;
    std::uint64_t n_discs_ = 0;
    DiscId first_id_ = 0;
    std::size_t n_own_ = 0;
    double speed_ = 0; ///< by which units of sums are chosen
    std::optional<ImageCounts> lengths_;
    FollowedStates states_;
};

} // namespace carrom
