// SPDX-License-Identifier: BSD-3-Clause
// What `[output.measurements]` asks for, sampled every so many steps. A run that does not ask has
// none of this: no memory, and no work in any kernel.
//
// Everything is a count, or a sum in fixed point (exact_sum.hpp). So the tables have the same bits
// for every machine shape, and a restart goes on with them. docs/reference/measurements.md has the
// price of each. Wall pressure is added up collision by collision, as the log of collisions is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <carrom/measured_table.hpp>

#include "core/disc.hpp"
#include "core/stored_samples.hpp"
#include "engine/wall_impulses.hpp"
#include "measure/image_counts.hpp"
#include "measure/pressure_sampler.hpp"
#include "measure/sample_sums.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"
#include "statistics/pair_distances.hpp"

namespace carrom {

class Sampler {
public:
    /// Samples from the present step on if the scene's `from_step` has come. All must outlive this.
    /// **Collective.**
    Sampler(const Scene& scene, Simulation& simulation, const Communicator& ranks);
    ~Sampler();
    Sampler(const Sampler&) = delete;
    Sampler& operator=(const Sampler&) = delete;

    /// Goes on with what a checkpoint has kept, to be called before anything is sampled. Where
    /// there is nothing, or where `from_step` is still to come, sampling begins anew; throws
    /// InputError on every rank where the sums are of other keys. **Collective.**
    void go_on(StoredSamples stored);

    /// The next step after `step` at which to sample.
    std::int64_t next_due(std::int64_t step) const;
    /// Samples if the present step is due, once. **Collective.**
    void look();

    /// **Collective.**
    StoredSamples stored() const;
    /// Of what has been sampled; none before the first sample. The same on every rank.
    std::vector<MeasuredTable> tables() const;
    /// The table "thermo" from its row number `first` on; nothing where there are no such rows.
    std::optional<MeasuredTable> thermo_from(std::size_t first) const;

private:
    void begin();
    void sample(std::int64_t step);
    void sample_velocities(std::span<const Disc> discs);
    void sample_density(std::span<const Disc> discs, const Extent& box);
    void sample_distances(const Extent& box);
    void sample_impulses(std::int64_t step);
    void sample_thermo();
    void sample_psi6();
    void sample_structure_factor(std::span<const Disc> discs, const Extent& box);
    void sample_displacement(std::span<const Disc> shown, std::uint64_t n_discs, bool is_first);
    std::array<double, 3> flights_of(std::span<const Disc> discs, std::uint64_t n_discs);
    double fastest_of(std::span<const Disc> discs) const;
    void begin_flights(std::span<const Disc> discs);
    bool follows_flights() const { return output_.displacement || output_.diffusion; }
    bool follows_lengths() const { return follows_flights() && scene_.effects.are_periodic(); }
    void place_first(std::span<const FirstPlace> places);
    void follow_walls();
    void follow_crossings();
    SampleSums wanted() const;

    const Scene& scene_;
    const MeasurementOutput& output_;
    Simulation& simulation_;
    const Communicator& ranks_;
    SampleSums sums_;
    bool has_begun_ = false;
    std::optional<WallImpulses> impulses_; ///< of this rank since the last sample
    std::optional<PressureSampler> pressure_;
    std::uint64_t first_id_ = 0;
    std::vector<std::array<double, 2>> first_places_; ///< of this rank's run of ids, see pieces.hpp
    std::vector<std::array<double, 2>> first_velocities_; ///< along them, for "diffusion"
    mutable std::optional<ImageCounts> lengths_;          ///< since then, of a periodic box
};

/// The species whose pairs are counted apart: the scene's, or one of all discs where they are alike
/// or of more than eight species.
std::vector<Species> species_apart(const Scene& scene);

/// The table "thermo" from a row on. Its bytes do not change as it grows.
MeasuredTable thermo(const SampleSums& sums, std::size_t first = 0);

/// The tables of sums.
std::vector<MeasuredTable> tables_of(const SampleSums& sums, const Scene& scene);

} // namespace carrom
