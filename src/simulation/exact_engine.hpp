// SPDX-License-Identifier: BSD-3-Clause
// The rule "all" on ranks and threads: windows of time, replayed block by block, certified, then made true.
//
//   settle   own discs to their strips, halo discs from the neighbours, all into cells; the own cells into blocks
//   replay   each block with its halo, alone, by whichever thread is free
//   certify  each block's ring has seen the same as its owners, and no disc was faster than the bound; if not,
//            the blocks that differ are replayed with twice the halo, in the end with the whole box (docs/method.md, 8)
//   commit   new states for the discs that were hit
//
// Nothing is rewritten before the window is certified, so every way back is safe.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "carrom/collision/cell_grid.hpp"
#include "carrom/exact/block_replay.hpp"
#include "engine.hpp"
#include "exact_window.hpp"
#include "phase_clock.hpp"
#include "strip_discs.hpp"

namespace carrom {

/// What tests turn; nothing of it changes the bits, but for the certificate.
struct ExactTuning {
    std::optional<int> halo;            ///< reaches that blocks look beyond their own cells at first
    std::optional<double> block_side;   ///< in reaches
    double speed_allowance = 1.08;      ///< bound over the largest speed at a window's start
    bool has_certificate = true;        ///< false gives wrong results
};

template <class Law> class ExactEngine final : public Engine {
public:
    /// Refuses discs that overlap. **Collective.**
    ExactEngine(const Scene& scene, StoredState state, const Communicator& communicator, const Tuning& tuning,
                const ExactTuning& exact = {});

    void advance_towards(std::int64_t last_step) override;
    void add_to(Totals& totals) override;
    Settled settled(double reach) override;
    void forget_images() override { discs_.forget_images(); }
    ReplayCounts replay_counts() const override;

    std::int64_t micro_steps_done() const override { return n_micro_done_; }
    std::span<const Disc> own() const override { return discs_.own(); }
    std::span<const double> spins() const override { return discs_.own_spins(); }
    const DiscBodies* bodies() const override {
        if constexpr (Law::has_bodies) return &law_.bodies();
        return nullptr;
    }
    double clock() const override { return time_; }
    Frame frame() const override;
    std::span<const Disc> gone() const override { return discs_.gone(); }
    std::uint64_t n_discs() const override { return discs_.n_with_gone(); }
    PhaseSeconds phase_seconds() const override { return clock_.seconds(); }

private:
    struct Block {
        CellBlock cells;
        int halo = 0; ///< in reaches
        std::uint8_t is_marked = 0; ///< has to be replayed
        bool is_replayed = false;   ///< in this window, before
        BlockOutcome outcome;
    };
    enum class Verdict { exact, repeat, too_fast };

    void run_window(double target);
    void set_gone_aside();
    void migrate();
    ReplayWindow choose(double target);
    void shorten();
    void settle();
    void make_blocks();
    void replay();
    Verdict certify();
    void compare_histories(std::vector<LocalIndex>& foreign);
    void mark_owner(LocalIndex own_index);
    bool widen_marked();
    double share_marked() const;
    /// With room for blocks at the strip's ends to look further: to fetch more is to replay all ranks' blocks again.
    int first_halo_depth() const { return Law::is_periodic && is_one_block_ ? choice_.halo : 2 * choice_.halo; }
    bool sees_all(const Block& block) const;
    bool sees_all_images(const Block& block) const;
    void fail_if_endless() const;
    void commit();
    void log_events(const BlockOutcome& outcome);
    void sync();
    void begin_interval();
    double clock_at(std::int64_t micro_steps) const;
    Extent extent() const;
    void settle_now(double least_reach = 0);

    Communicator communicator_;
    Tuning tuning_;
    ExactTuning exact_;
    Law law_;
    std::int64_t micro_steps_, sync_every_;

    StripDiscs discs_;
    std::int64_t n_micro_done_ = 0, n_syncs_ = 0, n_windows_ = 0;
    double time_ = 0;             ///< since the last sync
    double settled_time_ = 0;
    double jumped_ = 0;           ///< how far the frame has moved under the discs since the last settling, in x
    double travel_speed_ = 0;     ///< bounds the motion since the last settling; the same on all ranks
    double largest_speed_ = 0;    ///< of the own discs now
    double collision_rate_ = 0;   ///< per disc and time, of the last window, on all ranks
    double last_duration_ = 1;    ///< of the last window
    double repeated_ = 0;         ///< replays of the last window that had to be repeated, in shares of all its blocks; the same on all ranks
    ReplayCaution caution_;
    std::uint64_t n_events_ = 0;  ///< of this rank in the last window
    ReplayCounts counts_;         ///< blocks: of this rank

    ExactChoice choice_;
    ReplayWindow window_;
    bool is_one_block_ = false;   ///< all discs in one block, for lack of threads and ranks
    int halo_depth_ = 0;          ///< reaches that the halo covers
    int first_own_column_ = 0, end_own_column_ = 1;
    int first_own_row_ = 0, end_own_row_ = 1;
    int block_columns_ = 1, block_rows_ = 1; ///< cells to a block
    int n_block_rows_ = 1;
    std::vector<Block> blocks_;
    std::vector<std::uint64_t> histories_; ///< by disc, own then halo
    std::vector<BlockReplay<Law>> replays_; ///< by thread

    PhaseClock clock_;
};

/// The engine of the rule "all" with the law that the scene's precision and arithmetic ask for. **Collective.**
std::unique_ptr<Engine> make_exact_engine(const Scene& scene, StoredState state, const Communicator& communicator,
                                          const Tuning& tuning);

} // namespace carrom
