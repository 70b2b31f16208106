// SPDX-License-Identifier: BSD-3-Clause
// The wave vectors of structure factors: one of each two opposite wave vectors of a periodic box,
// up to a largest wavenumber, in bins of wavenumber. Also the setting and the rules for them.
#pragma once

#include <span>
#include <vector>

#include "measure/measurement.hpp"
#include "statistics/blocking.hpp"
#include "statistics/structure_factor.hpp"

namespace carrom {

inline constexpr QuantitySetting largest_wavenumber{"largest_wavenumber"};

Key largest_wavenumber_key();
/// Sets the largest wavenumber if the scene does not. Checks that there is at least one wave
/// vector, and at most a million, because a sample evaluates each vector for each disc.
void check_wavenumber(const SceneDraft& draft);
/// The rules that the box must be periodic along both axes and that its sides must not be sheared.
template <bool (*is_measured)(const SceneParameters&)>
std::vector<Rule> rules_of_waves(std::string_view quantity) {
    return {
        {.one = "sheared sides",
         .other = quantity,
         .why = "the flow bends waves",
         .keys = {quantities_key},
         .is_broken =
             [](const SceneParameters& s) { return is_measured(s) && s.effects.are_sheared(); }},
        {.one = quantity,
         .other = "a side that is not periodic",
         .why = "wave vectors are those of a box that repeats itself; make all four sides "
                "periodic",
         .keys = {quantities_key},
         .is_broken = [](const SceneParameters& s) {
             return is_measured(s) && !(s.effects.is_periodic_x() && s.effects.is_periodic_y());
         }}};
}

class WaveBins {
public:
    explicit WaveBins(const MeasuredRun& run);

    const std::vector<WaveVector>& vectors() const { return vectors_; }
    std::size_t size() const { return n_bins_; }
    double largest() const { return largest_; }
    double low(std::size_t bin) const;
    double high(std::size_t bin) const { return low(bin + 1); }
    double length_of(const WaveVector& vector) const;

    /// The number of vectors in each bin.
    std::vector<double> counts() const;
    /// The mean over each bin of `numbers`, which has a number for each wave vector; NaN for an
    /// empty bin.
    std::vector<double> means(std::span<const double> numbers) const;
    /// Density modes of all ranks' discs; each rank passes its own in `discs`. **Collective.**
    DensityModes modes(const MeasuredRun& run, std::span<const DiscState> discs) const;

private:
    std::size_t bin_of(const WaveVector& vector) const;

    Box box_;
    double largest_;
    std::size_t n_bins_;
    std::vector<WaveVector> vectors_;
};

/// A measurement at wave vectors, with sums over all samples and with blocks of samples for errors.
class WaveMeasurement : public Measurement {
public:
    void keep(KeptNumbers& kept) override;

protected:
    explicit WaveMeasurement(MeasuredRun& run) : Measurement(run), waves_(run) {}

    WaveBins waves_;
    std::vector<double> sums_;
    VectorBlocks blocks_;
};

} // namespace carrom
