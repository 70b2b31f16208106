// SPDX-License-Identifier: BSD-3-Clause
// The measurements of a run: its averages, which are always on, and the quantities of
// `[output.measurements]`, which are sampled at regular steps. A run without such quantities pays
// nothing for them. The quantities are in quantities/, and docs/reference/measurements.md has the
// price of each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <carrom/measured_table.hpp>

#include "core/stored_samples.hpp"
#include "measure/block_averages.hpp"
#include "measure/measurement.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// An action between steps that takes all samples that are due.
class Sampler : public StepAction {
public:
    /// Samples from the scene's `from_step` on, or from the present step if that is later. All
    /// arguments must outlive this. **Collective.**
    Sampler(const SceneParameters& scene, DiscSystem& system, const Communicator& ranks);
    Sampler(const Sampler&) = delete;
    Sampler& operator=(const Sampler&) = delete;
    ~Sampler() override;

    /// Continues from a checkpoint's data; call it before anything is sampled. Sampling begins anew
    /// if there are no data, or if `from_step` is not before the present step. Averages begin anew
    /// also if the scene now averages over other steps. Throws InputError on every rank if the sums
    /// of a quantity have other settings. **Collective.**
    void go_on(const StoredSamples& stored);

    /// The first step after `step` at which a sample is due.
    std::int64_t next_due(std::int64_t step) const override;
    /// Takes the samples that are due at the present step and have not been taken. **Collective.**
    void sample_if_due();
    bool act() override {
        sample_if_due();
        return true;
    }

    /// Averages since the scene's `averages_from`, or since `average_anew`. **Collective.**
    Averages averages() const { return averages_.averages(); }
    /// Starts all averages anew, for example when a gas has come to equilibrium. **Collective.**
    void average_anew() { averages_.begin(); }

    /// **Collective.**
    StoredSamples stored() const;
    /// Tables of all samples; none before the first sample. All ranks get the same tables.
    std::vector<MeasuredTable> tables() const;
    /// A line for each quantity whose samples contradict an assumption of its tables.
    std::vector<std::string> doubts() const;
    /// Tables that grow by a row at each sample, from row number `first` on; none if
    /// there are no such rows.
    std::vector<MeasuredTable> rows_from(std::size_t first) const;

private:
    void go_on_measuring(const StoredSamples& stored);
    void measure_if_due();
    bool is_due(std::int64_t step) const;
    void sample(std::int64_t step);
    void sample_before_effects();
    bool is_turn_before_effects() const;
    void end_intervals();
    SampledState state_now(DiscStates& kept) const;
    void keep_settings(KeptNumbers& kept) const;
    void keep_counts(KeptNumbers& kept) const;

    mutable MeasuredRun run_;
    mutable BlockAverages averages_; ///< mutable, because `keep` both stores and restores
    Measurements measurements_;      ///< the quantities
    std::vector<std::string> names_; ///< names of the quantities, in their order
    bool has_begun_ = false;
    // Last steps at which averages, ends of intervals and samples were taken before effects acted:
    std::int64_t averaged_before_ = -1, ended_before_ = -1, sampled_before_ = -1;
};

} // namespace carrom
