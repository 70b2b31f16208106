// SPDX-License-Identifier: BSD-3-Clause
// Runs many rounds of random_insertion.hpp together, as if they ran one after another.
//
// When little free space is left, nearly all proposals overlap a disc that has been placed. The few
// free proposals, and the proposals of the same round that overlap them, are sent to all ranks. All
// ranks decide in the same way, in the order of rounds and ids. So thousands of rounds need only
// one exchange, and threads share the proposals.
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

    /// Runs `n_rounds` rounds, which place discs of `unplaced`, and removes these from the list.
    /// Lists of different ranks have no common discs; `n_left` is their total length. Returns the
    /// last round that placed a disc, counted from `first_round`; nothing if none did.
    /// **Collective.**
    std::optional<std::uint64_t> judge(std::vector<std::uint32_t>& unplaced, std::uint64_t n_left,
                                       std::uint64_t first_round, std::uint64_t n_rounds);

    /// The next batch's number of rounds, if the last batch placed `n_placed` discs in `n_rounds`
    /// and `n_left` discs have no place yet. These numbers are sums over all ranks.
    std::uint64_t choose_rounds(std::uint64_t n_placed, std::uint64_t n_rounds,
                                std::uint64_t n_left) const;

private:
    /// The proposals of discs `id` and `earlier`, which has the lower id, overlap in round `round`.
    /// So disc `id` is not placed in that round, unless `earlier` was placed in a previous round.
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
    std::vector<Rival> rivals_; ///< overlaps of free proposals with proposals of lower ids
};

} // namespace carrom
