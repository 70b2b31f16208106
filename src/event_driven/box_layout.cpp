// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/box_layout.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace carrom {

double least_cell_width(double reach, double height, double length, std::uint64_t n_discs) {
    const auto n_cells = static_cast<double>(n_discs + 16);
    // In a thin tube discs lie in one row, with a spacing of length / n_cells.
    const double spacing = std::max(std::sqrt(height * length / n_cells), length / n_cells);
    const double per_reach = std::round(reach / std::max(2 * spacing, reach / 4));
    return std::max(reach / std::clamp(per_reach, 1.0, 4.0), 0.7 * spacing);
}

BoxCells cells_of_box(const Extent& extent, const Periods& periods, double reach,
                      double least_width) {
    BoxCells cells;
    const auto cut = [&](double length, double period, int& n, double& width, int& n_reach) {
        const double n_fit = length / least_width * (1 - 1e-9);
        n = static_cast<int>(
            std::clamp(period > 0 ? std::floor(n_fit) : std::ceil(n_fit), 1.0, 1e6));
        width = period > 0 ? length / n : std::max(least_width, length / n);
        n_reach = static_cast<int>(std::ceil(reach / width * (1 - 1e-9)));
        return period > 0 ? n_reach : 0;
    };
    cells.x_low = extent.x_low;
    cells.y_low = extent.y_low;
    cells.n_beside = cut(extent.size().x, periods.x, cells.n_columns, cells.width,
                         cells.n_reach_columns);
    cells.n_above = cut(extent.size().y, periods.y, cells.n_rows, cells.height, cells.n_reach_rows);
    return cells;
}

void BoxLayout::lay(std::span<const DiscState> discs, std::size_t n_own, const BoxCells& cells,
                    const Periods& periods, double time) {
    clear();
    list_once(discs, n_own);
    if (periods.are_moving()) return lay_sliding(discs, n_own, cells, periods, time);
    add_level(discs, listed_, n_own, cells, periods, time, cells.width);
}

void BoxLayout::clear() {
    starts_.clear();
    indices_.clear();
    ghosts_.clear();
    ghost_at_.clear();
    first_ghost_.clear();
}

std::size_t BoxLayout::add_level(std::span<const DiscState> discs,
                                 std::span<const LocalIndex> listed, std::size_t n_own,
                                 const BoxCells& cells, const Periods& periods, double time,
                                 double lane_unit) {
    sort(discs, listed, n_own, cells, periods, time);
    const std::size_t first_start = starts_.size();
    const std::vector<Line> columns = lines(cells.n_columns, cells.n_beside),
                            rows = lines(cells.n_rows, cells.n_above);
    for (const Line column : columns) {
        const std::uint32_t* const box_column = box_starts_.data() + column.home * cells.n_rows;
        for (const Line row : rows) {
            starts_.push_back(static_cast<std::uint32_t>(indices_.size()));
            for (std::uint32_t k = box_column[row.home]; k < box_column[row.home + 1]; ++k)
                indices_.push_back(listed[sorted_[k]]);
        }
        starts_.push_back(static_cast<std::uint32_t>(indices_.size()));
    }
    add_ghosts(cells, first_start, columns, rows, lane_unit);
    return first_start;
}

/// Lists each disc of the box once: the rank's own discs, and the first copy of each other disc. A
/// hash table of ids finds further copies.
const std::vector<LocalIndex>& BoxLayout::list_once(std::span<const DiscState> discs,
                                                    std::size_t n_own) {
    listed_.resize(n_own);
    std::iota(listed_.begin(), listed_.end(), LocalIndex{0});
    if (discs.size() == n_own) return listed_;
    const std::size_t size = std::bit_ceil(2 * discs.size() + 1);
    id_table_.assign(size, none);
    for (LocalIndex index = 0; index < discs.size(); ++index) {
        const DiscId id = discs[index].id;
        std::size_t place = ((id * 0x9e3779b97f4a7c15u) >> 20) & (size - 1);
        while (id_table_[place] != none && discs[id_table_[place]].id != id)
            place = (place + 1) & (size - 1);
        if (id_table_[place] != none) continue;
        id_table_[place] = index;
        if (index >= n_own) listed_.push_back(index);
    }
    return listed_;
}

/// Sorts the listed discs by the cells of the box that contain them, column after column.
void BoxLayout::sort(std::span<const DiscState> discs, std::span<const LocalIndex> listed,
                     std::size_t n_own, const BoxCells& cells, const Periods& periods,
                     double time) {
    const auto n_rows = static_cast<std::uint32_t>(cells.n_rows);
    const double columns_per_length = 1 / cells.width, rows_per_length = 1 / cells.height;
    const auto cell_along = [](double place, int n) { // by rounding, a disc may be just outside
        const int cell = !(place > 0) ? 0 : place < n ? static_cast<int>(place) : n - 1;
        return static_cast<std::uint32_t>(cell);
    };
    box_starts_.assign(static_cast<std::size_t>(cells.n_columns) * n_rows + 1, 0);
    cell_of_.resize(listed.size());
    for (std::size_t k = 0; k < listed.size(); ++k) {
        const DiscState& disc = discs[listed[k]];
        const bool is_at_home = listed[k] < n_own || !periods.are_any();
        const Image home = is_at_home ? image_of(disc) : periods.home(disc, time);
        double x = disc.x_at(time) - cells.x_low, y = disc.y_at(time) - cells.y_low;
        if (home != Image{}) [[unlikely]] {
            const Shift shift = periods.shift_of(home, time);
            x += shift.x;
            y += shift.y;
        }
        cell_of_[k] = cell_along(x * columns_per_length, cells.n_columns) * n_rows +
                      cell_along(y * rows_per_length, cells.n_rows);
        ++box_starts_[cell_of_[k]];
    }
    std::partial_sum(box_starts_.begin(), box_starts_.end(), box_starts_.begin());
    sorted_.resize(listed.size());
    for (std::size_t k = listed.size(); k-- > 0;)
        sorted_[--box_starts_[cell_of_[k]]] = static_cast<std::uint32_t>(k);
}

/// The columns or rows of cells along an axis, including those beyond the sides.
std::vector<BoxLayout::Line> BoxLayout::lines(int n_cells, int n_beyond) {
    std::vector<Line> lines;
    for (int cell = -n_beyond; cell < n_cells + n_beyond; ++cell) {
        const int home = ((cell % n_cells) + n_cells) % n_cells;
        lines.push_back({(cell - home) / n_cells, home});
    }
    return lines;
}

void BoxLayout::add_ghosts(const BoxCells& cells, std::size_t first_start,
                           std::span<const Line> columns, std::span<const Line> rows,
                           double lane_unit) {
    const double x_period = cells.n_columns * (cells.width / lane_unit),
                 y_period = cells.n_rows * (cells.height / lane_unit);
    ghost_at_.resize(indices_.size(), none);
    first_ghost_.resize(indices_.size(), none);
    const auto slots_of = [&](std::size_t column, std::size_t row) {
        const std::size_t cell = first_start + column * (rows.size() + 1) + row;
        return SlotRange{starts_[cell], starts_[cell + 1]};
    };
    const auto beside = static_cast<std::size_t>(cells.n_beside),
               above = static_cast<std::size_t>(cells.n_above);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        for (std::size_t j = 0; j < rows.size(); ++j) {
            const Image image{columns[i].away, rows[j].away};
            if (image == Image{}) continue;
            const SlotRange seen = slots_of(i, j);
            std::uint32_t disc = slots_of(static_cast<std::size_t>(columns[i].home) + beside,
                                          static_cast<std::size_t>(rows[j].home) + above)
                                     .begin;
            Ghost ghost;
            ghost.image = image;
            ghost.x_shift = static_cast<float>(image.x * x_period);
            ghost.y_shift = static_cast<float>(image.y * y_period);
            for (ghost.slot = seen.begin; ghost.slot < seen.end; ++ghost.slot, ++disc) {
                ghost.disc = disc;
                ghost.next = first_ghost_[disc];
                first_ghost_[disc] = ghost_at_[ghost.slot] = static_cast<std::uint32_t>(
                    ghosts_.size());
                ghosts_.push_back(ghost);
            }
        }
    }
}

} // namespace carrom
