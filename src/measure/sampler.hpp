// SPDX-License-Identifier: BSD-3-Clause
// The measurements of a run: its averages, which every run has, and the quantities of
// `[output.measurements]`, which are sampled at regular steps. A run that measures no quantities
// spends no time on them. The quantities are in quantities/, and docs/reference/measurements.md has
// the cost of each.
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
    /// Samples quantities from the scene's `from_step` on, or from the present step if that is
    /// later. All arguments must outlive this object. **Collective.**
    Sampler(const SceneParameters& scene, DiscSystem& system, const Communicator& ranks);
    Sampler(const Sampler&) = delete;
    Sampler& operator=(const Sampler&) = delete;
    ~Sampler() override;

    /// Continues from a checkpoint's data; call it before the first sample. Sampling begins anew if
    /// there are no data, or if `from_step` is not before the present step. Averages also begin
    /// anew if the scene's `averages_from` has changed. Throws InputError on every rank if the sums
    /// of a quantity belong to other settings. **Collective.**
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
    /// The rows from number `first` on of all tables that get a row at each sample; no tables if
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
    std::vector<std::string> names_; ///< names of the quantities, in the same order
    bool has_begun_ = false;
    // Last steps at which averages were sampled, intervals ended and quantities sampled before
    // effects acted; -1 if there is no such step:
    std::int64_t averaged_before_ = -1, ended_before_ = -1, sampled_before_ = -1;
};

} // namespace carrom
