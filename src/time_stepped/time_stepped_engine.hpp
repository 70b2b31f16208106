// SPDX-License-Identifier: BSD-3-Clause
// The time-stepped method on ranks and threads. A window of time goes through these phases:
//
//   redistribute  Own discs go to their strips and cells. Halo discs come from the neighbours.
//   search        Every contact of the window is found, from stored states alone.
//
// Then for each micro-step of the window, on all ranks at the same time:
//
//   resolve       Each rank decides candidates alone as far as possible. Messages between ranks,
//                 and for long chains a distributed sort, decide the rest.
//   apply         Discs that collide get new states. Halos are updated. Another search follows.
//
// If discs are fast, a micro-step is divided into parts, each a window of its own. States do not
// change until the micro-step ends, so that every candidate is found. `outcomes_` contains the new
// states until then.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/raw_vector.hpp"
#include "engine/engine_base.hpp"
#include "engine/window_choice.hpp"
#include "time_stepped/boundary_resolution.hpp"
#include "time_stepped/local_resolution.hpp"
#include "time_stepped/search.hpp"

namespace carrom {

template <class Dynamics> class TimeSteppedEngine final : public EngineBase<Dynamics> {
public:
    TimeSteppedEngine(const SceneParameters& scene, StoredState state,
                      const Communicator& communicator, const Tuning& tuning);

    void add_to(Totals& totals) override;

private:
    using Base = EngineBase<Dynamics>;
    using Base::communicator_, Base::tuning_, Base::dynamics_, Base::discs_, Base::phases_;
    using Base::largest_speed_, Base::travel_speed_;
    using Base::population, Base::extent;
    using Base::time_, Base::redistributed_time_, Base::n_micro_done_, Base::n_windows_;

    void advance_to(std::int64_t target) override;
    void migrate() override;
    void finish_sync(double largest_speed) override;
    void take_speed(double largest_speed) override;
    void leave_window() override {
        Base::leave_window();
        end_window(false);
    }

    void run_window(int n_left, int n_to_horizon);
    void begin_window(int n_left);
    void end_window(bool is_cut);
    Window redistribute(int n_left);
    Window choose(int n_left);
    WindowNeeds window_needs() const;
    WindowNeeds usual_needs() const;
    void survey_images();
    void agree_on_speed();
    void migrate_at(double time);
    void sort(const Window& window, double reach, double usual_reach);
    DiscStates* companion() { return in_parts_ ? &outcomes_ : nullptr; }

    bool run_micro_step(const Window& window, int m);
    std::uint64_t count_ours(std::span<const Candidate> candidates) const;
    void strike_taken(Candidates& live) const;
    void apply(const Window& window, int m);
    double collide_all(const Window& window, int m, DiscStates& results);
    double collide(const Candidate& candidate, int m, DiscStates& results, StressTerms& terms,
                   StressSums& stress);
    void prefetch(const Candidate& candidate, const DiscStates& results, bool is_last) const;
    void update_flight(LocalIndex index, const DiscState& disc) {
        if constexpr (Dynamics::is_periodic)
            discs_.grid().update_flight_of_image(index, disc);
        else
            discs_.grid().update_flight(index, disc);
    }
    /// The disc's angular velocity; null if discs do not rotate.
    double* spin_of(LocalIndex index) {
        return dynamics_.has_spin() ? &discs_.columns()[SideColumn::spin][index] : nullptr;
    }
    void update_halo(const Window& window, int m);
    void record_velocities(std::span<const DiscState> results);
    void log_collisions(std::span<const DiscState> results, int m);

    DiscStates outcomes_; ///< new states of discs_.all() while a micro-step is divided into parts
    Window window_;
    bool in_parts_ = false; ///< whether the present micro-step is divided
    /// The next part of the present micro-step, and the number of parts
    int part_ = 0, n_parts_ = 1;

    double refreshed_speed_ = 0; ///< largest speed after the last sync; 0 once it has been used
    /// A time before which no state has changed since the last migration
    double unchanged_until_ = 0;

    /// Upper bound of speeds in the next window, relative to the largest speed at its start
    double speed_allowance_ = 1.02;
    /// Collisions per disc and micro-step in the last sync interval
    double hits_per_micro_step_ = 0;
    double window_speed_ = 0; ///< largest speed for which the window's reach is enough
    double usual_speed_ = 0;  ///< largest speed for which the window's cells are made
    SpeedSpread spread_;      ///< speeds at the start, or after the last divided micro-step
    bool speed_exceeded_ = false;

    Search<Dynamics> search_;
    LocalResolution local_;
    BoundaryResolution across_strips_;
    Verdicts verdicts_;
    RawVector<LocalIndex> hits_;
    std::vector<LocalIndex> updates_;
    DiscStates unhit_; ///< for the log: first discs of the kept candidates, before the collision
    DiscStates unhit_partners_;     ///< second discs before the collision, if pairs are recorded
    RawVector<WindowState> states_; ///< number of each disc's state (window.hpp)

    // Numbers of candidates whose first disc is an own disc.
    std::uint64_t n_candidates_ = 0, n_kept_ = 0, n_kept_at_sync_ = 0;
};

/// The engine of the time-stepped method with the scene's dynamics. **Collective.**
std::unique_ptr<Engine> make_time_stepped_engine(const SceneParameters& scene, StoredState state,
                                                 const Communicator& communicator,
                                                 const Tuning& tuning);

} // namespace carrom
