// SPDX-License-Identifier: BSD-3-Clause
// Event-driven molecular dynamics on ranks and threads, by speculative runs of blocks of cells
// (docs/understanding/method.md, section 8). A window of time goes through these phases:
//
//   redistribute  discs go to the ranks that own them, the halo comes from the neighbours, and
//                 all are sorted into cells; the own cells are cut into blocks
//   run           each block is run with its halo by a free thread, without the other blocks
//   validate      for discs of each block's ring that can have met an own disc, histories are
//                 compared with those that the discs' owners found; no own disc may have met a
//                 disc from beyond the ring or have moved too far; blocks that fail run again with
//                 twice the halo, and finally with the whole box (rollback)
//   commit        discs that have collided get their new states; at a stop inside the window, only
//                 the discs that have collided before it
//
// A rollback costs only the repeated run, because no state changes before the commit. A single run
// of the whole box, without halo and histories, is used for few discs on one rank.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/raw_vector.hpp"
#include "engine/engine_base.hpp"
#include "event_driven/block_cuts.hpp"
#include "event_driven/block_run.hpp"
#include "event_driven/jam_watch.hpp"
#include "event_driven/window_policy.hpp"
#include "parallel/joint_reduction.hpp"

namespace carrom {

/// Settings that tests vary. Only `is_validated` affects the bits.
struct BlockTuning {
    std::optional<int> halo;          ///< depth of the halo, in reaches
    std::optional<double> block_side; ///< side of a block, in reaches
    /// Bound of speeds, relative to the largest speed at a window's start
    double speed_allowance = 1.08;
    bool is_validated = true; ///< whether windows are validated; false gives wrong results
    bool parts_sizes = false; ///< whether each octave of radii has a level of cells of its own
    /// Whether blocks are cut by work; if unset, they are for several threads or clustered discs
    std::optional<bool> cuts_by_work;
    bool notes_work = false; ///< whether work is recorded for `take_work()`
};

/// The work for each disc of a run, relative to the work for a collision, which is `work_unit`.
inline constexpr double work_of_disc = 0.14;
inline constexpr std::uint64_t work_unit = 100;

/// The work of one block run, for studies of how threads share a window.
struct BlockWork {
    std::uint64_t n_carried = 0; ///< collisions carried out, including those of halo discs
    std::uint64_t n_seen = 0;    ///< number of discs, including halo discs and ghosts
    bool is_repeated = false;    ///< whether the block had run before in this window
};

/// Sums over a rank's windows so far, for studies of how ranks share a box.
struct HaloCounts {
    std::uint64_t n_windows = 0, n_own = 0, n_halo = 0; ///< n_own, n_halo: discs of all windows
    std::uint64_t n_neighbours = 0; ///< sum over windows of the number of neighbours
};

template <class Dynamics> class EventDrivenEngine final : public EngineBase<Dynamics> {
public:
    /// Throws InputError if discs overlap. **Collective.**
    EventDrivenEngine(const SceneParameters& scene, StoredState state,
                      const Communicator& communicator, const Tuning& tuning,
                      const BlockTuning& block_tuning = {});

    void add_to(Totals& totals) override;
    RollbackCounts rollback_counts() const override;
    double bytes_for_crowds() const override;

    /// The work of this rank's block runs since the last call, round by round. A window has one
    /// round, and another one for each rollback.
    std::vector<std::vector<BlockWork>> take_work() { return std::exchange(rounds_, {}); }
    const HaloCounts& halo_counts() const { return halo_counts_; }

private:
    using Base = EngineBase<Dynamics>;
    using Base::communicator_, Base::tuning_, Base::dynamics_, Base::discs_, Base::phases_;
    using Base::largest_speed_, Base::travel_speed_;
    using Base::population, Base::extent;
    using Base::time_, Base::redistributed_time_, Base::n_micro_done_, Base::n_windows_;

    struct Block {
        CellBlock cells;
        int halo = 0;               ///< depth of the halo, in reaches
        std::uint8_t is_marked = 0; ///< whether the block has to run
        bool has_run = false;       ///< whether the block has already run in this window
        bool saw_all = false;       ///< whether the block's last run covered the whole box
        BlockOutcome outcome;
    };
    /// `fails_later`: a block run ended in a collision cascade, which may lie after the window's
    /// first stop. So the window is shortened to end at that stop, and is run again.
    enum class Verdict { exact, repeat, too_fast, fails_later };
    /// Results of the validation of a window, summed over all ranks.
    struct FoundInWindow {
        std::uint64_t ranks_too_fast = 0; ///< ranks with a disc that was faster than the bound
        std::uint64_t marked_blocks = 0;  ///< blocks that have to run again
        std::uint64_t cascades = 0;       ///< blocks whose run ended in a collision cascade
        std::uint64_t ranks_to_stop = 0;  ///< ranks that were requested to stop
        std::uint64_t ranks_jammed = 0;   ///< ranks whose growing discs have become too fast
        std::uint64_t events = 0;
        std::uint64_t crowding = 0; ///< sum of the crowding, in units of 1 / `crowding_unit`
    };

    void advance_to(std::int64_t target) override;
    void migrate() override;
    void finish_sync(double largest_speed) override;
    void take_speed(double largest_speed) override;
    void drop_scratch() override;
    void leave_window() override;

    void run_window(std::int64_t target);
    void run_until_exact();
    void commit_until(double target);
    void end_window();
    double time_of(std::int64_t micro_step) const {
        return dynamics_.clock_at(static_cast<double>(micro_step - this->last_sync()));
    }
    double horizon(std::int64_t target) const;
    void list_stops(std::int64_t target);
    void end_at_first_stop();
    BlockWindow choose(double target);
    BlockNeeds block_needs(double speed_bound);
    double collision_rate(const BlockNeeds& needs) const;
    bool can_run_alone() const;
    double speed_bound_until(double target) const;
    double largest_of_all() const;
    void record_first_speed();
    bool are_jammed() const;
    [[noreturn]] void refuse_jam() const;
    void shorten();
    void redistribute();
    GridGeometry lay_cells(double reach);
    void make_blocks();
    std::vector<CellBlock> cut_evenly();
    std::vector<CellBlock> cut_by_work(double n_pairs);
    void learn_crowding();
    double measure_crowding(const CellBlock& cells);
    void take_crowding(std::uint64_t of_all);
    BlockNotes notes() const;
    BlockGround ground_of_blocks();
    void run_blocks();
    void commit(std::size_t first);
    void add(const BlockPart& part);
    void log_events(const BlockOutcome& outcome, std::size_t first_part, std::size_t end_part);

    Verdict validate();
    void check_partners();
    void compare_histories(std::vector<LocalIndex>& foreign);
    bool could_meet(const Block& block, const DiscState& disc, SpeedClass fastest) const;
    double distance_from_own(const Block& block, const DiscState& disc) const;
    void mark_owner(LocalIndex own_index);
    bool widen_marked();
    int halo_depth_for(const Block& block) const;
    void record_rollback();
    double price_of_reach() const;
    bool sees_all(const Block& block) const;
    bool sees_all_images(const Block& block) const;
    void fail_on_cascade() const;
    [[noreturn]] void refuse_runaway(double speed) const;

    /// Depth in reaches; at least two, because the last own row of cells may end beyond the domain.
    int first_halo_depth() const { return std::max(2, choice_.halo); }
    /// The depth in reaches up to which cells exist. Halos can become this deep without new cells.
    int laid_depth() const { return std::max(common_depth_, 2 * choice_.halo); }
    double reach() const { return block_reach(window_, contact_distance(), dynamics_.box()); }
    /// The largest distance between centres in a contact in this window.
    double contact_distance() const {
        return dynamics_.search_diameter() * dynamics_.size_at(window_.end);
    }

    BlockTuning block_tuning_;
    std::vector<SizeLevel> levels_;
    double jumped_ = 0; ///< upper bound of the frame's jumps at syncs since the last migration
    WindowPolicy policy_;
    double first_packing_ = 0;
    double runaway_speed_ = 0; ///< a run with faster discs is ended (runaway.hpp)
    JamWatch jam_watch_;       ///< detects a jam of growing discs
    /// If discs grow, their largest speed at the last sync or at the run's start, but at least the
    /// growth of the largest diameter per micro-step; 0 if discs do not grow
    double first_speed_ = 0;
    /// The density of other discs in an own disc's cell, relative to the mean density in the box,
    /// summed over own discs. In a homogeneous gas terms are below 1: discs exclude each other.
    double crowding_ = 0;
    double mean_crowding_ = 1; ///< mean over all discs, or 1 if it is at most 2; equal on all ranks
    /// Results of the validation of the last window, and the largest speed at its end.
    JointReduction<FoundInWindow> reduced_;
    /// The crowding is summed over ranks in whole units of 1 / `crowding_unit`, so that the result
    /// does not depend on the order
    static constexpr double crowding_unit = 1024;
    bool is_largest_known_ = false; ///< whether `reduced_` has the largest speed of all ranks
    RollbackCounts counts_;         ///< counts of windows are for all ranks, others for this rank

    BlockChoice choice_;
    BlockWindow window_;
    std::vector<double> stops_;    ///< times inside the window at which its parts end
    std::size_t n_parts_done_ = 0; ///< number of parts that have been committed
    BlockNotes notes_;             ///< which events blocks record in this window
    bool is_alone_ = false; ///< whether a single run covers the whole box: one rank, few discs
    BoxCells box_cells_;    ///< cells for runs of the whole box
    int common_depth_ = 0;  ///< least depth of the halos of all ranks, in reaches
    int halo_depth_ = 0;    ///< depth of this rank's halo, in reaches
    CellBlock own_cells_{0, 1, 0, 1};
    BlockCuts cuts_; ///< where this rank's own cells are cut into blocks
    std::vector<Block> blocks_;
    std::vector<std::vector<BlockWork>> rounds_;
    HaloCounts halo_counts_;
    /// Histories of own discs, then of the halo's discs
    RawVector<std::uint64_t> histories_;
    std::vector<BlockRun<Dynamics>> block_runs_; ///< one for each thread
};

/// The engine of the event-driven method with the scene's dynamics. **Collective.**
std::unique_ptr<Engine> make_event_driven_engine(const SceneParameters& scene, StoredState state,
                                                 const Communicator& communicator,
                                                 const Tuning& tuning);

} // namespace carrom
