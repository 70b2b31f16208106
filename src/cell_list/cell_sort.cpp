// SPDX-License-Identifier: BSD-3-Clause
// Bringing own discs into the order of their cells, in place.
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "cell_list/cell_places.hpp"
#include "core/errors.hpp"

namespace carrom {

namespace {

/// Windows of many lengths have cells of many sizes: memory of the smallest ones is not kept for
/// all, and a few more cells than last time do not take twice the memory. What was in `numbers` may
/// be gone.
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
    Lent from(std::size_t k) const { return Lent(at_ + k); }

private:
    float* at_;
};

} // namespace

void CellGrid::sort(std::span<Disc> own, const GridFrame& frame, double anchor, double time,
                    double duration, int n_threads, const Periods& periods,
                    const Companions& companions) {
    frame_ = frame;
    periods_ = periods;
    anchor_ = anchor;
    time_ = time;
    duration_ = duration;
    has_flights_ = true;
    sort(own, n_threads, companions);
    for (std::size_t lane = 1; lane <= 4; ++lane) {
        std::fill_n(lanes_.begin() +
                        static_cast<std::ptrdiff_t>(lane * lane_length_ - filter_padding),
                    filter_padding, 0.0f);
    }
}

void CellGrid::sort_cells(std::span<Disc> own, const GridFrame& frame, double time, int n_threads,
                          const Periods& periods, const Companions& companions) {
    frame_ = frame;
    periods_ = periods;
    anchor_ = time;
    has_flights_ = false;
    sort(own, n_threads, companions);
}

void CellGrid::sort(std::span<Disc> own, int n_threads, const Companions& companions) {
    ensure(companions.states.empty() || companions.states.size() == own.size(),
           "what goes with the own discs is as many");
    ensure(companions.spins.empty() || companions.spins.size() == own.size(),
           "there are as many spins as own discs");
    apart_.clear();
    longest_flight_ = 0;
    halo_order_.clear();
    n_own_ = own.size();
    lane_length_ = n_own_ + filter_padding;
    resize_close(lanes_, (has_flights_ ? 4 : 2) * lane_length_);
    resize_close(cell_start_, static_cast<std::size_t>(frame_.n_columns) * rows() + 1);
    if (periods_.are_any())
        sort(periods_, own, n_threads, companions);
    else
        sort(StoredPlaces{}, own, n_threads, companions);
}

/// First which disc goes where, in the second of the lanes; then they go. Nearly all come from near
/// by: a pass over the discs.
template <class Places>
void CellGrid::sort(const Places& places, std::span<Disc> own, int n_threads,
                    const Companions& companions) {
    begin_order(n_threads);
    if (n_threads == 1)
        order_alone(places, own);
    else
        order_together(places, own, n_threads);
    if (!companions.spins.empty()) {
        const Lent order(lanes_.data() + lane_length_);
        const std::vector<double> before(companions.spins.begin(), companions.spins.end());
        for (std::size_t i = 0; i < n_own_; ++i) companions.spins[i] = before[order[i]];
    }
    if (!share_out_travellers()) return rearrange(places, own, n_threads, companions.states);
    const auto place_flight = [&](std::size_t i) {
        if (has_flights_)
            place(places, lanes_.data() + i, lane_length_,
                  own[i]); // the order up to here has been used
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
    const std::size_t in_columns = columns_passed * n_own_ /
                                   static_cast<std::size_t>(frame_.n_columns);
    n_passed_ = std::bit_ceil(std::clamp(in_columns, least_passed, most_passed));
    most_travellers_ = 4096 + n_own_ / (64 * static_cast<std::size_t>(n_threads));
    are_in_disorder_ = false;
    carriers_.resize(static_cast<std::size_t>(n_threads));
    for (Carrier& carrier : carriers_) carrier.sent.clear();
}

/// A disc whose place another thread sees to, or that will have been passed so long ago that it is
/// not at hand any more.
void CellGrid::note_traveller(Carrier& carrier, std::uint32_t place) {
    if (carrier.sent.size() <= most_travellers_) carrier.sent.push_back(place);
}

// One counting sort: states are read in the order in which they lie.
template <class Places>
void CellGrid::order_alone(const Places& places, std::span<const Disc> own) {
    Lent cell_of(lanes_.data()), order(lanes_.data() + lane_length_);
    std::fill(cell_start_.begin(), cell_start_.end(), 0u);
    std::uint32_t* next = cell_start_.data() +
                          1; // by cell: how many discs, then the place of the next one
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

// The same by several threads: each sorter counts only between the first and the last cell of its
// share of the discs. Those lie nearly in the order of their cells, so all counts together are not
// many more than there are cells.
template <class Places>
void CellGrid::order_together(const Places& places, std::span<const Disc> own, int n_threads) {
    Lent cell_of(lanes_.data());
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
    cell_of = Lent(lanes_.data());
    Lent order(lanes_.data() + lane_length_), all_counts(lanes_.data() + 2 * lane_length_);
    const auto n_shares = static_cast<std::size_t>(n_threads);
    std::vector<std::uint32_t> starts(n_shares + 1, 0); // of shares of the cells
#pragma omp parallel num_threads(n_threads)
    {
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < sorters_.size(); ++k) {
            const Sorter& sorter = sorters_[k];
            Lent counts = all_counts.from(sorter.counts);
            for (std::uint32_t cell = sorter.first_cell; cell < sorter.end_cell; ++cell)
                counts.set(cell - sorter.first_cell, 0);
            for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) {
                const std::uint32_t place = cell_of[i] - sorter.first_cell;
                counts.set(place, counts[place] + 1);
            }
        }
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            std::uint32_t n_discs = 0;
            for_each_count(share(n_cells, k, n_shares), share(n_cells, k + 1, n_shares),
                           [&](std::size_t, std::size_t count) { n_discs += all_counts[count]; });
            starts[k + 1] = n_discs;
        }
#pragma omp single
        for (std::size_t k = 0; k < n_shares; ++k) starts[k + 1] += starts[k];
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            std::uint32_t start =
                starts[k]; // each count becomes the place of the sorter's next disc there
            const std::size_t begin = share(n_cells, k, n_shares),
                              end = share(n_cells, k + 1, n_shares);
            std::size_t next = begin;
            for_each_count(begin, end, [&](std::size_t cell, std::size_t count) {
                while (next <= cell) cell_start_[next++] = start;
                const std::uint32_t n = all_counts[count];
                all_counts.set(count, start);
                start += n;
            });
            while (next < end) cell_start_[next++] = start;
        }
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < sorters_.size(); ++k) {
            const Sorter& sorter = sorters_[k];
            Lent next = all_counts.from(sorter.counts);
            for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) {
                const std::uint32_t cell = cell_of[i] - sorter.first_cell, place = next[cell];
                next.set(cell, place + 1);
                order.set(place, static_cast<std::uint32_t>(i));
                const bool is_near = place >= sorter.first_disc && place < sorter.end_disc &&
                                     place < i + n_passed_;
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

/// Discs in no order have all sorters count in all cells: then only a few of them work, and it
/// returns false.
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
    if (lanes_.size() < 2 * lane_length_ + n_counts) lanes_.resize(2 * lane_length_ + n_counts);
    return !are_too_many;
}

/// Calls visit(cell, place of the count) for all sorters' counts of the cells begin .. end, cell by
/// cell.
template <class Visit>
void CellGrid::for_each_count(std::size_t begin, std::size_t end, const Visit& visit) const {
    std::vector<Sorter> here;
    for (const Sorter& sorter : sorters_)
        if (sorter.first_cell < end && sorter.end_cell > begin) here.push_back(sorter);
    const auto counts_in = [](const Sorter& sorter, std::size_t cell) {
        return sorter.first_cell <= cell && cell < sorter.end_cell;
    };
    for (std::size_t cell = begin;
         cell < end;) { // up to where another sorter begins or ends, mostly one counts
        std::size_t stretch_end = end;
        const Sorter* one = nullptr;
        std::size_t n_here = 0;
        for (const Sorter& sorter : here) {
            if (sorter.first_cell > cell)
                stretch_end = std::min<std::size_t>(stretch_end, sorter.first_cell);
            if (sorter.end_cell > cell)
                stretch_end = std::min<std::size_t>(stretch_end, sorter.end_cell);
            if (!counts_in(sorter, cell)) continue;
            one = &sorter;
            ++n_here;
        }
        if (n_here == 1) {
            for (std::size_t count = one->counts + (cell - one->first_cell); cell < stretch_end;
                 ++cell, ++count)
                visit(cell, count);
        }
        for (; cell < stretch_end; ++cell) {
            for (const Sorter& sorter : here)
                if (counts_in(sorter, cell))
                    visit(cell, sorter.counts + (cell - sorter.first_cell));
        }
    }
}

/// Tells each share which of its places are travellers'. False if they are many: these discs are in
/// no order yet.
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
        for (std::size_t j = 0; j + 1 < carrier.arrivals.size(); ++j)
            carrier.travellers.push_back(discs[order[carrier.arrivals[j]]]);
    }
}

/// Brings discs to their places, ascending: each comes from further on, from those passed lately,
/// or has been set aside. Calls placed(i) when the disc of place i is there.
template <class Placed>
void CellGrid::carry(std::span<Disc> discs, int n_threads, const Placed& placed) {
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
void CellGrid::rearrange(const Places& places, std::span<Disc> own, int n_threads,
                         std::span<Disc> companion) {
    std::vector<std::uint32_t> order(n_own_);
    std::memcpy(order.data(), lanes_.data() + lane_length_, n_own_ * sizeof(std::uint32_t));
    // A quarter of each state at a time goes through the lanes, so that no second array of states
    // is needed.
    constexpr std::size_t quarter = sizeof(Disc) / 4;
    static_assert(quarter == 4 * sizeof(float));
    resize_close(lanes_, 4 * lane_length_);
    auto* lent = reinterpret_cast<std::byte*>(lanes_.data());
    const auto n = static_cast<std::int64_t>(n_own_);
    for (const std::span<Disc> discs : {own, companion}) {
        if (discs.empty()) continue;
        auto* states = reinterpret_cast<std::byte*>(discs.data());
#pragma omp parallel num_threads(n_threads)
        for (std::size_t part = 0; part < 4; ++part) {
#pragma omp for schedule(static)
            for (std::int64_t k = 0; k < n; ++k) {
                const auto slot = static_cast<std::size_t>(k);
                std::memcpy(lent + slot * quarter,
                            states + order[slot] * sizeof(Disc) + part * quarter, quarter);
            }
#pragma omp for schedule(static)
            for (std::int64_t k = 0; k < n; ++k) {
                const auto slot = static_cast<std::size_t>(k);
                std::memcpy(states + slot * sizeof(Disc) + part * quarter, lent + slot * quarter,
                            quarter);
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

} // namespace carrom
