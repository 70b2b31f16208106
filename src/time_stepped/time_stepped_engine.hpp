// SPDX-License-Identifier: BSD-3-Clause
// The time-stepped method on ranks and threads: windows of time, each settled, searched, resolved
// and applied.
//
//   settle   own discs to their strips and into the order of their cells, halo discs from the
//   neighbours search   every contact of the window, from stored states alone then for each
//   micro-step of the window, in step on all ranks:
//     resolve  local rounds; what hangs together across strips by a distributed sort
//     apply    new states for the discs that were taken; neighbours are told of theirs; those discs
//     are searched again
//
// When discs are fast a micro-step is cut into parts, each a window of its own. States then stay as
// they were at the micro-step's start until it ends, so that every candidate is seen, and
// `outcomes_` holds what they will become.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "engine/engine.hpp"
#include "engine/phase_clock.hpp"
#include "engine/strip_discs.hpp"
#include "engine/window_choice.hpp"
#include "scene/scene.hpp"
#include "time_stepped/boundary_resolution.hpp"
#include "time_stepped/local_resolution.hpp"
#include "time_stepped/search.hpp"

namespace carrom {

template <class Dynamics> class TimeSteppedEngine final : public Engine {
public:
    TimeSteppedEngine(const Scene& scene, StoredState state, const Communicator& communicator,
                      const Tuning& tuning);

    void advance_towards(std::int64_t last_step) override;
    void add_to(Totals& totals) override;
    LocalView local_view(double reach) override;
    void forget_images() override { discs_.forget_images(); }

    std::int64_t micro_steps_done() const override { return n_micro_done_; }
    std::span<const Disc> own() const override { return discs_.own(); }
    std::span<const double> spins() const override { return discs_.own_spins(); }
    const SpeciesTable* species_table() const override {
        if constexpr (Dynamics::has_species) return &dynamics_.species_table();
        return nullptr;
    }
    double clock() const override { return micro_; }
    Frame frame() const override;
    std::span<const Disc> departed() const override { return discs_.departed(); }
    std::uint64_t n_discs() const override { return discs_.n_with_departed(); }
    PhaseSeconds phase_seconds() const override { return clock_.seconds(); }

private:
    Population population() const { return discs_.population(); }
    /// Settles discs, halo and grid as they are now, for partners within a diameter or `reach`. No
    /// state changes. **Collective.**
    void redistribute_now(double reach = 0);
    void set_departed_aside();
    void run_window(int n_left);
    Window redistribute(int n_left);
    Window choose(int n_left);
    WindowNeeds window_needs() const;
    void agree_on_speed();
    void migrate(double time);
    void fetch_halo(double time, double reach);
    std::vector<Disc>* companion() { return in_parts_ ? &outcomes_ : nullptr; }
    bool run_micro_step(const Window& window, int m);
    std::uint64_t count_ours(std::span<const Candidate> candidates) const;
    void strike_taken(std::vector<Candidate>& live) const;
    void apply(const Window& window, int m);
    void update_flight(LocalIndex index, const Disc& disc);
    void update_halo(const Window& window, int m);
    void note_velocities(std::span<const Disc> results);
    void log_collisions(std::span<const Disc> results, int m);
    void sync();
    void sort(const Window& window, double reach, double usual_reach);
    void survey_speeds();

    Communicator communicator_;
    Tuning tuning_;
    Dynamics dynamics_;
    std::int64_t micro_steps_, sync_every_, last_micro_step_;

    StripDiscs discs_;
    std::vector<Disc> outcomes_; ///< runs along discs_.all() while a micro-step is cut into parts
    std::int64_t n_micro_done_ = 0, n_syncs_ = 0, n_windows_ = 0;
    int micro_ = 0;              ///< micro-steps since the last sync
    bool in_parts_ = false;      ///< whether the present micro-step is cut
    int part_ = 0, n_parts_ = 1; ///< the next part of the present micro-step
    double largest_speed_ =
        0; ///< of any disc since the last settling, on any rank once it is settled
    double travel_speed_ = 0; ///< bounds the motion since the last settling; the same on all ranks
    double refreshed_speed_ = 0;     ///< what becomes of it then, if a sync has looked at all discs
    double hits_per_micro_step_ = 0; ///< per disc, over the last sync interval
    double window_speed_ = 0;        ///< what the window's reach allows for
    double usual_speed_ = 0;         ///< what its cells allow for
    SpeedSpread spread_;             ///< when the last micro-step began that was cut
    bool speed_exceeded_ = false;

    double redistributed_time_ = 0; ///< whose places the discs were last settled by
    double unchanged_until_ = 0;    ///< no state has changed before this time since then

    Search<Dynamics> search_;
    LocalResolution local_;
    BoundaryResolution across_strips_;
    std::vector<Candidate> live_;
    Verdicts verdicts_;
    std::vector<LocalIndex> hits_, updates_;
    std::vector<Disc>
        unhit_; ///< while collisions are logged: the first disc of each kept one, before it
    std::vector<WindowState> states_; ///< by disc

    std::uint64_t n_candidates_ = 0, n_kept_ = 0,
                  n_kept_at_sync_ = 0; ///< of those whose first disc is own
    PhaseClock clock_;
};

/// The engine of the time-stepped method with the law that the scene's precision and arithmetic ask
/// for. **Collective.**
std::unique_ptr<Engine> make_time_stepped_engine(const Scene& scene, StoredState state,
                                                 const Communicator& communicator,
                                                 const Tuning& tuning);

} // namespace carrom
