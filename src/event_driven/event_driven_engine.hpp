// SPDX-License-Identifier: BSD-3-Clause
// Event-driven molecular dynamics on ranks and threads, by speculative runs of blocks of cells
// (docs/understanding/method.md, section 8). A window of time goes through these phases:
//
//   redistribute  discs go to the strips that own them, the halo comes from the neighbours, and
//                 all are sorted into cells; the own cells are cut into blocks
//   run           a free thread runs each block with its halo, without the other blocks
//   validate      the histories of each block's ring are compared with those that the owners
//                 found; own discs may have met no disc from beyond the ring, and none may have
//                 got too far; otherwise the blocks that differ run again with twice the halo,
//                 in the end with the whole box (rollback)
//   commit        the discs that were hit get their new states
//
// A rollback costs only the repeated run, because no state changes before the commit. A single run
// of the whole box, without halo and histories, serves few discs on one rank and thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/engine_base.hpp"
#include "event_driven/block_run.hpp"
#include "event_driven/block_window.hpp"
#include "parallel/joint_reduction.hpp"

namespace carrom {

/// Settings that tests vary. Only the validation affects the bits.
struct BlockTuning {
    std::optional<int> halo;          ///< halo of a block's first run, in reaches
    std::optional<double> block_side; ///< in reaches
    double speed_allowance = 1.08;    ///< bound over the largest speed at a window's start
    bool is_validated = true;         ///< false gives wrong results
    bool parts_sizes = false;         ///< each octave of radii has a level of cells
};

template <class Dynamics> class EventDrivenEngine final : public EngineBase<Dynamics> {
public:
    /// Overlapping discs are an error. **Collective.**
    EventDrivenEngine(const Scene& scene, StoredState state, const Communicator& communicator,
                      const Tuning& tuning, const BlockTuning& block_tuning = {});

    RollbackCounts rollback_counts() const override;

private:
    using Base = EngineBase<Dynamics>;
    using Base::communicator_, Base::tuning_, Base::dynamics_, Base::discs_, Base::phases_;
    using Base::largest_speed_, Base::travel_speed_;
    using Base::population, Base::extent;
    using Base::time_, Base::redistributed_time_, Base::n_micro_done_, Base::n_windows_;

    struct Block {
        CellBlock cells;
        int halo = 0;               ///< in reaches
        std::uint8_t is_marked = 0; ///< the block has to run
        bool has_run = false;       ///< it has run before in this window
        BlockOutcome outcome;
    };
    enum class Verdict { exact, repeat, too_fast };

    void advance_to(std::int64_t target) override;
    void migrate() override;
    void finish_sync(double largest_speed) override;
    void drop_scratch() override;

    void run_window(double target);
    BlockWindow choose(double target);
    BlockNeeds block_needs(double speed_bound);
    double speed_bound_until(double target) const;
    double largest_of_all() const;
    void refuse_jam();
    void shorten();
    void redistribute();
    GridGeometry lay_cells(double reach);
    void make_blocks();
    double block_side() const;
    void run_blocks();
    void commit();
    void log_events(const BlockOutcome& outcome);

    Verdict validate();
    void check_partners();
    void compare_histories(std::vector<LocalIndex>& foreign);
    void mark_owner(LocalIndex own_index);
    bool widen_marked();
    int halo_depth_for(const Block& block) const;
    double share_marked() const;
    bool sees_all(const Block& block) const;
    bool sees_all_images(const Block& block) const;
    void fail_on_cascade() const;

    /// Twice a block's halo is fetched at once for the blocks at the strip's ends, because fetching
    /// more of it later makes all ranks run all blocks again.
    int first_halo_depth() const { return 2 * choice_.halo; }
    double reach() const {
        return block_reach(window_, dynamics_.search_diameter() * dynamics_.growth_at(window_.end),
                           dynamics_.box());
    }

    BlockTuning block_tuning_;
    std::vector<SizeLevel> levels_;
    double jumped_ = 0; ///< the frame's motion along the strips' axis since the last migration
    double collision_rate_ = 0; ///< per disc and time in the last window, on all ranks
    double last_duration_ = 1;  ///< duration of the last window
    double repeated_ = 0; ///< block runs of the last window that were repeated, as a share of all
                          ///< its blocks; equal on all ranks
    double first_speed_ = 0; ///< speed of growing discs when this interval or the engine began
    Caution caution_;
    /// What validation has found for the last window on all ranks: how many ranks had a disc that
    /// was too fast, blocks to run again, cascades, requests to stop, events; and the largest speed
    /// at its end. One message carries all, because in each all ranks wait for the slowest.
    JointReduction reduced_;
    bool is_largest_known_ = false; ///< `reduced_` has the largest speed of all ranks
    RollbackCounts counts_;         ///< its counts of blocks are of this rank alone

    BlockChoice choice_;
    BlockWindow window_;
    bool is_alone_ = false; ///< one run of the whole box serves, on one rank and with few discs
    BoxCells box_cells_;    ///< cells for runs of the whole box
    int halo_depth_ = 0;    ///< reaches that the rank's halo covers
    CellBlock own_cells_{0, 1, 0, 1};
    int block_columns_ = 1, block_rows_ = 1; ///< size of a block in cells
    int n_block_rows_ = 1;
    std::vector<Block> blocks_;
    std::vector<std::uint64_t> histories_;       ///< for each disc, own discs before the halo
    std::vector<BlockRun<Dynamics>> block_runs_; ///< one for each thread
};

/// The engine of the event-driven method with the scene's dynamics. **Collective.**
std::unique_ptr<Engine> make_event_driven_engine(const Scene& scene, StoredState state,
                                                 const Communicator& communicator,
                                                 const Tuning& tuning);

} // namespace carrom
