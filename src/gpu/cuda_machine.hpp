// SPDX-License-Identifier: BSD-3-Clause
// A GPU that is used through CUDA; only nvcc compiles this file. Kernels and copies run in the
// order in which the host starts them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <cub/device/device_scan.cuh>
#include <cuda_runtime.h>

#include "core/errors.hpp"

namespace carrom {

/// Throws CollectiveError with CUDA's text, unless `error` is cudaSuccess.
inline void check_cuda(cudaError_t error, const char* what) {
    if (error == cudaSuccess) return;
    throw CollectiveError(std::string("GPU: ") + what + ": " + cudaGetErrorString(error));
}

namespace cuda {

constexpr unsigned threads_of_block = 128, threads_of_rounds = 512;
/// The largest number of blocks of a kernel that reads its number of threads from the device's
/// memory. It is enough for any GPU.
constexpr unsigned most_blocks = 2048;

template <class Kernel> __global__ void for_each(std::uint32_t n, const Kernel kernel) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) kernel(i);
}
template <class Kernel> __global__ void for_each_of(const std::uint32_t* n, const Kernel kernel) {
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < *n;
         i += gridDim.x * blockDim.x)
        kernel(i);
}
template <class Rounds> __global__ void search(const Rounds rounds, int round) {
    const std::uint32_t n = *rounds.size(round);
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < n;
         i += gridDim.x * blockDim.x)
        rounds.search(round, i);
}
template <class Rounds> __global__ void match(const Rounds rounds, int round) {
    const std::uint32_t n = *rounds.size(round);
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < n;
         i += gridDim.x * blockDim.x)
        rounds.match(round, i);
}
/// Runs all remaining rounds in one block. Its threads wait for each other before each search and
/// each match, so that all of them read the same round size and the results of all others.
template <class Rounds> __global__ void finish_rounds(const Rounds rounds, int round) {
    for (;; ++round) {
        __syncthreads();
        const std::uint32_t n = *static_cast<const volatile std::uint32_t*>(rounds.size(round));
        if (n == 0) return;
        if (threadIdx.x == 0) rounds.begin(round);
        for (std::uint32_t i = threadIdx.x; i < n; i += blockDim.x) rounds.search(round, i);
        __syncthreads();
        for (std::uint32_t i = threadIdx.x; i < n; i += blockDim.x) rounds.match(round, i);
    }
}

inline unsigned blocks_for(std::uint64_t n) {
    return static_cast<unsigned>((n + threads_of_block - 1) / threads_of_block);
}

} // namespace cuda

struct CudaMachine {
    struct Free {
        void operator()(void* memory) const { cudaFree(memory); }
    };
    using Memory = std::unique_ptr<void, Free>;
    /// Scratch memory for kernels of CUDA's library.
    struct Scratch {
        Memory memory;
        std::size_t n_bytes = 0;
    };

    static Memory allocate(std::size_t n_bytes) {
        void* memory = nullptr;
        check_cuda(cudaMalloc(&memory, std::max<std::size_t>(n_bytes, 1)), "memory");
        return Memory(memory);
    }
    static void copy_to_device(void* to, const void* from, std::size_t n_bytes) {
        check_cuda(cudaMemcpy(to, from, n_bytes, cudaMemcpyHostToDevice), "copy");
    }
    /// Waits for all kernels, throws if one has failed, and copies from the device.
    static void copy_to_host(void* to, const void* from, std::size_t n_bytes) {
        check_cuda(cudaGetLastError(), "kernel");
        check_cuda(cudaMemcpy(to, from, n_bytes, cudaMemcpyDeviceToHost), "copy");
    }
    static void zero(void* to, std::size_t n_bytes) {
        check_cuda(cudaMemsetAsync(to, 0, n_bytes), "memory");
    }

    template <class Kernel> static void for_each(std::uint32_t n, const Kernel& kernel) {
        if (n > 0) cuda::for_each<<<cuda::blocks_for(n), cuda::threads_of_block>>>(n, kernel);
    }
    template <class Kernel>
    static void for_each_of(const std::uint32_t* n, std::uint32_t most, const Kernel& kernel) {
        cuda::for_each_of<<<some_blocks(most), cuda::threads_of_block>>>(n, kernel);
    }
    template <class Rounds>
    static void run_round(const Rounds& rounds, int round, std::uint32_t most) {
        cuda::search<<<some_blocks(most), cuda::threads_of_block>>>(rounds, round);
        cuda::match<<<some_blocks(most), cuda::threads_of_block>>>(rounds, round);
    }
    template <class Rounds> static void finish_rounds(const Rounds& rounds, int round) {
        cuda::finish_rounds<<<1, cuda::threads_of_rounds>>>(rounds, round);
    }
    static void sum_before(std::uint32_t* numbers, std::uint32_t n, Scratch& scratch) {
        std::size_t needed = 0;
        check_cuda(cub::DeviceScan::ExclusiveSum(nullptr, needed, numbers, numbers, n), "scan");
        if (needed > scratch.n_bytes) {
            scratch.memory.reset();
            scratch = {allocate(needed), needed};
        }
        check_cuda(cub::DeviceScan::ExclusiveSum(scratch.memory.get(), needed, numbers, numbers, n),
                   "scan");
    }

private:
    static unsigned some_blocks(std::uint32_t most) {
        return std::clamp(cuda::blocks_for(most), 1u, cuda::most_blocks);
    }
};

} // namespace carrom
