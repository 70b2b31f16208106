// SPDX-License-Identifier: BSD-3-Clause
// Sorts records that are in any distribution over the ranks.
//
// Each rank sorts its own records and selects a fixed share of them as samples. Rank 0 sorts the
// samples and cuts them into slices, and each record is sent once (Shi and Schaeffer 1992). The
// number of samples of a rank is proportional to its records, so an uneven distribution does not
// bias the cuts. Cost: n log n / ranks comparisons, one any-to-any exchange, and about 64 samples
// per slice on rank 0. If records are distinct, a slice exceeds its share by less than ranks / 64
// of the share, and by far less unless the data are a worst case.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace detail {

inline constexpr std::uint64_t samples_per_slice = 64;

/// Merges the sorted groups of `in` into one sorted array; equal items stay in the order of their
/// senders.
template <class T, class Less> std::vector<T> merge_groups(Received<T> in, const Less& less) {
    const auto at = [&in](std::size_t k) {
        return in.items.begin() + static_cast<std::ptrdiff_t>(in.offsets[k]);
    };
    const std::size_t n = in.n_senders();
    for (std::size_t width = 1; width < n; width *= 2)
        for (std::size_t k = 0; k + width < n; k += 2 * width)
            std::inplace_merge(at(k), at(k + width), at(std::min(k + 2 * width, n)), less);
    return std::move(in.items);
}

/// Returns every rank's list on rank 0, and nothing on the others.
template <Message T>
Received<T> collect_on_root(const Communicator& communicator, std::vector<T> mine) {
    std::vector<std::vector<T>> out(static_cast<std::size_t>(communicator.size()));
    out.front() = std::move(mine);
    return send_to_owners(communicator, out);
}

/// Returns the first records of slices 1 .. n_slices - 1, the same on all ranks;
/// nothing if no rank has a record.
template <Message T, class Less>
std::vector<T> choose_splitters(const Communicator& communicator, const std::vector<T>& sorted,
                                const Less& less, int n_slices) {
    const auto n = static_cast<std::uint64_t>(n_slices);
    const std::uint64_t total = communicator.sum(std::uint64_t{sorted.size()});
    const std::uint64_t before = communicator.sum_before(sorted.size());
    const std::uint64_t stride = std::max<std::uint64_t>(1, total / (n * samples_per_slice));
    std::vector<T> samples;
    for (std::uint64_t k = (stride - before % stride) % stride; k < sorted.size(); k += stride)
        samples.push_back(sorted[k]);
    samples = merge_groups(collect_on_root(communicator, std::move(samples)), less);
    std::vector<T> splitters;
    for (std::uint64_t slice = 1; slice < n && !samples.empty(); ++slice)
        splitters.push_back(samples[slice * samples.size() / n]);
    communicator.broadcast(splitters);
    return splitters;
}

} // namespace detail

/// Sorts the records of all ranks into `n_slices` slices. Returns slice number
/// `communicator.rank()`, and nothing on ranks >= n_slices. Slices follow each other in the order
/// `less` (strict, weak; the same on all ranks). Equal records are in one slice, ordered by their
/// old ranks and places. 1 <= n_slices <= size(). **Collective.**
template <Message T, class Less>
std::vector<T> sample_sort(const Communicator& communicator, std::vector<T> records,
                           const Less& less, int n_slices) {
    ensure(1 <= n_slices && n_slices <= communicator.size(),
           "a sort needs between one slice and one per rank");
    std::stable_sort(records.begin(), records.end(), less);
    if (communicator.size() == 1) return records;
    if (n_slices == 1)
        return detail::merge_groups(detail::collect_on_root(communicator, std::move(records)),
                                    less);

    const std::vector<T> splitters = detail::choose_splitters(communicator, records, less,
                                                              n_slices);
    std::vector<std::vector<T>> out(static_cast<std::size_t>(communicator.size()));
    auto begin = records.cbegin();
    for (std::size_t slice = 0; slice <= splitters.size(); ++slice) {
        const auto end = slice < splitters.size()
                             ? std::lower_bound(begin, records.cend(), splitters[slice], less)
                             : records.cend();
        out[slice].assign(begin, end);
        begin = end;
    }
    std::vector<T>().swap(records); // swap frees the memory, which `= {}` would keep
    return detail::merge_groups(send_to_owners(communicator, out), less);
}

} // namespace carrom
