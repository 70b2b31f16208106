// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/collision/cell_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "carrom/core/errors.hpp"

namespace carrom {

namespace {

/// Cells are no narrower than so many mean distances of discs: smaller ones save no time, and each takes 4 bytes.
constexpr double least_spacings = 1.15;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// First index of the `part`-th of `n_parts` equal shares of n.
std::size_t share(std::size_t n, std::size_t part, std::size_t n_parts) { return n * part / n_parts; }

/// Windows of many lengths have cells of many sizes: memory of the smallest ones is not kept for all, and a few more cells than
/// last time do not take twice the memory. What was in `numbers` may be gone.
template <class T> void resize_close(std::vector<T>& numbers, std::size_t size) {
    if (numbers.capacity() < size || numbers.capacity() > size + size / 2) {
        std::vector<T>().swap(numbers);
        numbers.reserve(size + size / 8);
    }
    numbers.resize(size);
}

/// Whole numbers where flights will be: what sorts discs needs no memory of its own.
class Lent {
public:
    explicit Lent(float* at) : at_(at) {}
    std::uint32_t operator[](std::size_t k) const {
        std::uint32_t number = 0;
        std::memcpy(&number, at_ + k, sizeof number);
        return number;
    }
    void set(std::size_t k, std::uint32_t number) { std::memcpy(at_ + k, &number, sizeof number); }

private:
    float* at_;
};

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
    frame.set_cell_width(std::max(wanted, least_spacings * sparse_width));
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

void CellGrid::sort(std::span<Disc> own, const GridFrame& frame, double anchor, double time, double duration, int n_threads,
                    const Periods& periods, const Companions& companions) {
    frame_ = frame;
    periods_ = periods;
    anchor_ = anchor;
    time_ = time;
    duration_ = duration;
    has_flights_ = true;
    sort(own, n_threads, companions);
    for (std::size_t lane = 1; lane <= 4; ++lane) {
        std::fill_n(lanes_.begin() + static_cast<std::ptrdiff_t>(lane * lane_length_ - filter_padding), filter_padding, 0.0f);
    }
}

void CellGrid::sort_cells(std::span<Disc> own, const GridFrame& frame, double time, int n_threads, const Periods& periods,
                          const Companions& companions) {
    frame_ = frame;
    periods_ = periods;
    anchor_ = time;
    has_flights_ = false;
    sort(own, n_threads, companions);
}

void CellGrid::sort(std::span<Disc> own, int n_threads, const Companions& companions) {
    ensure(companions.states.empty() || companions.states.size() == own.size(), "what goes with the own discs is as many");
    ensure(companions.spins.empty() || companions.spins.size() == own.size(), "there are as many spins as own discs");
    apart_.clear();
    longest_flight_ = 0;
    halo_order_.clear();
    n_own_ = own.size();
    lane_length_ = n_own_ + filter_padding;
    resize_close(lanes_, (has_flights_ ? 4 : 2) * lane_length_);
    resize_close(cell_start_, static_cast<std::size_t>(frame_.n_columns) * rows() + 1);
    if (periods_.are_any()) sort(periods_, own, n_threads, companions);
    else sort(StoredPlaces{}, own, n_threads, companions);
}

/// First which disc goes where, in the second of the lanes; then they go. Nearly all come from near by: a pass over the discs.
template <class Places>
void CellGrid::sort(const Places& places, std::span<Disc> own, int n_threads, const Companions& companions) {
    begin_order(n_threads);
    if (n_threads == 1) order_alone(places, own);
    else order_together(places, own, n_threads);
    if (!share_out_travellers()) return rearrange(places, own, n_threads, companions);
    const Lent order(lanes_.data() + lane_length_);
    if (!companions.spins.empty()) {
        const std::vector<double> before(companions.spins.begin(), companions.spins.end());
        for (std::size_t i = 0; i < n_own_; ++i) companions.spins[i] = before[order[i]];
    }
    const auto place_flight = [&](std::size_t i) {
        if (has_flights_) place(places, lanes_.data() + i, lane_length_, own[i]); // the order up to here has been used
    };
    if (!companions.states.empty()) {
        set_travellers_aside(companions.states, n_threads);
        carry(companions.states, n_threads, [](std::size_t) {});
    }
    set_travellers_aside(own, n_threads);
    carry(own, n_threads, place_flight);
}

void CellGrid::begin_order(int n_threads) {
    constexpr std::size_t least_passed = 256, most_passed = 32768, columns_passed = 4;
    const std::size_t in_columns = columns_passed * n_own_ / static_cast<std::size_t>(frame_.n_columns);
    n_passed_ = std::bit_ceil(std::clamp(in_columns, least_passed, most_passed));
    most_travellers_ = 4096 + n_own_ / (64 * static_cast<std::size_t>(n_threads));
    are_in_disorder_ = false;
    carriers_.resize(static_cast<std::size_t>(n_threads));
    for (Carrier& carrier : carriers_) carrier.sent.clear();
}

/// A disc whose place another thread sees to, or that will have been passed so long ago that it is not at hand any more.
void CellGrid::note_traveller(Carrier& carrier, std::uint32_t place) {
    if (carrier.sent.size() <= most_travellers_) carrier.sent.push_back(place);
}

template <class Places> std::uint32_t CellGrid::cell_at(const Places& places, const Disc& disc) const {
    const auto column = static_cast<std::uint32_t>(frame_.column_of(places.x_of(disc, anchor_)));
    const auto row = static_cast<std::uint32_t>(frame_.row_of(places.y_of(disc, anchor_)));
    return column * rows() + row;
}

// One counting sort: states are read in the order in which they lie.
template <class Places> void CellGrid::order_alone(const Places& places, std::span<const Disc> own) {
    Lent cell_of(lanes_.data()), order(lanes_.data() + lane_length_);
    std::fill(cell_start_.begin(), cell_start_.end(), 0u);
    std::uint32_t* next = cell_start_.data() + 1; // by cell: how many discs, then the place of the next one
    for (std::size_t i = 0; i < own.size(); ++i) {
        const std::uint32_t cell = cell_at(places, own[i]);
        cell_of.set(i, cell);
        ++next[cell];
    }
    std::uint32_t start = 0;
    for (std::size_t cell = 0; cell + 1 < cell_start_.size(); ++cell) {
        const std::uint32_t count = next[cell];
        next[cell] = start;
        start += count;
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
        const std::uint32_t place = next[cell_of[i]]++;
        order.set(place, static_cast<std::uint32_t>(i));
        if (i + n_passed_ <= place) note_traveller(carriers_[0], place);
    }
}

// The same by several threads: each sorter counts only between the first and the last cell of its share of the discs. Those lie
// nearly in the order of their cells, so all counts together are not many more than there are cells.
template <class Places> void CellGrid::order_together(const Places& places, std::span<const Disc> own, int n_threads) {
    Lent cell_of(lanes_.data()), order(lanes_.data() + lane_length_);
    const std::size_t n_cells = cell_start_.size() - 1;
    share_out(own.size(), n_threads);
#pragma omp parallel for num_threads(n_threads) schedule(static, 1)
    for (std::size_t k = 0; k < sorters_.size(); ++k) {
        Sorter& sorter = sorters_[k];
        std::uint32_t first = ~std::uint32_t{0}, last = 0;
        for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) {
            const std::uint32_t cell = cell_at(places, own[i]);
            cell_of.set(i, cell);
            first = std::min(first, cell);
            last = std::max(last, cell);
        }
        sorter.first_cell = std::min(first, last);
        sorter.end_cell = last + 1;
    }
    are_in_disorder_ = !make_room_for_counts(n_cells);
    const auto n_shares = static_cast<std::size_t>(n_threads);
    std::vector<std::uint32_t> starts(n_shares + 1, 0); // of shares of the cells
#pragma omp parallel num_threads(n_threads)
    {
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < sorters_.size(); ++k) {
            const Sorter& sorter = sorters_[k];
            std::fill_n(counts_.begin() + static_cast<std::ptrdiff_t>(sorter.counts), sorter.end_cell - sorter.first_cell, 0u);
            std::uint32_t* const counts = counts_.data() + sorter.counts;
            for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) ++counts[cell_of[i] - sorter.first_cell];
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
            std::uint32_t start = starts[k]; // each count becomes the place of the sorter's next disc there
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
                const std::uint32_t place = next[cell_of[i] - sorter.first_cell]++;
                order.set(place, static_cast<std::uint32_t>(i));
                const bool is_near = place >= sorter.first_disc && place < sorter.end_disc && place < i + n_passed_;
                if (!is_near && !are_in_disorder_) note_traveller(carriers_[k], place);
            }
        }
    }
    cell_start_[n_cells] = static_cast<std::uint32_t>(own.size());
}

void CellGrid::share_out(std::size_t n_discs, int n_sorters) {
    const auto n = static_cast<std::size_t>(n_sorters);
    sorters_.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
        sorters_[k].first_disc = share(n_discs, k, n);
        sorters_[k].end_disc = share(n_discs, k + 1, n);
    }
}

/// Discs in no order have all sorters count in all cells: then only a few of them work, and it returns false.
bool CellGrid::make_room_for_counts(std::size_t n_cells) {
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
    const bool are_too_many = n_counts > most_counting_all * n_cells;
    if (are_too_many) {
        share_out(n_own_, most_counting_all);
        for (Sorter& sorter : sorters_) {
            sorter.first_cell = 0;
            sorter.end_cell = static_cast<std::uint32_t>(n_cells);
        }
        n_counts = lay_out();
    }
    resize_close(counts_, n_counts);
    return !are_too_many;
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

/// Tells each share which of its places are travellers'. False if they are many: these discs are in no order yet.
bool CellGrid::share_out_travellers() {
    std::vector<LocalIndex> all;
    for (const Carrier& carrier : carriers_) {
        if (carrier.sent.size() > most_travellers_) are_in_disorder_ = true;
        if (are_in_disorder_) return false;
        all.insert(all.end(), carrier.sent.begin(), carrier.sent.end());
    }
    std::sort(all.begin(), all.end());
    auto begin = all.begin();
    for (std::size_t k = 0; k < carriers_.size(); ++k) {
        const auto end = std::lower_bound(begin, all.end(), share(n_own_, k + 1, carriers_.size()));
        carriers_[k].arrivals.assign(begin, end);
        carriers_[k].arrivals.push_back(std::numeric_limits<LocalIndex>::max());
        begin = end;
    }
    return true;
}

void CellGrid::set_travellers_aside(std::span<const Disc> discs, int n_threads) {
    const Lent order(lanes_.data() + lane_length_);
#pragma omp parallel for num_threads(n_threads) schedule(static, 1)
    for (std::size_t k = 0; k < carriers_.size(); ++k) {
        Carrier& carrier = carriers_[k];
        carrier.passed.resize(n_passed_);
        carrier.travellers.clear();
        carrier.travellers.reserve(carrier.arrivals.size());
        for (std::size_t j = 0; j + 1 < carrier.arrivals.size(); ++j) carrier.travellers.push_back(discs[order[carrier.arrivals[j]]]);
    }
}

/// Brings discs to their places, ascending: each comes from further on, from those passed lately, or has been set aside. Calls
/// placed(i) when the disc of place i is there.
template <class Placed> void CellGrid::carry(std::span<Disc> discs, int n_threads, const Placed& placed) {
    constexpr std::size_t ahead = 16;
    const Lent order(lanes_.data() + lane_length_);
    const std::size_t n_shares = carriers_.size(), mask = n_passed_ - 1;
#pragma omp parallel for num_threads(n_threads) schedule(static, 1)
    for (std::size_t k = 0; k < n_shares; ++k) {
        Disc* const at = discs.data();
        Disc* const passed = carriers_[k].passed.data();
        const Disc* traveller = carriers_[k].travellers.data();
        const LocalIndex* arrival = carriers_[k].arrivals.data();
        const std::size_t end = share(n_own_, k + 1, n_shares);
        for (std::size_t i = share(n_own_, k, n_shares); i < end; ++i) {
            __builtin_prefetch(at + order[std::min(i + ahead, end - 1)]);
            const std::size_t from = order[i];
            const Disc* source = from >= i ? at + from : passed + (from & mask);
            if (i == *arrival) [[unlikely]] {
                source = traveller++;
                ++arrival;
            }
            if (source != at + i) {
                passed[i & mask] = at[i];
                at[i] = *source;
            }
            placed(i);
        }
    }
}

/// The same for discs in no order.
template <class Places>
void CellGrid::rearrange(const Places& places, std::span<Disc> own, int n_threads, const Companions& companions) {
    std::vector<std::uint32_t> order(n_own_);
    std::memcpy(order.data(), lanes_.data() + lane_length_, n_own_ * sizeof(std::uint32_t));
    if (!companions.spins.empty()) {
        const std::vector<double> before(companions.spins.begin(), companions.spins.end());
        for (std::size_t i = 0; i < n_own_; ++i) companions.spins[i] = before[order[i]];
    }
    // A quarter of each state at a time goes through the lanes, so that no second array of states is needed.
    constexpr std::size_t quarter = sizeof(Disc) / 4;
    static_assert(quarter == 4 * sizeof(float));
    resize_close(lanes_, 4 * lane_length_);
    auto* lent = reinterpret_cast<std::byte*>(lanes_.data());
    const auto n = static_cast<std::int64_t>(n_own_);
    for (const std::span<Disc> discs : {own, companions.states}) {
        if (discs.empty()) continue;
        auto* states = reinterpret_cast<std::byte*>(discs.data());
#pragma omp parallel num_threads(n_threads)
        for (std::size_t part = 0; part < 4; ++part) {
#pragma omp for schedule(static)
            for (std::int64_t k = 0; k < n; ++k) {
                const auto slot = static_cast<std::size_t>(k);
                std::memcpy(lent + slot * quarter, states + order[slot] * sizeof(Disc) + part * quarter, quarter);
            }
#pragma omp for schedule(static)
            for (std::int64_t k = 0; k < n; ++k) {
                const auto slot = static_cast<std::size_t>(k);
                std::memcpy(states + slot * sizeof(Disc) + part * quarter, lent + slot * quarter, quarter);
            }
        }
    }
    if (!has_flights_) return;
#pragma omp parallel for num_threads(n_threads) schedule(static)
    for (std::int64_t k = 0; k < n; ++k) {
        const auto slot = static_cast<std::size_t>(k);
        place(places, lanes_.data() + slot, lane_length_, own[slot]);
    }
}

void CellGrid::add_halo(std::span<const Disc> halo) {
    if (periods_.are_any()) add_halo(periods_, halo);
    else add_halo(StoredPlaces{}, halo);
}

/// A counting sort over the cells of those columns that hold any of them.
template <class Places> void CellGrid::add_halo(const Places& places, std::span<const Disc> halo) {
    halo_order_.resize(halo.size());
    halo_slot_.resize(halo.size());
    if (halo.empty()) return;
    halo_column_.assign(static_cast<std::size_t>(frame_.n_columns), no_halo);
    for (std::size_t i = 0; i < halo.size(); ++i) {
        halo_slot_[i] = cell_at(places, halo[i]); // for now
        halo_column_[halo_slot_[i] / rows()] = 0;
    }
    std::uint32_t n_cells = 0;
    for (std::uint32_t& column : halo_column_) {
        if (column != no_halo) column = std::exchange(n_cells, n_cells + rows());
    }
    halo_start_.assign(std::size_t{n_cells} + 1, 0);
    std::uint32_t* next = halo_start_.data() + 1;
    for (std::uint32_t& cell : halo_slot_) {
        cell = halo_column_[cell / rows()] + cell % rows();
        ++next[cell];
    }
    std::uint32_t start = 0;
    for (std::size_t cell = 0; cell < n_cells; ++cell) start += std::exchange(next[cell], start);
    const std::size_t length = halo.size() + filter_padding;
    if (has_flights_) halo_lanes_.assign(4 * length, 0.0f);
    for (std::size_t i = 0; i < halo.size(); ++i) {
        const std::uint32_t slot = next[halo_slot_[i]]++;
        halo_order_[slot] = static_cast<LocalIndex>(i);
        halo_slot_[i] = slot;
        if (has_flights_) place(places, halo_lanes_.data() + slot, length, halo[i]);
    }
}

template <class Places> void CellGrid::place(const Places& places, float* flight, std::size_t length, const Disc& disc) const {
    const double cells = frame_.cells_per_length();
    flight[0] = static_cast<float>((places.x_of(disc, time_) - frame_.x_low) * cells);
    flight[length] = static_cast<float>((places.y_of(disc, time_) - frame_.y_low) * cells);
    flight[2 * length] = static_cast<float>(disc.vx * duration_ * cells);
    flight[3 * length] = static_cast<float>(disc.vy * duration_ * cells);
}

template <class Places> void CellGrid::update(const Places& places, LocalIndex index, const Disc& disc) {
    if (index < n_own_) place(places, lanes_.data() + index, lane_length_, disc);
    else place(places, halo_lanes_.data() + halo_slot(index), halo_order_.size() + filter_padding, disc);
}

void CellGrid::update_flight(LocalIndex index, const Disc& disc) { update(StoredPlaces{}, index, disc); }

void CellGrid::update_flight_of_image(LocalIndex index, const Disc& disc) { update(periods_, index, disc); }

void CellGrid::set_apart(double speed) {
    const double flight = speed * duration_ * frame_.cells_per_length();
    const auto longest = static_cast<float>(flight * flight);
    std::vector<float> kept; // four numbers a disc
    float longest_squared = 0;
    const auto look_through = [&](std::vector<float>& lanes, std::size_t length, std::size_t n_slots, const auto& index_of) {
        if (n_slots == 0) return;
        float *x = lanes.data(), *y = x + length, *vx = y + length, *vy = vx + length;
        for (std::size_t slot = 0; slot < n_slots; ++slot) {
            const float squared = vx[slot] * vx[slot] + vy[slot] * vy[slot];
            if (!(squared > longest)) continue;
            longest_squared = std::max(longest_squared, squared);
            apart_.push_back(index_of(static_cast<std::uint32_t>(slot)));
            kept.insert(kept.end(), {x[slot], y[slot], vx[slot], vy[slot]});
            // Far from everybody and from each other, and flying away: the filter keeps pairs without relative velocity.
            x[slot] = y[slot] = 1e6f * static_cast<float>(apart_.size());
            vx[slot] = vy[slot] = 1e3f * static_cast<float>(apart_.size());
        }
    };
    look_through(lanes_, lane_length_, n_own_, [](std::uint32_t slot) { return LocalIndex{slot}; });
    look_through(halo_lanes_, halo_order_.size() + filter_padding, halo_order_.size(), [this](std::uint32_t slot) { return halo_index(slot); });
    longest_flight_ = std::sqrt(static_cast<double>(longest_squared));
    const std::size_t apart_length = apart_.size() + filter_padding;
    apart_lanes_.assign(4 * apart_length, 0.0f);
    for (std::size_t k = 0; k < apart_.size(); ++k) {
        for (std::size_t lane = 0; lane < 4; ++lane) apart_lanes_[lane * apart_length + k] = kept[4 * k + lane];
    }
}

CellGrid::Cell CellGrid::cell_of(LocalIndex own_index) const {
    const auto behind = std::upper_bound(cell_start_.begin(), cell_start_.end(), own_index);
    const auto cell = static_cast<int>(behind - cell_start_.begin() - 1);
    return {cell / frame_.n_rows, cell % frame_.n_rows};
}

std::vector<SlotRange> CellGrid::outside(const Inside& inner) const {
    constexpr double margin = 1e-6; // where a cell ends is rounded
    // Cells first .. end - 1 of n from `origin` on lie within low .. high; those at the ends hold what is beyond them, too.
    const auto cells_within = [this](double low, double high, double origin, int n) {
        const double from = (low - origin) / frame_.cell_width + margin, to = (high - origin) / frame_.cell_width - margin;
        SlotRange cells;
        cells.begin = static_cast<std::uint32_t>(low == -infinity ? 0 : std::clamp(std::floor(from) + 1, 1.0, static_cast<double>(n)));
        cells.end = static_cast<std::uint32_t>(high == infinity ? n : std::clamp(std::floor(to), 0.0, n - 1.0));
        return cells;
    };
    const SlotRange columns = cells_within(inner.x_low, inner.x_high, frame_.x_low, frame_.n_columns);
    const SlotRange inner_rows = cells_within(inner.y_low, inner.y_high, frame_.y_low, frame_.n_rows);
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
        const std::size_t before = share(n_own_, static_cast<std::size_t>(k), static_cast<std::size_t>(n_shares));
        while (column < frame_.n_columns && cell_start_[static_cast<std::size_t>(column) * rows()] < before) ++column;
        bounds.push_back(column);
    }
    bounds.push_back(frame_.n_columns);
    return bounds;
}

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
    return sizeof(float) * (lanes_.capacity() + halo_lanes_.capacity()) +
           sizeof(std::uint32_t) * (cell_start_.capacity() + counts_.capacity() + halo_column_.capacity() + halo_start_.capacity() +
                                    halo_order_.capacity() + halo_slot_.capacity());
}

bool CellGrid::is_valid(std::size_t n_discs) const {
    if (cell_start_.back() != n_own_ || n_own_ + halo_order_.size() != n_discs) return false;
    for (std::size_t slot = 0; slot < halo_order_.size(); ++slot)
        if (halo_slot_[halo_order_[slot]] != slot) return false;
    return std::is_sorted(cell_start_.begin(), cell_start_.end()) && (!has_halo() || std::is_sorted(halo_start_.begin(), halo_start_.end()));
}

} // namespace carrom
