// SPDX-License-Identifier: BSD-3-Clause
// The event-driven method on ranks and threads: windows of time, replayed block by block,
// validated, then made true.
//
//   settle   own discs to their strips, halo discs from the neighbours, all into cells; the own
//   cells into blocks replay   each block with its halo, alone, by whichever thread is free
//   validate  each block's ring has seen the same as its owners, and no disc was faster than the
//   bound; if not,
//            the blocks that differ are replayed with twice the halo, in the end with the whole box
//            (docs/method.md, 8)
//   commit   new states for the discs that were hit
//
// Nothing is rewritten before the window is validated, so every way back is safe.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "engine/engine.hpp"
#include "engine/phase_clock.hpp"
#include "engine/strip_discs.hpp"
#include "event_driven/block_run.hpp"
#include "event_driven/block_window.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// What tests turn; nothing of it changes the bits, but for the validation.
struct BlockTuning {
    std::optional<int> halo;          ///< reaches that blocks look beyond their own cells at first
    std::optional<double> block_side; ///< in reaches
    double speed_allowance = 1.08;    ///< bound over the largest speed at a window's start
    bool is_validated = true;         ///< false gives wrong results
};

template <class Dynamics> class EventDrivenEngine final : public Engine {
public:
    /// Refuses discs that overlap. **Collective.**
    EventDrivenEngine(const Scene& scene, StoredState state, const Communicator& communicator,
                      const Tuning& tuning, const BlockTuning& exact = {});

    void advance_towards(std::int64_t last_step) override;
    void add_to(Totals& totals) override;
    LocalView local_view(double reach) override;
    void forget_images() override { discs_.forget_images(); }
    RollbackCounts rollback_counts() const override;

    std::int64_t micro_steps_done() const override { return n_micro_done_; }
    std::span<const Disc> own() const override { return discs_.own(); }
    std::span<const double> spins() const override { return discs_.own_spins(); }
    const SpeciesTable* species_table() const override {
        if constexpr (Dynamics::has_species) return &dynamics_.species_table();
        return nullptr;
    }
    double clock() const override { return time_; }
    Frame frame() const override;
    std::span<const Disc> departed() const override { return discs_.departed(); }
    std::uint64_t n_discs() const override { return discs_.n_with_departed(); }
    PhaseSeconds phase_seconds() const override { return clock_.seconds(); }

private:
    struct Block {
        CellBlock cells;
        int halo = 0;               ///< in reaches
        std::uint8_t is_marked = 0; ///< has to be replayed
        bool has_run = false;       ///< in this window, before
        BlockOutcome outcome;
    };
    enum class Verdict { exact, repeat, too_fast };

    void run_window(double target);
    void set_departed_aside();
    void migrate();
    BlockWindow choose(double target);
    void shorten();
    void redistribute();
    void make_blocks();
    void run_blocks();
    Verdict validate();
    void compare_histories(std::vector<LocalIndex>& foreign);
    void mark_owner(LocalIndex own_index);
    bool widen_marked();
    double share_marked() const;
    /// With room for blocks at the strip's ends to look further: to fetch more is to replay all
    /// ranks' blocks again.
    int first_halo_depth() const {
        return Dynamics::is_periodic && is_one_block_ ? choice_.halo : 2 * choice_.halo;
    }
    bool sees_all(const Block& block) const;
    bool sees_all_images(const Block& block) const;
    void fail_on_cascade() const;
    void commit();
    void log_events(const BlockOutcome& outcome);
    void sync();
    void begin_interval();
    double clock_at(std::int64_t micro_steps) const;
    Extent extent() const;
    void redistribute_now(double least_reach = 0);

    Communicator communicator_;
    Tuning tuning_;
    BlockTuning block_tuning_;
    Dynamics dynamics_;
    std::int64_t micro_steps_, sync_every_;

    StripDiscs discs_;
    std::int64_t n_micro_done_ = 0, n_syncs_ = 0, n_windows_ = 0;
    double time_ = 0; ///< since the last sync
    double redistributed_time_ = 0;
    double jumped_ =
        0; ///< how far the frame has moved under the discs since the last settling, in x
    double travel_speed_ = 0;  ///< bounds the motion since the last settling; the same on all ranks
    double largest_speed_ = 0; ///< of the own discs now
    double collision_rate_ = 0; ///< per disc and time, of the last window, on all ranks
    double last_duration_ = 1;  ///< of the last window
    double repeated_ = 0; ///< replays of the last window that had to be repeated, in shares of all
                          ///< its blocks; the same on all ranks
    Caution caution_;
    std::uint64_t n_events_ = 0; ///< of this rank in the last window
    RollbackCounts counts_;      ///< blocks: of this rank

    BlockChoice choice_;
    BlockWindow window_;
    bool is_one_block_ = false; ///< all discs in one block, for lack of threads and ranks
    int halo_depth_ = 0;        ///< reaches that the halo covers
    int first_own_column_ = 0, end_own_column_ = 1;
    int first_own_row_ = 0, end_own_row_ = 1;
    int block_columns_ = 1, block_rows_ = 1; ///< cells to a block
    int n_block_rows_ = 1;
    std::vector<Block> blocks_;
    std::vector<std::uint64_t> histories_;       ///< by disc, own then halo
    std::vector<BlockRun<Dynamics>> block_runs_; ///< by thread

    PhaseClock clock_;
};

/// The engine of the event-driven method with the law that the scene's precision and arithmetic ask
/// for. **Collective.**
std::unique_ptr<Engine> make_event_driven_engine(const Scene& scene, StoredState state,
                                                 const Communicator& communicator,
                                                 const Tuning& tuning);

} // namespace carrom
