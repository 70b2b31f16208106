// SPDX-License-Identifier: BSD-3-Clause
// The time-stepped method on a device. The discs stay in the device's memory. Their states are
// copied to the host only for measurements, checkpoints, printed lists of discs, and totals.
//
// The host chooses windows and reads a few numbers after each window. A device never divides a
// micro-step into parts: if discs are fast, a window is one micro-step, and its cells are wide
// enough for the flights in it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "engine/engine_base.hpp"
#include "engine/window_choice.hpp"
#include "gpu/stepper.hpp"

namespace carrom {

template <class Dynamics> class GpuEngine final : public EngineBase<Dynamics> {
public:
    GpuEngine(const SceneParameters& scene, StoredState state, const Communicator& communicator,
              const Tuning& tuning, const DeviceKind& device);

    void add_to(Totals& totals) override;
    DeviceFacts device() const override { return facts_; }

private:
    using Base = EngineBase<Dynamics>;
    using Base::communicator_, Base::tuning_, Base::dynamics_, Base::discs_, Base::phases_;
    using Base::largest_speed_, Base::travel_speed_;
    using Base::time_, Base::n_micro_done_, Base::n_windows_;

    void advance_to(std::int64_t target) override;
    void migrate() override;
    void finish_sync(double largest_speed) override;
    void take_speed(double largest_speed) override;
    double restart_states() override;
    void bring_states() const override;

    void run_window(int n_left);
    int choose_length(int n_left) const;
    WindowNeeds needs() const;
    DeviceWindow device_window() const;
    void take_stress();
    void put_states();
    void refuse_followers() const;

    DeviceFacts facts_;
    std::unique_ptr<Stepper> stepper_;
    /// `discs_` without const, because const functions copy the device's discs into it
    StripDiscs* on_host_ = nullptr;
    PhaseClock* copying_time_ = nullptr; ///< `phases_` without const, for copies in const functions
    mutable bool is_host_current_ = true;
    double window_speed_ = 0; ///< speed that the window's reach allows for
    /// Bound on speeds in the next window, relative to the largest speed
    double speed_allowance_ = 1.02;
    /// Collisions per disc and micro-step in the last sync interval
    double hits_per_micro_step_ = 0;
    std::uint64_t n_candidates_ = 0, n_kept_ = 0, n_kept_at_sync_ = 0;
};

} // namespace carrom
