// SPDX-License-Identifier: BSD-3-Clause
// Divides a loop into chunks for several threads. Each thread first works on the chunks of its own
// share, in order, and then on chunks that other threads have not begun.
//
// If a loop is repeated, each thread gets the same share again, so the data are in its own cache.
// No thread is idle while there is work.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace carrom {

/// First index of the `part`-th of `n_parts` equal shares of n.
inline std::size_t share(std::size_t n, std::size_t part, std::size_t n_parts) {
    return n * part / n_parts;
}

class SharedWork {
public:
    /// Thread k's share is `bounds[k]` .. `bounds[k + 1]` - 1; a chunk has at most `chunk` items.
    SharedWork(std::vector<std::int64_t> bounds, std::int64_t chunk)
        : bounds_(std::move(bounds)), chunk_(chunk), n_shares_(bounds_.size() - 1),
          next_(std::make_unique<Next[]>(n_shares_)) {
        for (std::size_t k = 0; k < n_shares_; ++k) next_[k].item = bounds_[k];
    }

    /// Calls work(item) for items of thread `thread`, and then for items of other threads, until
    /// none is left. All threads call `run` at the same time.
    template <class Work> void run(int thread, const Work& work) {
        for (std::size_t k = 0; k < n_shares_; ++k) {
            const std::size_t share = (static_cast<std::size_t>(thread) + k) % n_shares_;
            const std::int64_t end = bounds_[share + 1];
            while (next_[share].item.load(std::memory_order_relaxed) < end) {
                const std::int64_t first = next_[share].item.fetch_add(chunk_,
                                                                       std::memory_order_relaxed);
                for (std::int64_t item = first; item < first + chunk_ && item < end; ++item)
                    work(item);
            }
        }
    }

private:
    struct alignas(64) Next {
        std::atomic<std::int64_t> item;
    };

    std::vector<std::int64_t> bounds_;
    std::int64_t chunk_;
    std::size_t n_shares_;
    std::unique_ptr<Next[]> next_;
};

/// The bounds of equal shares of n items.
inline std::vector<std::int64_t> equal_shares(std::int64_t n, int n_shares) {
    std::vector<std::int64_t> bounds;
    for (int k = 0; k <= n_shares; ++k) bounds.push_back(n * k / n_shares);
    return bounds;
}

} // namespace carrom
