// SPDX-License-Identifier: BSD-3-Clause
// Items that arrived from several ranks, in one array, grouped by sender.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace carrom {

template <class T> struct Received {
    std::vector<T> items;
    std::vector<std::size_t> offsets = {0}; ///< sender k's items are [offsets[k], offsets[k + 1])

    std::size_t n_senders() const { return offsets.size() - 1; }
    std::span<const T> from(std::size_t k) const {
        return std::span(items).subspan(offsets[k], offsets[k + 1] - offsets[k]);
    }
};

} // namespace carrom
