// SPDX-License-Identifier: BSD-3-Clause
// Discs sorted into square cells by where they are at a window's anchor, x-major: the cells of a column that lie within
// reach of a disc are one contiguous run of slots, to be read 16 lanes at a time.
//
// Beside the order of slots the grid holds each disc's free flight in single precision, in units of cells and windows,
// so that nothing can overflow. It serves to reject; the double predicate decides. Price: 28 bytes a disc and 4 a cell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "carrom/core/disc.hpp"
#include "carrom/core/image.hpp"

namespace carrom {

/// Where the cells lie. Discs outside the frame are put into its border cells, which brings no two discs further apart.
struct GridFrame {
    double x_low = 0, y_low = 0;
    double cell_width = 1; ///< see set_cell_width
    int n_columns = 1, n_rows = 1;
    int n_reach = 1; ///< cells on each side that can hold a partner

    int column_of(double x) const { return clamp_cell((x - x_low) * cells_per_length_, n_columns); }
    int row_of(double y) const { return clamp_cell((y - y_low) * cells_per_length_, n_rows); }
    double cells_per_length() const { return cells_per_length_; }

    void set_cell_width(double width) {
        cell_width = width;
        cells_per_length_ = 1 / width;
    }

private:
    double cells_per_length_ = 1; ///< a division a disc costs as much as all else that finds its cell
    static int clamp_cell(double cell, int n) {
        if (!(cell > 0)) return 0;
        return cell < n ? static_cast<int>(cell) : n - 1;
    }
};

/// A frame of cells over [x_low, x_high] x [y_low, y_high] for partners within `reach`, about `n_discs` cells at most.
/// `cell_width` in units of reach, 0 for a choice by density.
GridFrame make_frame(double x_low, double x_high, double y_low, double y_high, double reach, std::size_t n_discs,
                     double cell_width);

/// The same for a look now and then, with no more than half as many cells as discs: less memory, more pairs.
GridFrame make_sparse_frame(double x_low, double x_high, double y_low, double y_high, double reach, std::size_t n_discs);

/// Free flights in slot order: position in cells from the frame's corner at the window's start, cells per window.
struct FlightLanes {
    const float* x = nullptr;
    const float* y = nullptr;
    const float* vx = nullptr;
    const float* vy = nullptr;
};

struct SlotRange {
    std::uint32_t begin = 0, end = 0;
};

struct SlotPair {
    std::uint32_t first = 0, second = 0;
};

/// Slots that must be readable beyond the last one: a vector may look past its run's end.
inline constexpr std::size_t filter_padding = 64;

class CellGrid {
public:
    /// Sorts `discs` by their cells at `anchor`; flights begin at `time` and last for `duration`. Where there are periods
    /// discs are where their images are.
    void build(std::span<const Disc> discs, const GridFrame& frame, double anchor, double time, double duration, int n_threads,
               const Periods& periods = {});
    /// The same for cells alone, by where discs are at `time`: `lanes()` and what is found by them say nothing.
    void build_cells(std::span<const Disc> discs, const GridFrame& frame, double time, int n_threads, const Periods& periods = {});

    /// Brings the first `n_own` of `discs`, those that the grid was built for, into the order of their slots, in place,
    /// and makes the grid unusable until it is built again. Neighbours in space become neighbours in memory.
    /// `column`, if it is not empty, runs along the discs and goes with them.
    void reorder(std::span<Disc> discs, std::size_t n_own, int n_threads, std::span<double> column = {});

    /// Takes the flights of discs that are faster than `speed`, in lengths per unit of time, out of the lanes: no disc that
    /// looks at their slots will find them there. They are listed in `apart()` until the grid is built again.
    void set_apart(double speed);
    std::span<const LocalIndex> apart() const { return apart_; }
    FlightLanes apart_lanes() const {
        const float* x = apart_lanes_.data();
        return {x, x + apart_length_, x + 2 * apart_length_, x + 3 * apart_length_};
    }

    /// Takes over a disc's new free flight. Its cell stays what it was.
    void update_flight(LocalIndex index, const Disc& disc);
    void update_flight_of_image(LocalIndex index, const Disc& disc);

    const GridFrame& frame() const { return frame_; }
    FlightLanes lanes() const {
        const float* x = lanes_.data();
        return {x, x + lane_length_, x + 2 * lane_length_, x + 3 * lane_length_};
    }
    std::span<const LocalIndex> order() const { return order_; }
    std::uint32_t slot_of(LocalIndex index) const { return slot_of_[index]; }
    int column_of(LocalIndex index) const { return static_cast<int>(column_of_cell(cell_of_[index])); }
    int row_of(LocalIndex index) const {
        return static_cast<int>(cell_of_[index] - column_of_cell(cell_of_[index]) * rows());
    }

    /// The column or row of a position in cells.
    int clamped_column(float x) const { return x > 0 ? (x < static_cast<float>(frame_.n_columns) ? static_cast<int>(x) : frame_.n_columns - 1) : 0; }
    int clamped_row(float y) const { return y > 0 ? (y < static_cast<float>(frame_.n_rows) ? static_cast<int>(y) : frame_.n_rows - 1) : 0; }

    /// Slots of the cells (column, first_row .. last_row); rows are cut at the frame's ends.
    SlotRange run(int column, int first_row, int last_row) const {
        const int low = first_row < 0 ? 0 : first_row;
        const int high = last_row >= frame_.n_rows ? frame_.n_rows - 1 : last_row;
        const std::size_t base = static_cast<std::size_t>(column) * rows();
        return {cell_start_[base + static_cast<std::size_t>(low)], cell_start_[base + static_cast<std::size_t>(high) + 1]};
    }

    /// First columns of `n_shares` shares with about as many discs each, and the number of columns.
    std::vector<std::int64_t> column_shares(int n_shares) const;

    /// Ask for what a look around a disc will need: first where its cells begin, some time later the flights in them.
    void prefetch_cells(LocalIndex index) const {
        const std::uint32_t cell = cell_of_[index];
        for (int column = -1; column <= 1; ++column) {
            const std::size_t place = cell + static_cast<std::size_t>(column) * rows(); // wraps at the left end
            if (place < cell_start_.size()) __builtin_prefetch(&cell_start_[place]);
        }
        __builtin_prefetch(&slot_of_[index]);
    }
    void prefetch_flights(LocalIndex index) const {
        const std::uint32_t cell = cell_of_[index];
        for (int column = -1; column <= 1; ++column) {
            const std::size_t place = cell + static_cast<std::size_t>(column) * rows() - 1;
            if (place >= cell_start_.size()) continue;
            const float* flight = lanes_.data() + cell_start_[place];
            for (int lane = 0; lane < 4; ++lane) __builtin_prefetch(flight + static_cast<std::size_t>(lane) * lane_length_);
        }
    }

    void prefetch_slot(LocalIndex index) const { __builtin_prefetch(&slot_of_[index]); }
    void prefetch_flight(LocalIndex index) const {
        const float* flight = lanes_.data() + slot_of_[index];
        for (int lane = 0; lane < 4; ++lane) __builtin_prefetch(flight + static_cast<std::size_t>(lane) * lane_length_, 1);
    }

    /// Squared distance in cells, with a margin for single precision, beyond which flights cannot touch.
    float touching_squared(double diameter) const;
    /// `length` in cells, with a margin for single precision.
    float cells_of(double length) const;

    bool is_valid(std::size_t n_discs) const;
    std::size_t bytes() const;

private:
    /// A share of the discs, which lie in the cells first .. end, and where the counts of those begin.
    struct Sorter {
        std::size_t first_disc = 0, end_disc = 0;
        std::uint32_t first_cell = 0, end_cell = 0;
        std::size_t counts = 0;
    };

    /// cell / rows() by a multiplication: exact for 32-bit cells with a 64-bit inverse rounded up.
    std::uint32_t column_of_cell(std::uint32_t cell) const {
        __extension__ using Wide = unsigned __int128;
        return n_rows_inverse_ == 0 ? cell : static_cast<std::uint32_t>((static_cast<Wide>(n_rows_inverse_) * cell) >> 64);
    }
    std::uint32_t rows() const { return static_cast<std::uint32_t>(frame_.n_rows); }
    void build(std::span<const Disc> discs, double anchor, int n_threads);
    /// `Places` says where discs are: their states, or their images.
    template <class Places> void sort(const Places& places, std::span<const Disc> discs, double anchor, int n_threads);
    template <class Places> std::uint32_t cell_at(const Places& places, const Disc& disc, double time) const;
    template <class Places> void sort_alone(const Places& places, std::span<const Disc> discs, double anchor);
    template <class Places> void sort_together(const Places& places, std::span<const Disc> discs, double anchor, int n_threads);
    void share_out(std::size_t n_discs, int n_sorters);
    void make_room_for_counts(std::size_t n_cells);
    template <class Visit> void for_each_count(std::size_t begin, std::size_t end, const Visit& visit);
    template <class Places> void place(const Places& places, std::uint32_t slot, const Disc& disc);

    GridFrame frame_;
    Periods periods_;
    std::uint64_t n_rows_inverse_ = 0; ///< 2^64 / rows, rounded up; 0 for one row
    double time_ = 0, duration_ = 1;
    bool has_flights_ = false;
    std::vector<std::uint32_t> cell_start_;  ///< by cell, and one more
    std::vector<Sorter> sorters_;            ///< scratch for several threads, as the next
    std::vector<std::uint32_t> counts_;
    std::vector<LocalIndex> order_;          ///< by slot
    std::vector<std::uint32_t> cell_of_, slot_of_; ///< by disc
    std::size_t lane_length_ = 0;            ///< slots and padding for whole vectors
    std::vector<float> lanes_;               ///< x, y, vx, vy by slot, one after the other
    std::vector<LocalIndex> apart_;
    std::size_t apart_length_ = 0;
    std::vector<float> apart_lanes_;         ///< the same by place in `apart_`
    double longest_flight_ = 0;              ///< of those, in cells
};

} // namespace carrom
