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
#include "engine/jammed.hpp"
#include "engine/speed_survey.hpp"
#include "engine/state_sums.hpp"
#include "engine/window_choice.hpp"
#include "event_driven/initial_overlaps.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

/// Factor by which the largest speed may grow between two syncs. Growing discs become some 30 times
/// as fast from a thin gas to the densest liquid.
constexpr double jam_heating = 64;
/// Up to this many discs a single block without a halo is fastest on one thread.
constexpr double most_discs_alone = 30000;

/// **Collective.**
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
    this->distribute();
    learn_crowding();
    if (mean_crowding_ > 1) this->redistribute_now(); // the cells of before hold too many discs
    // A later state is checked only if its dynamics part overlapping discs, because in other
    // dynamics the run itself may have made discs overlap.
    if (dynamics_.has_pairs() && (dynamics_.parts_overlaps() || n_micro_done_ == 0))
        refuse_overlaps(population(), discs_.grid(), time_,
                        touching_of(dynamics_, time_, discs_.periods()), communicator_, scene.name);
    discs_.forget_images();
    phases_ = {};
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::advance_to(std::int64_t target) {
    const auto micro_steps = static_cast<double>(target - this->last_sync());
    const double target_time = dynamics_.clock_at(micro_steps);
    while (time_ < target_time) run_window(std::min(target_time, jam_watch_.bin_end()));
    n_micro_done_ = target;
}

/// Runs one window, which ends at `target` or before.
template <class Dynamics> void EventDrivenEngine<Dynamics>::run_window(double target) {
    this->set_departed_aside();
    migrate();
    note_first_speed();
    window_ = choose(target);
    common_depth_ = first_halo_depth();
    redistribute();
    for (bool is_first = true;; is_first = false) {
        run_blocks();
        const Verdict verdict = validate();
        if (verdict == Verdict::exact) break;
        counts_.windows_redone += is_first;
        if (verdict == Verdict::too_fast) shorten();
        if (verdict == Verdict::too_fast || widen_marked()) redistribute();
        if (verdict == Verdict::repeat) note_rollback();
    }
    if (reduced_.counts.ranks_jammed > 0 || jam_watch_.add(reduced_.counts.events)) refuse_jam();
    commit();
    travel_speed_ = window_.speed_bound;
    time_ = window_.end;
    ++n_windows_;
    ++counts_.windows;
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

template <class Dynamics> BlockWindow EventDrivenEngine<Dynamics>::choose(double target) {
    const PhaseClock::Scope scope(phases_, Phase::wait);
    BlockWindow window;
    window.begin = time_;
    window.holds_begin = time_ == 0;
    window.speed_bound = speed_bound_until(target);
    this->refuse_long_flights(window.speed_bound);
    is_alone_ = can_run_alone();
    if (n_windows_ > 0) take_crowding(reduced_.counts.crowding);
    const BlockNeeds needs = block_needs(window.speed_bound);
    double longest = target - time_;
    if constexpr (Dynamics::is_periodic)
        longest = std::min(longest, longest_in_period(discs_.periods(), window.speed_bound));
    const PlannedWindow planned = policy_.plan(needs, collision_rate(needs), longest, target);
    choice_ = planned.choice;
    window.end = planned.end;
    return window;
}

/// The largest speed at the window's start. After a window, its validation has found that for all
/// ranks. **Collective.**
template <class Dynamics> double EventDrivenEngine<Dynamics>::largest_of_all() const {
    return is_largest_known_ ? reduced_.largest : communicator_.max(largest_speed_);
}

/// Speeds in the falling frame grow, also those of discs at rest on a floor. **Collective.**
template <class Dynamics>
double EventDrivenEngine<Dynamics>::speed_bound_until(double target) const {
    const double gained = dynamics_.speed_gained_at(policy_.soon(time_, target)) -
                          dynamics_.speed_gained_at(time_);
    return policy_.speed_bound(largest_of_all(), travel_speed_, gained);
}

/// Of growing discs. The interval's first speed is 0 otherwise. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::note_first_speed() {
    const double per_micro_step = dynamics_.growth_at(1) - dynamics_.growth_at(0);
    if (!(per_micro_step > 0) || (time_ > 0 && n_windows_ > 0)) return;
    first_speed_ = std::max(largest_of_all(), dynamics_.diameter() * per_micro_step);
}

/// Whether discs have grown into a jam: they become ever faster and collide ever more often, so
/// that the step would never end. All speeds of the window count, not only those at its end, so
/// that every cut into windows and blocks gives the same answer.
template <class Dynamics> bool EventDrivenEngine<Dynamics>::are_jammed() const {
    if (first_speed_ == 0) return false;
    return std::ranges::any_of(blocks_, [&](const Block& block) {
        return block.outcome.largest_speed > jam_heating * first_speed_;
    });
}

/// Ends the run. The message names the place up to which all is well, and not what has shown the
/// jam, because that depends on windows and threads. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::refuse_jam() const {
    const double safe = jam_watch_.safe_until();
    const double growth = dynamics_.growth_at(safe - static_cast<double>(this->last_sync()));
    throw Jammed(fmt::format("discs jam after step {:.6g}, at a packing fraction of {:.5g} (radii "
                             "{:.6g} times the first): they collide ever more often, because they "
                             "have no room to grow further",
                             safe / static_cast<double>(this->micro_steps_),
                             first_packing_ * growth * growth, growth),
                 static_cast<std::int64_t>(safe));
}

/// Whether one run of the whole box serves.
template <class Dynamics> bool EventDrivenEngine<Dynamics>::can_run_alone() const {
    const auto n = static_cast<double>(discs_.n_total());
    const bool is_few = tuning_.threads == 1 ||
                        n < 2 * static_cast<double>(tuning_.discs_per_thread);
    return communicator_.size() == 1 && is_few && n <= most_discs_alone && !block_tuning_.halo &&
           !block_tuning_.block_side && !block_tuning_.cuts_by_work;
}

/// The numbers for the choice of the next window that are not learned from windows.
template <class Dynamics> BlockNeeds EventDrivenEngine<Dynamics>::block_needs(double speed_bound) {
    BlockNeeds needs;
    needs.box = dynamics_.box();
    needs.radius = dynamics_.radius() * dynamics_.growth_at(time_) + dynamics_.slack();
    needs.equivalent_radius = equivalent_radius(levels_) * dynamics_.growth_at(time_) +
                              dynamics_.slack();
    needs.n_discs = static_cast<double>(discs_.n_total());
    needs.speed_bound = speed_bound;
    needs.time = time_;
    needs.is_one_block = is_alone_;
    needs.goes_round_x = discs_.periods().x != 0;
    needs.goes_round_y = discs_.periods().y != 0;
    needs.crowding = is_alone_ ? 1 : mean_crowding_; // a run of the whole box measures none
    return needs;
}

/// Collisions per disc and time in the last window, or a guess for the first one. **Collective.**
template <class Dynamics>
double EventDrivenEngine<Dynamics>::collision_rate(const BlockNeeds& needs) const {
    if (n_windows_ > 0)
        return static_cast<double>(reduced_.counts.events) /
               (std::max(needs.n_discs, 1.0) * policy_.last_duration());
    const double largest = communicator_.max(largest_speed_);
    if (!(largest > 0)) return 0;
    return guessed_collision_rate(
        needs, survey_speeds(discs_.own(), largest, communicator_, tuning_.threads).mean());
}

/// Makes the window shorter, because a disc was faster than the bound. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::shorten() {
    double fastest = 0;
    for (const Block& block : blocks_) fastest = std::max(fastest, block.outcome.too_fast);
    window_ = shortened(window_, communicator_.max(fastest) * policy_.speed_allowance(),
                        dynamics_.diameter());
}

/// Fetches the halo of every strip, sorts all discs into cells, and cuts the own cells into blocks
/// that are all marked to run. A single run of the whole box makes its own cells.
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
    // Where discs crowd there are many cells. The results of the last window would be there with
    // them and with the sums by which blocks are cut, 30 bytes a disc at the peak.
    if (mean_crowding_ > 1)
        for (Block& block : blocks_) block.outcome = {};
    discs_.sort_cells(lay_cells(reach()), time_);
    halo_depth_ = common_depth_;
    {
        const PhaseClock::Scope exchange(phases_, Phase::exchange);
        discs_.fetch_halo(time_, halo_depth_ * reach(), nullptr);
    }
    histories_.clear(); // nothing of it needs to be kept
    // With room for a wider halo. A list that grows is there twice for a while.
    histories_.reserve(discs_.all().capacity());
    histories_.resize(discs_.all().size());
    halo_counts_.n_windows += 1;
    halo_counts_.n_own += discs_.n_own();
    halo_counts_.n_halo += discs_.all().size() - discs_.n_own();
    halo_counts_.n_neighbours += discs_.neighbours().size();
    make_blocks();
}

template <class Dynamics> BlockGround EventDrivenEngine<Dynamics>::ground_of_blocks() {
    return {.discs = discs_.all(),
            .n_own = discs_.n_own(),
            .columns = &discs_.columns(),
            .grid = &discs_.grid(),
            .own_cells = own_cells_,
            .window = window_,
            .is_alone = is_alone_,
            .box_cells = box_cells_,
            .extent = extent(),
            .levels = levels_,
            .sums = {.no_stress = this->no_stress_,
                     .no_losses = this->no_losses_,
                     .flown_before = this->flown_before_},
            .notes = {.log = this->log_ != nullptr || this->wall_followers_.are_any(),
                      .pairs_in_log = this->log_ != nullptr,
                      .pairs = this->pair_followers_.are_any(),
                      .last_sync = this->last_sync(),
                      .velocity_unit = static_cast<double>(this->micro_steps_)}};
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::run_blocks() {
    const PhaseClock::Scope scope(phases_, Phase::search);
    const BlockGround ground = ground_of_blocks();
    std::vector<std::size_t> marked;
    for (std::size_t k = 0; k < blocks_.size(); ++k)
        if (blocks_[k].is_marked != 0) marked.push_back(k);
    // The others wait less for a block with much work if it does not begin last.
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
        BlockRun<Dynamics>& block_run = block_runs_[static_cast<std::size_t>(omp_get_thread_num())];
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
        if (round[i].is_repeated) continue; // it may happen anywhere next time
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

template <class Dynamics> void EventDrivenEngine<Dynamics>::commit() {
    const PhaseClock::Scope scope(phases_, Phase::move);
    DiscState* const discs = discs_.all().data();
    const auto n_blocks = static_cast<std::int64_t>(blocks_.size());
#pragma omp parallel for num_threads(tuning_.threads) schedule(dynamic, 1)
    for (std::int64_t k = 0; k < n_blocks; ++k) {
        const BlockOutcome& outcome = blocks_[static_cast<std::size_t>(k)].outcome;
        for (std::size_t i = 0; i < outcome.hit.size(); ++i)
            outcome.states[i].overwrite(discs[outcome.hit[i]]);
        for (std::size_t i = 0; i < outcome.hit.size(); ++i)
            discs_.columns().copy(outcome.hit[i], outcome.columns, i);
    }
    largest_speed_ = 0;
    for (const Block& block : blocks_) {
        largest_speed_ = std::max(largest_speed_, block.outcome.largest_speed_at_end);
        counts_.simultaneous += block.outcome.n_simultaneous;
        if (this->stress_) *this->stress_ += block.outcome.stress;
        this->losses_ += block.outcome.losses;
        if (this->is_followed()) log_events(block.outcome);
        if (Dynamics::has_moving_images && this->work_) *this->work_ += block.outcome.work;
    }
    for (Block& block : blocks_) block.has_run = false;
    policy_.note_end(window_.duration());
    is_largest_known_ = true;
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::finish_sync(double largest_speed) {
    largest_speed_ = largest_speed;
    is_largest_known_ = false; // noise and thermostats change speeds
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
