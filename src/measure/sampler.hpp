// SPDX-License-Identifier: BSD-3-Clause
// Samples the quantities of `[output.measurements]` at regular steps. A run without
// them has none of this: no memory, and no work in any kernel. The quantities are in
// quantities/, and docs/reference/measurements.md has the price of each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <carrom/measured_table.hpp>

#include "core/stored_samples.hpp"
#include "measure/measurement.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

class Sampler {
public:
    /// Samples from the present step on if the scene's `from_step` has come. All
    /// arguments must outlive this. **Collective.**
    Sampler(const Scene& scene, Simulation& simulation, const Communicator& ranks);
    Sampler(const Sampler&) = delete;
    Sampler& operator=(const Sampler&) = delete;

    /// Goes on from a checkpoint's data; to be called before anything is sampled.
    /// Sampling begins anew if there are none, or if `from_step` is still to come.
    /// Throws InputError on every rank if the sums have other settings. **Collective.**
    void go_on(const StoredSamples& stored);

    /// The first step after `step` at which a sample is due.
    std::int64_t next_due(std::int64_t step) const;
    /// Takes a sample if one is due at the present step and has not been taken. **Collective.**
    void sample_if_due();

    /// **Collective.**
    StoredSamples stored() const;
    /// Tables of all samples; none before the first one. The same on every rank.
    std::vector<MeasuredTable> tables() const;
    /// Tables that grow by a row at each sample, from row number `first` on; none if
    /// there are no such rows.
    std::vector<MeasuredTable> rows_from(std::size_t first) const;

private:
    void sample(std::int64_t step);
    void keep_settings(KeptNumbers& kept) const;
    void keep_counts(KeptNumbers& kept) const;

    mutable MeasuredRun run_;
    Measurements measurements_;
    std::vector<std::string> names_; ///< names of the quantities, in their order
    bool has_begun_ = false;
};

} // namespace carrom
