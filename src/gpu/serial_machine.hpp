// SPDX-License-Identifier: BSD-3-Clause
// The CPU as a device, for tests: its memory is the host's memory, and it calls a kernel for one
// index after the other. Its results equal those of a GPU, because no kernel depends on the order
// of its threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>

namespace carrom {

struct SerialMachine {
    struct Free {
        void operator()(void* memory) const { ::operator delete(memory, alignment); }
    };
    using Memory = std::unique_ptr<void, Free>;
    struct Scratch {};

    static Memory allocate(std::size_t n_bytes) {
        return Memory(::operator new(std::max<std::size_t>(n_bytes, 1), alignment));
    }
    static void copy_to_device(void* to, const void* from, std::size_t n_bytes) {
        if (n_bytes > 0) std::memcpy(to, from, n_bytes);
    }
    static void copy_to_host(void* to, const void* from, std::size_t n_bytes) {
        if (n_bytes > 0) std::memcpy(to, from, n_bytes);
    }
    static void zero(void* to, std::size_t n_bytes) {
        if (n_bytes > 0) std::memset(to, 0, n_bytes);
    }

    template <class Kernel> static void for_each(std::uint32_t n, const Kernel& kernel) {
        for (std::uint32_t i = 0; i < n; ++i) kernel(i);
    }
    /// Calls the kernel `*n` times. On a GPU `n` is in device memory. `*n` is at most `most`.
    template <class Kernel>
    static void for_each_of(const std::uint32_t* n, std::uint32_t /*most*/, const Kernel& kernel) {
        for_each(*n, kernel);
    }
    /// Runs one round of kernels such as Waiting. A GPU uses all of its threads for this round.
    template <class Rounds>
    static void run_round(const Rounds& rounds, int round, std::uint32_t /*most*/) {
        const std::uint32_t n = *rounds.size(round);
        for (std::uint32_t i = 0; i < n; ++i) rounds.search(round, i);
        for (std::uint32_t i = 0; i < n; ++i) rounds.match(round, i);
    }
    /// Runs all further rounds. A GPU uses one block of threads for them.
    template <class Rounds> static void finish_rounds(const Rounds& rounds, int round) {
        for (; *rounds.size(round) > 0; ++round) {
            rounds.begin(round);
            run_round(rounds, round, 0);
        }
    }
    /// Replaces each number by the sum of the numbers before it.
    static void sum_before(std::uint32_t* numbers, std::uint32_t n, Scratch& /*scratch*/) {
        std::uint32_t sum = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t number = numbers[i];
            numbers[i] = sum;
            sum += number;
        }
    }

private:
    static constexpr std::align_val_t alignment{64};
};

} // namespace carrom
