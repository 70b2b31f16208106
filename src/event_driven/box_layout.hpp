// SPDX-License-Identifier: BSD-3-Clause
// The whole box cut into cells, for a run that has all of its discs. Each is there once. Beyond
// periodic sides are cells with ghosts: slots where discs are seen, with flights but no states.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "core/disc.hpp"
#include "core/extent.hpp"
#include "core/image.hpp"

namespace carrom {

/// How wide cells should be at least in a box of this height and length. Cells of about two
/// spacings hold a vector's worth of discs in three rows.
double least_cell_width(double reach, double height, double length, std::uint64_t n_discs);

/// Cells of the box. Between periodic sides they fill it exactly.
struct BoxCells {
    double x_low = 0, y_low = 0, width = 1, height = 1;
    int n_columns = 1, n_rows = 1;
    int n_reach_columns = 1, n_reach_rows = 1; ///< in which partners of a cell's discs can be
    int n_beside = 0, n_above = 0;             ///< columns and rows beyond each side
};

/// Their width and height are at least `least_width`, if the box is so large.
BoxCells cells_of_box(const Extent& extent, const Periods& periods, double reach,
                      double least_width);

/// Where a disc is seen beyond a periodic side.
struct Ghost {
    std::uint32_t slot = 0, disc = 0; ///< its own slot and the disc's
    std::uint32_t next = 0;           ///< of the same disc, or none
    Image image;
    float x_shift = 0, y_shift = 0; ///< from the disc, in widths of a cell
};

class BoxLayout {
public:
    static constexpr std::uint32_t none = 0xffffffff;

    /// Gives slots to all discs of the box as they are at `time`, by column and row, and to their
    /// ghosts. `discs` are the rank's own ones, which lie in the box, and then copies of others,
    /// perhaps several of each.
    void lay(std::span<const Disc> discs, std::size_t n_own, const BoxCells& cells,
             const Periods& periods, double time);

    /// The same in levels, one behind the other, each with its own cells. First forgets what was
    /// laid.
    void clear();
    /// Places of the own discs, and of one copy of each other one.
    const std::vector<LocalIndex>& list_once(std::span<const Disc> discs, std::size_t n_own);
    /// Gives slots to `listed`, which are places among `discs`. Of those before `n_own` the image
    /// is the one in the box. Returns where the starts of these cells begin.
    std::size_t add_level(std::span<const Disc> discs, std::span<const LocalIndex> listed,
                          std::size_t n_own, const BoxCells& cells, const Periods& periods,
                          double time);
    /// By slot of the last level: the place in its list.
    const std::vector<std::uint32_t>& order() const { return sorted_; }

    /// By slot: the place among the discs that were given. Of a ghost the one of its disc.
    const std::vector<LocalIndex>& indices() const { return indices_; }
    /// Where the slots of each cell begin, cells beyond the sides included; one more to a column.
    const std::vector<std::uint32_t>& cell_starts() const { return starts_; }
    const std::vector<Ghost>& ghosts() const { return ghosts_; }
    /// The ghost in the slot, or null.
    const Ghost* ghost_at(std::uint32_t slot) const {
        return ghost_at_[slot] == none ? nullptr : &ghosts_[ghost_at_[slot]];
    }
    /// Calls visit(ghost) for each of a disc's.
    template <class Visit> void for_ghosts_of(std::uint32_t slot, const Visit& visit) const {
        for (std::uint32_t k = first_ghost_[slot]; k != none; k = ghosts_[k].next)
            visit(ghosts_[k]);
    }

private:
    struct Line {
        int away = 0; ///< in box lengths
        int home = 0; ///< the line of cells in the box that is seen there
    };

    void sort(std::span<const Disc> discs, std::span<const LocalIndex> listed, std::size_t n_own,
              const BoxCells& cells, const Periods& periods, double time);
    void add_ghosts(const BoxCells& cells, std::size_t first_start, std::span<const Line> columns,
                    std::span<const Line> rows);
    void lay_sliding(std::span<const Disc> discs, std::size_t n_own, const BoxCells& cells,
                     const Periods& periods, double time);
    static std::vector<Line> lines(int n_cells, int n_beyond);

    std::vector<LocalIndex> indices_;
    std::vector<std::uint32_t> starts_;
    std::vector<Ghost> ghosts_;
    std::vector<std::uint32_t> ghost_at_, first_ghost_; ///< by slot
    std::vector<LocalIndex> listed_;                    ///< each disc once
    std::vector<std::uint32_t> sorted_;                 ///< places in the list, by cells of the box
    std::vector<std::uint32_t> cell_of_, box_starts_;   ///< of `listed_`; of `sorted_`
    std::vector<LocalIndex> id_table_;
};

} // namespace carrom
