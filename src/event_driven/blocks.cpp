// SPDX-License-Identifier: BSD-3-Clause
// How the event-driven engine lays cells over its strip and cuts them into blocks.
#include <algorithm>
#include <cmath>

#include "event_driven/event_driven_engine.hpp"

namespace carrom {

namespace {

/// Blocks are cut by work if the fullest one has this many times the discs of the mean one. Below
/// it such cuts gain less than they cost, and blocks of few discs differ as much by chance.
constexpr double uneven = 1.5;
/// Where discs crowd, there are at most this many times as many cells as in an even gas, because
/// empty cells take memory too.
constexpr double most_cells = 4;
/// What a disc that a run sees costs, in units of a collision.
constexpr double work_of_disc = 0.14;

int cells_along(double length, double width) {
    return static_cast<int>(std::clamp(std::ceil(length / width * (1 - 1e-9)), 1.0, 1e9));
}

} // namespace

/// Own columns end where the strip does: a block's halo counts from its last column, the rank's
/// from the strip.
template <class Dynamics> GridGeometry EventDrivenEngine<Dynamics>::lay_cells(double reach) {
    const Extent box = extent();
    const Axis axis = discs_.strips().axis();
    const auto [low, across_low] = turned(axis, box.x_low, box.y_low);
    const auto [high, across_high] = turned(axis, box.x_high, box.y_high);
    const double from = std::max(low, discs_.strips().low(communicator_.rank()));
    const double to = std::min(high, discs_.strips().high(communicator_.rank()));
    const auto n_for_cells = static_cast<std::uint64_t>(
        static_cast<double>(discs_.n_own()) * std::min(mean_crowding_, most_cells));
    const double least_width = least_cell_width(reach, dynamics_.box().shortest(),
                                                std::max(to - from, 0.0),
                                                n_for_cells);
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

/// Cuts the own cells into blocks. A block that exists already keeps its halo.
template <class Dynamics> void EventDrivenEngine<Dynamics>::make_blocks() {
    const CellGrid& grid = discs_.grid();
    const double cell_width = grid.geometry().cell_width, side = block_side();
    const auto cells_of_block = [&](int n_cells) {
        const double n_parts = std::ceil(n_cells * cell_width / side * (1 - 1e-9));
        const int n = std::clamp(static_cast<int>(n_parts), 1, n_cells);
        return (n_cells + n - 1) / n;
    };
    const auto n_in = [&grid](int column, int first_row, int end_row) -> std::uint64_t {
        const SlotRange run = grid.run(column, first_row, end_row - 1);
        return run.end - run.begin;
    };
    const double n_cells = dynamics_.box().area() / (cell_width * cell_width);
    crowding_ = static_cast<double>(pairs_in_cells(own_cells_, n_in)) * n_cells /
                static_cast<double>(std::max<std::uint64_t>(1, discs_.n_total()));
    cuts_.cut_evenly(own_cells_, cells_of_block(own_cells_.n_columns()),
                     cells_of_block(own_cells_.n_rows()));
    if (block_tuning_.cuts_by_work.value_or(!block_tuning_.block_side &&
                                            cuts_.is_uneven(uneven, n_in)))
        cuts_.cut_by_work(own_cells_, cut_needs(n_cells), n_in);
    const std::vector<CellBlock>& blocks = cuts_.blocks();
    const bool is_new = halo_depth_ == first_halo_depth() || blocks_.size() != blocks.size();
    blocks_.resize(blocks.size());
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        blocks_[k].cells = blocks[k];
        blocks_[k].is_marked = 1;
        if (is_new) blocks_[k].halo = choice_.halo;
    }
}

/// What cuts by work have to know. A disc collides the more often the denser it is around it.
template <class Dynamics>
CutNeeds EventDrivenEngine<Dynamics>::cut_needs(double n_cells_of_box) const {
    CutNeeds needs;
    needs.halo = choice_.halo * discs_.grid().geometry().n_reach;
    needs.least = block_tuning_.cuts_by_work ? 1 : needs.halo;
    needs.n_blocks = tuning_.threads == 1 && !block_tuning_.cuts_by_work
                         ? 1
                         : static_cast<std::size_t>(blocks_per_thread * tuning_.threads);
    needs.most_seen = most_discs_seen;
    needs.work_per_disc = work_of_disc;
    const double mean_in_cell = mean_crowding_ * static_cast<double>(discs_.n_total()) /
                                n_cells_of_box;
    needs.work_per_crowding = collision_rate_ * window_.duration() / std::max(mean_in_cell, 1e-300);
    return needs;
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


// These members are called from event_driven_engine.cpp, where the class itself is compiled.
#define CARROM_DEFINE(Dynamics)                                                                    \
    template GridGeometry EventDrivenEngine<Dynamics>::lay_cells(double);                          \
    template void EventDrivenEngine<Dynamics>::make_blocks();
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
