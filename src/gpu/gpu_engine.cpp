// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/gpu_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/stop_request.hpp"
#include "engine/dynamics_of_scene.hpp"
#include "gpu/gpu.hpp"

namespace carrom {

namespace {

/// The speed up to which a window is valid, relative to the largest speed: the value in
/// equilibrium, and the value after a window that was cut short.
constexpr double least_allowance = 1.02, allowance_after_cut = 1.15;

/// Reorders `columns` from the order of `old_ids` to the order of `discs`. Ids are 0 to n - 1.
void follow(SideColumns& columns, std::span<const DiscId> old_ids,
            std::span<const DiscState> discs) {
    std::vector<std::size_t> place_of(old_ids.size());
    for (std::size_t i = 0; i < old_ids.size(); ++i) place_of[old_ids[i]] = i;
    columns.for_each([&](SideColumn column) {
        std::vector<double>& values = columns[column];
        std::vector<double> moved(values.size());
        for (std::size_t i = 0; i < discs.size(); ++i) moved[i] = values[place_of[discs[i].id]];
        values = std::move(moved);
    });
}

} // namespace

template <class Dynamics>
GpuEngine<Dynamics>::GpuEngine(const SceneParameters& scene, StoredState state,
                               const Communicator& communicator, const Tuning& tuning,
                               const DeviceKind& device)
    : Base(scene, std::move(state), communicator, tuning), facts_(device.facts()),
      on_host_(&discs_), copying_time_(&phases_) {
    this->distribute();
    discs_.forget_images();
    stepper_ = device.make_stepper(dynamics_.motion(), dynamics_.species_table(),
                                   static_cast<std::uint32_t>(discs_.n_own()));
    put_states();
    phases_ = {};
}

template <class Dynamics> void GpuEngine<Dynamics>::put_states() {
    const PhaseClock::Scope scope(phases_, Phase::exchange);
    stepper_->put(discs_.own());
    is_host_current_ = true;
}

/// Copies the discs to the host, in the order of the device's memory.
template <class Dynamics> void GpuEngine<Dynamics>::bring_states() const {
    if (is_host_current_) return;
    const PhaseClock::Scope scope(*copying_time_, Phase::exchange);
    is_host_current_ = true;
    on_host_->forget_halo();
    on_host_->drop_grid(); // the grid was made for the old order
    std::vector<DiscId> old_ids;
    bool has_columns = false;
    on_host_->columns().for_each([&](SideColumn) { has_columns = true; });
    if (has_columns)
        for (const DiscState& disc : on_host_->own()) old_ids.push_back(disc.id);
    stepper_->get(on_host_->own());
    if (has_columns) follow(on_host_->columns(), old_ids, on_host_->own());
    if constexpr (Dynamics::is_periodic) on_host_->forget_images();
}

template <class Dynamics> void GpuEngine<Dynamics>::migrate() {
    const double anywhere = dynamics_.box().longest();
    discs_.drop_grid();
    discs_.migrate(time_, anywhere, nullptr);
    this->redistributed_time_ = time_;
}

template <class Dynamics> void GpuEngine<Dynamics>::advance_to(std::int64_t target) {
    refuse_followers();
    while (n_micro_done_ < target) run_window(static_cast<int>(target - n_micro_done_));
    take_stress();
}

template <class Dynamics> void GpuEngine<Dynamics>::refuse_followers() const {
    if (this->is_followed() || this->work_)
        throw CollectiveError("this version lists no single collisions on a GPU; try: without "
                              "machine.gpu");
}

/// Runs one window of at most `n_left` micro-steps. It ends early if discs become too fast.
template <class Dynamics> void GpuEngine<Dynamics>::run_window(int n_left) {
    const PhaseClock::Scope scope(phases_, Phase::move);
    if (is_stop_overdue()) throw StopRequested("stopped on request inside a step");
    travel_speed_ = largest_speed_;
    this->refuse_long_flights(largest_speed_);
    window_speed_ = largest_speed_ * speed_allowance_;
    DeviceWindow window = device_window();
    window.window.n_micro = choose_length(n_left);
    window.reach = reach_of(needs(), window.window.duration());
    is_host_current_ = false;
    const DeviceOutcome outcome = stepper_->run(window);
    ensure(outcome.n_micro > 0, "a device does at least one micro-step of a window");
    speed_allowance_ = outcome.n_micro < window.window.n_micro
                           ? allowance_after_cut
                           : std::max(least_allowance, (1 + speed_allowance_) / 2);
    largest_speed_ = std::max(largest_speed_, std::sqrt(outcome.squared_speed));
    n_candidates_ = outcome.n_candidates;
    n_kept_ = outcome.n_kept;
    ++n_windows_;
    n_micro_done_ += outcome.n_micro;
    time_ += outcome.n_micro;
}

template <class Dynamics> DeviceWindow GpuEngine<Dynamics>::device_window() const {
    DeviceWindow window;
    window.window.first_micro = static_cast<int>(time_);
    window.speed = window_speed_;
    window.flown = this->flown_before_;
    if (this->stress_) window.stress_scale = this->stress_->xx.scale();
    return window;
}

template <class Dynamics> int GpuEngine<Dynamics>::choose_length(int n_left) const {
    int longest = std::min(n_left, longest_window);
    if constexpr (Dynamics::is_periodic) {
        const double in_period = longest_in_period(discs_.periods(), window_speed_);
        longest = static_cast<int>(std::clamp(in_period, 1.0, static_cast<double>(longest)));
    }
    return choose_window(needs(), longest, tuning_.window).n_micro;
}

template <class Dynamics> WindowNeeds GpuEngine<Dynamics>::needs() const {
    const auto n = static_cast<double>(discs_.n_total());
    return {dynamics_.box(),
            dynamics_.radius() + dynamics_.slack(),
            n,
            window_speed_,
            hits_per_micro_step_,
            n,
            nullptr};
}

template <class Dynamics> void GpuEngine<Dynamics>::take_stress() {
    if (this->stress_) stepper_->take_stress(*this->stress_);
}

/// If a measurement follows the images of discs, the host carries out the sync, because the
/// measurement needs the flight of each disc.
template <class Dynamics> double GpuEngine<Dynamics>::restart_states() {
    if (!this->crossings_.empty()) {
        bring_states();
        const double largest_speed = Base::restart_states();
        put_states();
        return largest_speed;
    }
    take_stress();
    is_host_current_ = false;
    const DeviceWindow window = device_window();
    const bool ends_flights = this->begin_flights();
    const double squared_speed = stepper_->restart(time_, ends_flights, window);
    if (this->stress_ && ends_flights) {
        StressSums flights = this->no_stress_;
        stepper_->take_stress(flights);
        flights.energy += flights.xx;
        flights.energy += flights.yy;
        *this->stress_ += flights;
    }
    return std::sqrt(squared_speed);
}

template <class Dynamics> void GpuEngine<Dynamics>::finish_sync(double largest_speed) {
    largest_speed_ = largest_speed;
    const auto n_kept = n_kept_ - std::exchange(n_kept_at_sync_, n_kept_);
    hits_per_micro_step_ = 2 * static_cast<double>(n_kept) /
                           (std::max(static_cast<double>(discs_.n_total()), 1.0) *
                            static_cast<double>(this->sync_every_));
}

/// The states on the device are already current, because scenes with effects that change velocities
/// on the host cannot run on a GPU (EffectDeclaration).
template <class Dynamics> void GpuEngine<Dynamics>::take_speed(double largest_speed) {
    largest_speed_ = std::max(largest_speed_, largest_speed);
}

template <class Dynamics> void GpuEngine<Dynamics>::add_to(Totals& totals) {
    totals.rejected_candidates = communicator_.sum(n_candidates_ - n_kept_);
    bring_states();
    Base::add_to(totals);
}

std::unique_ptr<Engine> make_gpu_engine_on(const DeviceKind& device, const SceneParameters& scene,
                                           StoredState state, const Communicator& communicator,
                                           const Tuning& tuning) {
    return with_dynamics_of(scene, [&]<class Dynamics>() -> std::unique_ptr<Engine> {
        if constexpr (is_dynamics_of_gpus<Dynamics>)
            return std::make_unique<GpuEngine<Dynamics>>(scene, std::move(state), communicator,
                                                         tuning, device);
        fail("a scene that a GPU cannot do has been checked", __FILE__, __LINE__);
    });
}

} // namespace carrom
