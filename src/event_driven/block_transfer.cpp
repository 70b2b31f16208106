// SPDX-License-Identifier: BSD-3-Clause
// What a block takes over from its rank before a run, and what it gives back afterwards. A run that
// sees all of a periodic box links images, so that what happens to one happens to all.
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/errors.hpp"
#include "event_driven/block_scratch.hpp"

namespace carrom {

/// Copies the block's and its halo's discs, column by column, into slots of our own.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::gather(const BlockGround& of_rank, const CellBlock& own,
                                         int halo) {
    ground = of_rank;
    list_discs(own, halo);
    const std::size_t n = indices.size();
    runs.resize(static_cast<std::size_t>(cells.end_column - cells.first_column) + 1);
    discs.resize(n);
    past_events_of.assign(n, EventHistory{});
    if (ground.columns) columns.gather(*ground.columns, indices);
    for (std::vector<float>* lane : {&x, &y, &vx, &vy}) {
        if (lane->size() < n + filter_padding) lane->resize(2 * n + filter_padding);
    }
    lanes = {x.data(), y.data(), vx.data(), vy.data()};
    set_scales();
    for (std::size_t slot = 0; slot < n; ++slot) {
        if (slot + 16 < n) __builtin_prefetch(&ground.discs[indices[slot + 16]]);
        discs[slot] = ground.discs[indices[slot]];
        place(static_cast<std::uint32_t>(slot), ground.window.begin);
    }
}

/// The cells that the run sees, and the rank's discs in them.
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
    firsts = {0, cells.end_column - cells.first_column, 0, cells.end_row - cells.first_row};
    firsts_in_all_rows = 0;
    cell_rows = static_cast<std::size_t>(cells.end_row - cells.first_row) + 1;
    cell_starts.clear();
    indices.clear();
    for (int column = cells.first_column; column < cells.end_column; ++column) {
        cell_starts.push_back(static_cast<std::uint32_t>(indices.size()));
        const bool has_halo = grid.has_halo_in(column);
        for (int row = cells.first_row; row < cells.end_row; ++row) {
            const SlotRange run = grid.run(column, row, row),
                            of_halo = has_halo ? grid.halo_run(column, row, row) : SlotRange{};
            for (LocalIndex index = run.begin; index < run.end; ++index) indices.push_back(index);
            for (std::uint32_t slot = of_halo.begin; slot < of_halo.end; ++slot)
                indices.push_back(grid.halo_index(slot));
            cell_starts.push_back(static_cast<std::uint32_t>(indices.size()));
        }
    }
}

/// What the filter's single-precision lanes measure in: cells from a corner, windows, and their
/// margins.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::set_scales() {
    const GridGeometry& geometry = ground.grid->geometry();
    column_limit = static_cast<float>(cells.end_column - cells.first_column - 1);
    row_limit = static_cast<float>(cells.end_row - cells.first_row - 1);
    const BlockWindow& window = ground.window;
    axis = geometry.axis;
    x_corner = geometry.low + cells.first_column * geometry.cell_width;
    y_corner = geometry.across_low + cells.first_row * geometry.cell_width;
    cells_per_length = 1 / geometry.cell_width;
    cells_per_speed = window.duration() / geometry.cell_width;
    windows_per_time = 1 / window.duration();
    const double growth = dynamics.growth_at(window.end),
                 diameter = dynamics.search_diameter() * growth;
    const double sigma = diameter * cells_per_length;
    const double extent = std::max(cells.end_column - cells.first_column,
                                   cells.end_row - cells.first_row) +
                          8.0;
    const double reach = block_reach(window, diameter, dynamics.box()) * cells_per_length;
    // Positions carry an error of 2^-23 of the block's size. The rounding of the filter's other
    // terms acts like a longer diameter by 2^-20 d^2 / diameter, with the largest distance d that
    // is looked at.
    const double looked_at = 3 * reach + 3;
    const double touching = sigma * (1 + 0x1p-18) + 0x1p-20 * extent +
                            0x1p-20 * looked_at * looked_at / sigma;
    touching_squared = static_cast<float>(touching * touching);
    farthest = static_cast<float>((reach + sigma) / 2 + 0x1p-18 * extent + 1e-6);
    const double inner = dynamics.radius() * growth + dynamics.slack() +
                         1e-3 * geometry.cell_width + 0x1p-18 * extent * geometry.cell_width;
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
    bound_squared = ground.window.speed_bound * ground.window.speed_bound;
    const double bound_lane = ground.window.speed_bound * cells_per_speed * (1 - 1e-6);
    bound_lane_squared = static_cast<float>(bound_lane * bound_lane);
    too_fast = 0;
    cascade_begin = -1;
    cascade = 0;
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

/// Writes down what has become of the block's own discs, and what has been seen of those of its
/// ring.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::report(std::span<std::uint64_t> histories) {
    outcome->too_fast = too_fast;
    double end_squared = 0;
    // Memory for what a block has, not for twice as much: all blocks keep theirs until the window
    // is validated.
    std::size_t n_hit = 0;
    for (std::size_t slot = 0; slot < past_events_of.size(); ++slot)
        n_hit += is_own[slot] != 0 && past_events_of[slot].history != 0;
    outcome->hit.resize(n_hit);
    outcome->states.resize(n_hit);
    outcome->columns = side_columns_of<Dynamics>();
    outcome->columns.resize(n_hit);
    std::size_t next = 0;
    for (int column = ring.first_column; column < ring.end_column; ++column) {
        const SlotRange run = grid_run(column, ring.first_row, ring.end_row - 1);
        for (std::uint32_t slot = run.begin; slot < run.end; ++slot) {
            const EventHistory& past_events = past_events_of[slot];
            if (is_own[slot] == 0) {
                if (!are_images_linked())
                    outcome->ring.push_back({indices[slot], past_events.history});
                continue;
            }
            histories[indices[slot]] = past_events.history;
            end_squared = std::max(end_squared, speed_squared(discs[slot]));
            if (past_events.history == 0) continue;
            outcome->hit[next] = indices[slot];
            outcome->states[next] = NewState(discs[slot]);
            outcome->columns.copy(next, columns, slot);
            ++next;
        }
    }
    ensure(next == n_hit, "a block's own discs lie in its own cells or next to them");
    outcome->largest_speed_at_end = std::sqrt(end_squared) * (1 + 0x1p-50);
}

/// Makes rings of the images of each disc.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::link_images(const CellBlock& own) {
    constexpr std::uint32_t none = 0xffffffff;
    const std::size_t n = discs.size(), size = std::bit_ceil(2 * n + 1);
    next_image.resize(n);
    image_table.assign(size, none);
    std::size_t n_discs = 0;
    for (std::uint32_t slot = 0; slot < n; ++slot) {
        std::size_t place = ((discs[slot].id * 0x9e3779b97f4a7c15u) >> 20) & (size - 1);
        while (image_table[place] != none && discs[image_table[place]].id != discs[slot].id)
            place = (place + 1) & (size - 1);
        next_image[slot] = slot;
        if (image_table[place] == none) {
            image_table[place] = slot;
            ++n_discs;
        } else {
            std::swap(next_image[slot], next_image[image_table[place]]);
        }
    }
    take_pairs_once(own, n_discs);
}

/// Where all discs are own ones, each with an image of the other is found twice. Take those whose
/// first disc is in an own cell. If images differ along x, the one of the two contacts with an
/// image on the right has the own disc first, or the image in the last own column. Else both discs
/// have the same columns in both: the own disc in the left one is first in one of them, and in one
/// column the image is above in one of them. That needs own cells with own discs and no images;
/// rounding and cells that do not end with the box may put them elsewhere.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::take_pairs_once(const CellBlock& own, std::size_t n_discs) {
    std::size_t n_there = 0, n_own = 0;
    for (int column = own.first_column; column < own.end_column; ++column) {
        const SlotRange run = grid_run(column, own.first_row, own.end_row - 1);
        n_there += run.end - run.begin;
        for (std::uint32_t slot = run.begin; slot < run.end; ++slot) n_own += is_own[slot];
    }
    if (n_there != n_discs || n_own != n_discs) return;
    firsts = {own.first_column - cells.first_column, own.end_column - cells.first_column,
              own.first_row - cells.first_row, own.end_row - cells.first_row};
    firsts_in_all_rows = firsts.end_column - 1;
}

/// What has happened to a disc has happened to all of its images.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::mirror(std::uint32_t slot, double time) {
    for (std::uint32_t other = next_image[slot]; other != slot; other = next_image[other]) {
        const Image image = image_of(discs[other]);
        discs[other] = discs[slot];
        set_image(discs[other], image);
        past_events_of[other] = past_events_of[slot];
        columns.copy(other, columns, slot);
        const double speed_squared = discs[other].vx * discs[other].vx +
                                     discs[other].vy * discs[other].vy;
        const float before = vx[other] * vx[other] + vy[other] * vy[other];
        if (is_own[other] != 0 && (speed_squared > bound_squared || before > bound_lane_squared))
            hold_to_schedule(other, time);
        place(other, ground.window.begin);
    }
}

/// What comes next for an event's discs and all of their images.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::predict_linked(const Event& event) {
    mirror(event.p, event.time);
    const std::uint32_t p = own_image(event.p);
    if (dynamics.has_walls()) predict_walls(p);
    if (is_wall(event.q)) return predict_images(p);
    mirror(event.q, event.time);
    const std::uint32_t q = own_image(event.q);
    if (dynamics.has_walls()) predict_walls(q);
    if (is_own[p] != 0 && is_own[q] != 0 && p == event.p && q == event.q)
        return predict_pairs_of(p, q);
    predict_images(p);
    predict_images(q);
}

/// An own disc sees all that it may meet: its images meet nothing else. Of one that is not own,
/// each image looks around. A contact that is found several times makes the others stale when it is
/// carried out.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::predict_images(std::uint32_t slot) {
    predict_pairs(slot);
    if (is_own[slot] != 0) return;
    for (std::uint32_t other = next_image[slot]; other != slot; other = next_image[other])
        predict_pairs(other);
}

#define CARROM_DEFINE(Dynamics)                                                                    \
    template void BlockRun<Dynamics>::Scratch::gather(const BlockGround&, const CellBlock&, int);  \
    template void BlockRun<Dynamics>::Scratch::mark_own(const CellBlock&);                         \
    template void BlockRun<Dynamics>::Scratch::report(std::span<std::uint64_t>);
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

#define CARROM_DEFINE_IMAGES(Dynamics)                                                             \
    template void BlockRun<Dynamics>::Scratch::link_images(const CellBlock&);                      \
    template void BlockRun<Dynamics>::Scratch::predict_linked(const Event&);
CARROM_FOR_EACH_PERIODIC_DYNAMICS(CARROM_DEFINE_IMAGES)
#undef CARROM_DEFINE_IMAGES

} // namespace carrom
