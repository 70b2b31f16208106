// SPDX-License-Identifier: BSD-3-Clause
// Sorts discs by their cells, in place.
//
// A counting sort determines the new place of each disc. Each thread counts the discs of its share
// in its own cells, and lists the few discs that lie in other threads' cells. Then one pass moves
// the discs: nearly all move only a few places; those that move farther are copied beforehand.
// Cost: two passes. The sorter borrows the memory of the flights, which are written later, so it
// needs little memory of its own.
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <vector>

#include "core/disc_state.hpp"
#include "core/raw_vector.hpp"

namespace carrom {

/// A list of whole numbers in memory that was allocated for floats.
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

/// The memory that the sorter borrows: lanes of `lane_length` numbers. The first lane holds each
/// disc's cell, the second lane the new order of the discs.
struct SortMemory {
    RawVector<float>& lanes;
    std::size_t lane_length = 0;

    Lent cells() const { return Lent(lanes.data()); }
    Lent order() const { return Lent(lanes.data() + lane_length); }
};

class DiscSorter {
public:
    /// Determines the order of `discs` by cells; `find_cell(disc)` returns the index of a cell.
    /// Writes the order to `memory.order()`, and the first place of each cell to `cell_start`,
    /// whose last element becomes the end of the last cell. `n_columns` determines the length of
    /// the ring buffer.
    template <class CellOf>
    void find_order(std::span<const DiscState> discs, const CellOf& find_cell,
                    std::size_t n_columns, int n_threads, RawVector<std::uint32_t>& cell_start,
                    SortMemory memory);

    /// Assigns each disc that moves far to the thread whose share contains its new place. Returns
    /// false if too many discs move far: they are then not nearly sorted, and `rearrange` is
    /// faster.
    bool share_out_travellers();
    /// Moves discs to their new places; each thread fills the places of its share in ascending
    /// order. Calls placed(i) when place i holds its disc. The order's element i is not read
    /// afterwards.
    template <class Placed>
    void carry(std::span<DiscState> discs, SortMemory memory, const Placed& placed) {
        set_travellers_aside(discs, memory);
        bring(discs, memory, placed);
    }
    /// Reorders arrays of discs that are not nearly sorted; empty arrays are ignored.
    void rearrange(std::initializer_list<std::span<DiscState>> arrays, SortMemory memory);

private:
    /// The discs that a thread sorts, and the cells in which nearly all of them lie.
    struct Sorter {
        std::size_t first_disc = 0, end_disc = 0;
        std::uint32_t first_cell = 0, end_cell = 0;
        std::vector<LocalIndex> strays; ///< discs of this share in other shares' cells, ascending
    };
    /// The data of a thread while it moves discs to the sorted places of its share.
    struct Carrier {
        DiscStates passed;                ///< ring buffer of the last discs that were overwritten
        DiscStates travellers;            ///< discs that move far; copied beforehand
        std::vector<LocalIndex> arrivals; ///< sorted new places of `travellers`, then an end mark
        /// New places of the far-moving discs that this thread has found, unsorted
        std::vector<LocalIndex> sent;
    };

    void begin(std::size_t n_discs, std::size_t n_columns, int n_threads);
    template <class CellOf>
    void share_out(std::span<const DiscState> discs, const CellOf& find_cell,
                   std::uint32_t n_cells);
    void share_out_equally(std::uint32_t n_cells);
    template <class CellOf>
    void count_share(Sorter& mine, std::span<const DiscState> discs, CellOf find_cell,
                     std::uint32_t* counts, Lent cell_of);
    std::uint32_t count_rest(const Sorter& mine, std::uint32_t* counts, Lent cell_of) const;
    void find_places(std::uint32_t* counts, SortMemory memory);
    template <class Visit>
    void visit_discs(const Sorter& mine, const Sorter& home, Lent cell_of, Visit visit) const;
    auto place_giver(const Sorter& home, Carrier& carrier, std::uint32_t* counts,
                     SortMemory memory) const;
    /// Adds a disc to a list of discs that move far, unless the list is already too long.
    [[gnu::noinline]] void record(std::vector<LocalIndex>& few, std::size_t index) const {
        if (few.size() <= most_travellers_) few.push_back(static_cast<LocalIndex>(index));
    }
    void set_travellers_aside(std::span<const DiscState> discs, SortMemory memory);
    template <class Placed>
    void bring(std::span<DiscState> discs, SortMemory memory, const Placed& placed);

    int n_threads_ = 1;
    std::size_t n_discs_ = 0;
    std::vector<Sorter> sorters_;     ///< one for each thread
    std::vector<Carrier> carriers_;   ///< one for each thread
    std::size_t n_passed_ = 1;        ///< length of the ring buffer, a power of two
    std::size_t most_travellers_ = 0; ///< most far-moving discs allowed in a share
    bool are_in_disorder_ = false;    ///< whether too many discs move far
};

} // namespace carrom
