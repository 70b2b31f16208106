// SPDX-License-Identifier: BSD-3-Clause
// Brings discs into the order of their cells, in place.
//
// A counting sort finds which disc goes where. Then one pass over the discs moves them: nearly all
// come from a place a little ahead or a little behind. The few that come from farther away are
// copied beforehand. Price: two passes. The sorter works in the memory of the flights, which are
// written afterwards, so it needs no memory of its own.
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <vector>

#include "core/disc_state.hpp"
#include "core/raw_vector.hpp"

namespace carrom {

/// Stores whole numbers in memory that belongs to floats.
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

/// The memory that sorting borrows: lanes of `lane_length` numbers. The first lane
/// holds each disc's cell, the second the order, and the rest holds counts.
struct SortMemory {
    RawVector<float>& lanes;
    std::size_t lane_length = 0;

    Lent cells() const { return Lent(lanes.data()); }
    Lent order() const { return Lent(lanes.data() + lane_length); }
    Lent counts() const { return Lent(lanes.data() + 2 * lane_length); }
};

class DiscSorter {
public:
    /// Sorts `discs` by `find_cell(disc)`, a number below the count of cells. Writes
    /// which disc goes where to `memory.order()`, and the first place of each cell,
    /// and the end, to `cell_start`. `n_columns` is the number of stretches of cells.
    template <class CellOf>
    void find_order(std::span<const DiscState> discs, const CellOf& find_cell,
                    std::size_t n_columns, int n_threads, RawVector<std::uint32_t>& cell_start,
                    SortMemory memory) {
        begin(discs.size(), n_columns, n_threads);
        if (n_threads == 1)
            order_alone(discs, find_cell, cell_start, memory);
        else
            order_together(discs, find_cell, cell_start, memory);
    }

    /// Gives each thread the travellers among its places. Returns false if there are many: then the
    /// discs are not nearly sorted, and `rearrange` is faster.
    bool share_out_travellers();
    /// Brings discs to their places, in ascending order. Calls placed(i) when the disc of place i
    /// is there. From then on the order up to i is not needed.
    template <class Placed>
    void carry(std::span<DiscState> discs, SortMemory memory, const Placed& placed) {
        set_travellers_aside(discs, memory);
        bring(discs, memory, placed);
    }
    /// Sorts discs that are not nearly sorted, in each of the arrays that are not empty.
    void rearrange(std::initializer_list<std::span<DiscState>> arrays, SortMemory memory);

private:
    /// A share of the discs, which lie in the cells first .. end, and where its counts
    /// begin.
    struct Sorter {
        std::size_t first_disc = 0, end_disc = 0;
        std::uint32_t first_cell = 0, end_cell = 0;
        std::size_t counts = 0;
    };
    /// The state of a thread while it brings its share of the places into order.
    struct Carrier {
        DiscStates passed;     ///< a ring buffer of the discs whose places were just overwritten
        DiscStates travellers; ///< discs that move far, copied beforehand
        std::vector<LocalIndex> arrivals; ///< their new places, ascending, with an end
        /// New places of travellers that go to other threads, unsorted
        std::vector<LocalIndex> sent;
    };

    void begin(std::size_t n_discs, std::size_t n_columns, int n_threads);
    template <class CellOf>
    void order_alone(std::span<const DiscState> discs, const CellOf& find_cell,
                     RawVector<std::uint32_t>& cell_start, SortMemory memory);
    template <class CellOf>
    void order_together(std::span<const DiscState> discs, const CellOf& find_cell,
                        RawVector<std::uint32_t>& cell_start, SortMemory memory);
    template <class CellOf>
    void find_cells(std::span<const DiscState> discs, const CellOf& find_cell, SortMemory memory);
    void turn_into_places(RawVector<std::uint32_t>& cell_start, Lent all_counts);
    void share_out(std::size_t n_discs, std::size_t n_sorters);
    bool make_room_for_counts(std::size_t n_cells, SortMemory memory);
    template <class Visit>
    void for_each_count(std::size_t begin, std::size_t end, const Visit& visit) const;
    /// Records a disc whose new place belongs to another thread, or whose disc has already left the
    /// ring buffer.
    void record_traveller(Carrier& carrier, std::uint32_t place) const {
        if (carrier.sent.size() <= most_travellers_) carrier.sent.push_back(place);
    }
    void set_travellers_aside(std::span<const DiscState> discs, SortMemory memory);
    template <class Placed>
    void bring(std::span<DiscState> discs, SortMemory memory, const Placed& placed);

    int n_threads_ = 1;
    std::size_t n_discs_ = 0;
    std::vector<Sorter> sorters_;     ///< scratch memory for several threads
    std::vector<Carrier> carriers_;   ///< the state of each thread
    std::size_t n_passed_ = 1;        ///< length of the ring buffer, a power of two
    std::size_t most_travellers_ = 0; ///< limit for each thread's share
    bool are_in_disorder_ = false;    ///< whether too many discs move far
};

} // namespace carrom
