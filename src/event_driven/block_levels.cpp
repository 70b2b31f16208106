// SPDX-License-Identifier: BSD-3-Clause
// Block runs for discs of several sizes. Each disc is in the level of cells for its size
// (size_levels.hpp).
//
// A disc's partners in its own level and in levels of larger discs are found among the discs and
// the ghosts (box_layout.hpp) of these levels. Its partners in levels of smaller discs are found
// without ghosts: a run of the whole box searches around the disc and around its images near the
// box. So the ghosts of a level need no more depth than the reach of its own discs.
#include <algorithm>
#include <cmath>

#include "event_driven/block_scratch.hpp"

namespace carrom {

/// Lists the discs of a block and its halo level by level, in the order of each level's cells.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::list_levels(const CellBlock& own, int halo) {
    list_discs(own, halo);
    mark_own(own);
    constexpr std::uint8_t own_mark = 1, ring_mark = 2;
    std::vector<std::uint8_t> marks = is_own;
    for (int column = ring.first_column; column < ring.end_column; ++column) {
        const SlotRange run = grid_run(column, ring.first_row, ring.end_row - 1);
        for (std::uint32_t k = run.begin; k < run.end; ++k) marks[k] |= ring_mark;
    }
    std::vector<std::vector<std::uint8_t>> marks_in(ground.levels.size());
    in_levels.resize(ground.levels.size());
    for (std::vector<LocalIndex>& list : in_levels) list.clear();
    for (std::size_t k = 0; k < indices.size(); ++k) {
        const std::size_t level = level_of(first_radius_of(ground.discs[indices[k]]),
                                           ground.levels);
        in_levels[level].push_back(indices[k]);
        marks_in[level].push_back(marks[k]);
    }
    const GridGeometry& geometry = ground.grid->geometry();
    const double low = geometry.low + cells.first_column * cell_width,
                 high = geometry.low + cells.end_column * cell_width,
                 across_low = geometry.across_low + cells.first_row * cell_width,
                 across_high = geometry.across_low + cells.end_row * cell_width;
    const auto [x_low, y_low] = turned(axis, low, across_low);
    const auto [x_high, y_high] = turned(axis, high, across_high);
    axis = Axis::x;
    is_own.clear();
    is_of_ring.clear();
    lay_levels({x_low, x_high, y_low, y_high}, {}, ground.discs.size());
    for (std::size_t level = 0; level < in_levels.size(); ++level) {
        for (const std::uint32_t k : orders[level]) {
            is_own.push_back(marks_in[level][k] & own_mark);
            is_of_ring.push_back((marks_in[level][k] & ring_mark) != 0);
        }
    }
}

/// Lists each disc of the box once, by level.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::list_levels_of_all() {
    is_whole = true;
    axis = Axis::x;
    in_levels.resize(ground.levels.size());
    for (std::vector<LocalIndex>& list : in_levels) list.clear();
    for (const LocalIndex index : layout.list_once(ground.discs, ground.n_own)) {
        const double radius = first_radius_of(ground.discs[index]);
        in_levels[level_of(radius, ground.levels)].push_back(index);
    }
    lay_levels(ground.extent, periods(), ground.n_own);
}

/// Gives slots to the discs in `in_levels`, in cells that fill `extent`. `across` has the box's
/// periods in a run of the whole box, and is empty in other runs. Discs with indices below
/// `n_at_home` keep the images of their states; of other discs, the image inside the box is used.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::lay_levels(const Extent& extent, const Periods& across,
                                             std::size_t n_at_home) {
    const double at_end = dynamics.size_at(ground.window.end);
    levels.resize(ground.levels.size());
    orders.resize(ground.levels.size());
    layout.clear();
    for (std::size_t k = 0; k < levels.size(); ++k) {
        LevelCells& level = levels[k];
        level.smallest_radius = ground.levels[k].smallest_radius * at_end + dynamics.slack();
        level.largest_radius = ground.levels[k].largest_radius * at_end + dynamics.slack();
        const double reach = block_reach(ground.window, 2 * level.largest_radius, dynamics.box());
        const Box size = extent.size();
        level.cells = cells_of_box(
            extent, across, reach,
            least_cell_width(reach, size.shortest(), size.longest(), in_levels[k].size()));
        level.first_start = layout.add_level(ground.discs, in_levels[k], n_at_home, level.cells,
                                             periods(), ground.window.begin,
                                             levels.front().cells.width);
        level.end_slot = static_cast<std::uint32_t>(layout.indices().size());
        if (!is_whole) orders[k] = layout.order();
    }
    indices = layout.indices();
    cell_starts = layout.cell_starts();
}

/// Like set_scales, for levels. The unit of length of the lanes is the width of the smallest cells.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::set_scales_of_levels() {
    const BlockWindow& window = ground.window;
    cell_width = levels.front().cells.width;
    cells_per_length = 1 / cell_width;
    cells_per_speed = window.duration() / cell_width;
    windows_per_time = 1 / window.duration();
    const auto left_of = [](const BoxCells& c) { return c.x_low - c.n_beside * c.width; };
    const auto bottom_of = [](const BoxCells& c) { return c.y_low - c.n_above * c.height; };
    x_corner = left_of(levels.front().cells);
    y_corner = bottom_of(levels.front().cells);
    for (const LevelCells& level : levels) {
        x_corner = std::min(x_corner, left_of(level.cells));
        y_corner = std::min(y_corner, bottom_of(level.cells));
    }
    double extent = 0;
    std::size_t most_columns = 0;
    for (LevelCells& level : levels) {
        const BoxCells& c = level.cells;
        level.left = static_cast<float>((left_of(c) - x_corner) * cells_per_length);
        level.bottom = static_cast<float>((bottom_of(c) - y_corner) * cells_per_length);
        level.columns_per_unit = static_cast<float>(cell_width / c.width);
        level.rows_per_unit = static_cast<float>(cell_width / c.height);
        extent = std::max({extent, (left_of(c) + level.n_columns() * c.width - x_corner),
                           (bottom_of(c) + level.n_rows() * c.height - y_corner)});
        most_columns = std::max(most_columns, static_cast<std::size_t>(level.n_columns()));
    }
    extent = extent * cells_per_length + 8;
    runs.resize(most_columns + 1);
    margins.clear();
    for (const LevelCells& own : levels) {
        for (const LevelCells& other : levels) {
            const auto rounding = [&](double sigma) { // see set_scales
                const double reach = block_reach(window, sigma, dynamics.box()) * cells_per_length,
                             width = std::max(other.cells.width, other.cells.height) *
                                     cells_per_length,
                             farthest_tried = 3 * reach + 3 * width;
                return 0x1p-20 * farthest_tried * farthest_tried / (sigma * cells_per_length);
            };
            margins.push_back(static_cast<float>(
                0x1p-20 * extent + std::max(rounding(own.smallest_radius + other.smallest_radius),
                                            rounding(own.largest_radius + other.largest_radius))));
        }
    }
    const double flown = block_reach(window, 0, dynamics.box()) / 2;
    for (LevelCells& level : levels)
        level.farthest = static_cast<float>((level.largest_radius * (1 + 1e-6) + flown) *
                                                cells_per_length +
                                            0x1p-18 * extent + 1e-6);
    const double inner = 1e-3 * cell_width + 0x1p-18 * extent * cell_width;
    const Extent walls = dynamics.walls_between(window.begin, window.end);
    x_inner_low = static_cast<float>((walls.x_low + inner - x_corner) * cells_per_length);
    y_inner_low = static_cast<float>((walls.y_low + inner - y_corner) * cells_per_length);
    x_inner_high = static_cast<float>((walls.x_high - inner - x_corner) * cells_per_length);
    y_inner_high = static_cast<float>((walls.y_high - inner - y_corner) * cells_per_length);
}

/// Fills the lane of radii. Each radius is slightly enlarged, so that rounding loses no contact.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::measure_radii() {
    const double size = dynamics.size_at(ground.window.end),
                 scale = cells_per_length * (1 + 0x1p-18);
    if (radii.size() < indices.size() + filter_padding)
        radii.resize(2 * indices.size() + filter_padding);
    for (std::size_t slot = 0; slot < indices.size(); ++slot) {
        const double radius = first_radius_of(ground.discs[indices[slot]]);
        radii[slot] = static_cast<float>((radius * size + dynamics.slack()) * scale);
    }
}

/// Pairs within a level are found like pairs of equal discs. Pairs of discs from two levels are
/// found by searches around the larger disc, because there are fewer large discs.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::predict_levels() {
    for (std::size_t own = 0; own < levels.size(); ++own) {
        const LevelCells& level = levels[own];
        const BoxCells& c = level.cells;
        const auto column_length = static_cast<std::size_t>(level.n_rows()) + 1;
        const CellTable table{cell_starts.data() + level.first_start,
                              column_length,
                              level.n_columns(),
                              level.n_rows(),
                              c.n_reach_columns,
                              c.n_reach_rows};
        for (int column = c.n_beside; column < c.n_beside + c.n_columns; ++column) {
            const std::uint32_t* const starts = table.starts +
                                                static_cast<std::size_t>(column) * column_length;
            const std::uint32_t first = starts[c.n_above], end = starts[c.n_above + c.n_rows];
            later_ends.clear();
            flight_filters<SizedLanes>().column(sized_lanes(), table, column,
                                                {c.n_above, c.n_above + c.n_rows},
                                                margin_of(own, own), later, later_ends);
            std::uint32_t slot = first, k = 0;
            for (const std::uint32_t later_end : later_ends) {
                for (; k < later_end; ++k) predict_pair(slot, later[k]);
                ++slot;
            }
            for (slot = first; slot < end && own > 0; ++slot) {
                const Flight flight{x[slot], y[slot], vx[slot], vy[slot], 0, slot};
                for (std::size_t other = 0; other < own; ++other)
                    predict_in_level(flight, own, other);
            }
        }
    }
}

/// Fills `runs` with the ranges of slots in the level's cells that the flight box covers, and
/// reserves memory for all these slots in the lists of partners.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::find_runs_of(const LevelCells& level, const FlightBox& box,
                                               bool with_ghosts) {
    const auto cell = [](float place, int first, int end) {
        const float above = place > static_cast<float>(first) ? place : static_cast<float>(first);
        const auto last = static_cast<float>(end - 1);
        return static_cast<int>(above < last ? above : last);
    };
    const BoxCells& c = level.cells;
    const int column = with_ghosts ? 0 : c.n_beside, row = with_ghosts ? 0 : c.n_above,
              end_column = level.n_columns() - column, end_row = level.n_rows() - row;
    const int left = cell((box.left - level.left) * level.columns_per_unit, column, end_column),
              right = cell((box.right - level.left) * level.columns_per_unit, column, end_column),
              bottom = cell((box.bottom - level.bottom) * level.rows_per_unit, row, end_row),
              top = cell((box.top - level.bottom) * level.rows_per_unit, row, end_row);
    list_runs(cell_starts.data() + level.first_start, static_cast<std::size_t>(level.n_rows()) + 1,
              {left, right, bottom, top});
}

/// Predicts contacts of the flight's disc with the discs in `runs`, to whose positions `image`
/// (whole boxes) is added unless it is null.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::predict_seen(const Flight& flight, float radius,
                                               const Image* image) {
    const std::size_t n_partners = flight_filters<SizedLanes>().one(
        sized_lanes(), std::span(runs).first(n_runs), flight, radius, partners.data());
    for (std::size_t k = 0; k < n_partners; ++k) {
        if (image)
            predict_image(flight.slot, partners[k], *image);
        else
            predict_pair(flight.slot, partners[k]);
    }
}

template <class Dynamics>
void BlockRun<Dynamics>::Scratch::predict_in_level(const Flight& flight, std::size_t own,
                                                   std::size_t other) {
    const LevelCells& level = levels[other];
    const float radius = radii[flight.slot] + margin_of(own, other);
    const FlightBox box = box_of(flight, radii[flight.slot] + level.farthest);
    const bool is_round = is_whole && Dynamics::is_periodic && other < own;
    if (!is_round) {
        find_runs_of(level, box, true);
        return predict_seen(flight, radius, nullptr);
    }
    const BoxCells& c = level.cells;
    const Periods length = periods();
    const float x_period = static_cast<float>(length.x * cells_per_length),
                y_period = static_cast<float>(length.y * cells_per_length),
                x_low = static_cast<float>((c.x_low - x_corner) * cells_per_length),
                y_low = static_cast<float>((c.y_low - y_corner) * cells_per_length);
    const auto lengths = [](float place, float period) {
        return period > 0 ? static_cast<int>(std::floor(place / period)) : 0;
    };
    const int right = lengths(box.right - x_low, x_period),
              top = lengths(box.top - y_low, y_period);
    for (int i = lengths(box.left - x_low, x_period); i <= right; ++i) {
        for (int j = lengths(box.bottom - y_low, y_period); j <= top; ++j) {
            const float x_shift = static_cast<float>(i) * x_period,
                        y_shift = static_cast<float>(j) * y_period;
            Flight seen = flight;
            seen.x -= x_shift;
            seen.y -= y_shift;
            find_runs_of(
                level,
                {box.left - x_shift, box.right - x_shift, box.bottom - y_shift, box.top - y_shift},
                false);
            const Image image{i, j};
            predict_seen(seen, radius, image == Image{} ? nullptr : &image);
        }
    }
}

template <class Dynamics> void BlockRun<Dynamics>::Scratch::predict_sized(std::uint32_t slot) {
    const Flight flight = flight_of(slot);
    const std::size_t own = level_of_slot(slot);
    for (std::size_t other = 0; other < levels.size(); ++other)
        predict_in_level(flight, own, other);
}

/// Predicts contacts of two discs that have just collided. Discs of the same level search nearly
/// the same cells, so one search finds the partners of both.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::predict_two_sized(std::uint32_t p, std::uint32_t q) {
    const std::size_t own = level_of_slot(p);
    if (level_of_slot(q) != own) {
        predict_sized(p);
        return predict_sized(q);
    }
    const Flight p_flight = flight_of(p), q_flight = flight_of(q);
    for (std::size_t other = 0; other < own; ++other) {
        predict_in_level(p_flight, own, other);
        predict_in_level(q_flight, own, other);
    }
    predict_pair(p, q);
    for (std::size_t other = own; other < levels.size(); ++other) {
        const LevelCells& level = levels[other];
        const FlightBox a = box_of(p_flight, radii[p] + level.farthest),
                        b = box_of(q_flight, radii[q] + level.farthest);
        find_runs_of(level,
                     {std::min(a.left, b.left), std::max(a.right, b.right),
                      std::min(a.bottom, b.bottom), std::max(a.top, b.top)},
                     true);
        const float margin = margin_of(own, other);
        const PartnerCounts n = flight_filters<SizedLanes>().two(
            sized_lanes(), std::span(runs).first(n_runs), p_flight, q_flight, radii[p] + margin,
            radii[q] + margin, partners.data(), others_partners.data());
        for (std::size_t k = 0; k < n.p; ++k) predict_pair(p, partners[k]);
        for (std::size_t k = 0; k < n.q; ++k) predict_pair(q, others_partners[k]);
    }
}

#define CARROM_DEFINE(Dynamics)                                                                    \
    template void BlockRun<Dynamics>::Scratch::list_levels(const CellBlock&, int);                 \
    template void BlockRun<Dynamics>::Scratch::list_levels_of_all();                               \
    template void BlockRun<Dynamics>::Scratch::set_scales_of_levels();                             \
    template void BlockRun<Dynamics>::Scratch::measure_radii();                                    \
    template void BlockRun<Dynamics>::Scratch::predict_levels();                                   \
    template void BlockRun<Dynamics>::Scratch::predict_sized(std::uint32_t);                       \
    template void BlockRun<Dynamics>::Scratch::predict_two_sized(std::uint32_t, std::uint32_t);
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
