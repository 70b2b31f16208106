// SPDX-License-Identifier: BSD-3-Clause
// Displacements of discs since a first sample, continued through periodic sides, and the mean
// product of present and first velocities. A disc's id determines the rank that stores its first
// position (pieces.hpp). Memory: 16 bytes a disc, or 32 with velocities, and 16 more in periodic
// boxes. Each sample sends each disc once.
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
    /// This rank's discs. Discs that have crossed a periodic side since the last sync have
    /// positions outside the box.
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
        first_places_; ///< first positions of this rank's range of ids, in order of id
    std::vector<std::array<double, 2>> first_velocities_;
    /// Numbers of box lengths that discs have crossed since `begin`; unset without periodic sides
    std::optional<ImageCounts> lengths_;
    DiscStates flown_;
};

} // namespace carrom
