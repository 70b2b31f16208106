// SPDX-License-Identifier: BSD-3-Clause
// The ranks of a run and their common operations: reductions, broadcasts, gathers. Only this module
// calls MPI.
//
// Values are sent as bytes, so they must be trivially copyable; all ranks run the same program.
// Data of any size is split into messages below MPI's limit of 2^31 bytes. Copies of a Communicator
// share one MPI communicator. It is a duplicate, so its messages never mix with those of other
// parts of the program. The result of a reduction has the same bits on all ranks and for any number
// of ranks, because sums of floating-point numbers are exact.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace carrom {

class ExactSum;

/// Types that can be sent as bytes. `bool` cannot, because std::vector<bool> is not an array.
template <class T>
concept Message = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> &&
                  !std::same_as<T, bool>;

/// What this rank has sent so far: messages to single ranks, their bytes, and calls that involve
/// all ranks.
struct Traffic {
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;
    std::uint64_t collectives = 0;
};

class Communicator {
public:
    static constexpr std::size_t largest_message = std::size_t{1} << 30;

    /// All ranks of the run, or this process alone if MPI has not been started. **Collective.**
    /// Must not outlive `Mpi`. Data above `max_message` bytes (the same on all ranks) is split;
    /// tests make this limit small.
    static Communicator world(std::size_t max_message = largest_message);
    /// A duplicate of the communicator that has this number in Fortran (MPI_Comm_c2f).
    /// **Collective** over its ranks.
    static Communicator of_fortran(int number);
    /// This rank alone. Functions that are collective over it involve no other rank. Not
    /// collective.
    static Communicator of_this_rank();

    int rank() const;
    int size() const;
    bool is_root() const { return rank() == 0; }

    /// Reductions over all ranks; every rank gets the result. **Collective.** Values must not be
    /// NaN; -0 becomes +0.
    double max(double value) const;
    double min(double value) const;
    std::int64_t max(std::int64_t value) const;
    std::int64_t min(std::int64_t value) const;
    std::uint64_t max(std::uint64_t value) const;
    std::uint64_t min(std::uint64_t value) const;
    std::uint64_t sum(std::uint64_t value) const; ///< modulo 2^64
    void sum(std::span<std::uint64_t> values)
        const; ///< element-wise, in place, modulo 2^64; the same length on all ranks
    /// Replaces `value` by its sum over all ranks; its bound must be the same on all ranks
    void sum(ExactSum& value) const;
    std::uint64_t sum_before(
        std::uint64_t value) const; ///< sum over the ranks below this one; 0 on rank 0
    bool any(bool value) const;
    bool all(bool value) const;

    /// Returns when every rank has called it. **Collective.**
    void barrier() const;

    /// Replaces the value on every rank by the value on `root`.
    /// **Collective.** A span has the same length on all ranks.
    void broadcast(std::string& text, int root = 0) const;
    void broadcast_bytes(std::span<std::byte> bytes, int root) const;
    template <Message T> void broadcast(T& value, int root = 0) const {
        broadcast_bytes(std::as_writable_bytes(std::span(&value, 1)), root);
    }
    template <Message T> void broadcast(std::vector<T>& values, int root = 0) const {
        std::uint64_t count = values.size();
        broadcast(count, root);
        values.resize(count);
        broadcast_bytes(std::as_writable_bytes(std::span(values)), root);
    }

    /// Every rank's value, in rank order, on every rank. The memory is proportional to size().
    /// **Collective.**
    template <Message T> std::vector<T> all_gather(const T& value) const {
        std::vector<T> values(static_cast<std::size_t>(size()));
        all_gather_bytes(std::as_bytes(std::span(&value, 1)),
                         std::as_writable_bytes(std::span(values)));
        return values;
    }
    void all_gather_bytes(std::span<const std::byte> mine, std::span<std::byte> all) const;

    Traffic traffic() const;

    struct Handle; ///< defined only in this module
    Handle& handle() const { return *handle_; }

private:
    explicit Communicator(std::shared_ptr<Handle> handle) : handle_(std::move(handle)) {}
    std::shared_ptr<Handle> handle_;
};

} // namespace carrom
