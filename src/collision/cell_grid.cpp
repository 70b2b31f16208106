// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/collision/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <omp.h>

#include "carrom/core/errors.hpp"

namespace carrom {

namespace {

/// First index of the `part`-th of `n_parts` equal shares of n.
std::size_t share(std::size_t n, int part, int n_parts) {
    return n * static_cast<std::size_t>(part) / static_cast<std::size_t>(n_parts);
}

/// Discs placed later whose states are asked for now.
constexpr std::uint32_t states_ahead = 8;

/// Windows of many lengths have cells of many sizes: memory of the smallest ones is not kept for all.
void resize_close(std::vector<std::uint32_t>& numbers, std::size_t size) {
    if (numbers.capacity() > size + size / 2) std::vector<std::uint32_t>().swap(numbers);
    numbers.resize(size);
}

/// Where discs are without periodic sides.
struct StoredPlaces {
    static double x_of(const Disc& disc, double time) { return disc.x_at(time); }
    static double y_of(const Disc& disc, double time) { return disc.y_at(time); }
};

int cells_along(double length, double width) {
    return static_cast<int>(std::clamp(std::ceil(length / width), 1.0, 1e9));
}

} // namespace

GridFrame make_frame(double x_low, double x_high, double y_low, double y_high, double reach, std::size_t n_discs,
                     double cell_width) {
    const double width = std::max(x_high - x_low, 0.0), height = std::max(y_high - y_low, 0.0);
    const double sparse_width = std::sqrt(width / static_cast<double>(n_discs + 16)) * std::sqrt(height);
    // Two cells to the reach save a third of the pairs where cells of one reach would hold many discs.
    const double crowding = reach / std::max(sparse_width, reach * 1e-3);
    // Cells much smaller than that would be more to the reach of fast discs than an int counts.
    const double wanted = cell_width > 0 ? std::max(cell_width, 1e-6) * reach : (crowding > 2.4 ? reach / 2 : reach);
    GridFrame frame;
    frame.x_low = x_low;
    frame.y_low = y_low;
    frame.set_cell_width(std::max(wanted, 0.8 * sparse_width));
    frame.n_reach = std::max(1, static_cast<int>(std::ceil(reach / frame.cell_width * (1 - 1e-9))));
    frame.n_columns = cells_along(width, frame.cell_width);
    frame.n_rows = cells_along(height, frame.cell_width);
    return frame;
}

void CellGrid::build(std::span<const Disc> discs, const GridFrame& frame, double anchor, double time, double duration, int n_threads,
                     const Periods& periods) {
    frame_ = frame;
    periods_ = periods;
    time_ = time;
    duration_ = duration;
    apart_.clear();
    longest_flight_ = 0;
    n_rows_inverse_ = rows() == 1 ? 0 : ~std::uint64_t{0} / rows() + 1;
    const std::size_t n = discs.size();
    order_.resize(n);
    cell_of_.resize(n);
    slot_of_.resize(n);
    lane_length_ = n + filter_padding;
    lanes_.resize(4 * lane_length_);
    resize_close(cell_start_, static_cast<std::size_t>(frame.n_columns) * rows() + 1);
    if (periods.are_any()) sort(periods, discs, anchor, n_threads);
    else sort(StoredPlaces{}, discs, anchor, n_threads);
    for (std::size_t lane = 1; lane <= 4; ++lane) {
        std::fill_n(lanes_.begin() + static_cast<std::ptrdiff_t>(lane * lane_length_ - filter_padding), filter_padding, 0.0f);
    }
}

template <class Places> void CellGrid::sort(const Places& places, std::span<const Disc> discs, double anchor, int n_threads) {
    if (n_threads == 1) sort_alone(places, discs, anchor);
    else sort_together(places, discs, anchor, n_threads);
}

template <class Places> std::uint32_t CellGrid::cell_at(const Places& places, const Disc& disc, double time) const {
    const auto column = static_cast<std::uint32_t>(frame_.column_of(places.x_of(disc, time)));
    const auto row = static_cast<std::uint32_t>(frame_.row_of(places.y_of(disc, time)));
    return column * rows() + row;
}

// One counting sort: states are read in the order in which they lie.
template <class Places> void CellGrid::sort_alone(const Places& places, std::span<const Disc> discs, double anchor) {
    std::fill(cell_start_.begin(), cell_start_.end(), 0u);
    std::uint32_t* next = cell_start_.data() + 1; // by cell: how many discs, then the slot of the next one
    for (std::size_t i = 0; i < discs.size(); ++i) {
        cell_of_[i] = cell_at(places, discs[i], anchor);
        ++next[cell_of_[i]];
    }
    std::uint32_t start = 0;
    for (std::size_t cell = 0; cell + 1 < cell_start_.size(); ++cell) {
        const std::uint32_t count = next[cell];
        next[cell] = start;
        start += count;
    }
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const std::uint32_t slot = next[cell_of_[i]]++;
        order_[slot] = static_cast<LocalIndex>(i);
        slot_of_[i] = slot;
        place(places, slot, discs[i]);
    }
}

// Two counting sorts, first by column over equal shares of the discs, then by row inside each column: no atomics,
// and the scattered writes of the second stay within one column.
template <class Places>
void CellGrid::sort_together(const Places& places, std::span<const Disc> discs, double anchor, int n_threads) {
    const std::size_t n = discs.size(), n_columns = static_cast<std::size_t>(frame_.n_columns);
    column_start_.resize(n_columns + 1);
    thread_column_start_.assign(n_columns * static_cast<std::size_t>(n_threads), 0);
#pragma omp parallel num_threads(n_threads)
    {
        const int thread = omp_get_thread_num();
        std::uint32_t* counts = thread_column_start_.data() + n_columns * static_cast<std::size_t>(thread);
        const std::size_t begin = share(n, thread, n_threads), end = share(n, thread + 1, n_threads);
        for (std::size_t i = begin; i < end; ++i) {
            cell_of_[i] = cell_at(places, discs[i], anchor);
            ++counts[column_of_cell(cell_of_[i])];
        }
#pragma omp barrier
#pragma omp single
        {
            std::uint32_t start = 0;
            for (std::size_t column = 0; column < n_columns; ++column) {
                column_start_[column] = start;
                for (int t = 0; t < n_threads; ++t) {
                    std::uint32_t& count = thread_column_start_[n_columns * static_cast<std::size_t>(t) + column];
                    const std::uint32_t next = start + count;
                    count = start;
                    start = next;
                }
            }
            column_start_[n_columns] = start;
            cell_start_.back() = start;
        }
        for (std::size_t i = begin; i < end; ++i) {
            // slot_of_ serves as the list of discs by column until the second sort has read it.
            slot_of_[counts[column_of_cell(cell_of_[i])]++] = static_cast<LocalIndex>(i);
        }
#pragma omp barrier
#pragma omp for schedule(static)
        for (int column = 0; column < frame_.n_columns; ++column) sort_column(places, discs, column);
        // slot_of_ is free again once every column is sorted (the loop ends with a barrier).
#pragma omp for schedule(static)
        for (std::size_t slot = 0; slot < n; ++slot) slot_of_[order_[slot]] = static_cast<std::uint32_t>(slot);
    }
}

template <class Places> void CellGrid::sort_column(const Places& places, std::span<const Disc> discs, int column) {
    const std::size_t base = static_cast<std::size_t>(column) * rows();
    const std::uint32_t begin = column_start_[static_cast<std::size_t>(column)];
    const std::uint32_t end = column_start_[static_cast<std::size_t>(column) + 1];
    std::uint32_t* starts = cell_start_.data() + base;
    std::fill(starts, starts + rows(), 0u);
    for (std::uint32_t k = begin; k < end; ++k) ++starts[cell_of_[slot_of_[k]] - base];
    std::uint32_t start = begin;
    for (std::uint32_t row = 0; row < rows(); ++row) {
        const std::uint32_t count = starts[row];
        starts[row] = start;
        start += count;
    }
    for (std::uint32_t k = begin; k < end; ++k) {
        if (k + states_ahead < end) __builtin_prefetch(&discs[slot_of_[k + states_ahead]]);
        const LocalIndex index = slot_of_[k];
        const std::uint32_t slot = starts[cell_of_[index] - base]++;
        order_[slot] = index;
        place(places, slot, discs[index]);
    }
    // Each start has moved to its cell's end, which is the next cell's start: shift them back by one cell.
    for (std::uint32_t row = rows() - 1; row > 0; --row) starts[row] = starts[row - 1];
    starts[0] = begin;
}

template <class Places> void CellGrid::place(const Places& places, std::uint32_t slot, const Disc& disc) {
    const double cells = frame_.cells_per_length();
    float* lane = lanes_.data() + slot;
    lane[0] = static_cast<float>((places.x_of(disc, time_) - frame_.x_low) * cells);
    lane[lane_length_] = static_cast<float>((places.y_of(disc, time_) - frame_.y_low) * cells);
    lane[2 * lane_length_] = static_cast<float>(disc.vx * duration_ * cells);
    lane[3 * lane_length_] = static_cast<float>(disc.vy * duration_ * cells);
}

void CellGrid::set_apart(double speed) {
    const double flight = speed * duration_ * frame_.cells_per_length();
    const auto longest = static_cast<float>(flight * flight);
    float *x = lanes_.data(), *y = x + lane_length_, *vx = y + lane_length_, *vy = vx + lane_length_;
    std::vector<float> kept; // four numbers a disc
    float longest_squared = 0;
    for (std::size_t slot = 0; slot < order_.size(); ++slot) {
        const float squared = vx[slot] * vx[slot] + vy[slot] * vy[slot];
        if (!(squared > longest)) continue;
        longest_squared = std::max(longest_squared, squared);
        apart_.push_back(order_[slot]);
        kept.insert(kept.end(), {x[slot], y[slot], vx[slot], vy[slot]});
        // Far from everybody and from each other, and flying away: the filter keeps pairs without relative velocity.
        x[slot] = y[slot] = 1e6f * static_cast<float>(apart_.size());
        vx[slot] = vy[slot] = 1e3f * static_cast<float>(apart_.size());
    }
    longest_flight_ = std::sqrt(static_cast<double>(longest_squared));
    apart_length_ = apart_.size() + filter_padding;
    apart_lanes_.assign(4 * apart_length_, 0.0f);
    for (std::size_t k = 0; k < apart_.size(); ++k) {
        for (std::size_t lane = 0; lane < 4; ++lane) apart_lanes_[lane * apart_length_ + k] = kept[4 * k + lane];
    }
}

std::vector<std::int64_t> CellGrid::column_shares(int n_shares) const {
    std::vector<std::int64_t> bounds;
    int column = 0;
    for (int k = 0; k < n_shares; ++k) {
        const std::size_t before = share(order_.size(), k, n_shares);
        while (column < frame_.n_columns && cell_start_[static_cast<std::size_t>(column) * rows()] < before) ++column;
        bounds.push_back(column);
    }
    bounds.push_back(frame_.n_columns);
    return bounds;
}

void CellGrid::reorder(std::span<Disc> discs, std::size_t n_own, int n_threads, std::span<double> column) {
    ensure(order_.size() >= n_own && discs.size() >= n_own, "discs are brought into the order of a grid that holds them");
    std::size_t n_placed = 0; // slot_of_ becomes the list of own discs by slot
    for (const LocalIndex index : order_) {
        if (index < n_own) slot_of_[n_placed++] = index;
    }
    // A quarter of each state at a time goes through the lanes, so that no second array of states is needed.
    constexpr std::size_t quarter = sizeof(Disc) / 4;
    static_assert(quarter == 4 * sizeof(float));
    auto* states = reinterpret_cast<std::byte*>(discs.data());
    auto* lent = reinterpret_cast<std::byte*>(lanes_.data());
    const auto n = static_cast<std::int64_t>(n_own);
#pragma omp parallel num_threads(n_threads)
    for (std::size_t part = 0; part < 4; ++part) {
#pragma omp for schedule(static)
        for (std::int64_t k = 0; k < n; ++k) {
            const auto slot = static_cast<std::size_t>(k);
            std::memcpy(lent + slot * quarter, states + slot_of_[slot] * sizeof(Disc) + part * quarter, quarter);
        }
#pragma omp for schedule(static)
        for (std::int64_t k = 0; k < n; ++k) {
            const auto slot = static_cast<std::size_t>(k);
            std::memcpy(states + slot * sizeof(Disc) + part * quarter, lent + slot * quarter, quarter);
        }
    }
    if (!column.empty()) {
        const std::vector<double> before(column.begin(), column.begin() + n);
        for (std::size_t slot = 0; slot < n_own; ++slot) column[slot] = before[slot_of_[slot]];
    }
    order_.clear();
}

void CellGrid::update_flight(LocalIndex index, const Disc& disc) { place(StoredPlaces{}, slot_of_[index], disc); }

void CellGrid::update_flight_of_image(LocalIndex index, const Disc& disc) { place(periods_, slot_of_[index], disc); }

float CellGrid::touching_squared(double diameter) const {
    // Positions and velocities carry an error of 2^-24 of the frame's size; the filter allows for its own rounding.
    const double extent = std::max(frame_.n_columns, frame_.n_rows) + 4.0 * std::max<double>(frame_.n_reach, longest_flight_);
    const double touching = diameter / frame_.cell_width * (1 + 0x1p-18) + 0x1p-21 * extent;
    return static_cast<float>(touching * touching);
}

float CellGrid::cells_of(double length) const {
    return static_cast<float>(length / frame_.cell_width * (1 + 0x1p-18) + 0x1p-20 * (std::max(frame_.n_columns, frame_.n_rows) + 8));
}

std::size_t CellGrid::bytes() const {
    return sizeof(float) * lanes_.capacity() +
           sizeof(std::uint32_t) * (cell_start_.capacity() + column_start_.capacity() + thread_column_start_.capacity() +
                                    order_.capacity() + cell_of_.capacity() + slot_of_.capacity());
}

bool CellGrid::is_valid(std::size_t n_discs) const {
    if (order_.size() != n_discs || cell_start_.back() != n_discs) return false;
    for (std::size_t slot = 0; slot < n_discs; ++slot) {
        const LocalIndex index = order_[slot];
        if (slot_of_[index] != slot) return false;
        const std::uint32_t cell = cell_of_[index];
        if (slot < cell_start_[cell] || slot >= cell_start_[cell + 1]) return false;
    }
    return true;
}

} // namespace carrom
