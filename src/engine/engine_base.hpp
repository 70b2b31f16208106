// SPDX-License-Identifier: BSD-3-Clause
// The base of the engines of both methods. It keeps discs, clock and communicator, runs from sync
// to sync, sends discs to their ranks, and reports totals. Each method adds its own windows.
//
//   advance_towards   until the stop or the next sync:
//     advance_to        the method's windows
//     sync              all states at one time; times start again from 0; new cuts if they are due
#pragma once

#include <cstdint>
#include <span>

#include "domain/strip_discs.hpp"
#include "dynamics/all_dynamics.hpp"
#include "engine/engine.hpp"
#include "engine/phase_clock.hpp"
#include "engine/sync_action.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

template <class Dynamics> class EngineBase : public Engine {
public:
    void advance_towards(std::int64_t last_step) final;
    void add_to(Totals& totals) override;
    LocalView local_view(double reach) final;
    void forget_images() final { discs_.forget_images(time_ == 0); }

    std::int64_t micro_steps_done() const final { return n_micro_done_; }
    std::span<const DiscState> own() const final {
        bring_states();
        return discs_.own();
    }
    std::span<const DiscState> departed() const final { return discs_.departed(); }
    SideSpans side_columns() const final {
        bring_states();
        return discs_.own_columns();
    }
    SideSpans departed_columns() const final { return discs_.departed_columns().spans(); }
    const SpeciesTable& species_table() const final { return species_; }
    double size() const final {
        const SizeChange* const sizes = sync_action_.sizes();
        return sizes ? sizes->size() : 1;
    }
    double clock() const final { return time_; }
    Frame frame() const final;
    FlightIntegral flight_integral() const final {
        FlightIntegral integral = dynamics_.flight_integral_at(time_);
        integral.weight += flown_before_;
        return integral;
    }
    Box box() const final { return dynamics_.box(); }
    std::uint64_t n_discs() const final { return discs_.n_with_departed(); }
    double energy_given() const final { return sync_action_.energy_given(); }
    std::vector<std::int64_t> kept_by_effects() const final { return sync_action_.kept(); }
    PhaseSeconds phase_seconds() const final { return phases_.seconds(); }
    int most_ranks_across() const final { return discs_.domains().largest_group(); }

protected:
    /// Takes over the state. A derived class calls `distribute` when its own members are ready.
    EngineBase(const SceneParameters& scene, StoredState state, const Communicator& communicator,
               const Tuning& tuning);

    /// Runs windows until `n_micro_done_` is `target`, which is not beyond the next
    /// sync. **Collective.**
    virtual void advance_to(std::int64_t target) = 0;
    /// Sends each own disc to the rank whose domain contains its present position. **Collective.**
    virtual void migrate() = 0;
    /// Called after a sync at `time_`, before times start again from 0. No own disc is faster than
    /// `largest_speed`. **Collective.**
    virtual void finish_sync(double largest_speed) = 0;
    /// Called after finish_sync if discs may have come in, and after effects that act before
    /// flights. No own disc is faster than `largest_speed`. **Collective.**
    virtual void take_speed(double largest_speed) = 0;
    /// Ends a window that extends beyond the present stop. **Collective.**
    virtual void leave_window() { is_in_window_ = false; }
    /// Advances own discs to `time_`, which becomes time 0. Returns this rank's largest speed.
    virtual double restart_states();
    /// Copies the present states to `discs_`, in engines that keep states elsewhere.
    virtual void bring_states() const {}
    /// Frees the memory that is kept from one window to the next.
    virtual void drop_scratch() { discs_.drop_grid(); }

    /// Cuts the box into new domains and sends each disc to its domain, from any position.
    /// **Collective.**
    void distribute();
    /// The micro-step until which windows may extend if the run stops at `target`: `target` or
    /// later. If windows ended at all stops, runs that are inspected at each step would have a
    /// window for each step, which costs nearly as much as a long window.
    std::int64_t horizon_of(std::int64_t target) const;
    /// Stops are probable at multiples of this number of micro-steps after the present stop.
    std::int64_t stop_interval() const { return stop_interval_; }
    /// The region that cells cover: the whole region that the rank uses, or only the part of it
    /// that contains its discs. If discs are clustered, cells of the whole region would hold
    /// hundreds of discs each.
    enum class Covered { domain, discs };
    /// Redistributes discs, fetches the halo and sorts both into cells at the present time, for
    /// pairs within a diameter, or within `least_reach` if that is more. States do not change.
    /// **Collective.**
    void redistribute_now(double least_reach = 0, Covered covered = Covered::discs);
    /// Moves departed discs out of the arrays of own discs. **Collective.**
    void set_departed_aside();

    /// Ends the run if discs are so fast that they cross a periodic box more often than image
    /// counts allow. `speed` is the largest speed, equal on all ranks. **Collective.**
    void refuse_long_flights(double speed) const;

    /// At a sync: adds the time since the last sync to `flown_before_`. If flights must be added to
    /// the sums of stress at this sync, sets it to 0 instead and returns true.
    bool begin_flights();
    /// The square of the largest speed of own discs at `time`.
    double squared_speed_of_own(double time) const;
    /// Adds the number of discs in a window, halo included, to this rank's work, and returns it.
    std::size_t count_seen() {
        rank_work_.of_discs += discs_.all().size();
        return discs_.all().size();
    }

    Population population() const { return discs_.population(); }
    /// Positions of the box's sides now, in the coordinates of stored states.
    Extent extent() const;
    std::int64_t last_sync() const { return n_micro_done_ / sync_every_ * sync_every_; }
    /// Upper bound of the rounding error of a position, plus half the largest gap that rounding
    /// leaves between discs in contact.
    double place_margin() const {
        return 64 * 0x1p-53 * dynamics_.box().longest() + dynamics_.slack();
    }

    Communicator communicator_;
    Tuning tuning_;
    Dynamics dynamics_;
    /// Micro-steps in a step, and micro-steps from sync to sync
    std::int64_t micro_steps_, sync_every_;
    StripDiscs discs_;

    std::int64_t n_micro_done_ = 0, n_windows_ = 0;
    double time_ = 0;           ///< time since the last sync, on the clock of the dynamics
    bool is_in_window_ = false; ///< the run has stopped inside a window that is not finished
    /// Time of the flights before the last sync that are not yet added to the stress
    double flown_before_ = 0;
    double redistributed_time_ = 0; ///< time of the last migration, relative to the last sync
    double largest_speed_ = 0;      ///< upper bound of the speed of own discs
    double travel_speed_ = 0; ///< bound of all speeds since the last migration; equal on all ranks
    RankWork rank_work_;      ///< this rank's work since the loads of ranks were last compared
    PhaseClock phases_;

private:
    void sync();
    double let_effects_act();
    void let_effects_begin();
    double largest_speed_of_all_states() const;
    void change_volume();
    void reshape(const Box& box);
    double let_discs_in(DiscSource& source);
    void fetch_neighbours(double reach);
    void forget_neighbours();
    void visit_neighbours(double reach, const SyncDiscs::VisitNear& visit) const;
    void wrap(DiscState& disc);
    Extent where_discs_are(const Extent& seen, double reach) const;
    double energy_of_own() const;
    std::int64_t flight_length() const;

    SpeciesTable species_;
    SyncAction sync_action_;
    /// Number of micro-steps between two syncs at which flights are added to the sums of stress
    std::int64_t flight_length_;
    std::int64_t last_micro_step_, n_syncs_ = 0;
    /// Whether windows continue after stops. This is so if no redistribution followed the last stop
    /// between syncs, because a redistribution would make the rest of a window useless.
    bool windows_pass_stops_ = false;
    bool is_redistributed_ = true; ///< whether discs have been redistributed since the last stop
    /// Greatest common divisor of the micro-steps between stops since the last sync; 0 at first
    std::int64_t stop_interval_ = 0;
};

#define CARROM_DECLARE(Dynamics) extern template class EngineBase<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DECLARE)
#undef CARROM_DECLARE

} // namespace carrom
