// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/collision/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "carrom/core/errors.hpp"

namespace carrom {

namespace {

/// First index of the `part`-th of `n_parts` equal shares of n.
std::size_t share(std::size_t n, std::size_t part, std::size_t n_parts) { return n * part / n_parts; }

/// Windows of many lengths have cells of many sizes: memory of the smallest ones is not kept for all, and a few more cells than
/// last time do not take twice the memory. What was in `numbers` may be gone.
void resize_close(std::vector<std::uint32_t>& numbers, std::size_t size) {
    if (numbers.capacity() < size || numbers.capacity() > size + size / 2) {
        std::vector<std::uint32_t>().swap(numbers);
        numbers.reserve(size + size / 8);
    }
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

GridFrame make_sparse_frame(double x_low, double x_high, double y_low, double y_high, double reach, std::size_t n_discs) {
    const double area = std::max(x_high - x_low, 0.0) * std::max(y_high - y_low, 0.0);
    const double width = std::sqrt(2 * area / static_cast<double>(n_discs + 16)) / reach;
    return make_frame(x_low, x_high, y_low, y_high, reach, n_discs, width > 1 ? width : 0);
}

void CellGrid::build(std::span<const Disc> discs, const GridFrame& frame, double anchor, double time, double duration, int n_threads,
                     const Periods& periods) {
    frame_ = frame;
    periods_ = periods;
    time_ = time;
    duration_ = duration;
    has_flights_ = true;
    build(discs, anchor, n_threads);
    for (std::size_t lane = 1; lane <= 4; ++lane) {
        std::fill_n(lanes_.begin() + static_cast<std::ptrdiff_t>(lane * lane_length_ - filter_padding), filter_padding, 0.0f);
    }
}

void CellGrid::build_cells(std::span<const Disc> discs, const GridFrame& frame, double time, int n_threads, const Periods& periods) {
    frame_ = frame;
    periods_ = periods;
    has_flights_ = false;
    build(discs, time, n_threads);
}

void CellGrid::build(std::span<const Disc> discs, double anchor, int n_threads) {
    apart_.clear();
    longest_flight_ = 0;
    n_rows_inverse_ = rows() == 1 ? 0 : ~std::uint64_t{0} / rows() + 1;
    const std::size_t n = discs.size();
    order_.resize(n);
    cell_of_.resize(n);
    slot_of_.resize(n);
    lane_length_ = n + filter_padding;
    lanes_.resize(4 * lane_length_);
    resize_close(cell_start_, static_cast<std::size_t>(frame_.n_columns) * rows() + 1);
    if (periods_.are_any()) sort(periods_, discs, anchor, n_threads);
    else sort(StoredPlaces{}, discs, anchor, n_threads);
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
        if (has_flights_) place(places, slot, discs[i]);
    }
}

// The same by several threads: each sorter counts only between the first and the last cell of its share of the discs. Those lie
// nearly in the order of their cells, so all counts together are not many more than there are cells.
template <class Places>
void CellGrid::sort_together(const Places& places, std::span<const Disc> discs, double anchor, int n_threads) {
    const std::size_t n_cells = cell_start_.size() - 1;
    share_out(discs.size(), n_threads);
#pragma omp parallel for num_threads(n_threads) schedule(static, 1)
    for (std::size_t k = 0; k < sorters_.size(); ++k) {
        Sorter& sorter = sorters_[k];
        std::uint32_t first = ~std::uint32_t{0}, last = 0;
        for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) {
            const std::uint32_t cell = cell_at(places, discs[i], anchor);
            cell_of_[i] = cell;
            first = std::min(first, cell);
            last = std::max(last, cell);
        }
        sorter.first_cell = std::min(first, last);
        sorter.end_cell = last + 1;
    }
    make_room_for_counts(n_cells);
    const auto n_shares = static_cast<std::size_t>(n_threads);
    std::vector<std::uint32_t> starts(n_shares + 1, 0); // of shares of the cells
#pragma omp parallel num_threads(n_threads)
    {
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < sorters_.size(); ++k) {
            const Sorter& sorter = sorters_[k];
            std::fill_n(counts_.begin() + static_cast<std::ptrdiff_t>(sorter.counts), sorter.end_cell - sorter.first_cell, 0u);
            std::uint32_t* const counts = counts_.data() + sorter.counts;
            for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) ++counts[cell_of_[i] - sorter.first_cell];
        }
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            std::uint32_t n_discs = 0;
            for_each_count(share(n_cells, k, n_shares), share(n_cells, k + 1, n_shares),
                           [&](std::size_t, std::uint32_t& count) { n_discs += count; });
            starts[k + 1] = n_discs;
        }
#pragma omp single
        for (std::size_t k = 0; k < n_shares; ++k) starts[k + 1] += starts[k];
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            std::uint32_t start = starts[k]; // each count becomes the slot of the sorter's next disc there
            const std::size_t begin = share(n_cells, k, n_shares), end = share(n_cells, k + 1, n_shares);
            std::size_t next = begin;
            for_each_count(begin, end, [&](std::size_t cell, std::uint32_t& count) {
                while (next <= cell) cell_start_[next++] = start;
                start += std::exchange(count, start);
            });
            while (next < end) cell_start_[next++] = start;
        }
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < sorters_.size(); ++k) {
            const Sorter& sorter = sorters_[k];
            std::uint32_t* const next = counts_.data() + sorter.counts;
            for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) {
                const std::uint32_t slot = next[cell_of_[i] - sorter.first_cell]++;
                order_[slot] = static_cast<LocalIndex>(i);
                slot_of_[i] = slot;
                if (has_flights_) place(places, slot, discs[i]);
            }
        }
    }
    cell_start_[n_cells] = static_cast<std::uint32_t>(discs.size());
}

void CellGrid::share_out(std::size_t n_discs, int n_sorters) {
    const auto n = static_cast<std::size_t>(n_sorters);
    sorters_.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
        sorters_[k].first_disc = share(n_discs, k, n);
        sorters_[k].end_disc = share(n_discs, k + 1, n);
    }
}

/// Discs in no order have all sorters count in all cells: then only a few of them work.
void CellGrid::make_room_for_counts(std::size_t n_cells) {
    constexpr std::size_t most_counting_all = 4;
    const auto lay_out = [this] {
        std::size_t n_counts = 0;
        for (Sorter& sorter : sorters_) {
            sorter.counts = n_counts;
            n_counts += sorter.end_cell - sorter.first_cell;
        }
        return n_counts;
    };
    std::size_t n_counts = lay_out();
    if (n_counts > most_counting_all * n_cells) {
        share_out(order_.size(), most_counting_all);
        for (Sorter& sorter : sorters_) {
            sorter.first_cell = 0;
            sorter.end_cell = static_cast<std::uint32_t>(n_cells);
        }
        n_counts = lay_out();
    }
    resize_close(counts_, n_counts);
}

/// Calls visit(cell, count) for all sorters' counts of the cells begin .. end, cell by cell.
template <class Visit> void CellGrid::for_each_count(std::size_t begin, std::size_t end, const Visit& visit) {
    struct Row {
        std::uint32_t* counts; ///< of `first` and the cells behind it
        std::size_t first, end;
    };
    std::vector<Row> rows_here;
    for (const Sorter& sorter : sorters_)
        if (sorter.first_cell < end && sorter.end_cell > begin) rows_here.push_back({counts_.data() + sorter.counts, sorter.first_cell, sorter.end_cell});
    for (std::size_t cell = begin; cell < end;) { // up to where another sorter begins or ends, mostly one counts
        std::size_t stretch_end = end;
        const Row* here = nullptr;
        std::size_t n_here = 0;
        for (const Row& row : rows_here) {
            if (row.first > cell) stretch_end = std::min(stretch_end, row.first);
            if (row.end > cell) stretch_end = std::min(stretch_end, row.end);
            if (row.first > cell || row.end <= cell) continue;
            here = &row;
            ++n_here;
        }
        if (n_here == 1) {
            for (std::uint32_t* count = here->counts + (cell - here->first); cell < stretch_end; ++cell, ++count) visit(cell, *count);
        }
        for (; cell < stretch_end; ++cell) {
            for (const Row& row : rows_here)
                if (row.first <= cell && cell < row.end) visit(cell, row.counts[cell - row.first]);
        }
    }
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
        const std::size_t before = share(order_.size(), static_cast<std::size_t>(k), static_cast<std::size_t>(n_shares));
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
           sizeof(std::uint32_t) * (cell_start_.capacity() + counts_.capacity() + order_.capacity() + cell_of_.capacity() + slot_of_.capacity());
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
