// SPDX-License-Identifier: BSD-3-Clause
// Checks the invariants of a run at each step. They are listed in check_failure.hpp, and their
// bounds in docs/understanding/hard-cases.md.
//
// The check keeps a record of each disc at the last check, by id, so that a disc can be compared
// with its earlier state even if its owner changes. The log contains the collisions since then.
//
// In the time-stepped method an overlap is allowed if the pair was already closer than a diameter
// when both discs became free to collide. A disc becomes free after its last micro-step with a
// collision, at a sync that changes its velocity, or at the beginning of the check. From then on it
// has flown straight, so discs that were apart would have collided before they overlap.
//
// Effects are taken into account. Discs are compared in the box's coordinates. The check computes
// how discs fall and slow down, allows overlaps of discs of an ideal gas, and allows inelastic
// collisions to lose energy. Growing discs push each other: the work is the impulse times the speed
// of the surfaces. The energy from thermal and moving walls is not known beforehand, so the energy
// of discs that have met such a wall is not checked. Other walls give or take at most the impulse
// times their largest speed. If an acceleration varies in time, the check uses a frame that falls
// with the varying part since the last inspection: in this frame that part has no effect, but walls
// move. Discs that have departed through open sides stay in the record. In the log each departure
// is a collision with a wall, with zero impulse. So departures and returns by inlets determine
// whether a disc is in the box. The energy that departing and returning discs carry is unknown, so
// in such a step neither their energy nor the total energy is checked. Energies include masses and
// spins. Cost: 256 bytes per disc. In each step every disc is sent to the rank that keeps its
// record, every collision to the ranks of its discs and to rank 0, and discs that have collided
// also to rank 0.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "check/check_failure.hpp"
#include "check/finding.hpp"
#include "check/shared_energy.hpp"
#include "check/surroundings.hpp"
#include "core/disc_state.hpp"
#include "dynamics/fixed_bodies.hpp"
#include "dynamics/sway.hpp"
#include "engine/collision.hpp"
#include "engine/engine.hpp"
#include "engine/totals.hpp"
#include "parallel/communicator.hpp"
#include "scene/effects/effect.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Values of this rank's discs, in the order of the discs; empty in scenes without such values.
struct CheckedColumns {
    std::span<const double> spins{};         ///< spins per micro-step
    std::span<const double> swapped_radii{}; ///< present radii, if discs exchange radii
    /// The departed discs of this rank, which are not among the own discs
    std::span<const DiscState> departed{};
};

class StateCheck {
public:
    /// Begins with the present state, which is taken as correct. `scene` must outlive this object
    /// and use the default arithmetic. `spins` of rough discs, per micro-step, are in the order of
    /// the discs. **Collective.**
    StateCheck(const SceneParameters& scene, const SpeciesTable& species,
               std::span<const DiscState> own, std::int64_t micro_steps_done,
               const Communicator& communicator, const Frame& frame = {}, double time = 0,
               std::span<const double> spins = {}, double energy_given = 0);

    /// Checks the state at the end of a step. `log` has this rank's share of the collisions since
    /// the last inspection. If an invariant is broken, every rank throws the same CheckFailure.
    /// `work_of_images`: work of images on this rank since the last inspection
    /// (Engine::add_work_to). `energy_given`: Engine::energy_given. **Collective.**
    void inspect(const LocalView& now, std::int64_t micro_steps_done,
                 std::span<const Collision> log, const CheckedColumns& columns = {},
                 double work_of_images = 0, double energy_given = 0);

private:
    struct Known {
        DiscState disc;
        double spin = 0;
        /// First micro-step of the disc's present straight flight
        std::int64_t free_from = 0;
        std::uint64_t walls = 0, pairs = 0; ///< collisions of the disc since the last inspection
        std::uint64_t departures = 0;       ///< departures since then, which `walls` includes
        double wall_impulse = 0;            ///< total impulse from walls since then
        double work = 0; ///< energy from growing surfaces since then; for a pair, at the lower id
        int owner = -1;
    };
    struct Suspect {
        DiscState p, q;
        double depth = 0, bound = 0;
        std::int64_t free_from = 0;
        int owner = 0;
    };
    using Log = std::span<const Collision>;

    /// Throws CheckFailure with the first finding of all ranks. Does nothing if there is no
    /// finding. **Collective.**
    void fail_if_found(const Finding& mine, Log log);
    std::vector<SceneDisc> discs_before() const;

    Finding first_other_radius(std::span<const DiscState> own,
                               std::span<const double> swapped_radii) const;
    Finding first_not_finite(std::span<const DiscState> own, std::span<const double> spins) const;
    /// `departed`: discs of this rank that have left the box.
    Finding take_records(std::span<const DiscState> own, std::span<const double> spins,
                         std::span<const DiscState> departed, const Frame& frame, double time);
    void take_log(Log log);
    Finding first_out_of_place(const LocalView& now) const;
    Finding first_wrong_departure() const;
    double from_departure(const DiscState& disc) const;
    /// How often the disc has returned into the box since the last inspection.
    double returns_of(std::size_t i) const;
    bool have_any_moved() const;
    /// Whether the disc has departed or returned since the last inspection, or was outside before.
    bool was_outside(std::size_t i) const {
        return known_[i].departures > 0 || before_[i].disc.has_departed() ||
               known_[i].disc.has_departed();
    }
    Finding first_in_fixed_body(const LocalView& now) const;
    Finding first_wrong_count() const;
    Finding find_velocity_change() const;
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
        return size_at(micro_steps_done_) * (species_.of(p.id).radius + species_.of(q.id).radius);
    }
    double size_at(std::int64_t micro_step) const {
        const double size = micro_step == micro_steps_done_ ? size_ : size_before_;
        return size * effects_.size_at(static_cast<double>(micro_step));
    }
    double work_of(const Collision& collision) const;
    double resting_gain(const Known& known) const;
    double largest_energy_of_place() const;
    double energy_of_flow() const;
    double other_energy(const DiscState& seen, double spin) const;
    double energy_of_way(std::size_t i) const;
    double speed_of_walls() const;
    DiscState in_swaying_frame(const DiscState& seen) const;
    double work_of_walls(const Known& known) const;
    double work_of_walls() const;
    Extent walls_before() const;
    /// The fraction of its energy that a disc with drag has kept since the last check. `stretch`:
    /// micro-steps since then.
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
    void record_speeds();
    bool may_have_met_seam(std::size_t i) const;

    int slab_of_disc(DiscId id) const;
    /// The rounding error of positions: `n_ulps` ulp of the box length, plus the distance flown
    /// during the rounding error of a time.
    double blur(double n_ulps) const;

    const SceneParameters& scene_;
    Effects effects_; ///< times in micro-steps
    FixedBodies fixed_bodies_;
    SpeciesTable species_;
    /// Displacement and velocity along x and y since the last inspection that come from the varying
    /// part of the acceleration
    std::array<Swayed, 2> swayed_{};
    double total_mass_ = 0, smallest_mass_ = 1;
    /// Largest speed of vibrating walls, and their largest acceleration towards a disc
    double wall_speed_ = 0, wall_pull_ = 0;
    double tightest_arc_ = std::numeric_limits<double>::infinity(); ///< radius of the smallest arc
    double work_of_images_ = 0; ///< work of images on this rank since the last inspection
    /// Largest speed along y of the discs between sheared sides, now or at the last inspection
    double fastest_up_ = 0;
    /// Energies besides the kinetic energy; energies that change only at syncs are left out.
    std::vector<OtherEnergy> energies_;
    /// Whether other energies, or the work along a disc's path, depend on x and on y
    bool depends_on_x_ = false, depends_on_y_ = false;
    bool may_lose_energy_ = false, walls_give_energy_ = false, surfaces_give_energy_ = false;
    bool have_open_sides_ = false, have_inlets_ = false;
    bool surfaces_rub_ = false; ///< walls or fixed bodies have friction, which changes spins
    bool acts_at_syncs_ = false, acts_before_flights_ = false; ///< as in CheckAllowance
    /// Energy that effects at syncs gave on this rank, now and at the last inspection
    double energy_given_ = 0, energy_given_before_ = 0;
    Box box_, box_before_;              ///< sides of the box now and at the last inspection
    double size_ = 1, size_before_ = 1; ///< LocalView::size now and at the last inspection
    Communicator communicator_;
    std::uint64_t first_id_ = 0;
    /// Discs of this rank's slab of ids, now and at the last inspection
    std::vector<Known> known_, before_;
    std::int64_t micro_steps_done_ = 0, micro_steps_before_ = 0;
    double tolerance_ = 0, fastest_ = 0,
           energy_ = 0; ///< energy of all discs at the start or last check, in the scene's units
    /// Collisions of pairs on all ranks since the check began
    std::uint64_t n_pair_collisions_ = 0;
};

} // namespace carrom
