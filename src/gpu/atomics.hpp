// SPDX-License-Identifier: BSD-3-Clause
// Operations by which several threads of a device can safely change the same number. The serial
// device on the CPU has one thread, so it uses plain operations.
#pragma once

#include <bit>
#include <cstdint>

#include "core/device.hpp"

namespace carrom {

/// Adds to `number` and returns its old value. The order of threads is random, so use the value
/// only as an index in a list whose order has no effect.
CARROM_DEVICE inline std::uint32_t fetch_add(std::uint32_t& number, std::uint32_t more) {
#ifdef __CUDA_ARCH__
    return atomicAdd(&number, more);
#else
    const std::uint32_t before = number;
    number += more;
    return before;
#endif
}

CARROM_DEVICE inline void add(std::uint64_t& number, std::uint64_t more) {
#ifdef __CUDA_ARCH__
    static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
    atomicAdd(reinterpret_cast<unsigned long long*>(&number), more);
#else
    number += more;
#endif
}

/// Sets `flag` to 1. Returns true if it was 0; of several threads only one gets true.
CARROM_DEVICE inline bool raise(std::uint32_t& flag) {
#ifdef __CUDA_ARCH__
    return atomicExch(&flag, 1u) == 0;
#else
    const bool was_down = flag == 0;
    flag = 1;
    return was_down;
#endif
}

/// The maximum of nonnegative numbers; their bits, read as integers, have the same order.
class Largest {
public:
    CARROM_DEVICE void offer(double number) {
        const auto bits = std::bit_cast<std::uint64_t>(number);
#ifdef __CUDA_ARCH__
        // Most values are not larger, and a read costs less than an atomic operation.
        if (*static_cast<volatile std::uint64_t*>(&bits_) < bits)
            atomicMax(reinterpret_cast<unsigned long long*>(&bits_),
                      static_cast<unsigned long long>(bits));
#else
        if (bits_ < bits) bits_ = bits;
#endif
    }
    CARROM_DEVICE double value() const { return std::bit_cast<double>(bits_); }

private:
    std::uint64_t bits_ = 0;
};

} // namespace carrom
