// SPDX-License-Identifier: BSD-3-Clause
// The cells of a run of the whole box, or of the levels for discs of several sizes. Each disc has
// one slot. Cells beyond periodic sides contain ghosts: slots for images of discs. The filter
// (flight_filter.hpp) tests the ghost's own flight; the predicate uses the state of its disc.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "core/disc_state.hpp"
#include "core/extent.hpp"
#include "core/image.hpp"

namespace carrom {

/// The smallest width of cells in a box of this height and length. Cells are about as wide as two
/// mean distances between discs, so that three cells of a column contain about as many discs as a
/// vector has lanes.
double least_cell_width(double reach, double height, double length, std::uint64_t n_discs);

/// Cells of the box. Between periodic sides they fill it exactly.
struct BoxCells {
    double x_low = 0, y_low = 0, width = 1, height = 1;
    int n_columns = 1, n_rows = 1;
    int n_reach_columns = 1, n_reach_rows = 1; ///< partners are at most this many cells away
    int n_beside = 0, n_above = 0;             ///< number of columns and rows beyond each side
};

/// Cuts the box into cells that are at least `least_width` wide and high. If the box is shorter
/// than that along an axis, there is one cell along this axis.
BoxCells cells_of_box(const Extent& extent, const Periods& periods, double reach,
                      double least_width);

/// An image of a disc beyond a periodic side.
struct Ghost {
    std::uint32_t slot = 0, disc = 0; ///< slot of the ghost, and slot of its disc
    std::uint32_t next = 0;           ///< index of the disc's next ghost, or `none`
    Image image;
    /// Displacement from the disc to the ghost, in units of the lanes
    float x_shift = 0, y_shift = 0;
};

class BoxLayout {
public:
    static constexpr std::uint32_t none = 0xffffffff;

    /// Gives slots to all discs of the box and to their ghosts, in order of the column and row that
    /// contain them at `time`. `discs` has first the rank's own discs, which lie in the box, and
    /// then copies of other ranks' discs. A disc may have several copies, one for each image.
    void lay(std::span<const DiscState> discs, std::size_t n_own, const BoxCells& cells,
             const Periods& periods, double time);

    /// The next three functions give slots to discs level by level; each level has its own cells.
    /// `clear` removes the previous layout.
    void clear();
    /// Returns the indices of the own discs, and of one copy of each other disc.
    const std::vector<LocalIndex>& list_once(std::span<const DiscState> discs, std::size_t n_own);
    /// Gives slots to the discs whose indices are `listed`; own discs (indices below `n_own`) lie
    /// in the box. Shifts of ghosts are in units of `lane_unit`, which all levels share. Returns
    /// the index in `cell_starts` at which the level begins.
    std::size_t add_level(std::span<const DiscState> discs, std::span<const LocalIndex> listed,
                          std::size_t n_own, const BoxCells& cells, const Periods& periods,
                          double time, double lane_unit);
    /// For each slot of the last level, the index of its disc in `listed`.
    const std::vector<std::uint32_t>& order() const { return sorted_; }

    /// For each slot, the index of its disc in `discs`. A ghost has the index of its disc.
    const std::vector<LocalIndex>& indices() const { return indices_; }
    /// The first slot of each cell, including cells beyond the sides. Each column has one more
    /// entry, the end of its last cell.
    const std::vector<std::uint32_t>& cell_starts() const { return starts_; }
    const std::vector<Ghost>& ghosts() const { return ghosts_; }
    /// The ghost in the slot, or null.
    const Ghost* ghost_at(std::uint32_t slot) const {
        return ghost_at_[slot] == none ? nullptr : &ghosts_[ghost_at_[slot]];
    }
    /// Calls visit(ghost) for each ghost of a disc.
    template <class Visit> void for_ghosts_of(std::uint32_t slot, const Visit& visit) const {
        for (std::uint32_t k = first_ghost_[slot]; k != none; k = ghosts_[k].next)
            visit(ghosts_[k]);
    }

private:
    struct Line {
        int away = 0; ///< signed distance from `home` to this line of cells, in box lengths
        int home = 0; ///< the line of cells in the box of which this line is an image
    };

    void sort(std::span<const DiscState> discs, std::span<const LocalIndex> listed,
              std::size_t n_own, const BoxCells& cells, const Periods& periods, double time);
    void add_ghosts(const BoxCells& cells, std::size_t first_start, std::span<const Line> columns,
                    std::span<const Line> rows, double lane_unit);
    void lay_sliding(std::span<const DiscState> discs, std::size_t n_own, const BoxCells& cells,
                     const Periods& periods, double time);
    static std::vector<Line> lines(int n_cells, int n_beyond);

    std::vector<LocalIndex> indices_;
    std::vector<std::uint32_t> starts_;
    std::vector<Ghost> ghosts_;
    /// For each slot, the indices of the ghost in it and of the first ghost of its disc, or `none`
    std::vector<std::uint32_t> ghost_at_, first_ghost_;
    std::vector<LocalIndex> listed_;        ///< each disc of the box once
    std::vector<std::uint32_t> sorted_;     ///< indices in the list of discs, in order of cell
    std::vector<std::uint32_t> cell_of_;    ///< for each disc of the list, its cell
    std::vector<std::uint32_t> box_starts_; ///< first index in `sorted_` for each cell of the box
    std::vector<LocalIndex> id_table_;
};

} // namespace carrom
