// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/gpu.hpp"

#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace carrom {

#ifdef CARROM_HAS_CUDA
const DeviceKind& cuda_device();
#endif

Gpu& program_gpu() {
#ifdef CARROM_HAS_CUDA
    static Gpu gpu{&cuda_device(), &make_gpu_engine_on};
#else
    static Gpu gpu;
#endif
    return gpu;
}

namespace {

void check_memory(const DeviceFacts& facts, std::uint64_t n_discs) {
    const std::uint64_t needed = device_bytes_of_run + device_bytes_per_disc * n_discs;
    if (n_discs < std::numeric_limits<std::uint32_t>::max() - 2 && needed <= facts.free_bytes)
        return;
    throw CollectiveError(fmt::format(
        "{} discs need {:.3g} GB of the GPU's memory, {} bytes a disc; {} has {:.3g} GB free of "
        "{:.3g} GB",
        n_discs, 1e-9 * static_cast<double>(needed), device_bytes_per_disc, facts.name,
        1e-9 * static_cast<double>(facts.free_bytes), 1e-9 * static_cast<double>(facts.bytes)));
}

} // namespace

std::unique_ptr<Engine> make_gpu_engine(const SceneParameters& scene, StoredState state,
                                        const Communicator& communicator, const Tuning& tuning) {
    const Gpu& gpu = program_gpu();
    if (!gpu.device)
        throw CollectiveError("machine.gpu: this program was built without CUDA; build it with "
                              "-DCARROM_CUDA=ON, or run without a GPU");
    if (communicator.size() > 1)
        throw CollectiveError(fmt::format("machine.gpu: this version runs one rank on one GPU, not "
                                          "{} ranks",
                                          communicator.size()));
    check_memory(gpu.device->facts(), scene.n_discs);
    return gpu.make_engine(*gpu.device, scene, std::move(state), communicator, tuning);
}

} // namespace carrom
