// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/event_driven_engine.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <omp.h>

#include "engine/dynamics_of_scene.hpp"
#include "engine/state_sums.hpp"
#include "event_driven/initial_overlaps.hpp"
#include "event_driven/runaway.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

/// If a commit gives new states to fewer discs than this, threads cost more time than they save.
constexpr std::size_t least_hits_for_threads = 4096;

/// The settings from which windows are chosen, equal on all ranks. **Collective.**
WindowSetting window_setting(const Tuning& tuning, const BlockTuning& blocks,
                             const Communicator& communicator) {
    const auto threads = static_cast<double>(communicator.max(std::int64_t{tuning.threads}));
    return {tuning.window, blocks.halo, blocks.speed_allowance,
            threads > 1 ? threads * communicator.size() : 0};
}

} // namespace

template <class Dynamics>
EventDrivenEngine<Dynamics>::EventDrivenEngine(const SceneParameters& scene, StoredState state,
                                               const Communicator& communicator,
                                               const Tuning& tuning,
                                               const BlockTuning& block_tuning)
    : Base(scene, std::move(state), communicator, tuning), block_tuning_(block_tuning),
      levels_(choose_size_levels(scene.effects.species, dynamics_.radius(),
                                 static_cast<double>(scene.n_discs), scene.area(),
                                 block_tuning.parts_sizes)),
      policy_(window_setting(tuning_, block_tuning, communicator_)),
      first_packing_(scene.packing()),
      jam_watch_({scene.effects.growth / static_cast<double>(scene.micro_steps),
                  static_cast<double>(scene.sync_every),
                  static_cast<double>(scene.steps) * static_cast<double>(scene.micro_steps),
                  static_cast<double>(scene.n_discs)}) {
    if (tuning_.ends_jams) jam_watch_.start(time_, static_cast<double>(this->last_sync()));
    for (int thread = 0; thread < tuning_.threads; ++thread) block_runs_.emplace_back(dynamics_);
    travel_speed_ = communicator_.max(largest_speed_);
    runaway_speed_ = runaway_speed(scene, travel_speed_);
    this->distribute();
    learn_crowding();
    if (mean_crowding_ > 1) this->redistribute_now(); // the first cells have too many discs
    // Overlaps are always an error at the start of a scene. In a restart they are an error only if
    // the dynamics separates overlapping discs; otherwise they may have arisen during the run.
    if (dynamics_.has_pairs() && (dynamics_.parts_overlaps() || n_micro_done_ == 0))
        refuse_overlaps(population(), discs_.grid(), time_,
                        touching_of(dynamics_, time_, discs_.periods()), communicator_,
                        tuning_.threads, scene.name);
    discs_.forget_images();
    phases_ = {};
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::advance_to(std::int64_t target) {
    while (time_ < time_of(target)) {
        if (this->is_in_window_ && notes() != notes_) leave_window();
        if (!this->is_in_window_) run_window(target);
        commit_until(time_of(target));
    }
    n_micro_done_ = target;
}

/// Finds all events of the next window. If windows may contain stops, the window may end after
/// `target`. Then one part of it ends at `target`, and others where the next stops are expected.
/// No state changes before `commit_until`, so that threads and ranks can work on a whole window
/// without waiting for each other at stops.
template <class Dynamics> void EventDrivenEngine<Dynamics>::run_window(std::int64_t target) {
    this->set_departed_aside();
    migrate();
    record_first_speed();
    is_alone_ = can_run_alone();
    window_ = choose(horizon(target));
    list_stops(target);
    notes_ = notes();
    common_depth_ = first_halo_depth();
    redistribute();
    run_until_exact();
    if (reduced_.counts.ranks_jammed > 0 || jam_watch_.add(reduced_.counts.events)) refuse_jam();
    travel_speed_ = window_.speed_bound;
    n_parts_done_ = 0;
    this->is_in_window_ = true;
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::run_until_exact() {
    for (bool is_first = true;; is_first = false) {
        run_blocks();
        const Verdict verdict = validate();
        if (verdict == Verdict::exact) return;
        counts_.windows_redone += is_first;
        if (verdict == Verdict::too_fast) shorten();
        if (verdict == Verdict::fails_later) end_at_first_stop();
        if (verdict != Verdict::repeat || widen_marked()) redistribute();
        if (verdict == Verdict::repeat) record_rollback();
    }
}

/// Commits the parts of the window that end up to the time `target`. If `target` lies inside the
/// window but no part ends there, the window is cut at the last of these ends.
template <class Dynamics> void EventDrivenEngine<Dynamics>::commit_until(double target) {
    const std::size_t first = n_parts_done_;
    const auto later = std::ranges::upper_bound(stops_, target);
    n_parts_done_ = static_cast<std::size_t>(later - stops_.begin());
    if (n_parts_done_ > 0) time_ = stops_[n_parts_done_ - 1];
    const bool is_end = window_.end <= target;
    if (is_end) {
        ++n_parts_done_;
        time_ = window_.end;
    }
    if (n_parts_done_ > first) commit(first);
    if (is_end)
        end_window();
    else if (time_ < target)
        leave_window();
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::end_window() {
    this->is_in_window_ = false;
    policy_.record_end(window_.duration());
    ++n_windows_;
    ++counts_.windows;
    largest_speed_ = 0;
    for (Block& block : blocks_) {
        largest_speed_ = std::max(largest_speed_, block.outcome.largest_speed_at_end);
        block.has_run = false;
    }
    is_largest_known_ = true;
    if (time_ == jam_watch_.bin_end() && jam_watch_.finish_bin()) refuse_jam();
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::migrate() {
    const PhaseClock::Scope scope(phases_, Phase::exchange);
    const double farthest = travel_speed_ * (time_ - redistributed_time_) * (1 + 1e-6) +
                            this->place_margin() + jumped_;
    discs_.migrate(time_, farthest, nullptr);
    redistributed_time_ = time_;
    jumped_ = 0;
}

/// Fetches the halo of the own domain, sorts all discs into cells, and cuts the own cells into
/// blocks that are all marked to run. None of this is done if a single run covers the whole box,
/// because that run makes its own cells.
template <class Dynamics> void EventDrivenEngine<Dynamics>::redistribute() {
    const PhaseClock::Scope scope(phases_, Phase::redistribute);
    const Box box = dynamics_.box();
    box_cells_ = cells_of_box(
        extent(), discs_.periods(), reach(),
        least_cell_width(reach(), box.shortest(), box.longest(), discs_.n_total()));
    if (is_alone_) {
        own_cells_ = {0, 1, 0, 1};
        blocks_.resize(1);
        blocks_.front().cells = own_cells_;
        blocks_.front().is_marked = 1;
        return;
    }
    // Clustered discs need many cells, so the results of the last window are freed first. Otherwise
    // these results would be in memory together with the sums for the cuts, and the peak of memory
    // would be higher by 30 bytes per disc.
    if (mean_crowding_ > 1)
        for (Block& block : blocks_) block.outcome = {};
    discs_.sort_cells(lay_cells(reach()), time_);
    halo_depth_ = common_depth_;
    {
        const PhaseClock::Scope exchange(phases_, Phase::exchange);
        discs_.fetch_halo(time_, halo_depth_ * reach(), nullptr);
    }
    histories_.clear(); // old histories need not be copied
    // Reserves room for a wider halo, because a list that is moved occupies memory twice meanwhile.
    histories_.reserve(discs_.all().capacity());
    histories_.resize(discs_.all().size());
    halo_counts_.n_windows += 1;
    halo_counts_.n_own += discs_.n_own();
    halo_counts_.n_halo += discs_.all().size() - discs_.n_own();
    halo_counts_.n_neighbours += discs_.neighbours().size();
    make_blocks();
}

template <class Dynamics> BlockNotes EventDrivenEngine<Dynamics>::notes() const {
    return {.log = this->log_ != nullptr || this->wall_followers_.are_any(),
            .pairs_in_log = this->log_ != nullptr,
            .pairs = this->pair_followers_.are_any(),
            .last_sync = this->last_sync(),
            .velocity_unit = static_cast<double>(this->micro_steps_)};
}

template <class Dynamics> BlockGround EventDrivenEngine<Dynamics>::ground_of_blocks() {
    return {.discs = discs_.all(),
            .n_own = discs_.n_own(),
            .columns = &discs_.columns(),
            .grid = &discs_.grid(),
            .own_cells = own_cells_,
            .window = window_,
            .stops = stops_,
            .is_alone = is_alone_,
            .box_cells = box_cells_,
            .extent = extent(),
            .levels = levels_,
            .sums = {.no_stress = this->no_stress_,
                     .no_losses = this->no_losses_,
                     .flown_before = this->flown_before_},
            .notes = notes_};
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::run_blocks() {
    const PhaseClock::Scope scope(phases_, Phase::search);
    const BlockGround ground = ground_of_blocks();
    std::vector<std::size_t> marked;
    for (std::size_t k = 0; k < blocks_.size(); ++k)
        if (blocks_[k].is_marked != 0) marked.push_back(k);
    // Blocks with the most work run first, so that the other threads wait less for them at the end.
    if (const std::vector<double>& work = cuts_.work(); work.size() == blocks_.size())
        std::ranges::stable_sort(marked, std::greater<>(), [&](std::size_t k) { return work[k]; });
    std::vector<BlockWork> round;
    for (const std::size_t k : marked) {
        Block& block = blocks_[k];
        ++(block.has_run ? counts_.blocks_redone : counts_.blocks);
        round.push_back({0, 0, block.has_run});
        block.has_run = true;
    }
#pragma omp parallel for num_threads(tuning_.threads) schedule(dynamic, 1)
    for (std::size_t i = 0; i < marked.size(); ++i) {
        Block& block = blocks_[marked[i]];
        auto& block_run = block_runs_[static_cast<std::size_t>(omp_get_thread_num())];
        block.saw_all = sees_all(block);
        if (is_alone_ || (Dynamics::is_periodic && block.saw_all))
            block_run.run_whole(ground, block.cells, histories_, block.outcome);
        else
            block_run.run(ground, block.cells, block.halo * discs_.grid().geometry().n_reach,
                          histories_, block.outcome);
        block.is_marked = 0;
    }
    for (std::size_t i = 0; i < marked.size(); ++i) {
        const BlockOutcome& outcome = blocks_[marked[i]].outcome;
        round[i].n_carried = outcome.n_carried;
        round[i].n_seen = outcome.n_seen;
        // repeated runs do not count for the load balance: the next window may repeat other blocks
        if (round[i].is_repeated) continue;
        this->rank_work_.of_pairs += work_unit * outcome.n_carried;
        this->rank_work_.of_discs += static_cast<std::uint64_t>(
            work_of_disc * work_unit * static_cast<double>(outcome.n_seen));
    }
    if (block_tuning_.notes_work) rounds_.push_back(std::move(round));
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::add_to(Totals& totals) {
    Base::add_to(totals);
    add_losses(this->losses_, this->micro_steps_, communicator_, totals);
}

/// Commits the window's parts from `first` to `n_parts_done_` - 1.
template <class Dynamics> void EventDrivenEngine<Dynamics>::commit(std::size_t first) {
    const PhaseClock::Scope scope(phases_, Phase::move);
    DiscState* const discs = discs_.all().data();
    const auto entries = [&](const Block& block) {
        return block.outcome.entries(&BlockPart::n_hit, first, n_parts_done_);
    };
    std::size_t n_hit = 0;
    for (const Block& block : blocks_) n_hit += entries(block).second - entries(block).first;
    const auto n_blocks = static_cast<std::int64_t>(blocks_.size());
#pragma omp parallel for num_threads(tuning_.threads)                                              \
    schedule(dynamic, 1) if (n_hit >= least_hits_for_threads)
    for (std::int64_t k = 0; k < n_blocks; ++k) {
        const Block& block = blocks_[static_cast<std::size_t>(k)];
        const BlockOutcome& outcome = block.outcome;
        const auto [begin, end] = entries(block);
        for (std::size_t i = begin; i < end; ++i)
            outcome.states[i].overwrite(discs[outcome.hit[i]]);
        for (std::size_t i = begin; i < end; ++i)
            discs_.columns().copy(outcome.hit[i], outcome.columns, i);
    }
    for (const Block& block : blocks_) {
        for (std::size_t k = first; k < n_parts_done_; ++k) add(block.outcome.parts[k]);
        if (this->is_followed()) log_events(block.outcome, first, n_parts_done_);
    }
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::add(const BlockPart& part) {
    counts_.simultaneous += part.n_simultaneous;
    if (this->stress_) *this->stress_ += part.stress;
    this->losses_ += part.losses;
    if (Dynamics::has_moving_images && this->work_) *this->work_ += part.work;
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::finish_sync(double largest_speed) {
    largest_speed_ = largest_speed;
    is_largest_known_ = false; // effects at the sync may have changed speeds
    const Axis axis = discs_.domains().axis();
    const double across = discs_.domains().are_cut_across()
                              ? dynamics_.jump_at(other_axis(axis), time_)
                              : 0;
    jumped_ += std::max(dynamics_.jump_at(axis, time_), across);
    for (BlockRun<Dynamics>& block_run : block_runs_) block_run.change_dynamics(dynamics_);
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::take_speed(double largest_speed) {
    largest_speed_ = largest_speed;
    is_largest_known_ = false;
}

/// Ends the window at the present stop. The largest speed is computed here, because validation has
/// found it only for the planned end of the window.
template <class Dynamics> void EventDrivenEngine<Dynamics>::leave_window() {
    end_window();
    take_speed(std::sqrt(this->squared_speed_of_own(time_)));
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::drop_scratch() {
    Base::drop_scratch();
    std::vector<Block>().swap(blocks_);
    RawVector<std::uint64_t>().swap(histories_);
}

template <class Dynamics> RollbackCounts EventDrivenEngine<Dynamics>::rollback_counts() const {
    RollbackCounts counts = counts_;
    counts.blocks = communicator_.sum(counts_.blocks);
    counts.blocks_redone = communicator_.sum(counts_.blocks_redone);
    counts.simultaneous = communicator_.sum(counts_.simultaneous);
    return counts;
}

#define CARROM_DEFINE(Dynamics) template class EventDrivenEngine<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

std::unique_ptr<Engine> make_event_driven_engine(const SceneParameters& scene, StoredState state,
                                                 const Communicator& communicator,
                                                 const Tuning& tuning) {
    return with_dynamics_of(scene, [&]<class Dynamics>() -> std::unique_ptr<Engine> {
        return std::make_unique<EventDrivenEngine<Dynamics>>(scene, std::move(state), communicator,
                                                             tuning);
    });
}

} // namespace carrom
