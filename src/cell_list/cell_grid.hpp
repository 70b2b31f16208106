// SPDX-License-Identifier: BSD-3-Clause
// The cell list: discs sorted into square cells by their positions at one time of a window, the
// anchor. Cells are numbered column by column. So the cells of one column within reach of a disc
// are one contiguous range of slots, which vector instructions read up to 16 at a time.
//
// Own discs are sorted in memory: the slot of an own disc is its index, so neighbours in space are
// neighbours in memory. Discs of the halo stay in the order of arrival. They have their own slots,
// in those columns that contain halo discs. For each slot the grid stores the disc's free flight in
// single precision, in units of cells and windows, so that nothing can overflow. Flights are only
// used to reject pairs; a test in double precision decides on the remaining pairs. Cost: 16 bytes
// per disc and 4 bytes per cell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/disc_sorter.hpp"
#include "cell_list/halo_cells.hpp"
#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "core/extent.hpp"
#include "core/image.hpp"
#include "core/raw_vector.hpp"
#include "core/side_columns.hpp"

namespace carrom {

/// The positions of cells. Columns follow each other along `axis`, rows across it. Discs outside of
/// the grid belong to its border cells; this never increases the number of cells between discs.
struct GridGeometry {
    Axis axis = Axis::x;
    double low = 0, across_low = 0; ///< lower ends of the first column and row
    double cell_width = 1;          ///< width of cells; change it with set_cell_width
    int n_columns = 1, n_rows = 1;
    int n_reach = 1; ///< discs that can collide are at most this many cells apart

    int column_of(double place) const {
        return clamp_cell((place - low) * cells_per_length_, n_columns);
    }
    int row_of(double across) const {
        return clamp_cell((across - across_low) * cells_per_length_, n_rows);
    }
    double cells_per_length() const { return cells_per_length_; }

    void set_cell_width(double width) {
        cell_width = width;
        cells_per_length_ = 1 / width;
    }

private:
    double cells_per_length_ = 1; ///< the inverse width, because a division for each disc would
                                  ///< double the cost of finding its cell
    static int clamp_cell(double cell, int n) {
        if (!(cell > 0)) return 0;
        return cell < n ? static_cast<int>(cell) : n - 1;
    }
};

/// Returns a grid that covers `extent`, for searches of pairs within `reach`, with at most about
/// `n_discs` cells. `cell_width` is in units of the reach; if it is 0, the width is chosen from the
/// density of discs.
GridGeometry make_geometry(const Extent& extent, Axis axis, double reach, std::size_t n_discs,
                           double cell_width);

/// Returns a grid with at most about half as many cells as discs, for rare searches. It takes less
/// memory, but a search tests more pairs.
GridGeometry make_sparse_geometry(const Extent& extent, Axis axis, double reach,
                                  std::size_t n_discs);

/// Free flights in slot order: the position at the window's start, in cells from the grid's corner,
/// and the velocity, in cells per window. x is along the grid's axis, y across it.
struct FlightLanes {
    const float* x = nullptr;
    const float* y = nullptr;
    const float* vx = nullptr;
    const float* vy = nullptr;
};

struct SlotRange {
    std::uint32_t begin = 0, end = 0;
};

struct DiscPair {
    LocalIndex first = 0, second = 0;
};

/// Number of slots behind the last one that must be readable, because vector instructions read past
/// the end of a range.
inline constexpr std::size_t filter_padding = 64;

/// Arrays with one element for each own disc, which are reordered together with the discs. Empty
/// arrays are ignored.
struct Companions {
    std::span<DiscState> states;
    SideColumns* columns = nullptr;
};

class CellGrid {
public:
    /// Sorts `own` by cells at the time `anchor`. Flights begin at `time` and last for `duration`.
    /// In a periodic box the cell of a disc contains the position of its image. The grid then has
    /// no halo until add_halo is called.
    void sort(std::span<DiscState> own, const GridGeometry& geometry, double anchor, double time,
              double duration, int n_threads, const Periods& periods = {},
              const Companions& companions = {});
    /// Sorts `own` into cells by the positions at `time`, without computing flights. `lanes()` is
    /// then empty, so filters of flights must not be called.
    void sort_cells(std::span<DiscState> own, const GridGeometry& geometry, double time,
                    int n_threads, const Periods& periods = {}, const Companions& companions = {});
    /// Sorts the halo's discs, which follow the own ones in memory, into cells.
    void add_halo(std::span<const DiscState> halo, int n_threads = 1);

    /// Removes flights of discs faster than `speed`, in lengths per micro-step, from the lanes, so
    /// that no search finds these discs. They are listed in `apart()` until discs are sorted again.
    void set_apart(double speed);
    std::span<const LocalIndex> apart() const { return apart_; }
    FlightLanes apart_lanes() const {
        return lanes_of(apart_lanes_, apart_.size() + filter_padding);
    }

    /// Replaces a disc's free flight. Its cell stays the same.
    void update_flight(LocalIndex index, const DiscState& disc);
    void update_flight_of_image(LocalIndex index, const DiscState& disc);

    const GridGeometry& geometry() const { return geometry_; }
    std::size_t n_own() const { return n_own_; }
    bool has_halo() const { return !halo_.is_empty(); }

    /// `lanes` has the flights of own discs by index, and `halo_lanes` those of halo discs by slot.
    FlightLanes lanes() const { return lanes_of(lanes_, lane_length_); }
    FlightLanes halo_lanes() const { return lanes_of(halo_lanes_, halo_.size() + filter_padding); }
    LocalIndex halo_index(std::uint32_t slot) const {
        return static_cast<LocalIndex>(n_own_) + halo_.disc_in(slot);
    }
    std::uint32_t halo_slot(LocalIndex index) const {
        return halo_.slot_of(index - static_cast<LocalIndex>(n_own_));
    }

    /// The column or row of a position given in cells, limited to the grid.
    int clamped_column(float x) const {
        return x > 0 ? (x < static_cast<float>(geometry_.n_columns) ? static_cast<int>(x)
                                                                    : geometry_.n_columns - 1)
                     : 0;
    }
    int clamped_row(float y) const {
        return y > 0 ? (y < static_cast<float>(geometry_.n_rows) ? static_cast<int>(y)
                                                                 : geometry_.n_rows - 1)
                     : 0;
    }

    /// The slots of own discs in the cells (column, first_row .. last_row). Rows outside of the
    /// grid are ignored.
    SlotRange run(int column, int first_row, int last_row) const {
        return run_from(cell_start_, static_cast<std::size_t>(column) * rows(), first_row,
                        last_row);
    }
    /// The slots of the halo's discs in the cells (column, first_row .. last_row).
    SlotRange halo_run(int column, int first_row, int last_row) const {
        if (!has_halo_in(column)) return {};
        return run_from(halo_.starts(), halo_.first_cell(column), first_row, last_row);
    }
    bool has_halo_in(int column) const { return halo_.has_column(column); }
    /// The first row from `row` on that has halo discs in this column, or the number of rows if no
    /// such row is left. The column must have halo discs.
    int next_halo_row(int column, int row) const {
        return halo_.next_row(column, row, geometry().n_rows);
    }

    /// The cell of an own disc, found by a binary search. Code for all discs should loop over cells
    /// instead, because that is faster.
    struct Cell {
        int column = 0, row = 0;
    };
    Cell cell_of(LocalIndex own_index) const;

    /// Ascending ranges of slots that contain every own disc that is outside of `inner` at the time
    /// of the anchor. They also contain many discs that are inside.
    std::vector<SlotRange> outside(const Inside& inner) const;

    /// Divides the columns into `n_shares` shares with about equally many own discs. Returns the
    /// first column of each share; the last element is the number of columns.
    std::vector<std::int64_t> column_shares(int n_shares) const;

    /// Three steps of prefetching for a search around an own disc: first its flight, then the first
    /// slots of the cells around it, then the flights in these cells.
    void prefetch_flight(LocalIndex index) const {
        if (index >= n_own_) return;
        const float* flight = lanes_.data() + index;
        for (std::size_t lane = 0; lane < 4; ++lane)
            __builtin_prefetch(flight + lane * lane_length_, 1);
    }
    void prefetch_cells(LocalIndex index) const {
        for_each_place_around(
            index, [this](std::size_t place) { __builtin_prefetch(&cell_start_[place]); });
    }
    void prefetch_flights(LocalIndex index) const {
        for_each_place_around(index, [this](std::size_t place) {
            const float* flight = lanes_.data() + cell_start_[place > 0 ? place - 1 : 0];
            for (std::size_t lane = 0; lane < 4; ++lane)
                __builtin_prefetch(flight + lane * lane_length_);
        });
    }

    /// The squared distance, in cells, beyond which two discs cannot touch. It includes a margin
    /// for single precision.
    float touching_squared(double diameter) const;
    /// `length` in units of cells, enlarged by a margin for single precision.
    float cells_of(double length) const;

    bool is_valid(std::size_t n_discs) const;

private:
    template <class Lanes> static FlightLanes lanes_of(const Lanes& lanes, std::size_t length) {
        const float* x = lanes.data();
        return {x, x + length, x + 2 * length, x + 3 * length};
    }
    template <class Starts>
    SlotRange run_from(const Starts& starts, std::size_t base, int first_row, int last_row) const {
        const int low = first_row < 0 ? 0 : first_row;
        const int high = last_row >= geometry_.n_rows ? geometry_.n_rows - 1 : last_row;
        return {starts[base + static_cast<std::size_t>(low)],
                starts[base + static_cast<std::size_t>(high) + 1]};
    }
    /// Calls visit with the index of the disc's cell at the window's start, and with the indices of
    /// the cells in the same row of the columns beside it.
    template <class Visit> void for_each_place_around(LocalIndex index, const Visit& visit) const {
        if (index >= n_own_) return;
        const int column = clamped_column(lanes_[index]);
        const auto row = static_cast<std::size_t>(clamped_row(lanes_[index + lane_length_]));
        for (int other = column - 1; other <= column + 1; ++other)
            if (other >= 0 && other < geometry_.n_columns)
                visit(static_cast<std::size_t>(other) * rows() + row);
    }
    std::uint32_t rows() const { return static_cast<std::uint32_t>(geometry_.n_rows); }

    // `Places` computes a disc's position: the stored one, or the position of its image in the box.
    void sort(std::span<DiscState> own, int n_threads, const Companions& companions);
    template <class Places>
    void sort(const Places& places, std::span<DiscState> own, int n_threads,
              const Companions& companions);
    void sort_columns(SideColumns& columns, Lent order, int n_threads) const;
    template <class Places>
    void add_halo(const Places& places, std::span<const DiscState> halo, int n_threads);
    template <class Places>
    void place(const Places& places, float* flight, std::size_t length,
               const DiscState& disc) const;
    template <class Places>
    void update(const Places& places, LocalIndex index, const DiscState& disc);

    GridGeometry geometry_;
    Periods periods_;
    double anchor_ = 0, time_ = 0, duration_ = 1;
    bool has_flights_ = false;
    std::size_t n_own_ = 0;
    RawVector<std::uint32_t> cell_start_; ///< first slot of each cell, and the last cell's end
    std::size_t lane_length_ = 0;         ///< own discs plus padding for whole vectors
    RawVector<float> lanes_; ///< x, y, vx, vy of own discs, one array after the other; the sorter
                             ///< borrows this memory
    DiscSorter sorter_;

    HaloCells halo_;
    RawVector<float> halo_lanes_; ///< x, y, vx, vy of halo discs, by slot

    std::vector<LocalIndex> apart_;
    std::vector<float> apart_lanes_; ///< x, y, vx, vy of the discs in `apart_`
    double longest_flight_ = 0;      ///< longest flight of the discs in `apart_`, in cells
};

} // namespace carrom
