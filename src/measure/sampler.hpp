// SPDX-License-Identifier: BSD-3-Clause
// What `[output.measurements]` asks for, sampled every so many steps. A run that does not ask has
// none of this: no memory, and no work in any kernel. The quantities are in quantities/, and
// docs/reference/measurements.md has the price of each.
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
    /// Samples from the present step on if the scene's `from_step` has come. All must outlive this.
    /// **Collective.**
    Sampler(const Scene& scene, Simulation& simulation, const Communicator& ranks);
    Sampler(const Sampler&) = delete;
    Sampler& operator=(const Sampler&) = delete;

    /// Goes on with what a checkpoint has kept, to be called before anything is sampled. Where
    /// there is nothing, or where `from_step` is still to come, sampling begins anew; throws
    /// InputError on every rank where the sums are of other keys. **Collective.**
    void go_on(const StoredSamples& stored);

    /// The next step after `step` at which to sample.
    std::int64_t next_due(std::int64_t step) const;
    /// Samples if the present step is due, once. **Collective.**
    void look();

    /// **Collective.**
    StoredSamples stored() const;
    /// Of what has been sampled; none before the first sample. The same on every rank.
    std::vector<MeasuredTable> tables() const;
    /// Tables that grow by a row at each sample, from row number `first` on; none where there are
    /// no such rows.
    std::vector<MeasuredTable> rows_from(std::size_t first) const;

private:
    void sample(std::int64_t step);
    void keep_settings(KeptNumbers& kept) const;
    void keep_counts(KeptNumbers& kept) const;

    mutable MeasuredRun run_;
    Measurements measurements_;
    std::vector<std::string> names_; ///< of the quantities, along them
    bool has_begun_ = false;
};

} // namespace carrom
