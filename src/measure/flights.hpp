// SPDX-License-Identifier: BSD-3-Clause
// Displacements of discs since a first sample, continued through periodic sides, and the
// correlation with their first velocities. A disc's id determines the rank that stores its first
// position (pieces.hpp). Price: 16 bytes a disc, 32 with velocities, and in periodic boxes 16 more;
// at a sample each disc is sent once.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "measure/image_counts.hpp"
#include "measure/measurement.hpp"

namespace carrom {

class Flights {
public:
    Flights(MeasuredRun& run, bool have_velocities)
        : run_(run), have_velocities_(have_velocities) {}

    /// Starts to count crossings of periodic sides. Call it before `begin`. **Collective.**
    void follow();
    /// This rank's discs; a disc that crossed a periodic side since the last sync is outside of it.
    std::span<const DiscState> flown(std::span<const DiscState> shown);
    /// Starts all displacements at the present positions. **Collective.**
    void begin(std::span<const DiscState> flown);
    /// Mean squares of displacements along x and y since `begin`, and the mean scalar product of
    /// the velocities at that time and now. **Collective.**
    std::array<double, 3> means(std::span<const DiscState> flown, std::uint64_t n_discs);

    void store(StoredSamples& stored);         ///< **Collective.**
    void restore(const StoredSamples& stored); ///< **Collective.**

private:
    bool follows_lengths() const { return run_.scene.effects.are_periodic(); }
    double fastest_of(std::span<const DiscState> discs) const;
    void place_first(std::span<const FirstPlace> places);

    MeasuredRun& run_;
    bool have_velocities_;
    std::uint64_t first_id_ = 0;
    std::vector<std::array<double, 2>>
        first_places_; ///< first positions, by id, of the discs that this rank keeps
    std::vector<std::array<double, 2>> first_velocities_;
    /// In a periodic box: the box lengths that discs have crossed since `begin`
    std::optional<ImageCounts> lengths_;
    DiscStates flown_;
};

} // namespace carrom
