// SPDX-License-Identifier: BSD-3-Clause
// A set of discs that is filled and emptied several times a window. Emptying takes a constant time
// and frees no memory, so that later insertions rarely allocate any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/disc_state.hpp"

namespace carrom {

/// A hash table with open addressing. A slot is in use if it has been filled since the last call
/// of `clear`.
class DiscSet {
public:
    void clear() {
        n_ = 0;
        // after 2^32 calls round_ takes old values again, so old slots would count as used
        if (++round_ == 0) {
            slots_.assign(slots_.size(), {});
            round_ = 1;
        }
    }

    /// Inserts the disc. Returns false if it was already in the set.
    bool insert(LocalIndex disc) {
        Slot& slot = slots_[place_of(disc)];
        if (slot.round == round_) return false;
        slot = {disc, round_};
        if (++n_ > slots_.size() / 2) grow();
        return true;
    }

    bool contains(LocalIndex disc) const { return slots_[place_of(disc)].round == round_; }

private:
    struct Slot {
        LocalIndex disc = 0;
        std::uint32_t round = 0;
    };

    /// The slot that contains the disc, or the free slot where it would be inserted. At least half
    /// of all slots are free.
    std::size_t place_of(LocalIndex disc) const {
        // 0.618..., the golden section, times 2^32; it scatters consecutive numbers
        constexpr std::uint32_t golden_section = 0x9E3779B9;
        std::size_t place = disc * golden_section >> (32 - n_bits_);
        while (slots_[place].round == round_ && slots_[place].disc != disc)
            place = (place + 1) & (slots_.size() - 1);
        return place;
    }

    void grow() {
        n_bits_ += 1;
        const std::vector<Slot> before = std::exchange(
            slots_, std::vector<Slot>(std::size_t{1} << n_bits_));
        for (const Slot& slot : before)
            if (slot.round == round_) slots_[place_of(slot.disc)] = slot;
    }

    int n_bits_ = 6;
    std::vector<Slot> slots_ = std::vector<Slot>(std::size_t{1} << n_bits_);
    std::size_t n_ = 0;
    std::uint32_t round_ = 1;
};

} // namespace carrom
