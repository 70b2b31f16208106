// SPDX-License-Identifier: BSD-3-Clause
#include "cell_list/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "cell_list/disc_sorter_passes.hpp"
#include "core/errors.hpp"

namespace carrom {

namespace {

/// The smallest width of cells, in mean distances between discs. Smaller cells would save no time,
/// but cost 4 bytes each.
constexpr double least_spacings = 1.15;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Resizes with little spare memory, because the number of cells changes from window to window.
/// Memory far above the need is freed, and a slight increase does not double the memory. The old
/// contents may be lost.
template <class Numbers> void resize_close(Numbers& numbers, std::size_t size) {
    if (numbers.capacity() < size || numbers.capacity() > size + size / 2) {
        Numbers().swap(numbers);
        numbers.reserve(size + size / 8);
    }
    numbers.resize(size);
}

/// Writes zeros behind the last flight, because vector instructions read past it.
void pad(RawVector<float>& lanes, std::size_t length) {
    for (std::size_t lane = 1; lane <= 4; ++lane)
        std::fill_n(lanes.begin() + static_cast<std::ptrdiff_t>(lane * length - filter_padding),
                    filter_padding, 0.0f);
}

int cells_along(double length, double width) {
    return static_cast<int>(std::clamp(std::ceil(length / width), 1.0, 1e9));
}

/// Positions of discs in a box without periodic sides: the stored ones.
struct StoredPlaces {
    static double x_of(const DiscState& disc, double time) { return disc.x_at(time); }
    static double y_of(const DiscState& disc, double time) { return disc.y_at(time); }
    static double vx_of(const DiscState& disc) { return disc.vx; }
};

/// Positions of images in a periodic box without shear. A separate type, so that its functions need
/// no test for moving images.
struct PlacesAtRest {
    Periods periods;

    double x_of(const DiscState& disc, double time) const { return periods.x_at_rest(disc, time); }
    double y_of(const DiscState& disc, double time) const { return periods.y_of(disc, time); }
    static double vx_of(const DiscState& disc) { return disc.vx; }
};

/// Finds the cell of a disc. The members are copies, so that the compiler keeps them in registers
/// while cells are stored.
template <class Places> struct CellFinder {
    Places places;
    GridGeometry geometry;
    double anchor = 0;

    CellGrid::Cell cell_of(const DiscState& disc) const {
        const auto [along, across] = turned(geometry.axis, places.x_of(disc, anchor),
                                            places.y_of(disc, anchor));
        return {geometry.column_of(along), geometry.row_of(across)};
    }
    std::uint32_t operator()(const DiscState& disc) const {
        const CellGrid::Cell cell = cell_of(disc);
        return static_cast<std::uint32_t>(cell.column) *
                   static_cast<std::uint32_t>(geometry.n_rows) +
               static_cast<std::uint32_t>(cell.row);
    }
};

/// Calls `work` with an object that computes positions of discs in this kind of box.
template <class Work> void with_places(const Periods& periods, Work work) {
    if (periods.are_moving())
        work(periods);
    else if (periods.are_any())
        work(PlacesAtRest{periods});
    else
        work(StoredPlaces{});
}

} // namespace

GridGeometry make_geometry(const Extent& extent, Axis axis, double reach, std::size_t n_discs,
                           double cell_width) {
    const auto [width, height] = turned(axis, std::max(extent.size().x, 0.0),
                                        std::max(extent.size().y, 0.0));
    const auto n_cells = static_cast<double>(n_discs + 16);
    // The width of about `n_cells` square cells. In a narrow tube they form a single row.
    const double sparse_width = std::max(std::sqrt(width / n_cells) * std::sqrt(height),
                                         std::max(width, height) / n_cells);
    // Cells half as wide as the reach save a third of the pair tests, if cells as wide as the reach
    // would contain many discs.
    const double discs_per_reach = reach / std::max(sparse_width, reach * 1e-3);
    // The lower limit keeps the reach of fast discs, counted in cells, within the range of int.
    const double wanted = cell_width > 0 ? std::max(cell_width, 1e-6) * reach
                                         : (discs_per_reach > 4 ? reach / 2 : reach);
    GridGeometry geometry;
    geometry.axis = axis;
    std::tie(geometry.low, geometry.across_low) = turned(axis, extent.x_low, extent.y_low);
    geometry.set_cell_width(std::max(wanted, least_spacings * sparse_width));
    geometry.n_reach = std::max(
        1, static_cast<int>(std::ceil(reach / geometry.cell_width * (1 - 1e-9))));
    geometry.n_columns = cells_along(width, geometry.cell_width);
    geometry.n_rows = cells_along(height, geometry.cell_width);
    return geometry;
}

GridGeometry make_sparse_geometry(const Extent& extent, Axis axis, double reach,
                                  std::size_t n_discs) {
    const double area = std::max(extent.size().x, 0.0) * std::max(extent.size().y, 0.0);
    const double width = std::sqrt(2 * area / static_cast<double>(n_discs + 16)) / reach;
    return make_geometry(extent, axis, reach, n_discs, width > 1 ? width : 0);
}

template <class Places>
[[gnu::always_inline]] inline void CellGrid::place(const Places& places, float* flight,
                                                   std::size_t length,
                                                   const DiscState& disc) const {
    const double cells = geometry_.cells_per_length();
    const auto [x, y] = turned(geometry_.axis, places.x_of(disc, time_), places.y_of(disc, time_));
    const auto [vx, vy] = turned(geometry_.axis, places.vx_of(disc), disc.vy);
    flight[0] = static_cast<float>((x - geometry_.low) * cells);
    flight[length] = static_cast<float>((y - geometry_.across_low) * cells);
    flight[2 * length] = static_cast<float>(vx * duration_ * cells);
    flight[3 * length] = static_cast<float>(vy * duration_ * cells);
}

void CellGrid::sort(std::span<DiscState> own, const GridGeometry& geometry, double anchor,
                    double time, double duration, int n_threads, const Periods& periods,
                    const Companions& companions) {
    geometry_ = geometry;
    periods_ = periods;
    anchor_ = anchor;
    time_ = time;
    duration_ = duration;
    has_flights_ = true;
    sort(own, n_threads, companions);
    pad(lanes_, lane_length_);
}

void CellGrid::sort_cells(std::span<DiscState> own, const GridGeometry& geometry, double time,
                          int n_threads, const Periods& periods, const Companions& companions) {
    geometry_ = geometry;
    periods_ = periods;
    anchor_ = time;
    has_flights_ = false;
    sort(own, n_threads, companions);
    RawVector<float>().swap(lanes_); // only the sorter used this memory
}

void CellGrid::sort(std::span<DiscState> own, int n_threads, const Companions& companions) {
    ensure(companions.states.empty() || companions.states.size() == own.size(),
           "what goes with the own discs is as many");
    apart_.clear();
    longest_flight_ = 0;
    halo_.begin(0, 0);
    n_own_ = own.size();
    lane_length_ = n_own_ + filter_padding;
    resize_close(cell_start_, static_cast<std::size_t>(geometry_.n_columns) * rows() + 1);
    resize_close(lanes_, (has_flights_ ? 4 : 2) * lane_length_);
    with_places(periods_, [&](const auto& places) { sort(places, own, n_threads, companions); });
}

void CellGrid::sort_columns(SideColumns& columns, Lent order, int n_threads) const {
    columns.for_each([&](SideColumn column) {
        std::vector<double>& values = columns[column];
        ensure(values.size() == n_own_, "a side column is as long as the own discs");
        RawVector<double> before(n_own_);
#pragma omp parallel num_threads(n_threads)
        {
#pragma omp for schedule(static)
            for (std::size_t i = 0; i < n_own_; ++i) before[i] = values[i];
#pragma omp for schedule(static)
            for (std::size_t i = 0; i < n_own_; ++i) values[i] = before[order[i]];
        }
    });
}

/// Writes the new order into the second lane, and then moves the discs. Usually one pass is enough,
/// because nearly all discs move only a few places.
template <class Places>
void CellGrid::sort(const Places& places, std::span<DiscState> own, int n_threads,
                    const Companions& companions) {
    const SortMemory memory{lanes_, lane_length_};
    sorter_.find_order(own, CellFinder<Places>{places, geometry_, anchor_},
                       static_cast<std::size_t>(geometry_.n_columns), n_threads, cell_start_,
                       memory);
    if (companions.columns) sort_columns(*companions.columns, memory.order(), n_threads);
    const auto place_flight = [&](std::size_t i) {
        if (has_flights_) place(places, lanes_.data() + i, lane_length_, own[i]);
    };
    if (!sorter_.share_out_travellers()) {
        sorter_.rearrange({own, companions.states}, memory);
#pragma omp parallel for num_threads(n_threads) schedule(static)
        for (std::size_t i = 0; i < n_own_; ++i) place_flight(i);
        return;
    }
    if (!companions.states.empty()) sorter_.carry(companions.states, memory, [](std::size_t) {});
    sorter_.carry(own, memory, place_flight);
}

void CellGrid::add_halo(std::span<const DiscState> halo, int n_threads) {
    constexpr std::size_t least_for_threads = 4096;
    with_places(periods_, [&](const auto& places) {
        add_halo(places, halo, halo.size() < least_for_threads ? 1 : n_threads);
    });
}

template <class Places>
void CellGrid::add_halo(const Places& places, std::span<const DiscState> halo, int n_threads) {
    halo_.begin(halo.size(), geometry_.n_columns);
    if (halo.empty()) return;
    const CellFinder<Places> finder{places, geometry_, anchor_};
#pragma omp parallel for num_threads(n_threads) schedule(static)
    for (std::size_t i = 0; i < halo.size(); ++i) {
        const Cell cell = finder.cell_of(halo[i]);
        halo_.set_cell(i, cell.column, cell.row);
    }
    halo_.sort(rows(), n_threads);
    if (!has_flights_) return;
    const std::size_t length = halo.size() + filter_padding;
    halo_lanes_.resize(4 * length);
#pragma omp parallel for num_threads(n_threads) schedule(static)
    for (std::size_t slot = 0; slot < halo.size(); ++slot)
        place(places, halo_lanes_.data() + slot, length,
              halo[halo_.disc_in(static_cast<std::uint32_t>(slot))]);
    pad(halo_lanes_, length);
}

template <class Places>
void CellGrid::update(const Places& places, LocalIndex index, const DiscState& disc) {
    if (index < n_own_)
        place(places, lanes_.data() + index, lane_length_, disc);
    else
        place(places, halo_lanes_.data() + halo_slot(index), halo_.size() + filter_padding, disc);
}

void CellGrid::update_flight(LocalIndex index, const DiscState& disc) {
    update(StoredPlaces{}, index, disc);
}

void CellGrid::update_flight_of_image(LocalIndex index, const DiscState& disc) {
    with_places(periods_, [&](const auto& places) { update(places, index, disc); });
}

void CellGrid::set_apart(double speed) {
    const double flight = speed * duration_ * geometry_.cells_per_length();
    const auto longest = static_cast<float>(flight * flight);
    std::vector<float> kept; // four numbers for each disc
    float longest_squared = 0;
    const auto take_apart = [&](auto& lanes, std::size_t length, std::size_t n_slots,
                                const auto& index_of) {
        if (n_slots == 0) return;
        float *x = lanes.data(), *y = x + length, *vx = y + length, *vy = vx + length;
        for (std::size_t slot = 0; slot < n_slots; ++slot) {
            const float squared = vx[slot] * vx[slot] + vy[slot] * vy[slot];
            if (!(squared > longest)) continue;
            longest_squared = std::max(longest_squared, squared);
            apart_.push_back(index_of(static_cast<std::uint32_t>(slot)));
            kept.insert(kept.end(), {x[slot], y[slot], vx[slot], vy[slot]});
            // Puts this flight far from all others, moving away from them, because the filter does
            // not reject pairs with zero relative velocity.
            x[slot] = y[slot] = 1e6f * static_cast<float>(apart_.size());
            vx[slot] = vy[slot] = 1e3f * static_cast<float>(apart_.size());
        }
    };
    take_apart(lanes_, lane_length_, n_own_, [](std::uint32_t slot) { return LocalIndex{slot}; });
    take_apart(halo_lanes_, halo_.size() + filter_padding, halo_.size(),
               [this](std::uint32_t slot) { return halo_index(slot); });
    longest_flight_ = std::sqrt(static_cast<double>(longest_squared));
    const std::size_t apart_length = apart_.size() + filter_padding;
    apart_lanes_.assign(4 * apart_length, 0.0f);
    for (std::size_t k = 0; k < apart_.size(); ++k) {
        for (std::size_t lane = 0; lane < 4; ++lane)
            apart_lanes_[lane * apart_length + k] = kept[4 * k + lane];
    }
}

CellGrid::Cell CellGrid::cell_of(LocalIndex own_index) const {
    const auto behind = std::upper_bound(cell_start_.begin(), cell_start_.end(), own_index);
    const auto cell = static_cast<int>(behind - cell_start_.begin() - 1);
    return {cell / geometry_.n_rows, cell % geometry_.n_rows};
}

std::vector<SlotRange> CellGrid::outside(const Inside& inner) const {
    constexpr double margin = 1e-6; // because the edges of cells are rounded
    const auto corner = turned(geometry_.axis, geometry_.low, geometry_.across_low);
    // Returns those of n cells in a line from `origin` that lie within low .. high. The first and
    // the last cell also contain discs from outside of the grid, so each is left out if the bound
    // on its side is finite.
    const auto cells_within = [this](double low, double high, double origin, int n) {
        const double from = (low - origin) / geometry_.cell_width + margin,
                     to = (high - origin) / geometry_.cell_width - margin;
        SlotRange cells;
        cells.begin = static_cast<std::uint32_t>(
            low == -infinity ? 0 : std::clamp(std::floor(from) + 1, 1.0, static_cast<double>(n)));
        cells.end = static_cast<std::uint32_t>(
            high == infinity ? n : std::clamp(std::floor(to), 0.0, n - 1.0));
        return cells;
    };
    const SlotRange in_x = cells_within(inner.x_low, inner.x_high, corner.first,
                                        geometry_.axis == Axis::x ? geometry_.n_columns
                                                                  : geometry_.n_rows);
    const SlotRange in_y = cells_within(inner.y_low, inner.y_high, corner.second,
                                        geometry_.axis == Axis::x ? geometry_.n_rows
                                                                  : geometry_.n_columns);
    const auto [columns, inner_rows] = turned(geometry_.axis, in_x, in_y);
    const auto n_own = static_cast<std::uint32_t>(n_own_);
    if (columns.begin >= columns.end || inner_rows.begin >= inner_rows.end) return {{0, n_own}};
    std::vector<SlotRange> ranges;
    std::uint32_t begin = 0;
    for (std::uint32_t column = columns.begin; column < columns.end; ++column) {
        ranges.push_back({begin, cell_start_[column * std::size_t{rows()} + inner_rows.begin]});
        begin = cell_start_[column * std::size_t{rows()} + inner_rows.end];
    }
    ranges.push_back({begin, n_own});
    std::erase_if(ranges, [](SlotRange range) { return range.begin >= range.end; });
    return ranges;
}

std::vector<std::int64_t> CellGrid::column_shares(int n_shares) const {
    std::vector<std::int64_t> bounds;
    int column = 0;
    for (int k = 0; k < n_shares; ++k) {
        const std::size_t before = share(n_own_, static_cast<std::size_t>(k),
                                         static_cast<std::size_t>(n_shares));
        while (column < geometry_.n_columns &&
               cell_start_[static_cast<std::size_t>(column) * rows()] < before)
            ++column;
        bounds.push_back(column);
    }
    bounds.push_back(geometry_.n_columns);
    return bounds;
}

float CellGrid::touching_squared(double diameter) const {
    // Single precision gives positions and velocities errors of 2^-24 of the grid's size. The
    // filter itself allows for the rounding in its own computation.
    const double extent = std::max(geometry_.n_columns, geometry_.n_rows) +
                          4.0 * std::max<double>(geometry_.n_reach, longest_flight_);
    const double touching = diameter / geometry_.cell_width * (1 + 0x1p-18) + 0x1p-21 * extent;
    return static_cast<float>(touching * touching);
}

float CellGrid::cells_of(double length) const {
    return static_cast<float>(length / geometry_.cell_width * (1 + 0x1p-18) +
                              0x1p-20 * (std::max(geometry_.n_columns, geometry_.n_rows) + 8));
}

bool CellGrid::is_valid(std::size_t n_discs) const {
    if (cell_start_.back() != n_own_ || n_own_ + halo_.size() != n_discs) return false;
    return std::is_sorted(cell_start_.begin(), cell_start_.end()) && halo_.is_valid();
}

} // namespace carrom
