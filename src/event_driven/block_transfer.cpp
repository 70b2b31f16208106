// SPDX-License-Identifier: BSD-3-Clause
// How a block copies discs from its rank before a run, and returns their new states afterwards.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/errors.hpp"
#include "event_driven/block_scratch.hpp"

namespace carrom {

template <class Dynamics>
void BlockRun<Dynamics>::Scratch::begin(const BlockGround& of_rank, BlockOutcome& of_run) {
    ground = of_rank;
    outcome = &of_run;
    outcome->parts.clear();
    outcome->hit.clear();
    outcome->states.clear();
    outcome->columns = side_columns_of(dynamics);
    outcome->ring.clear();
    outcome->log.clear();
    outcome->pairs.clear();
    outcome->n_events = outcome->n_carried = outcome->n_seen = 0;
    outcome->is_cascade = false;
    outcome->far_partner = 0;
    begin_part();
}

template <class Dynamics> void BlockRun<Dynamics>::Scratch::begin_part() {
    part = {.stress = ground.sums.no_stress, .losses = ground.sums.no_losses};
    hit_slots.clear();
}

/// Copies the listed discs into the block's slots, cell by cell.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::gather() {
    const std::size_t n = indices.size();
    outcome->n_seen = n;
    discs.resize(n);
    if (!has_sizes)
        runs.resize(static_cast<std::size_t>(cells.end_column - cells.first_column) + 1);
    past_events_of.assign(n, EventHistory{});
    is_hit.assign(n, 0);
    if (ground.columns) columns.gather(*ground.columns, indices);
    for (std::vector<float>* lane : {&x, &y, &vx, &vy}) {
        if (lane->size() < n + filter_padding) lane->resize(2 * n + filter_padding);
    }
    lanes = {x.data(), y.data(), vx.data(), vy.data()};
    if constexpr (has_sizes)
        set_scales_of_levels();
    else
        set_scales();
    largest_squared = 0;
    for (std::uint32_t slot = 0; slot < n; ++slot) {
        if (slot + 16 < n) __builtin_prefetch(&ground.discs[indices[slot + 16]]);
        if (ghost_at(slot)) continue;
        discs[slot] = ground.discs[indices[slot]];
        if (Dynamics::is_periodic && is_whole && indices[slot] >= ground.n_own)
            set_image(discs[slot], periods().home(discs[slot], ground.window.begin));
        place(slot, ground.window.begin);
        largest_squared = std::max(largest_squared, dynamics.squared_speed(discs[slot]));
    }
    if (is_whole)
        for (const Ghost& ghost : layout.ghosts()) place_ghost(ghost);
    if constexpr (has_sizes) measure_radii();
    bound_squared = ground.window.speed_bound * ground.window.speed_bound;
    classes_per_squared = bound_squared > 0 ? speed_classes_to_bound / bound_squared : 0x1p1000;
    const double bound_lane = ground.window.speed_bound * cells_per_speed * (1 - 1e-6);
    bound_lane_squared = static_cast<float>(bound_lane * bound_lane);
    void_squared = bound_squared > 0 ? 0x1p12 * bound_squared : never;
    too_fast = 0;
    is_void = false;
    cascade_watch = {};
}

/// Lists the cells of the block and its halo, and the rank's discs in them.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::list_discs(const CellBlock& own, int halo) {
    const CellGrid& grid = *ground.grid;
    const GridGeometry& geometry = grid.geometry();
    cells.first_column = std::max(0, own.first_column - halo);
    cells.end_column = std::min(geometry.n_columns, own.end_column + halo);
    cells.first_row = std::max(0, own.first_row - halo);
    cells.end_row = std::min(geometry.n_rows, own.end_row + halo);
    ring.first_column = std::max(cells.first_column, own.first_column - geometry.n_reach);
    ring.end_column = std::min(cells.end_column, own.end_column + geometry.n_reach);
    ring.first_row = std::max(cells.first_row, own.first_row - geometry.n_reach);
    ring.end_row = std::min(cells.end_row, own.end_row + geometry.n_reach);
    is_whole = false;
    firsts = {0, cells.end_column - cells.first_column, 0, cells.end_row - cells.first_row};
    n_reach_columns = n_reach_rows = geometry.n_reach;
    axis = geometry.axis;
    cell_width = geometry.cell_width;
    rows_per_cell = 1;
    x_corner = geometry.low + cells.first_column * cell_width;
    y_corner = geometry.across_low + cells.first_row * cell_width;
    cell_rows = static_cast<std::size_t>(cells.end_row - cells.first_row) + 1;
    cell_starts.clear();
    indices.clear();
    for (int column = cells.first_column; column < cells.end_column; ++column) {
        const SlotRange all = grid.run(column, cells.first_row, cells.end_row - 1),
                        all_of_halo = grid.halo_run(column, cells.first_row, cells.end_row - 1);
        std::size_t next = indices.size();
        indices.resize(next + (all.end - all.begin) + (all_of_halo.end - all_of_halo.begin));
        cell_starts.push_back(static_cast<std::uint32_t>(next));
        for (int row = cells.first_row; row < cells.end_row; ++row) {
            const SlotRange run = grid.run(column, row, row),
                            of_halo = grid.halo_run(column, row, row);
            for (LocalIndex index = run.begin; index < run.end; ++index) indices[next++] = index;
            for (std::uint32_t slot = of_halo.begin; slot < of_halo.end; ++slot)
                indices[next++] = grid.halo_index(slot);
            cell_starts.push_back(static_cast<std::uint32_t>(next));
        }
    }
}

/// Lists each disc of the box once, and all ghosts.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::list_all_discs() {
    const BoxCells& box = ground.box_cells;
    is_whole = true;
    n_reach_columns = box.n_reach_columns;
    n_reach_rows = box.n_reach_rows;
    firsts = {box.n_beside, box.n_beside + box.n_columns, box.n_above, box.n_above + box.n_rows};
    cells = ring = {0, box.n_columns + 2 * box.n_beside, 0, box.n_rows + 2 * box.n_above};
    cell_rows = static_cast<std::size_t>(cells.end_row) + 1;
    axis = Axis::x;
    cell_width = box.width;
    rows_per_cell = static_cast<float>(box.width / box.height);
    x_corner = box.x_low - box.n_beside * box.width;
    y_corner = box.y_low - box.n_above * box.height;
    layout.lay(ground.discs, ground.n_own, box, periods(), ground.window.begin);
    indices = layout.indices();
    cell_starts = layout.cell_starts();
}

/// Sets the units of the filter's lanes (lengths in cells, times in windows), and the margins that
/// cover the errors of single precision.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::set_scales() {
    column_limit = static_cast<float>(cells.end_column - cells.first_column - 1);
    row_limit = static_cast<float>(cells.end_row - cells.first_row - 1);
    const BlockWindow& window = ground.window;
    cells_per_length = 1 / cell_width;
    cells_per_speed = window.duration() / cell_width;
    windows_per_time = 1 / window.duration();
    const double size = dynamics.size_at(window.end), diameter = dynamics.search_diameter() * size;
    const double sigma = diameter * cells_per_length;
    const double extent = std::max(cells.end_column - cells.first_column + 0.0,
                                   (cells.end_row - cells.first_row) / double{rows_per_cell}) +
                          8.0;
    const double reach = block_reach(window, diameter, dynamics.box()) * cells_per_length;
    // Separations have errors of up to 2^-21 of the block's size. Rounding errors of the filter's
    // other terms have the effect of a diameter that is larger by 2^-20 d^2 / diameter, where d is
    // the largest distance at which the filter tests a pair.
    const double farthest_tried = 3 * reach + 3;
    const double touching = sigma * (1 + 0x1p-18) + 0x1p-20 * extent +
                            0x1p-20 * farthest_tried * farthest_tried / sigma;
    touching_squared = static_cast<float>(touching * touching);
    farthest = static_cast<float>((reach + sigma) / 2 + 0x1p-18 * extent + 1e-6);
    const double inner = dynamics.radius() * size + dynamics.slack() + 1e-3 * cell_width +
                         0x1p-18 * extent * cell_width;
    const Extent walls = dynamics.walls_between(window.begin, window.end);
    const auto [low, across_low] = turned(axis, walls.x_low, walls.y_low);
    const auto [high, across_high] = turned(axis, walls.x_high, walls.y_high);
    x_inner_low = static_cast<float>((low + inner - x_corner) * cells_per_length);
    y_inner_low = static_cast<float>((across_low + inner - y_corner) * cells_per_length);
    x_inner_high = static_cast<float>((high - inner - x_corner) * cells_per_length);
    y_inner_high = static_cast<float>((across_high - inner - y_corner) * cells_per_length);
}

template <class Dynamics> void BlockRun<Dynamics>::Scratch::mark_own(const CellBlock& own) {
    is_own.assign(indices.size(), 0);
    const int first_row = own.first_row == ground.own_cells.first_row ? cells.first_row
                                                                      : own.first_row;
    const int end_row = own.end_row == ground.own_cells.end_row ? cells.end_row : own.end_row;
    for (int column = cells.first_column; column < cells.end_column; ++column) {
        const int owner = owning_column(column);
        if (owner < own.first_column || owner >= own.end_column) continue;
        const SlotRange run = grid_run(column, first_row, end_row - 1);
        for (std::uint32_t slot = run.begin; slot < run.end; ++slot) {
            if (indices[slot] >= ground.n_own) continue;
            is_own[slot] = 1;
        }
    }
}

/// Marks the block's own discs in a run of the whole box. These are the rank's own discs that lie
/// in the block's cells of the rank's grid.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::mark_own_of_all(const CellBlock& own) {
    if (ground.is_alone) {
        is_own.assign(indices.size(), 1);
        for (const Ghost& ghost : layout.ghosts()) is_own[ghost.slot] = 0;
        return;
    }
    is_own.resize(indices.size());
    for (std::uint32_t slot = 0; slot < indices.size(); ++slot) {
        const LocalIndex index = indices[slot];
        is_own[slot] = index < ground.n_own && !ghost_at(slot);
        if (is_own[slot] == 0) continue;
        const CellGrid::Cell cell = ground.grid->cell_of(index);
        const int column = owning_column(cell.column),
                  row = std::clamp(cell.row, ground.own_cells.first_row,
                                   ground.own_cells.end_row - 1);
        is_own[slot] = column >= own.first_column && column < own.end_column &&
                       row >= own.first_row && row < own.end_row;
    }
}

/// Writes the results for a disc that is the block's own or in its ring.
template <class Dynamics>
[[gnu::always_inline]] inline void BlockRun<Dynamics>::Scratch::report_disc(
    std::uint32_t slot, std::span<std::uint64_t> histories, std::size_t& next,
    double& end_squared) {
    const std::uint64_t history = past_events_of[slot].history;
    if (is_own[slot] == 0) {
        if (!is_whole) outcome->ring.push_back({indices[slot], history});
        return;
    }
    histories[indices[slot]] = history;
    end_squared = std::max(end_squared, dynamics.squared_speed_at(discs[slot], ground.window.end));
    if (is_hit[slot] != 0) report_hit(slot, next++);
}

/// Writes the present state of a disc to the entries with index `place` of the outcome's lists.
template <class Dynamics>
[[gnu::always_inline]] inline void BlockRun<Dynamics>::Scratch::report_hit(std::uint32_t slot,
                                                                           std::size_t place) {
    outcome->hit[place] = indices[slot];
    outcome->states[place] = NewState(discs[slot]);
    outcome->columns.copy(place, columns, slot);
}

/// Makes room in the outcome's lists for the discs that have collided in this part. Returns the
/// index of the first new entry. Lists of the exact size save memory, because all blocks keep their
/// outcomes until the window is validated.
template <class Dynamics> std::size_t BlockRun<Dynamics>::Scratch::make_room_for_hits() {
    const std::size_t n_before = outcome->hit.size(), n = n_before + hit_slots.size();
    outcome->hit.resize(n);
    outcome->states.resize(n);
    outcome->columns.resize(n);
    return n_before;
}

/// Ends a part at a stop: writes the states of the discs that have collided in it.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::report_hits() {
    std::size_t next = make_room_for_hits();
    for (const std::uint32_t slot : hit_slots) {
        report_hit(slot, next++);
        is_hit[slot] = 0;
    }
    end_part();
}

template <class Dynamics> void BlockRun<Dynamics>::Scratch::end_part() {
    stress_terms.add_to(part.stress);
    part.n_hit = outcome->hit.size();
    part.n_logged = outcome->log.size();
    part.n_pairs = outcome->pairs.all().size();
    outcome->parts.push_back(part);
    begin_part();
}

/// Writes the new states of the block's own discs and the histories of the ring to the outcome.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::report(std::span<std::uint64_t> histories) {
    outcome->too_fast = too_fast;
    outcome->largest_speed = std::sqrt(largest_squared) * (1 + 0x1p-50);
    double end_squared = 0;
    if (ground.is_alone) {
        for (std::uint32_t slot = 0; slot < indices.size(); ++slot)
            if (is_own[slot] != 0)
                end_squared = std::max(end_squared,
                                       dynamics.squared_speed_at(discs[slot], ground.window.end));
        report_hits();
    } else {
        report_by_cells(histories, end_squared);
    }
    outcome->largest_speed_at_end = std::sqrt(end_squared) * (1 + 0x1p-50);
}

/// Writes the results for own discs and for discs of the ring, in order of slot.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::report_by_cells(std::span<std::uint64_t> histories,
                                                  double& end_squared) {
    std::size_t next = make_room_for_hits();
    if constexpr (has_sizes) {
        for (std::uint32_t slot = 0; slot < indices.size(); ++slot)
            if (is_own[slot] != 0 || (!is_whole && is_of_ring[slot] != 0))
                report_disc(slot, histories, next, end_squared);
    } else {
        for (int column = ring.first_column; column < ring.end_column; ++column) {
            const SlotRange run = grid_run(column, ring.first_row, ring.end_row - 1);
            for (std::uint32_t slot = run.begin; slot < run.end; ++slot)
                report_disc(slot, histories, next, end_squared);
        }
    }
    ensure(next == outcome->hit.size(), "a block's own discs lie in its own cells or next to them");
    end_part();
}

/// A window is exact if no disc is ever further from its position at the window's start than a disc
/// that has flown at the speed bound since then. So a disc may exceed the bound for a while without
/// harm if it was slower before. The run is void if the disc might get too far before the window
/// ends, or if it collides again while it is too far away.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::hold_to_schedule(std::uint32_t slot, double time) {
    const DiscState &disc = discs[slot], &at_start = ground.discs[indices[slot]];
    const BlockWindow& window = ground.window;
    const double elapsed = time - window.begin;
    double dx = disc.x - at_start.x_at(window.begin);
    const double dy = disc.y - at_start.y_at(window.begin);
    if constexpr (Dynamics::has_moving_images) // the fastest image next to the disc counts
        dx = std::fabs(dx + (periods().vx_of(disc) - disc.vx) * elapsed) +
             std::fabs(periods().speed) * elapsed;
    const double away = std::sqrt(dx * dx + dy * dy) * (1 + 1e-12) +
                        8 * 0x1p-53 * dynamics.box().longest();
    const double speed = std::sqrt(dynamics.squared_speed(disc));
    if (speed <= window.speed_bound && away <= window.speed_bound * elapsed) return;
    // A disc just above the bound might not be tested at its next collision, so the run is void.
    const bool will_be_seen = speed > window.speed_bound * (1 + 1e-5);
    if (will_be_seen && speed < 2 * window.speed_bound &&
        away + speed * (window.end - time) <= window.speed_bound * window.duration())
        return;
    too_fast = std::max({too_fast, speed, window.speed_bound * (1 + 1e-6)});
}

#define CARROM_DEFINE(Dynamics)                                                                    \
    template void BlockRun<Dynamics>::Scratch::begin(const BlockGround&, BlockOutcome&);           \
    template void BlockRun<Dynamics>::Scratch::list_discs(const CellBlock&, int);                  \
    template void BlockRun<Dynamics>::Scratch::list_all_discs();                                   \
    template void BlockRun<Dynamics>::Scratch::gather();                                           \
    template void BlockRun<Dynamics>::Scratch::mark_own(const CellBlock&);                         \
    template void BlockRun<Dynamics>::Scratch::mark_own_of_all(const CellBlock&);                  \
    template void BlockRun<Dynamics>::Scratch::hold_to_schedule(std::uint32_t, double);            \
    template void BlockRun<Dynamics>::Scratch::report_hits();                                      \
    template void BlockRun<Dynamics>::Scratch::report(std::span<std::uint64_t>);
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
