// SPDX-License-Identifier: BSD-3-Clause
#include "measure/order_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "measure/speeds.hpp"
#include "simulation/disc_order.hpp"

namespace carrom {

namespace {

/// The approximate largest number of samples in a run of the planned length. If a condition may end
/// the run earlier, samples are as frequent as `radii_apart` allows.
constexpr std::int64_t wanted_samples = 32;
/// In the mean time between samples a disc at a typical speed moves by at least this many radii.
constexpr double radii_apart = 8;
/// The largest number of discs in a sample of psi6. With more discs psi6 would hardly be more
/// precise, and its samples would take more time than the rest of the run.
constexpr std::uint64_t most_discs = 4096;
constexpr double longest_interval = 0x1p40;
constexpr double golden_ratio = 0.6180339887498949;

/// An empty list of measured quantities, because `run_` needs one.
const MeasurementOutput no_quantities;

bool watches_order(const SceneParameters& scene) {
    if (scene.n_discs < 2) return false;
    const bool is_dense = std::max(scene.packing(), scene.last_packing()) >
                          OrderWatch::least_watched_packing;
    return is_dense || (scene.measurements && scene.measurements->measures("psi6"));
}

} // namespace

OrderWatch::OrderWatch(const SceneParameters& scene, DiscSystem& system, const Communicator& ranks)
    : run_{scene, no_quantities, system, ranks}, has_order_(watches_order(scene)),
      has_energy_(!system.averaged_system().keeps_energy) {}

void OrderWatch::begin(std::span<const std::int64_t> stored) {
    if (!is_watching()) return;
    if (!stored.empty()) {
        KeptNumbers kept(stored);
        keep(kept);
        has_begun_ = kept.is_right() && kept.is_at_end() && interval_ >= 1 &&
                     samples_.size() < most_samples;
    }
    if (!has_begun_) act();
}

void OrderWatch::start() {
    const SceneParameters& scene = run_.scene;
    first_step_ = run_.system.step();
    const double least = std::ceil(radii_apart * scene.radius / usual_speed(run_));
    interval_ = std::max({static_cast<std::int64_t>(std::clamp(least, 1.0, longest_interval)),
                          (scene.least_last_step() - first_step_) / wanted_samples});
    samples_.clear();
    has_begun_ = true;
}

/// Shifts sample n by the fractional part of n times the golden ratio, in intervals between
/// samples, so that samples fall on all phases of any period.
std::int64_t OrderWatch::step_of_next() const {
    const double next = static_cast<double>(samples_.size() + 1);
    const double shift = next * golden_ratio - std::floor(next * golden_ratio);
    return first_step_ + interval_ * static_cast<std::int64_t>(samples_.size()) +
           std::max<std::int64_t>(
               1, static_cast<std::int64_t>(shift * static_cast<double>(interval_)));
}

std::int64_t OrderWatch::next_due(std::int64_t step) const {
    if (!is_watching()) return std::numeric_limits<std::int64_t>::max();
    return std::max(step + 1, has_begun_ ? step_of_next() : run_.scene.averages_from);
}

bool OrderWatch::act() {
    if (!is_watching()) return true;
    if (!has_begun_ && run_.system.step() >= run_.scene.averages_from) return start(), true;
    if (!has_begun_ || run_.system.step() < step_of_next()) return true;
    samples_.push_back(sampled());
    if (samples_.size() < most_samples) return true;
    for (std::size_t k = 0; k < most_samples / 2; ++k) samples_[k] = samples_[2 * k + 1];
    samples_.resize(most_samples / 2);
    interval_ *= 2;
    return true;
}

OrderWatch::Sample OrderWatch::sampled() const {
    Sample sample;
    if (has_energy_) {
        const Totals now = run_.system.energies();
        sample.energy = now.energy();
    }
    if (!has_order_) return sample;
    const HexaticSums sums = sampled_order(run_.system, most_discs);
    const auto n = static_cast<double>(
        std::accumulate(sums.neighbours.begin(), sums.neighbours.end(), std::uint64_t{0}));
    if (!(n > 0)) return sample;
    const double real = sums.real.value(), imaginary = sums.imaginary.value();
    sample.together = std::sqrt(real * real + imaginary * imaginary) / n;
    sample.local = sums.modulus.value() / n;
    return sample;
}

void OrderWatch::keep(KeptNumbers& kept) {
    kept.same(run_.scene.averages_from);
    kept.same(has_order_), kept.same(has_energy_);
    kept(first_step_), kept(interval_);
    std::size_t n = samples_.size();
    kept(n);
    if (n >= most_samples) return kept.refuse();
    samples_.resize(n);
    for (Sample& sample : samples_) kept(sample.together), kept(sample.local), kept(sample.energy);
}

std::vector<std::int64_t> OrderWatch::stored() {
    if (!has_begun_) return {};
    KeptNumbers kept;
    keep(kept);
    return kept.take_words();
}

std::array<double, 4> quarters_of(std::span<const double> terms) {
    std::array<double, 4> quarters{};
    quarters.fill(std::numeric_limits<double>::quiet_NaN());
    if (terms.size() < 2 * quarters.size()) return quarters;
    for (std::size_t k = 0; k < quarters.size(); ++k) {
        const std::size_t begin = k * terms.size() / quarters.size(),
                          end = (k + 1) * terms.size() / quarters.size();
        quarters[k] = std::accumulate(terms.begin() + static_cast<std::ptrdiff_t>(begin),
                                      terms.begin() + static_cast<std::ptrdiff_t>(end), 0.0) /
                      static_cast<double>(end - begin);
    }
    return quarters;
}

WatchedNumber OrderWatch::number(std::string name, double Sample::* one) const {
    std::vector<double> terms;
    for (const Sample& sample : samples_) terms.push_back(sample.*one);
    const auto n = static_cast<double>(terms.size());
    const BlockedMean blocked = blocked_mean(terms);
    const double apart = static_cast<double>(interval_);
    return {std::move(name),
            {std::accumulate(terms.begin(), terms.end(), 0.0) / n, blocked.error,
             blocked.blocks_per_independent * apart / 2, n / blocked.blocks_per_independent,
             blocked.is_constant, blocked.is_changing},
            quarters_of(terms)};
}

std::vector<WatchedNumber> OrderWatch::watched() const {
    std::vector<WatchedNumber> all;
    if (samples_.empty()) return all;
    if (has_order_) {
        all.push_back(number(order_names[0], &Sample::together));
        all.push_back(number(order_names[1], &Sample::local));
    }
    if (has_energy_)
        if (WatchedNumber energy = number("energy", &Sample::energy);
            !energy.mean.is_constant && !std::isnan(energy.quarters.front()))
            all.push_back(std::move(energy));
    return all;
}

} // namespace carrom
