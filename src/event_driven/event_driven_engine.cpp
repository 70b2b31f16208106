// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/event_driven_engine.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <omp.h>

#include "engine/dynamics_of_scene.hpp"
#include "engine/state_sums.hpp"
#include "engine/window_choice.hpp"
#include "event_driven/initial_overlaps.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

/// Blocks that each thread has at least, so that none waits for long.
constexpr double blocks_per_thread = 4;
/// Up to here one thread does best with a single block and no halo.
constexpr double most_discs_alone = 12000;

/// Cells of about two spacings hold a vector's worth of discs in three rows.
int cells_per_reach(double reach, double spacing) {
    return static_cast<int>(
        std::clamp(std::round(reach / std::max(2 * spacing, reach / 4)), 1.0, 4.0));
}

double speed_of(const Disc& disc) { return std::sqrt(disc.vx * disc.vx + disc.vy * disc.vy); }

int cells_along(double length, double width) {
    return static_cast<int>(std::clamp(std::ceil(length / width * (1 - 1e-9)), 1.0, 1e9));
}

} // namespace

template <class Dynamics>
EventDrivenEngine<Dynamics>::EventDrivenEngine(const Scene& scene, StoredState state,
                                               const Communicator& communicator,
                                               const Tuning& tuning, const BlockTuning& exact)
    : communicator_(communicator), tuning_(tuning), block_tuning_(exact),
      dynamics_(dynamics_of<Dynamics>(scene)), micro_steps_(scene.micro_steps),
      sync_every_(scene.sync_every),
      discs_(communicator, scene.box_size, std::move(state.discs),
             scene.effects.periods(scene.box_size), Dynamics::has_spin, std::move(state.spins)),
      n_micro_done_(state.micro_steps_done),
      time_(static_cast<double>(n_micro_done_ % sync_every_)) {
    for (int thread = 0; thread < tuning_.threads; ++thread) block_runs_.emplace_back(dynamics_);
    begin_interval();
    set_departed_aside();
    time_ = clock_at(n_micro_done_ % sync_every_);
    if constexpr (!Dynamics::is_double) {
        for (Disc& disc : discs_.all()) Dynamics::round(disc);
    }
    for (const Disc& disc : own()) largest_speed_ = std::max(largest_speed_, speed_of(disc));
    travel_speed_ = communicator_.max(largest_speed_);
    discs_.rebalance(time_, tuning_.rebalance_above);
    redistribute_now();
    if (Dynamics::has_pairs && (Dynamics::parts_overlaps ||
                                n_micro_done_ == 0)) // else the run itself may have come to them
        refuse_overlaps(discs_.population(), discs_.grid(), time_,
                        touching_of(dynamics_, discs_.periods()), communicator_, scene.name);
    discs_.forget_images();
    clock_ = {};
}

template <class Dynamics>
void EventDrivenEngine<Dynamics>::advance_towards(std::int64_t last_step) {
    const std::int64_t last_sync = n_micro_done_ / sync_every_ * sync_every_;
    const std::int64_t good_stop = (last_sync + sync_every_ + micro_steps_ - 1) / micro_steps_ *
                                   micro_steps_;
    const std::int64_t stop = std::min(last_step * micro_steps_, good_stop);
    while (n_micro_done_ < stop) {
        const std::int64_t sync_at = (n_micro_done_ / sync_every_ + 1) * sync_every_;
        const std::int64_t target = std::min(stop, sync_at);
        const double target_time = clock_at(target - (sync_at - sync_every_));
        while (time_ < target_time) run_window(target_time);
        n_micro_done_ = target;
        if (target == sync_at) sync();
    }
    discs_.forget_images();
}

/// One window, to `target` at most.
template <class Dynamics> void EventDrivenEngine<Dynamics>::run_window(double target) {
    set_departed_aside();
    migrate();
    window_ = choose(target);
    halo_depth_ = first_halo_depth();
    redistribute();
    for (bool is_first = true;; is_first = false) {
        run_blocks();
        const Verdict verdict = validate();
        if (verdict == Verdict::exact) break;
        counts_.windows_redone += is_first;
        if (verdict == Verdict::too_fast) shorten();
        if (verdict == Verdict::too_fast || widen_marked()) redistribute();
        if (verdict == Verdict::repeat) repeated_ += share_marked();
    }
    commit();
    travel_speed_ = window_.speed_bound;
    time_ = window_.end;
    ++n_windows_;
    ++counts_.windows;
}

/// Discs that have left the box stay where they are in the arrays until those are put in order
/// anyway.
template <class Dynamics> void EventDrivenEngine<Dynamics>::set_departed_aside() {
    if (dynamics_.boundaries().are_any_open()) discs_.set_departed_aside();
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::migrate() {
    const PhaseClock::Scope scope(clock_, Phase::exchange);
    const double farthest = travel_speed_ * (time_ - redistributed_time_) * (1 + 1e-6) +
                            64 * 0x1p-53 * dynamics_.box_size() + dynamics_.slack() + jumped_;
    discs_.migrate(time_, farthest, nullptr);
    redistributed_time_ = time_;
    jumped_ = 0;
}

template <class Dynamics> BlockWindow EventDrivenEngine<Dynamics>::choose(double target) {
    const PhaseClock::Scope scope(clock_, Phase::wait);
    BlockWindow window;
    window.begin = time_;
    window.holds_begin = time_ == 0;
    // Largest speeds come and go: what was needed lately may be needed again.
    window.speed_bound = std::max(communicator_.max(largest_speed_) * block_tuning_.speed_allowance,
                                  0.99 * travel_speed_);
    // Discs at rest on a floor become faster as the frame falls.
    const double soon = std::min(time_ + 2 * last_duration_, target);
    window.speed_bound += dynamics_.boundaries().speed_gained_at(soon) -
                          dynamics_.boundaries().speed_gained_at(time_);
    const auto n = static_cast<double>(discs_.n_total());
    BlockNeeds needs{dynamics_.box_size(),
                     dynamics_.radius() + dynamics_.slack(),
                     n,
                     window.speed_bound,
                     0,
                     time_,
                     block_tuning_.halo,
                     false};
    const bool is_alone = tuning_.threads == 1 ||
                          n < 2 * static_cast<double>(tuning_.discs_per_thread);
    is_one_block_ = communicator_.size() == 1 && is_alone && n <= most_discs_alone;
    needs.is_one_block = is_one_block_;
    needs.n_periodic_axes = (discs_.periods().x != 0) + (discs_.periods().y != 0);
    if (n_windows_ > 0)
        collision_rate_ = static_cast<double>(communicator_.sum(n_events_)) /
                          (std::max(n, 1.0) * last_duration_);
    needs.collision_rate = n_windows_ > 0 ? collision_rate_ : guessed_collision_rate(needs);
    caution_.learn(repeated_, collision_rate_ * last_duration_);
    needs.more_halo = caution_.more_halo();
    repeated_ = 0;
    const double left = target - time_;
    double longest = left;
    if constexpr (Dynamics::is_periodic)
        longest = std::min(longest, longest_in_period(dynamics_.box_size(), window.speed_bound));
    choice_ = choose_block_window(
        needs,
        tuning_.window ? longest : std::min(longest, caution_.most_hits() / needs.collision_rate),
        tuning_.window);
    if (Dynamics::is_periodic && is_one_block_ && !block_tuning_.halo && !block_tuning_.block_side)
        choice_.halo = 1; // as far as images have to be seen
    // Equal windows up to the target; the last one ends there exactly.
    const double n_windows = std::ceil(left / choice_.duration * (1 - 1e-9));
    window.end = n_windows > 1 ? time_ + left / n_windows : target;
    if (!(window.end > time_) || window.end > target)
        window.end = std::nextafter(time_, 2 * target);
    return window;
}

/// The same reach at a higher speed: a shorter window. Where all were at rest until a wall came, a
/// flight of a diameter.
template <class Dynamics> void EventDrivenEngine<Dynamics>::shorten() {
    double fastest = 0;
    for (const Block& block : blocks_) fastest = std::max(fastest, block.outcome.too_fast);
    const double bound = communicator_.max(fastest) * block_tuning_.speed_allowance;
    const double share = window_.speed_bound / bound;
    const double duration = share > 0x1p-200
                                ? window_.duration() * share
                                : std::min(window_.duration(), dynamics_.diameter() / bound);
    window_.end = std::max(window_.begin + duration, std::nextafter(window_.begin, window_.end));
    window_.speed_bound = bound;
}

/// Brings the halo to every strip, all discs into cells and the own cells into blocks, all of which
/// are to be replayed.
template <class Dynamics> void EventDrivenEngine<Dynamics>::redistribute() {
    const PhaseClock::Scope scope(clock_, Phase::redistribute);
    const double reach = block_reach(window_, dynamics_.search_diameter(), dynamics_.box_size());
    const Extent box = extent();
    const double x_from = std::max(box.x_low, discs_.strips().low(communicator_.rank()));
    const double x_to = std::min(box.x_high, discs_.strips().high(communicator_.rank()));
    const double spacing = std::sqrt(dynamics_.box_size() * std::max(x_to - x_from, 0.0) /
                                     static_cast<double>(discs_.n_own() + 16));
    GridFrame frame;
    // Own columns end where the strip does: a block's halo counts from its last column, the rank's
    // from the strip.
    const double least_width = std::max(reach / cells_per_reach(reach, spacing), 0.7 * spacing);
    frame.set_cell_width(std::max(
        least_width, (x_to - x_from) / std::max(1.0, std::floor((x_to - x_from) / least_width))));
    frame.n_reach = static_cast<int>(std::ceil(reach / frame.cell_width * (1 - 1e-9)));
    const int n_halo = halo_depth_ * frame.n_reach,
              n_beside = communicator_.size() > 1 ? n_halo : 0;
    const int n_own_columns = cells_along(x_to - x_from, frame.cell_width),
              n_own_rows = cells_along(box.y_high - box.y_low, frame.cell_width);
    const bool goes_round_x = discs_.periods().x != 0, goes_round_y = discs_.periods().y != 0;
    first_own_column_ = goes_round_x
                            ? n_halo
                            : std::min(n_beside, cells_along(x_from - box.x_low, frame.cell_width));
    end_own_column_ = first_own_column_ + n_own_columns;
    frame.n_columns = end_own_column_ +
                      (goes_round_x
                           ? n_halo
                           : std::min(n_beside, cells_along(box.x_high - x_to, frame.cell_width)));
    first_own_row_ = goes_round_y ? n_halo : 0;
    end_own_row_ = first_own_row_ + n_own_rows;
    frame.n_rows = end_own_row_ + first_own_row_;
    frame.x_low = x_from - first_own_column_ * frame.cell_width;
    frame.y_low = box.y_low - first_own_row_ * frame.cell_width;
    discs_.sort_cells(frame, time_, tuning_.threads);
    {
        const PhaseClock::Scope exchange(clock_, Phase::exchange);
        discs_.fetch_halo(time_, halo_depth_ * reach, nullptr);
    }
    histories_.resize(discs_.all().size());
    make_blocks();
}

/// Cuts the own cells into blocks of about equal size. A block that exists already keeps its halo.
template <class Dynamics> void EventDrivenEngine<Dynamics>::make_blocks() {
    const GridFrame& frame = discs_.grid().frame();
    const int n_columns = end_own_column_ - first_own_column_,
              n_rows = end_own_row_ - first_own_row_;
    const double width = n_columns * frame.cell_width, height = n_rows * frame.cell_width;
    double side = block_tuning_.block_side
                      ? *block_tuning_.block_side * frame.cell_width * frame.n_reach
                      : choice_.block_side;
    if (is_one_block_ && !block_tuning_.block_side) side = 2 * std::max(width, height);
    if (tuning_.threads > 1 && !is_one_block_)
        side = std::min(side, std::sqrt(width * height / (blocks_per_thread * tuning_.threads)));
    const auto parts = [&](double length, int n_cells) {
        return std::clamp(static_cast<int>(std::ceil(length / side * (1 - 1e-9))), 1, n_cells);
    };
    const auto cells_each = [](int n_cells, int n_parts) {
        return (n_cells + n_parts - 1) / n_parts;
    };
    block_columns_ = cells_each(n_columns, parts(width, n_columns));
    block_rows_ = cells_each(n_rows, parts(height, n_rows));
    const int n_block_columns = cells_each(n_columns, block_columns_);
    n_block_rows_ = cells_each(n_rows, block_rows_);
    const auto n_blocks = static_cast<std::size_t>(n_block_columns) *
                          static_cast<std::size_t>(n_block_rows_);
    const bool is_new = halo_depth_ == first_halo_depth() || blocks_.size() != n_blocks;
    blocks_.resize(n_blocks);
    for (int k = 0; k < n_block_columns; ++k) {
        for (int j = 0; j < n_block_rows_; ++j) {
            Block& block =
                blocks_[static_cast<std::size_t>(k) * static_cast<std::size_t>(n_block_rows_) +
                        static_cast<std::size_t>(j)];
            block.cells.first_column = first_own_column_ + k * block_columns_;
            block.cells.end_column = std::min(block.cells.first_column + block_columns_,
                                              end_own_column_);
            block.cells.first_row = first_own_row_ + j * block_rows_;
            block.cells.end_row = std::min(block.cells.first_row + block_rows_, end_own_row_);
            block.is_marked = 1;
            if (is_new) block.halo = choice_.halo;
        }
    }
}

/// Of all ranks' blocks those that are to be replayed. **Collective.**
template <class Dynamics> double EventDrivenEngine<Dynamics>::share_marked() const {
    std::uint64_t n[] = {0, blocks_.size()};
    for (const Block& block : blocks_) n[0] += block.is_marked;
    communicator_.sum(n);
    return static_cast<double>(n[0]) / static_cast<double>(std::max<std::uint64_t>(1, n[1]));
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::run_blocks() {
    const PhaseClock::Scope scope(clock_, Phase::search);
    const BlockGround ground{discs_.all(),    discs_.n_own(), &discs_.grid(), first_own_column_,
                             end_own_column_, first_own_row_, end_own_row_,   window_,
                             is_followed(),   discs_.spins()};
    const int n_reach = discs_.grid().frame().n_reach;
    const auto n_blocks = static_cast<std::int64_t>(blocks_.size());
    for (Block& block : blocks_) {
        if (block.is_marked == 0) continue;
        ++(block.has_run ? counts_.blocks_redone : counts_.blocks);
        block.has_run = true;
    }
#pragma omp parallel for num_threads(tuning_.threads) schedule(dynamic, 1)
    for (std::int64_t k = 0; k < n_blocks; ++k) {
        Block& block = blocks_[static_cast<std::size_t>(k)];
        if (block.is_marked == 0) continue;
        BlockRun<Dynamics>& run_blocks =
            block_runs_[static_cast<std::size_t>(omp_get_thread_num())];
        run_blocks.run(ground, block.cells, block.halo * n_reach,
                       Dynamics::is_periodic && sees_all(block), histories_, block.outcome);
        block.is_marked = 0;
    }
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::commit() {
    const PhaseClock::Scope scope(clock_, Phase::move);
    Disc* const discs = discs_.all().data();
    const auto n_blocks = static_cast<std::int64_t>(blocks_.size());
#pragma omp parallel for num_threads(tuning_.threads) schedule(dynamic, 1)
    for (std::int64_t k = 0; k < n_blocks; ++k) {
        const BlockOutcome& outcome = blocks_[static_cast<std::size_t>(k)].outcome;
        for (std::size_t i = 0; i < outcome.hit.size(); ++i)
            outcome.states[i].overwrite(discs[outcome.hit[i]]);
        if constexpr (Dynamics::has_spin) {
            for (std::size_t i = 0; i < outcome.hit.size(); ++i)
                discs_.spins()[outcome.hit[i]] = outcome.spins[i];
        }
    }
    n_events_ = 0;
    largest_speed_ = 0;
    for (const Block& block : blocks_) {
        n_events_ += block.outcome.n_events;
        largest_speed_ = std::max(largest_speed_, block.outcome.largest_speed_at_end);
        if (is_followed()) log_events(block.outcome);
    }
    for (Block& block : blocks_) block.has_run = false;
    last_duration_ = window_.duration();
}

template <class Dynamics>
void EventDrivenEngine<Dynamics>::log_events(const BlockOutcome& outcome) {
    const std::int64_t last_sync = n_micro_done_ / sync_every_ * sync_every_;
    for (const LoggedEvent& event : outcome.log) {
        double mass = 1;
        if constexpr (Dynamics::has_species) mass = dynamics_.species_table().of(event.p).mass;
        const double unit = mass * (dynamics_.boundaries().frame_at(event.time).slowing *
                                    static_cast<double>(micro_steps_));
        if (impulses_ && event.is_wall && event.q <= 1)
            impulses_->add(event.q, event.normal_impulse * unit);
        if (log_)
            log_->push_back({last_sync, dynamics_.boundaries().micro_steps_at(event.time),
                             event.generation, event.p, event.is_wall ? Collision::wall : event.q,
                             event.impulse * unit});
    }
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::sync() {
    const PhaseClock::Scope scope(clock_, Phase::sync);
    discs_.forget_halo();
    std::vector<Disc>& discs = discs_.all();
    const auto n = static_cast<std::int64_t>(discs.size());
#pragma omp parallel for num_threads(tuning_.threads) schedule(static)
    for (std::int64_t i = 0; i < n; ++i) {
        Disc& disc = discs[static_cast<std::size_t>(i)];
        if (Dynamics::may_lose_discs && disc.has_departed()) continue;
        Dynamics::advance(disc, time_);
        dynamics_.boundaries().restart_frame(disc, time_);
        if constexpr (Dynamics::is_periodic) this->wrap(dynamics_, disc);
        disc.tau = 0;
    }
    jumped_ += dynamics_.boundaries().jump_at(time_);
    largest_speed_ = (largest_speed_ + dynamics_.boundaries().speed_gained_at(time_)) *
                     dynamics_.boundaries().slowing_at(time_);
    begin_interval();
    redistributed_time_ -= time_;
    time_ = 0;
    ++n_syncs_;
    if (tuning_.rebalance_every > 0 && n_syncs_ % tuning_.rebalance_every == 0) {
        const PhaseClock::Scope wait(clock_, Phase::wait);
        discs_.rebalance(0, tuning_.rebalance_above);
    }
}

/// Tells the law where its walls are from here, the last sync, on.
template <class Dynamics> void EventDrivenEngine<Dynamics>::begin_interval() {
    dynamics_.begin_interval(n_micro_done_ / sync_every_ * sync_every_);
    for (BlockRun<Dynamics>& run_blocks : block_runs_) run_blocks.change_dynamics(dynamics_);
}

/// What the clock shows so many micro-steps after a sync.
template <class Dynamics>
double EventDrivenEngine<Dynamics>::clock_at(std::int64_t micro_steps) const {
    return dynamics_.boundaries().clock_at(static_cast<double>(micro_steps));
}

/// The walls in the coordinates of states, now.
template <class Dynamics> Extent EventDrivenEngine<Dynamics>::extent() const {
    Extent box = dynamics_.boundaries().extent_at(time_);
    const Periods& periods = discs_.periods();
    if (periods.x != 0) box.x_low = 0, box.x_high = periods.x;
    if (periods.y != 0) box.y_low = 0, box.y_high = periods.y;
    return box;
}

template <class Dynamics> Frame EventDrivenEngine<Dynamics>::frame() const {
    Frame frame = dynamics_.boundaries().frame_at(time_);
    if (!discs_.periods().are_any()) return frame;
    frame.period_x = discs_.periods().x;
    frame.period_y = discs_.periods().y;
    frame.clock = time_;
    frame.is_moving = true;
    return frame;
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::redistribute_now(double least_reach) {
    set_departed_aside();
    migrate();
    const double touching = reach_of({dynamics_.box_size(), dynamics_.radius() + dynamics_.slack(),
                                      static_cast<double>(discs_.n_total()), 0, 0, 0},
                                     0);
    const double reach = std::max(touching, least_reach);
    const Extent seen = discs_.extent_seen(extent(), reach);
    const GridFrame frame = make_sparse_frame(seen.x_low, seen.x_high, seen.y_low, seen.y_high,
                                              reach, discs_.n_own());
    discs_.sort_cells(frame, time_, tuning_.threads);
    discs_.fetch_halo(time_, reach, nullptr);
}

template <class Dynamics> RollbackCounts EventDrivenEngine<Dynamics>::rollback_counts() const {
    RollbackCounts counts = counts_;
    counts.blocks = communicator_.sum(counts_.blocks);
    counts.blocks_redone = communicator_.sum(counts_.blocks_redone);
    return counts;
}

template <class Dynamics> LocalView EventDrivenEngine<Dynamics>::local_view(double reach) {
    redistribute_now(reach * (1 + 1e-6));
    return {discs_.population(), &discs_.grid(), &discs_.strips(), time_, frame(),
            discs_.periods()};
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::add_to(Totals& totals) {
    redistribute_now();
    if constexpr (Dynamics::has_pairs)
        measure_overlaps(discs_.population(), discs_.grid(), time_,
                         touching_of(dynamics_, discs_.periods()), communicator_, tuning_.threads,
                         totals);
    discs_.forget_images();
}

#define CARROM_DEFINE(Dynamics) template class EventDrivenEngine<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

std::unique_ptr<Engine> make_event_driven_engine(const Scene& scene, StoredState state,
                                                 const Communicator& communicator,
                                                 const Tuning& tuning) {
    return with_dynamics_of(scene, [&]<class Dynamics>() -> std::unique_ptr<Engine> {
        return std::make_unique<EventDrivenEngine<Dynamics>>(scene, std::move(state), communicator,
                                                             tuning);
    });
}

} // namespace carrom
