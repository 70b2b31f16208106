// SPDX-License-Identifier: BSD-3-Clause
// Discs in the memory of a device, which runs their steps. Engines use devices only through this
// header, so that a compiler for GPUs has to read as little of the program as possible.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/disc_state.hpp"
#include "dynamics/species.hpp"
#include "engine/device_facts.hpp"
#include "engine/stress_sums.hpp"
#include "gpu/device_dynamics.hpp"
#include "time_stepped/window.hpp"

namespace carrom {

/// The arguments of a window. Lengths are in the scene's unit; speeds are per micro-step.
struct DeviceWindow {
    Window window;
    double reach = 0; ///< reach of the window (reach_of)
    double speed = 0; ///< speed for which the reach is enough; a faster disc cuts the window short
    double flown = 0; ///< micro-steps flown before the last sync that the stress sums lack
    double stress_scale = 0; ///< ExactSum::scale of the sums of stress; 0: no stress is summed
};

/// The results of a window.
struct DeviceOutcome {
    int n_micro = 0;          ///< number of completed micro-steps
    double squared_speed = 0; ///< square of the largest speed since the last sync
    /// Numbers of candidates found and carried out since the stepper was made
    std::uint64_t n_candidates = 0, n_kept = 0;
};

/// The discs on a device. If the device fails, functions throw CollectiveError.
class Stepper {
public:
    Stepper() = default;
    virtual ~Stepper() = default;
    Stepper(const Stepper&) = delete;
    Stepper& operator=(const Stepper&) = delete;

    /// Replaces the discs; their number never changes.
    virtual void put(std::span<const DiscState> discs) = 0;
    /// Copies the discs to the host, in the order of the device's memory.
    virtual void get(std::span<DiscState> discs) = 0;
    virtual DeviceOutcome run(const DeviceWindow& window) = 0;
    /// Advances all discs to `time`, which is time 0 afterwards (EngineBase::restart_states), and
    /// returns the largest squared speed. Of `window` it uses only `flown` and `stress_scale`.
    virtual double restart(double time, bool ends_flights, const DeviceWindow& window) = 0;
    /// Adds the stress since the previous call to `sums`, which must have the `stress_scale` of the
    /// windows since then.
    virtual void take_stress(StressSums& sums) = 0;
};

/// Device memory in bytes: for each disc, and for each run in addition to its discs.
constexpr std::uint64_t device_bytes_per_disc = 152, device_bytes_of_run = std::uint64_t{64} << 20;

/// A kind of device. There is one for each way to compile the kernels: GPU and CPU.
class DeviceKind {
public:
    virtual ~DeviceKind() = default;
    /// Facts about the device that this process uses. Throws CollectiveError if there is none.
    virtual DeviceFacts facts() const = 0;
    /// Makes a stepper for discs with this motion; `species` owns the table that the motion reads.
#define CARROM_DECLARE(Dynamics)                                                                   \
    virtual std::unique_ptr<Stepper> make_stepper(const MotionOf<Dynamics>& motion,                \
                                                  const SpeciesTable& species,                     \
                                                  std::uint32_t n_discs) const = 0;
    CARROM_FOR_EACH_DYNAMICS_OF_GPUS(CARROM_DECLARE)
#undef CARROM_DECLARE
};

} // namespace carrom
