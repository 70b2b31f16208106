// SPDX-License-Identifier: BSD-3-Clause
// How the event-driven engine lays cells over its domain and cuts them into blocks.
#include <algorithm>
#include <cmath>

#include "event_driven/cell_sums_fill.hpp"
#include "event_driven/event_driven_engine.hpp"

namespace carrom {

namespace {

/// On one thread, blocks are cut by work if the fullest block has more than this many times the
/// mean number of discs. At lower ratios, which small blocks may have by chance, cuts cost more
/// than they save.
constexpr double uneven = 1.5;
/// If discs are clustered, there are at most this many times as many cells as in a homogeneous gas,
/// because empty cells take memory too.
constexpr double most_cells = 4;
constexpr double most_units = 0x1p31; ///< sums of whole work units must fit into 32 bits

/// A crowding of at most `least_crowding` counts as 1, because runs with cells and windows for the
/// mean density are then hardly slower.
constexpr double least_crowding = 2, most_crowding = 400;

/// The number of own discs in all cells before this one. `row` may be one beyond the last row.
std::uint32_t discs_before(const CellGrid& grid, int column, int row) {
    return grid.run(column, row, row).begin;
}

/// The number of pairs of discs that are in the same cell; each pair counts twice.
double pairs_in_cells(const CellGrid& grid, const CellBlock& cells, int n_threads) {
    std::uint64_t n_pairs = 0;
#pragma omp parallel for num_threads(n_threads) schedule(static) reduction(+ : n_pairs)
    for (int column = cells.first_column; column < cells.end_column; ++column) {
        std::uint32_t before = discs_before(grid, column, cells.first_row);
        for (int row = cells.first_row; row < cells.end_row; ++row) {
            const std::uint32_t end = discs_before(grid, column, row + 1);
            const std::uint64_t n = end - before;
            n_pairs += n * n - n;
            before = end;
        }
    }
    return static_cast<double>(n_pairs);
}

std::uint64_t discs_in(const CellGrid& grid, const CellBlock& cells) {
    std::uint64_t n = 0;
    for (int column = cells.first_column; column < cells.end_column; ++column) {
        const SlotRange run = grid.run(column, cells.first_row, cells.end_row - 1);
        n += run.end - run.begin;
    }
    return n;
}

/// Whether the fullest block has far more discs than blocks have on average.
bool are_uneven(const CellGrid& grid, const std::vector<CellBlock>& blocks, int n_threads) {
    std::uint64_t most = 0, all = 0;
    const auto n_blocks = static_cast<std::int64_t>(blocks.size());
#pragma omp parallel for num_threads(n_threads) schedule(static) reduction(+ : all)                \
    reduction(max : most)
    for (std::int64_t k = 0; k < n_blocks; ++k) {
        const CellBlock& block = blocks[static_cast<std::size_t>(k)];
        const std::uint64_t n = discs_in(grid, block);
        most = std::max(most, n);
        all += n;
    }
    return static_cast<double>(most) * static_cast<double>(n_blocks) >
           uneven * static_cast<double>(all);
}

/// The smallest block of cells with all discs of the given block; one cell if it has no discs.
CellBlock without_margins(const CellBlock& block, const CellSums& sums) {
    if (sums.in(block) > 0) return sums.occupied(block);
    return {block.first_column, block.first_column + 1, block.first_row, block.first_row + 1};
}

int cells_along(double length, double width) {
    return static_cast<int>(std::clamp(std::ceil(length / width * (1 - 1e-9)), 1.0, 1e9));
}

} // namespace

/// Lays cells over the own domain and its halo. The last own column ends where the domain ends,
/// because a block's halo is counted from its last column, but the rank's halo from the end of the
/// domain. The last own row may extend beyond the domain by less than a reach.
template <class Dynamics> GridGeometry EventDrivenEngine<Dynamics>::lay_cells(double reach) {
    const Extent box = extent();
    const Domains& domains = discs_.domains();
    const Axis axis = domains.axis();
    const Domain mine = domains.of(communicator_.rank());
    const auto [low, across_low] = turned(axis, box.x_low, box.y_low);
    const auto [high, across_high] = turned(axis, box.x_high, box.y_high);
    const double from = std::max(low, mine.along.low), to = std::min(high, mine.along.high);
    const double across_from = std::max(across_low, mine.across.low),
                 across_to = std::min(across_high, mine.across.high);
    const auto n_for_cells = static_cast<std::uint64_t>(static_cast<double>(discs_.n_own()) *
                                                        std::min(mean_crowding_, most_cells));
    const double height = domains.are_cut_across() ? std::max(across_to - across_from, 0.0)
                                                   : dynamics_.box().shortest();
    const double least_width = least_cell_width(reach, height, std::max(to - from, 0.0),
                                                n_for_cells);
    const double n_whole = std::max(1.0, std::floor((to - from) / least_width));
    GridGeometry geometry;
    geometry.axis = axis;
    geometry.set_cell_width(std::max(least_width, (to - from) / n_whole));
    geometry.n_reach = static_cast<int>(std::ceil(reach / geometry.cell_width * (1 - 1e-9)));
    const int n_halo = laid_depth() * geometry.n_reach;
    // Number of columns or rows beyond the own cells, for discs of other domains or for images.
    const auto n_beside = [&](double beside, Axis of, bool is_cut) {
        if (discs_.periods().along(of) != 0) return n_halo;
        return is_cut ? std::min(n_halo, cells_along(beside, geometry.cell_width)) : 0;
    };
    const auto n_along = [&](double beside) {
        return n_beside(beside, axis, domains.n_strips() > 1);
    };
    const auto n_across = [&](double beside) {
        return n_beside(beside, other_axis(axis), domains.are_cut_across());
    };
    own_cells_.first_column = n_along(from - low);
    own_cells_.end_column = own_cells_.first_column + cells_along(to - from, geometry.cell_width);
    geometry.n_columns = own_cells_.end_column + n_along(high - to);
    own_cells_.first_row = n_across(across_from - across_low);
    own_cells_.end_row = own_cells_.first_row +
                         cells_along(across_to - across_from, geometry.cell_width);
    geometry.n_rows = own_cells_.end_row + n_across(across_high - across_to);
    geometry.low = from - own_cells_.first_column * geometry.cell_width;
    geometry.across_low = across_from - own_cells_.first_row * geometry.cell_width;
    return geometry;
}

/// Cuts the own cells into blocks. If all halos have been deepened in this window, the blocks keep
/// the depths of their halos.
template <class Dynamics> void EventDrivenEngine<Dynamics>::make_blocks() {
    const double n_pairs = measure_crowding(own_cells_);
    const bool is_set = block_tuning_.block_side || block_tuning_.cuts_by_work.has_value();
    const bool has_threads = tuning_.threads > 1 && !is_set;
    std::vector<CellBlock> blocks;
    if (!has_threads) blocks = cut_evenly();
    if (block_tuning_.cuts_by_work.value_or(
            has_threads || (!is_set && are_uneven(discs_.grid(), cuts_.blocks(), tuning_.threads))))
        blocks = cut_by_work(n_pairs);
    const bool is_new = common_depth_ == first_halo_depth() || blocks_.size() != blocks.size();
    blocks_.resize(blocks.size());
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        blocks_[k].cells = blocks[k];
        blocks_[k].is_marked = 1;
        if (is_new) blocks_[k].halo = choice_.halo;
    }
}

template <class Dynamics> std::vector<CellBlock> EventDrivenEngine<Dynamics>::cut_evenly() {
    const GridGeometry& geometry = discs_.grid().geometry();
    const double side = block_tuning_.block_side
                            ? *block_tuning_.block_side * geometry.cell_width * geometry.n_reach
                            : choice_.block_side;
    const auto cells_of_block = [&](int n_cells) {
        const double n_parts = std::ceil(n_cells * geometry.cell_width / side * (1 - 1e-9));
        const int n = std::clamp(static_cast<int>(n_parts), 1, n_cells);
        return (n_cells + n - 1) / n;
    };
    cuts_.cut_evenly(own_cells_, cells_of_block(own_cells_.n_columns()),
                     cells_of_block(own_cells_.n_rows()));
    return cuts_.blocks();
}

/// Cuts the own cells into blocks of about equal work. A disc in a dense region counts more,
/// because it collides more often.
template <class Dynamics>
std::vector<CellBlock> EventDrivenEngine<Dynamics>::cut_by_work(double n_pairs) {
    const CellGrid& grid = discs_.grid();
    const GridGeometry& geometry = grid.geometry();
    const auto n_own = static_cast<double>(discs_.n_own());
    CutNeeds needs;
    needs.halo = choice_.halo * geometry.n_reach;
    needs.frame = {0, geometry.n_columns, 0, geometry.n_rows};
    const double n_blocks = std::ceil(0.99 * n_own / (choice_.own_discs * tuning_.threads));
    needs.n_blocks = static_cast<std::size_t>(std::max(1.0, n_blocks) * tuning_.threads);
    const double events = policy_.collision_rate() * window_.duration() * n_own;
    const double unit = most_units / (work_of_disc * n_own + events + 1);
    const CellWork work{static_cast<std::uint32_t>(unit * work_of_disc),
                        static_cast<std::uint32_t>(unit * events / std::max(n_pairs, 1.0))};
    CellSums sums;
    sums.fill(own_cells_, tuning_.threads, work,
              [&grid](int column, int row) { return discs_before(grid, column, row); });
    cuts_.cut_by_work(own_cells_, needs, sums);
    std::vector<CellBlock> blocks = cuts_.blocks();
    // A run lists all cells of its block, so blocks are cut down to the cells that hold discs. This
    // is done only if all own discs lie in the own cells, because sums over cells miss a disc that
    // rounding has put outside of them.
    if (work.per_disc > 0 && discs_in(grid, own_cells_) == discs_.n_own())
        for (CellBlock& block : blocks) block = without_margins(block, sums);
    return blocks;
}

/// Measures the crowding in the present cells, before the first window. **Collective.**
template <class Dynamics> void EventDrivenEngine<Dynamics>::learn_crowding() {
    const GridGeometry& geometry = discs_.grid().geometry();
    measure_crowding({0, geometry.n_columns, 0, geometry.n_rows});
    take_crowding(communicator_.sum(static_cast<std::uint64_t>(crowding_unit * crowding_)));
}

/// Sets `crowding_`. Returns the number of pairs of discs that share a cell, each counted twice.
template <class Dynamics>
double EventDrivenEngine<Dynamics>::measure_crowding(const CellBlock& cells) {
    const double n_pairs = pairs_in_cells(discs_.grid(), cells, tuning_.threads);
    const double width = discs_.grid().geometry().cell_width;
    const auto n = static_cast<double>(std::max<std::uint64_t>(1, discs_.n_total()));
    crowding_ = std::min(n_pairs / (width * width) * dynamics_.box().area() / n,
                         most_crowding * static_cast<double>(discs_.n_own()));
    return n_pairs;
}

template <class Dynamics> void EventDrivenEngine<Dynamics>::take_crowding(std::uint64_t of_all) {
    const double crowding = static_cast<double>(of_all) /
                            (crowding_unit * std::max(1.0, static_cast<double>(discs_.n_total())));
    mean_crowding_ = crowding > least_crowding ? std::min(crowding, most_crowding) : 1;
}

/// Extra bytes per disc if discs are clustered: 4 for each extra cell, 4 more while cutting blocks.
template <class Dynamics> double EventDrivenEngine<Dynamics>::bytes_for_crowds() const {
    // cells per disc in a homogeneous gas with the smallest cells
    constexpr double cells_per_disc = 2;
    return cells_per_disc * 8 * (std::min(mean_crowding_, most_cells) - 1);
}

// These members are called from event_driven_engine.cpp, where the rest of the class is compiled.
#define CARROM_DEFINE(Dynamics)                                                                    \
    template GridGeometry EventDrivenEngine<Dynamics>::lay_cells(double);                          \
    template void EventDrivenEngine<Dynamics>::make_blocks();                                      \
    template double EventDrivenEngine<Dynamics>::bytes_for_crowds() const;                         \
    template void EventDrivenEngine<Dynamics>::learn_crowding();                                   \
    template void EventDrivenEngine<Dynamics>::take_crowding(std::uint64_t);
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
