// SPDX-License-Identifier: BSD-3-Clause
#include "run/stop_check.hpp"

#include <limits>

#include <fmt/format.h>

#include "simulation/disc_statistics.hpp"

namespace carrom {

namespace {

bool any(const StopConditions& stop) {
    return stop.collisions || stop.departed || stop.temperature_below || stop.temperature_above ||
           stop.energy_below || stop.energy_above || stop.pressure_below || stop.pressure_above;
}

} // namespace

std::string text_of(const StopReason& reason) {
    return fmt::format("{} = {:g}: {:.10g}", reason.key, reason.limit, reason.value);
}

StopCheck::StopCheck(const SceneParameters& scene, DiscSystem& system, const Communicator& ranks,
                     std::span<const std::int64_t> stored)
    : scene_(scene), system_(system), ranks_(ranks), has_conditions_(any(scene.stop)),
      has_pressure_(scene.stop.pressure_below || scene.stop.pressure_above),
      last_pressure_(std::numeric_limits<double>::quiet_NaN()), last_check_(system.step()) {
    if (!has_conditions_) return;
    if (has_pressure_ && !stored.empty()) {
        KeptNumbers kept(stored);
        keep(kept);
        if (!kept.is_right()) pressure_.reset();
    }
    if (has_pressure_ && !pressure_) {
        pressure_.emplace(system_, ranks_);
        last_pressure_ = std::numeric_limits<double>::quiet_NaN();
        last_check_ = system_.step();
    }
    if (is_due(system_.step())) check();
}

bool StopCheck::is_due(std::int64_t step) const {
    return step == 0 || n_syncs(step) > n_syncs(step - 1);
}

std::int64_t StopCheck::next_due(std::int64_t step) const {
    if (!has_conditions_) return std::numeric_limits<std::int64_t>::max();
    const std::int64_t micro_step = (n_syncs(step) + 1) * scene_.sync_every;
    return (micro_step + scene_.micro_steps - 1) / scene_.micro_steps;
}

bool StopCheck::act() {
    if (!has_conditions_ || reason_) return !reason_;
    if (is_due(system_.step()) && system_.step() > last_check_) {
        measure_pressure();
        last_check_ = system_.step();
        check();
    }
    return !reason_;
}

void StopCheck::measure_pressure() {
    if (!pressure_) return;
    pressure_->sample(static_cast<double>(system_.step() - last_check_));
    const std::vector<double>& numbers = pressure_->pressures();
    last_pressure_ = (numbers[0] + numbers[2]) / 2;
    pressure_->forget_pressures();
}

/// Finds the first condition that holds, in the order of the keys.
void StopCheck::check() {
    const StopConditions& stop = scene_.stop;
    check_counts();
    if (reason_) return;
    if (stop.temperature_below || stop.temperature_above) {
        const double kt = temperature_at(system_.averaged_system(), motion_sample(system_));
        if (holds("kT", stop.temperature_below, stop.temperature_above, kt)) return;
    }
    if (stop.energy_below || stop.energy_above) {
        const double energy = system_.energies().kinetic_energy;
        if (holds("energy", stop.energy_below, stop.energy_above, energy)) return;
    }
    holds("pressure", stop.pressure_below, stop.pressure_above, last_pressure_);
}

void StopCheck::check_counts() {
    const StopConditions& stop = scene_.stop;
    if (!stop.collisions && !stop.departed) return;
    std::uint64_t n_collisions = 0, n_departed = 0;
    for (const DiscState& disc : system_.discs()) {
        n_collisions += disc.pair_collisions;
        n_departed += disc.has_departed() ? 1 : 0;
    }
    if (stop.collisions && reaches("collisions", stop.collisions, ranks_.sum(n_collisions) / 2))
        return;
    if (stop.departed) reaches("departed", stop.departed, ranks_.sum(n_departed));
}

bool StopCheck::reaches(const char* name, const std::optional<std::int64_t>& limit,
                        std::uint64_t count) {
    if (static_cast<std::int64_t>(count) < *limit) return false;
    reason_ = {fmt::format("time.stop.{}", name), static_cast<double>(*limit),
               static_cast<double>(count), system_.step()};
    return true;
}

/// NaN, which stands for a missing value, is neither below nor above.
bool StopCheck::holds(const char* name, const std::optional<double>& below,
                      const std::optional<double>& above, double value) {
    const bool is_below = below && value < *below, is_above = above && value > *above;
    if (!is_below && !is_above) return false;
    reason_ = {fmt::format("time.stop.{}_{}", name, is_below ? "below" : "above"),
               is_below ? *below : *above, value, system_.step()};
    return true;
}

void StopCheck::keep(KeptNumbers& kept) {
    kept(last_check_), kept(last_pressure_);
    PressureSampler::keep(kept, pressure_, system_, ranks_);
}

std::vector<std::int64_t> StopCheck::stored() {
    if (!pressure_) return {};
    KeptNumbers kept;
    keep(kept);
    return kept.take_words();
}

} // namespace carrom
