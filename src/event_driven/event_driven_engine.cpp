// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/event_driven_engine.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <omp.h>

#include "engine/dynamics_of_scene.hpp"
#include "engine/speed_survey.hpp"
#include "engine/state_sums.hpp"
#include "engine/window_choice.hpp"
#include "event_driven/initial_overlaps.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

/// Each thread gets at least this many blocks, so that no thread waits long for the others.
constexpr double blocks_per_thread = 4;
/// Factor by which the largest speed may grow between two syncs. Growing discs become some 30 times
/// as fast from a thin gas to the densest liquid.
constexpr double jam_heating = 64;
/// Up to this many discs a single block without a halo is fastest on one thread.
constexpr double most_discs_alone = 30000;

int cells_along(double length, double width) {
    return static_cast<int>(std::clamp(std::ceil(length / width * (1 - 1e-9)), 1.0, 1e9));
}

} // namespace

template <class Dynamics>
EventDrivenEngine<Dynamics>::EventDrivenEngine(const Scene& scene, StoredState state,
                                               const Communicator& communicator,
                                               const Tuning& tuning,
                                               const BlockTuning& block_tuning)
    : Base(scene, std::move(state), communicator, tuning), block_tuning_(block_tuning),
      levels_(choose_size_levels(scene.effects.species, dynamics_.radius(),
                                 static_cast<double>(scene.n_discs), scene.box.area(),
                                 block_tuning.parts_sizes)) {
    for (int thread = 0; thread < tuning_.threads; ++thread) block_runs_.emplace_back(dynamics_);
    travel_speed_ = communicator_.max(largest_speed_);
    this->distribute();
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
    while (time_ < target_time) run_window(target_time);
    this->write_resting_states();
    n_micro_done_ = target;
}

/// Runs one window, which ends at `target` or before.
template <class Dynamics> void EventDrivenEngine<Dynamics>::run_window(double target) {
    this->set_departed_aside();
    this->write_resting_states();
    migrate();
    refuse_jam();
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
    const BlockNeeds needs = block_needs(window.speed_bound);
    const double left = target - time_;
    double longest = left;
    if constexpr (Dynamics::is_periodic)
        longest = std::min(longest, longest_in_period(discs_.periods(), window.speed_bound));
    if (!tuning_.window) longest = std::min(longest, caution_.most_hits() / needs.collision_rate);
    choice_ = choose_block_window(needs, longest, tuning_.window);
    // Equal windows up to the target; the last one ends there exactly.
    const double n_windows = std::ceil(left / choice_.duration * (1 - 1e-9));
    window.end = n_windows > 1 ? time_ + left / n_windows : target;
    if (!(window.end > time_) || window.end > target)
        window.end = std::nextafter(time_, 2 * target);
    return window;
}

/// The largest speed goes up and down, so the last window's bound is kept for a while. Speeds in
/// the falling frame grow, also those of discs at rest on a floor.
template <class Dynamics>
double EventDrivenEngine<Dynamics>::speed_bound_until(double target) const {
    const double now = communicator_.max(largest_speed_) * block_tuning_.speed_allowance;
    const double soon = std::min(time_ + 2 * last_duration_, target);
    const double at_rest = Dynamics::may_rest ? dynamics_.speed_gained_at(target) : 0;
    return std::max(std::max(now, at_rest), 0.99 * travel_speed_) +
           (dynamics_.speed_gained_at(soon) - dynamics_.speed_gained_at(time_));
}

/// Ends the run if discs grow into a jam: they become ever faster and collide ever more often, so
/// that the step would never end. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::refuse_jam() {
    const double growth = dynamics_.growth_at(time_);
    const double per_micro_step = dynamics_.growth_at(1) - dynamics_.growth_at(0);
    if (!(per_micro_step > 0)) return;
    const double fastest = communicator_.max(largest_speed_);
    if (time_ == 0 || n_windows_ == 0)
        first_speed_ = std::max(fastest, dynamics_.diameter() * per_micro_step);
    if (fastest <= jam_heating * first_speed_) return;
    throw CollectiveError(fmt::format(
        "discs jam at step {:.9g}, as radii have grown to {:.9g} times the first: since the last "
        "sync speeds have become {} times as large; let them grow less, or set time.sync_every to "
        "less",
        (static_cast<double>(this->last_sync()) + time_) / static_cast<double>(this->micro_steps_),
        growth, jam_heating));
}

/// The numbers for the choice of the next window, some of them learned from the last one.
template <class Dynamics> BlockNeeds EventDrivenEngine<Dynamics>::block_needs(double speed_bound) {
    const auto n = static_cast<double>(discs_.n_total());
    const bool is_few = tuning_.threads == 1 ||
                        n < 2 * static_cast<double>(tuning_.discs_per_thread);
    is_alone_ = communicator_.size() == 1 && is_few && n <= most_discs_alone &&
                !block_tuning_.halo && !block_tuning_.block_side;
    BlockNeeds needs;
    needs.box = dynamics_.box();
    needs.radius = dynamics_.radius() * dynamics_.growth_at(time_) + dynamics_.slack();
    needs.equivalent_radius = equivalent_radius(levels_) * dynamics_.growth_at(time_) +
                              dynamics_.slack();
    needs.n_discs = n;
    needs.speed_bound = speed_bound;
    needs.time = time_;
    needs.halo = block_tuning_.halo;
    needs.is_one_block = is_alone_;
    needs.goes_round_x = discs_.periods().x != 0;
    needs.goes_round_y = discs_.periods().y != 0;
    if (n_windows_ > 0)
        collision_rate_ = static_cast<double>(communicator_.sum(n_events_)) /
                          (std::max(n, 1.0) * last_duration_);
    else if (const double largest = communicator_.max(largest_speed_); largest > 0)
        collision_rate_ = guessed_collision_rate(
            needs, survey_speeds(discs_.own(), largest, communicator_).mean());
    needs.collision_rate = collision_rate_;
    caution_.learn(repeated_, collision_rate_ * last_duration_);
    needs.more_halo = caution_.more_halo();
    repeated_ = 0;
    return needs;
}

/// Makes the window shorter for a higher speed, so that the reach stays the same. If all discs were
/// at rest until a wall came, the window becomes as long as a flight over a diameter.
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
    discs_.sort_cells(lay_cells(reach()), time_, tuning_.threads);
    {
        const PhaseClock::Scope exchange(phases_, Phase::exchange);
        discs_.fetch_halo(time_, halo_depth_ * reach(), nullptr);
    }
    histories_.resize(discs_.all().size());
    make_blocks();
}

/// Own columns end where the strip does: a block's halo counts from its last column, the rank's
/// from the strip.
template <class Dynamics> GridGeometry EventDrivenEngine<Dynamics>::lay_cells(double reach) {
    const Extent box = extent();
    const Axis axis = discs_.strips().axis();
    const auto [low, across_low] = turned(axis, box.x_low, box.y_low);
    const auto [high, across_high] = turned(axis, box.x_high, box.y_high);
    const double from = std::max(low, discs_.strips().low(communicator_.rank()));
    const double to = std::min(high, discs_.strips().high(communicator_.rank()));
    const double least_width = least_cell_width(reach, dynamics_.box().shortest(),
                                                std::max(to - from, 0.0), discs_.n_own());
    const double n_whole = std::max(1.0, std::floor((to - from) / least_width));
    GridGeometry geometry;
    geometry.axis = axis;
    geometry.set_cell_width(std::max(least_width, (to - from) / n_whole));
    geometry.n_reach = static_cast<int>(std::ceil(reach / geometry.cell_width * (1 - 1e-9)));
    const int n_halo = halo_depth_ * geometry.n_reach;
    const bool goes_round_across = discs_.periods().along(other_axis(axis)) != 0;
    const auto n_beside = [&](double beside) { // columns of other strips, or of images
        if (discs_.periods().along(axis) != 0) return n_halo;
        return communicator_.size() > 1 ? std::min(n_halo, cells_along(beside, geometry.cell_width))
                                        : 0;
    };
    own_cells_.first_column = n_beside(from - low);
    own_cells_.end_column = own_cells_.first_column + cells_along(to - from, geometry.cell_width);
    geometry.n_columns = own_cells_.end_column + n_beside(high - to);
    own_cells_.first_row = goes_round_across ? n_halo : 0;
    own_cells_.end_row = own_cells_.first_row +
                         cells_along(across_high - across_low, geometry.cell_width);
    geometry.n_rows = own_cells_.end_row + own_cells_.first_row;
    geometry.low = from - own_cells_.first_column * geometry.cell_width;
    geometry.across_low = across_low - own_cells_.first_row * geometry.cell_width;
    return geometry;
}

/// Cuts the own cells into blocks of about equal size. A block that exists already keeps its halo.
template <class Dynamics> void EventDrivenEngine<Dynamics>::make_blocks() {
    const double cell_width = discs_.grid().geometry().cell_width, side = block_side();
    const auto cells_each = [](int n_cells, int n_parts) {
        return (n_cells + n_parts - 1) / n_parts;
    };
    const auto cells_of_block = [&](int n_cells) {
        const double n_parts = std::ceil(n_cells * cell_width / side * (1 - 1e-9));
        return cells_each(n_cells, std::clamp(static_cast<int>(n_parts), 1, n_cells));
    };
    const int n_columns = own_cells_.end_column - own_cells_.first_column,
              n_rows = own_cells_.end_row - own_cells_.first_row;
    block_columns_ = cells_of_block(n_columns);
    block_rows_ = cells_of_block(n_rows);
    const int n_block_columns = cells_each(n_columns, block_columns_);
    n_block_rows_ = cells_each(n_rows, block_rows_);
    const auto n_blocks = static_cast<std::size_t>(n_block_columns) *
                          static_cast<std::size_t>(n_block_rows_);
    const bool is_new = halo_depth_ == first_halo_depth() || blocks_.size() != n_blocks;
    blocks_.resize(n_blocks);
    std::size_t next = 0;
    for (int k = 0; k < n_block_columns; ++k) {
        for (int j = 0; j < n_block_rows_; ++j) {
            Block& block = blocks_[next++];
            block.cells.first_column = own_cells_.first_column + k * block_columns_;
            block.cells.end_column = std::min(block.cells.first_column + block_columns_,
                                              own_cells_.end_column);
            block.cells.first_row = own_cells_.first_row + j * block_rows_;
            block.cells.end_row = std::min(block.cells.first_row + block_rows_, own_cells_.end_row);
            block.is_marked = 1;
            if (is_new) block.halo = choice_.halo;
        }
    }
}

/// The length that a block's sides should have, in the unit of the scene.
template <class Dynamics> double EventDrivenEngine<Dynamics>::block_side() const {
    const GridGeometry& geometry = discs_.grid().geometry();
    const double width = (own_cells_.end_column - own_cells_.first_column) * geometry.cell_width,
                 height = (own_cells_.end_row - own_cells_.first_row) * geometry.cell_width;
    const double n_blocks = blocks_per_thread * tuning_.threads;
    if (block_tuning_.block_side)
        return *block_tuning_.block_side * geometry.cell_width * geometry.n_reach;
    if (tuning_.threads == 1) return choice_.block_side;
    return std::min(choice_.block_side, std::max(std::sqrt(width * height / n_blocks),
                                                 std::max(width, height) / n_blocks));
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::run_blocks() {
    const PhaseClock::Scope scope(phases_, Phase::search);
    const BlockGround ground{discs_.all(),
                             discs_.n_own(),
                             &discs_.grid(),
                             own_cells_,
                             window_,
                             this->log_ != nullptr || this->wall_followers_.are_any(),
                             &discs_.columns(),
                             this->no_stress_,
                             this->flown_before_,
                             box_cells_,
                             is_alone_,
                             this->pair_followers_.are_any(),
                             this->last_sync(),
                             this->log_ == nullptr,
                             static_cast<double>(this->micro_steps_),
                             levels_,
                             extent()};
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
        BlockRun<Dynamics>& block_run = block_runs_[static_cast<std::size_t>(omp_get_thread_num())];
        if (is_alone_ || (Dynamics::is_periodic && sees_all(block)))
            block_run.run_whole(ground, block.cells, histories_, block.outcome);
        else
            block_run.run(ground, block.cells, block.halo * discs_.grid().geometry().n_reach,
                          histories_, block.outcome);
        block.is_marked = 0;
    }
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::commit() {
    const PhaseClock::Scope scope(phases_, Phase::move);
    Disc* const discs = discs_.all().data();
    const auto n_blocks = static_cast<std::int64_t>(blocks_.size());
#pragma omp parallel for num_threads(tuning_.threads) schedule(dynamic, 1)
    for (std::int64_t k = 0; k < n_blocks; ++k) {
        const BlockOutcome& outcome = blocks_[static_cast<std::size_t>(k)].outcome;
        for (std::size_t i = 0; i < outcome.hit.size(); ++i)
            outcome.states[i].overwrite(discs[outcome.hit[i]]);
        for (std::size_t i = 0; i < outcome.hit.size(); ++i)
            discs_.columns().copy(outcome.hit[i], outcome.columns, i);
    }
    n_events_ = 0;
    largest_speed_ = 0;
    for (const Block& block : blocks_) {
        n_events_ += block.outcome.n_events;
        largest_speed_ = std::max(largest_speed_, block.outcome.largest_speed_at_end);
        if (this->stress_) *this->stress_ += block.outcome.stress;
        if (this->is_followed()) log_events(block.outcome);
        if (Dynamics::has_moving_images && this->work_) *this->work_ += block.outcome.work;
    }
    for (Block& block : blocks_) block.has_run = false;
    last_duration_ = window_.duration();
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::finish_sync(double largest_speed) {
    largest_speed_ = largest_speed;
    jumped_ += dynamics_.jump_at(discs_.strips().axis(), time_);
    for (BlockRun<Dynamics>& block_run : block_runs_) block_run.change_dynamics(dynamics_);
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::drop_scratch() {
    Base::drop_scratch();
    std::vector<Block>().swap(blocks_);
    std::vector<std::uint64_t>().swap(histories_);
}

template <class Dynamics> RollbackCounts EventDrivenEngine<Dynamics>::rollback_counts() const {
    RollbackCounts counts = counts_;
    counts.blocks = communicator_.sum(counts_.blocks);
    counts.blocks_redone = communicator_.sum(counts_.blocks_redone);
    return counts;
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
