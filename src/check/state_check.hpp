// SPDX-License-Identifier: BSD-3-Clause
// Holds a run to its invariants, step by step (CheckFailure lists them;
// docs/understanding/hard-cases.md has the bounds).
//
// It keeps a record of each disc at the last check, by id, so that a disc is compared
// with itself whichever rank owns it. The log shows which discs have collided.
//
// In the time-stepped method discs may pass through each other. An overlap is explained if the pair
// was closer than a diameter before both were free to collide: when the last micro-step ended in
// which one of them had a collision, or when the check began. From then on they flew straight. Had
// they been apart, nothing could have taken their contact from them.
//
// Effects are allowed for. Discs are compared as the box sees them. They fall and slow down
// as they should, may overlap if they do not collide at all, and lose energy in collisions
// that take some. Growing discs push each other: the work is the impulse times the speed at
// which surfaces grow. How much energy thermal and moving walls give is not known beforehand,
// so the energy of discs that have met such a wall is not checked. Oscillating walls give or
// take at most the impulse times their largest speed. Gravity that changes in time is seen from a
// frame that falls with its changing part from the last inspection on: there it does nothing, and
// walls move. Energies include masses and spins.
// Price: 128 bytes a disc, every disc and collision sent once a step, collisions to rank 0.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "check/check_failure.hpp"
#include "check/finding.hpp"
#include "check/shared_energy.hpp"
#include "check/surroundings.hpp"
#include "core/disc_state.hpp"
#include "dynamics/obstacles.hpp"
#include "dynamics/sway.hpp"
#include "engine/collision.hpp"
#include "engine/engine.hpp"
#include "engine/totals.hpp"
#include "parallel/communicator.hpp"
#include "scene/effects/effect.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

class StateCheck {
public:
    /// Takes the present state as right. `scene` must outlive this and have the default
    /// arithmetic. `spins` of rough discs run along the discs, per micro-step. **Collective.**
    StateCheck(const SceneParameters& scene, const SpeciesTable& species,
               std::span<const DiscState> own, std::int64_t micro_steps_done,
               const Communicator& communicator, const Frame& frame = {}, double time = 0,
               std::span<const double> spins = {}, double energy_given = 0);

    /// Inspects the end of a step. `log` has this rank's share of the collisions since the last
    /// inspection. If an invariant is broken every rank throws the same CheckFailure.
    /// `work_of_images` is what Engine::add_work_to has found since then on this rank,
    /// `energy_given` is Engine::energy_given, then and now. **Collective.**
    void inspect(const LocalView& now, std::int64_t micro_steps_done,
                 std::span<const Collision> log, std::span<const double> spins = {},
                 double work_of_images = 0, double energy_given = 0);

private:
    struct Known {
        DiscState disc;
        double spin = 0;
        std::int64_t free_from =
            0; ///< the end of the last micro-step with a collision, or the check's begin
        std::uint64_t walls = 0, pairs = 0; ///< collisions since the last inspection
        double wall_impulse = 0;            ///< sum over these collisions
        double work = 0; ///< that growing surfaces did in these collisions, per micro-step
        int owner = -1;
    };
    struct Suspect {
        DiscState p, q;
        double depth = 0, bound = 0;
        std::int64_t free_from = 0;
        int owner = 0;
    };
    using Log = std::span<const Collision>;

    /// Turns the first finding of all ranks into a failure. Does nothing if there is
    /// none. **Collective.**
    void fail_if_found(const Finding& mine, Log log);
    std::vector<SceneDisc> discs_before() const;

    Finding first_not_finite(std::span<const DiscState> own, std::span<const double> spins) const;
    Finding take_records(std::span<const DiscState> own, std::span<const double> spins,
                         const Frame& frame, double time);
    void take_log(Log log);
    Finding first_out_of_place(const LocalView& now) const;
    Finding first_in_obstacle(const LocalView& now) const;
    Finding first_wrong_count() const;
    Finding first_other_motion() const;
    static void keep_lowest(Finding& first, const Suspect& s);
    Finding first_overlap(const LocalView& now) const;
    Finding first_unexplained(std::vector<Suspect> suspects) const;
    Finding first_other_energy(std::span<const DiscState> own, Log log);
    Finding first_other_total(std::span<const DiscState> own,
                              const std::vector<SharedEnergy>& mine);
    SharedEnergy shared_energy_of(std::size_t i) const;
    double energy_of(std::span<const DiscState> own, bool in_swaying_frame = false) const;
    double twice_energy(const DiscState& seen, double spin) const;
    double mass_of(DiscId id) const { return species_.of(id).mass; }
    double diameter_of(const DiscState& p, const DiscState& q) const {
        return growth_at(micro_steps_done_) * (species_.of(p.id).radius + species_.of(q.id).radius);
    }
    double growth_at(std::int64_t micro_step) const {
        const double size = micro_step == micro_steps_done_ ? size_ : size_before_;
        return size * effects_.growth_at(static_cast<double>(micro_step));
    }
    double work_of(const Collision& collision) const;
    double resting_gain(const Known& known) const;
    double largest_energy_of_place() const;
    double other_energy(const DiscState& seen, double spin) const;
    double energy_of_way(std::size_t i) const;
    double speed_of_walls() const;
    DiscState in_swaying_frame(const DiscState& seen) const;
    double work_of_walls(const Known& known) const;
    double work_of_walls() const;
    Extent walls_before() const;
    /// The share of energy that is left since the last check, and how long ago that was.
    double energy_left() const;
    double stretch() const { return static_cast<double>(micro_steps_done_ - micro_steps_before_); }
    double n_syncs_since(std::int64_t micro_step) const {
        const std::int64_t interval = scene_.sync_every;
        return static_cast<double>(micro_steps_done_ / interval - micro_step / interval);
    }
    /// Whether effects at syncs have changed velocities since the last inspection.
    bool were_rewritten() const {
        return acts_at_syncs_ &&
               (n_syncs_since(micro_steps_before_) > 0 ||
                (acts_before_flights_ && micro_steps_before_ % scene_.sync_every == 0));
    }
    void note_speeds();
    bool may_have_met_seam(std::size_t i) const;

    int slab_of_disc(DiscId id) const;
    /// How far rounding moves a disc: so many ulp(L), and its flight in the rounding of times.
    double blur(double n_ulps) const;

    const SceneParameters& scene_;
    Effects effects_; ///< times in micro-steps
    std::optional<Obstacles> obstacles_;
    SpeciesTable species_;
    std::array<Swayed, 2> swayed_{}; ///< by gravity that changes, since the last inspection
    double total_mass_ = 0, smallest_mass_ = 1;
    double wall_speed_ = 0, wall_pull_ = 0; ///< for walls that swing: the largest speed, and the
                                            ///< largest acceleration with which one presses a disc
    double work_of_images_ = 0;             ///< on this rank, since the last inspection
    double fastest_up_ = 0; ///< between sheared sides: along y, now or at the last inspection
    /// Beside that of motion, without those that change at syncs alone.
    std::vector<OtherEnergy> energies_;
    bool depends_on_x_ = false, depends_on_y_ = false; ///< they do, or what discs get on their way
    bool may_lose_energy_ = false, walls_give_energy_ = false, surfaces_give_energy_ = false;
    bool surfaces_rub_ = false; ///< walls or obstacles rub: spins change there
    bool acts_at_syncs_ = false, acts_before_flights_ = false; ///< see CheckAllowance
    double energy_given_ = 0, energy_given_before_ = 0; ///< on this rank, by effects at syncs
    double size_ = 1, size_before_ = 1; ///< LocalView::size now, and at the last check
    Communicator communicator_;
    std::uint64_t first_id_ = 0;
    std::vector<Known> known_, before_; ///< this rank's slab of ids now, and at the last check
    std::int64_t micro_steps_done_ = 0, micro_steps_before_ = 0;
    double tolerance_ = 0, fastest_ = 0,
           energy_ = 0;                   ///< plain discs cannot become faster than with all of it
    std::uint64_t n_pair_collisions_ = 0; ///< on all ranks since the check began
};

} // namespace carrom
