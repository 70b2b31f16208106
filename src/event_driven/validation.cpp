// SPDX-License-Identifier: BSD-3-Clause
// Decides whether a window's block runs are right (docs/understanding/method.md, sections 8.2 and
// 9), and marks the blocks that have to run again.
#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/format.h>

#include "core/stop_request.hpp"
#include "engine/jammed.hpp"
#include "event_driven/event_driven_engine.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

/// Tests the block runs of all ranks, and marks the blocks that must run again. **Collective.**
template <class Dynamics>
typename EventDrivenEngine<Dynamics>::Verdict EventDrivenEngine<Dynamics>::validate() {
    const PhaseClock::Scope scope(phases_, Phase::resolve);
    check_partners();
    std::vector<LocalIndex> foreign;
    if (!is_alone_) {
        const PhaseClock::Scope exchange(phases_, Phase::exchange);
        discs_.show(histories_);
    }
    compare_histories(foreign);
    reduced_ = {};
    FoundInWindow& found = reduced_.counts;
    for (const Block& block : blocks_) {
        found.marked_blocks += block.is_marked;
        found.cascades += block.outcome.is_cascade;
        found.events += block.outcome.n_events;
        reduced_.largest = std::max(reduced_.largest, block.outcome.largest_speed_at_end);
        if (block.outcome.too_fast > 0) found.ranks_too_fast = 1;
    }
    found.marked_blocks += foreign.size();
    found.ranks_to_stop = is_stop_overdue() ? 1 : 0;
    found.ranks_jammed = are_jammed() ? 1 : 0;
    found.crowding = static_cast<std::uint64_t>(crowding_unit * crowding_);
    if (communicator_.size() > 1) {
        const PhaseClock::Scope wait(phases_, Phase::wait);
        reduce(reduced_, communicator_);
    }
    if (found.ranks_to_stop > 0) throw StopRequested("stopped on request inside a step");
    if (found.ranks_too_fast > 0) return Verdict::too_fast;
    if (found.cascades > 0 && !stops_.empty()) return Verdict::fails_later;
    if (found.cascades > 0) fail_on_cascade();
    if (!block_tuning_.is_validated || found.marked_blocks + found.cascades == 0)
        return Verdict::exact;
    const PhaseClock::Scope exchange(phases_, Phase::exchange);
    std::vector<LocalIndex> reported;
    discs_.report_to_owners(foreign, reported);
    for (const LocalIndex index : reported) mark_owner(index);
    return Verdict::repeat;
}

/// Marks the blocks whose own discs have met a disc from beyond the ring. If such a run covered
/// the whole box, it missed no disc, so the other disc must have been faster than the bound.
template <class Dynamics> void EventDrivenEngine<Dynamics>::check_partners() {
    for (Block& block : blocks_) {
        BlockOutcome& outcome = block.outcome;
        if (!(outcome.far_partner > 0)) continue;
        if (block.saw_all)
            outcome.too_fast = std::max(outcome.too_fast, outcome.far_partner);
        else
            block.is_marked = 1;
    }
}

/// Compares the histories of ring discs with their owners' histories. If they differ and the disc
/// can have met an own disc, marks the block of the ring and the block that owns the disc; discs of
/// other ranks are appended to `foreign`. Blocks that ended in a cascade are marked, too.
template <class Dynamics>
void EventDrivenEngine<Dynamics>::compare_histories(std::vector<LocalIndex>& foreign) {
    const auto n_blocks = static_cast<std::int64_t>(blocks_.size());
#pragma omp parallel num_threads(tuning_.threads)
    {
        std::vector<LocalIndex> differing;
#pragma omp for schedule(dynamic, 1)
        for (std::int64_t k = 0; k < n_blocks; ++k) {
            Block& block = blocks_[static_cast<std::size_t>(k)];
            bool differs = block.outcome.is_cascade;
            for (const HaloRecord& record : block.outcome.ring) {
                const std::uint64_t of_owner = histories_[record.index];
                if (record.history == of_owner) continue;
                const SpeedClass fastest = std::max(speed_class_of(record.history),
                                                    speed_class_of(of_owner));
                if (!could_meet(block, discs_.all()[record.index], fastest)) continue;
                differs = true;
                differing.push_back(record.index);
            }
            if (differs) std::atomic_ref(block.is_marked).store(1, std::memory_order_relaxed);
        }
        for (const LocalIndex index : differing) {
            if (index < discs_.n_own()) mark_owner(index);
        }
#pragma omp critical
        for (const LocalIndex index : differing) {
            if (index >= discs_.n_own()) foreign.push_back(index);
        }
    }
}

/// Whether a disc of the ring can have met an own disc of the block, in the block's run or in the
/// run of the disc's owner. If it cannot, the run is right although its history of this disc is
/// wrong (docs/understanding/method.md, section 8.2).
template <class Dynamics>
bool EventDrivenEngine<Dynamics>::could_meet(const Block& block, const DiscState& disc,
                                             SpeedClass fastest) const {
    if (Dynamics::has_moving_images) return true; // a disc's speed differs between rows of images
    if (fastest == largest_speed_class) return true;
    const double at_begin = std::sqrt(dynamics_.squared_speed(disc)),
                 later = window_.speed_bound * std::sqrt(fastest / speed_classes_to_bound);
    const double speeds = block.outcome.largest_speed + std::max(at_begin, later);
    // block_reach assumes that both discs move at the bound, so half the sum of their speeds is
    // used as the bound.
    const double farthest = block_reach(window_.with_bound(speeds / 2), contact_distance(),
                                        dynamics_.box());
    return distance_from_own(block, disc) <= farthest;
}

/// The least distance at the window's start between a disc and the positions that own discs of the
/// block can have had.
template <class Dynamics>
double EventDrivenEngine<Dynamics>::distance_from_own(const Block& block,
                                                      const DiscState& disc) const {
    const GridGeometry& geometry = discs_.grid().geometry();
    const Domain mine = discs_.domains().of(communicator_.rank());
    const double rounding = 1e-6 * geometry.cell_width;
    const auto away = [&](double place, double corner, const Strip& domain, double period,
                          int first, int end, int first_own, int end_own) {
        double low = first == first_own ? domain.low : corner + first * geometry.cell_width,
               high = end == end_own ? domain.high : corner + end * geometry.cell_width;
        if (period != 0) { // own discs are always inside the box
            low = std::max(low, 0.0);
            high = std::min(high, period);
        }
        return std::max({low - place, place - high, rounding}) - rounding;
    };
    const auto [along, across] = turned(geometry.axis, discs_.periods().x_of(disc, window_.begin),
                                        discs_.periods().y_of(disc, window_.begin));
    const auto [period_along, period_across] = turned(geometry.axis, discs_.periods().x,
                                                      discs_.periods().y);
    const CellBlock& cells = block.cells;
    return std::hypot(away(along, geometry.low, mine.along, period_along, cells.first_column,
                           cells.end_column, own_cells_.first_column, own_cells_.end_column),
                      away(across, geometry.across_low, mine.across, period_across, cells.first_row,
                           cells.end_row, own_cells_.first_row, own_cells_.end_row));
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::mark_owner(LocalIndex own_index) {
    const CellGrid::Cell cell = discs_.grid().cell_of(own_index);
    const int column = std::clamp(cell.column, own_cells_.first_column, own_cells_.end_column - 1),
              row = std::clamp(cell.row, own_cells_.first_row, own_cells_.end_row - 1);
    std::atomic_ref(blocks_[cuts_.block_of(column, row)].is_marked)
        .store(1, std::memory_order_relaxed);
}

/// Records the cost of running the marked blocks again. All threads of all ranks wait for the rank
/// with the most marked blocks. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::record_rollback() {
    // time of a run with twice the halo divided by the time of a first run
    constexpr double deeper = 1.6;
    std::uint64_t n_marked = 0;
    for (const Block& block : blocks_) n_marked += block.is_marked;
    const auto share_of = [](std::uint64_t n, std::uint64_t n_blocks) {
        return static_cast<double>(n) / static_cast<double>(std::max<std::uint64_t>(n_blocks, 1));
    };
    const auto n_threads = static_cast<std::uint64_t>(tuning_.threads);
    const std::uint64_t in_turn = (n_marked + n_threads - 1) / n_threads * n_threads;
    const double longest = communicator_.max(deeper * share_of(in_turn, blocks_.size()));
    Rollback rollback;
    if (communicator_.size() > 1 || n_threads > 1) rollback.waited = longest;
    rollback.price_of_reach = communicator_.max(price_of_reach());
    std::uint64_t n[] = {n_marked, blocks_.size()};
    communicator_.sum(n);
    rollback.repeated = share_of(n[0], n[1]);
    policy_.note(rollback);
}

/// The relative growth of the area of this rank's blocks and halos if halos were one reach deeper.
template <class Dynamics> double EventDrivenEngine<Dynamics>::price_of_reach() const {
    const GridGeometry& geometry = discs_.grid().geometry();
    const CellBlock frame{0, geometry.n_columns, 0, geometry.n_rows};
    double now = 0, deeper = 0;
    for (const Block& block : blocks_) {
        const int halo = choice_.halo * geometry.n_reach;
        now += block.cells.widened(halo).within(frame).area();
        deeper += block.cells.widened(halo + geometry.n_reach).within(frame).area();
    }
    return now > 0 ? deeper / now - 1 : 0;
}

/// Doubles the halo of each marked block that does not yet cover the whole box. (Even if its last
/// run did not cover the box, its next run may, because the rank's halo has become deeper for other
/// blocks.) Ranks extend their halos as far as there are cells for them. If this is not enough,
/// increases the depth of all ranks' halos and returns true: then all blocks have to run again.
/// **Collective.**
template <class Dynamics> bool EventDrivenEngine<Dynamics>::widen_marked() {
    int deepest = halo_depth_;
    struct Counts {
        std::uint64_t blocks = 0, ranks_that_go_deeper = 0;
    };
    JointReduction<Counts> wanted;
    for (Block& block : blocks_) {
        if (block.is_marked == 0) continue;
        if (block.saw_all) {
            block.is_marked = 0; // another run would have the same result
            continue;
        }
        if (!sees_all(block)) block.halo *= 2;
        ++wanted.counts.blocks;
        deepest = std::max(deepest, halo_depth_for(block));
    }
    if (discs_.periods().are_any()) { // a halo that goes once around the box has all discs
        const int around = static_cast<int>(std::ceil(dynamics_.box().longest() / reach())) + 3;
        deepest = std::max(halo_depth_, std::min(deepest, around));
    }
    const bool wants = deepest > halo_depth_;
    wanted.counts.ranks_that_go_deeper = wants ? 1 : 0;
    wanted.largest = deepest;
    if (communicator_.size() > 1) reduce(wanted, communicator_);
    ensure(wanted.counts.blocks > 0, "blocks that have seen the whole box disagree");
    if (discs_.has_no_halo() || wanted.counts.ranks_that_go_deeper == 0) return false;
    if (wanted.largest > laid_depth()) {
        common_depth_ = static_cast<int>(wanted.largest);
        return true;
    }
    const PhaseClock::Scope exchange(phases_, Phase::exchange);
    discs_.fetch_more_halo(time_, common_depth_ * reach(), laid_depth() * reach(), wants);
    if (wants) halo_depth_ = laid_depth();
    histories_.resize(discs_.all().size());
    return false;
}

/// The depth in reaches that the rank's halo needs for this block. A side where a wall ends the box
/// needs no halo.
template <class Dynamics>
int EventDrivenEngine<Dynamics>::halo_depth_for(const Block& block) const {
    const int n_reach = discs_.grid().geometry().n_reach;
    const Axis axis = discs_.domains().axis();
    const Domains& domains = discs_.domains();
    const Domain mine = domains.of(communicator_.rank());
    const bool goes_round = discs_.periods().along(axis) != 0,
               goes_round_across = discs_.periods().along(other_axis(axis)) != 0;
    int depth = 0;
    const auto reach_over = [&](bool is_open, int n_cells_inside) {
        if (is_open)
            depth = std::max(depth,
                             (block.halo * n_reach - n_cells_inside + n_reach - 1) / n_reach);
    };
    reach_over(goes_round || std::isfinite(mine.along.low),
               block.cells.first_column - own_cells_.first_column);
    reach_over(goes_round || std::isfinite(mine.along.high),
               own_cells_.end_column - block.cells.end_column);
    reach_over(goes_round_across || std::isfinite(mine.across.low),
               block.cells.first_row - own_cells_.first_row);
    reach_over(goes_round_across || std::isfinite(mine.across.high),
               own_cells_.end_row - block.cells.end_row);
    return depth;
}

template <class Dynamics> bool EventDrivenEngine<Dynamics>::sees_all(const Block& block) const {
    if (is_alone_) return true;
    if (Dynamics::is_periodic) return sees_all_images(block);
    const GridGeometry& geometry = discs_.grid().geometry();
    const int halo = block.halo * geometry.n_reach;
    const bool has_all_cells = block.cells.first_column <= halo &&
                               block.cells.end_column + halo >= geometry.n_columns &&
                               block.cells.first_row <= halo &&
                               block.cells.end_row + halo >= geometry.n_rows;
    const double reach = this->reach();
    const Domains& domains = discs_.domains();
    const Box box = extent().size();
    const double length = domains.are_cut_across() ? box.longest() : along(domains.axis(), box);
    const bool rank_has_all = communicator_.size() == 1 || halo_depth_ * reach > length;
    return has_all_cells && rank_has_all;
}

/// Whether the block's cells contain all images that it needs along periodic axes. This is so if
/// they extend once around the box, and one reach further at both ends.
template <class Dynamics>
bool EventDrivenEngine<Dynamics>::sees_all_images(const Block& block) const {
    const GridGeometry& geometry = discs_.grid().geometry();
    const int halo = block.halo * geometry.n_reach;
    const double reach = this->reach();
    const Domains& domains = discs_.domains();
    const Axis axis = domains.axis();
    const auto is_deep_enough = [&](double length) {
        return halo_depth_ * reach > length + 2 * reach;
    };
    const bool has_all_along = domains.n_strips() == 1, has_all_across = !domains.are_cut_across();
    const Box box = dynamics_.box();
    const bool rank_has_all = (has_all_along || is_deep_enough(along(axis, box))) &&
                              (has_all_across || is_deep_enough(along(other_axis(axis), box)));
    const auto has_all = [&](int first, int end, int first_own, int end_own, int n_cells, Axis of,
                             bool own_is_all) {
        const int seen_first = std::max(0, first - halo), seen_end = std::min(n_cells, end + halo);
        if (discs_.periods().along(of) == 0) return seen_first == 0 && seen_end == n_cells;
        const int around = static_cast<int>(std::ceil(along(of, box) / geometry.cell_width)) + 1 +
                           geometry.n_reach;
        const bool has_own = seen_first <= first_own - geometry.n_reach &&
                             seen_end >= end_own + geometry.n_reach;
        return has_own && (own_is_all || seen_end >= first_own + around);
    };
    return rank_has_all &&
           has_all(block.cells.first_column, block.cells.end_column, own_cells_.first_column,
                   own_cells_.end_column, geometry.n_columns, axis, has_all_along) &&
           has_all(block.cells.first_row, block.cells.end_row, own_cells_.first_row,
                   own_cells_.end_row, geometry.n_rows, other_axis(axis), has_all_across);
}

/// Ends the run on all ranks if a block run of the whole box ended in a collision cascade.
/// **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::fail_on_cascade() const {
    std::string text;
    for (const Block& block : blocks_) {
        const BlockOutcome& outcome = block.outcome;
        if (!outcome.is_cascade || !block.saw_all) continue;
        const std::string partner = outcome.cascade_partner == outcome.cascade_disc
                                        ? "a wall"
                                        : fmt::format("disc {}", outcome.cascade_partner);
        text = fmt::format(
            "disc {} collides without end at step {:.9g}, at last with {}: {}",
            outcome.cascade_disc,
            (static_cast<double>(this->last_sync()) + outcome.cascade_time) /
                static_cast<double>(this->micro_steps_),
            partner,
            Dynamics::is_for_study
                ? "it has no room to move, or the scene's precision and arithmetic do not tell "
                  "when it moves"
                : "it has no room to move, is so fast that steps should be shorter, or lies at "
                  "rest (try a longer effects.contact.contact_time); where a surface slides, try "
                  "a restitution or a tangential_restitution below 1 there");
        break;
    }
    if (communicator_.any(!text.empty()) && jam_watch_.is_on()) refuse_jam();
    agree(communicator_, text.empty(), text);
}

// These members are called from event_driven_engine.cpp, where the rest of the class is compiled.
#define CARROM_DEFINE(Dynamics)                                                                    \
    template EventDrivenEngine<Dynamics>::Verdict EventDrivenEngine<Dynamics>::validate();         \
    template bool EventDrivenEngine<Dynamics>::widen_marked();                                     \
    template void EventDrivenEngine<Dynamics>::record_rollback();                                  \
    template bool EventDrivenEngine<Dynamics>::sees_all(const Block&) const;
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
