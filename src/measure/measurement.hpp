// SPDX-License-Identifier: BSD-3-Clause
// The interface of a measurement. Each quantity is one file in src/measure/quantities. The file has
// its declaration for scenes and documentation (scene/quantity.hpp), and the class that samples it.
//
// Sums over discs and collisions are integers, or are in fixed point (exact_sum.hpp), or are added
// in a fixed order. So tables have the same bits on any number of ranks and threads, with or
// without a restart. To add a quantity: copy the file of the most similar quantity, rename
// the quantity in the copy, and add the name of the new file to the list in
// src/measure/CMakeLists.txt.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <carrom/measured_table.hpp>

#include "core/disc_state.hpp"
#include "core/stored_samples.hpp"
#include "measure/kept_numbers.hpp"
#include "parallel/communicator.hpp"
#include "scene/quantity.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The samples so far: their steps and number, and sums over them. All are the same on every rank.
struct SampleCounts {
    std::int64_t first_step = 0, last_step = -1;
    std::uint64_t n_samples = 0;
    std::uint64_t n_discs = 0; ///< number of discs in the box, summed over all samples
    double area = 0;           ///< sum of the box's area over all samples
};

/// The run that is measured; it outlives the measurements.
struct MeasuredRun {
    const SceneParameters& scene;
    const MeasurementOutput& output;
    DiscSystem& system;
    const Communicator& ranks;
    SampleCounts counts = {};

    /// The step of the sample with this number; the first sample has the number 0.
    double step_of(std::size_t sample) const {
        return static_cast<double>(counts.first_step +
                                   static_cast<std::int64_t>(sample) * output.every_steps);
    }
    bool is_periodic_all_round() const {
        return scene.effects.is_periodic_x() && scene.effects.is_periodic_y();
    }
};

/// The state at a sample. It contains the discs of this rank, and is valid only during
/// `Measurement::sample`.
struct SampledState {
    std::span<const DiscState> shown;  ///< the discs in the frame of the box
    std::span<const DiscState> inside; ///< the discs of `shown` that are in the box
    std::uint64_t n_discs = 0;         ///< number of discs in `shown` on all ranks
    Extent box;
    bool is_first = false; ///< whether it is the first sample, before which there is no interval
    /// Whether effects have acted at this step after the last interval ended.
    bool follows_effects = false;
};

/// A column that a quantity adds to the table "thermo", with a number for each sample.
struct ThermoColumn {
    std::string name, remark;
    std::function<double(std::size_t)> at_sample;
};

/// All functions before `tables` are **collective**.
class Measurement {
public:
    explicit Measurement(MeasuredRun& run) : run_(run) {}
    virtual ~Measurement() = default;
    Measurement(const Measurement&) = delete;
    Measurement& operator=(const Measurement&) = delete;

    /// Called once, before the first sample and at its step. It is not called at a restart that
    /// restores sums.
    virtual void begin() {}
    /// Ends the interval since the last sample. It is called once before each sample except the
    /// first. If effects change the energy at a sync, it is called before they act, so that the
    /// change is not part of the interval.
    virtual void end_interval() {}
    virtual void sample(const SampledState& state) = 0;
    /// Whether samples use velocities. If effects change the energy at syncs, such samples are
    /// taken alternately before and after the effects, so that their mean is the mean over time.
    virtual bool has_velocities() const { return false; }
    /// Whether `sample` changes the order of discs in memory. It is then called after all others.
    virtual bool moves_discs() const { return false; }

    /// Passes all numbers of a checkpoint to `kept`, which stores them or, at a restart, restores
    /// them.
    virtual void keep(KeptNumbers& kept) = 0;
    /// Adds numbers of each disc to a checkpoint's data; most measurements have none.
    virtual void store_discs(StoredSamples& /*stored*/) {}
    virtual void restore_discs(const StoredSamples& /*stored*/) {}

    /// Tables of the samples so far; there must be at least one sample. All ranks get equal tables.
    virtual std::vector<MeasuredTable> tables() const = 0;
    /// The rows from number `first` on of a table that gets a row at each sample. They are appended
    /// to its file during the run, so earlier rows must never change.
    virtual std::optional<MeasuredTable> rows_from(std::size_t /*first*/) const {
        return std::nullopt;
    }
    /// A warning of one line if samples contradict an assumption of the tables; otherwise empty.
    virtual std::string doubt() const { return {}; }
    virtual std::optional<ThermoColumn> thermo_column() const { return std::nullopt; }

protected:
    MeasuredRun& run_;
};

using Measurements = std::vector<std::unique_ptr<Measurement>>;

/// The declaration of a quantity and its measurement.
struct MeasuredQuantity {
    Quantity declared;
    std::unique_ptr<Measurement> (*make)(MeasuredRun&, const Measurements& others);
    /// Names of further tables of the quantity, without a number at the end as in "profiles_1"
    std::vector<std::string_view> other_tables = {};
};

/// Whether a quantity declares a table of this name, which may end in a number as in "profiles_1".
bool is_name_of_table(std::string_view name);

template <class M>
std::unique_ptr<Measurement> make_measurement(MeasuredRun& run, const Measurements& /*others*/) {
    return std::make_unique<M>(run);
}

/// All quantities, in the order of the list in CMakeLists.txt.
const std::vector<MeasuredQuantity>& measured_quantities();

/// Adds the arrays `mine` of all ranks, element by element, to `sums`. **Collective.**
void add_over(const Communicator& ranks, std::vector<std::uint64_t>&& mine,
              std::vector<std::uint64_t>& sums);
/// Adds 1 to the bin that contains `place`, a position in widths of bins. Positions outside all
/// bins are not counted.
void count(std::vector<std::uint64_t>& counts, double place);

} // namespace carrom
