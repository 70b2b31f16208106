// SPDX-License-Identifier: BSD-3-Clause
// Judges many rounds of random insertion at once, with the same result as one by one.
//
// When little free space is left, nearly all proposals overlap a disc that has been placed. The few
// other proposals, and those of the same round that they overlap, are sent to all ranks. All ranks
// decide in the same way, in the order of rounds and ids. So thousands of rounds need one exchange,
// and threads share the proposals.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "initial_state/insertion_box.hpp"
#include "initial_state/placed_discs.hpp"

namespace carrom {

class InsertionBatch {
public:
    InsertionBatch(const InsertionBox& box, const Communicator& communicator, int n_threads,
                   PlacedDiscs& placed)
        : box_(box), communicator_(communicator), n_threads_(n_threads), placed_(placed) {}

    /// Places discs of `unplaced` and removes them from the list. Each rank has other discs in its
    /// list, `n_left` in all. Returns the last round in which a place was found, counted from the
    /// first one. **Collective.**
    std::optional<std::uint64_t> judge(std::vector<std::uint32_t>& unplaced, std::uint64_t n_left,
                                       std::uint64_t first_round, std::uint64_t n_rounds);

    /// The number of rounds of the next batch, if the last one had `n_rounds` and placed `n_placed`
    /// discs, and `n_left` are still without a place. Numbers are sums over all ranks.
    std::uint64_t choose_rounds(std::uint64_t n_placed, std::uint64_t n_rounds,
                                std::uint64_t n_left) const;

private:
    /// A proposal that overlaps a later one of the same round. The later one is then rejected,
    /// unless the disc of the earlier one has been placed in a previous round.
    struct Rival {
        std::uint32_t round = 0, id = 0, earlier = 0;

        auto operator<=>(const Rival&) const = default;
    };

    static void take_out(std::vector<Notice> found, std::vector<std::uint32_t>& unplaced);
    void find_free();
    void find_rivals();
    std::vector<Notice> decide();
    template <class Counts> bool has_rival(const Notice& notice, const Counts& counts) const;
    template <class Item> void gather_on_all(std::vector<Item>& items) const;

    const InsertionBox& box_;
    const Communicator& communicator_;
    int n_threads_;
    PlacedDiscs& placed_;
    RawVector<Notice> proposals_;
    std::vector<Notice> free_;  ///< proposals that overlap no disc placed before the batch
    std::vector<Rival> rivals_; ///< overlaps among free proposals and their periodic images
};

} // namespace carrom
