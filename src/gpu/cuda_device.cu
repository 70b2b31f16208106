// SPDX-License-Identifier: BSD-3-Clause
// The kernels on a GPU. nvcc compiles this file with -fmad=false, because a product that is fused
// with a sum would give other bits than on the CPU (docs/understanding/gpu.md).
#include "gpu/cuda_machine.hpp"
#include "gpu/device_stepper.hpp"

namespace carrom {

namespace {

std::string version_text(int version) {
    return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

/// Throws CollectiveError if no GPU can be used, with a different message for each reason.
void check_gpu() {
    int driver = 0, runtime = 0, n_devices = 0;
    cudaDriverGetVersion(&driver);
    cudaRuntimeGetVersion(&runtime);
    if (driver == 0)
        throw CollectiveError("machine.gpu: no NVIDIA driver is installed here; run without a GPU");
    const cudaError_t error = cudaGetDeviceCount(&n_devices);
    if (error == cudaErrorInsufficientDriver)
        throw CollectiveError("machine.gpu: the NVIDIA driver is for CUDA " + version_text(driver) +
                              "; this program needs one for CUDA " + version_text(runtime));
    if (error == cudaErrorNoDevice || (error == cudaSuccess && n_devices == 0))
        throw CollectiveError("machine.gpu: no GPU is visible here; see nvidia-smi and "
                              "CUDA_VISIBLE_DEVICES");
    check_cuda(error, "machine.gpu");
}

class CudaDevice final : public DeviceKind {
public:
    DeviceFacts facts() const override {
        check_gpu();
        cudaDeviceProp properties{};
        check_cuda(cudaGetDeviceProperties(&properties, 0), "machine.gpu");
        std::size_t free_bytes = 0, bytes = 0;
        check_cuda(cudaMemGetInfo(&free_bytes, &bytes), "machine.gpu");
        return {properties.name, bytes, free_bytes};
    }
#define CARROM_DEFINE(Dynamics)                                                                    \
    std::unique_ptr<Stepper> make_stepper(const MotionOf<Dynamics>& motion,                        \
                                          const SpeciesTable& species, std::uint32_t n)            \
        const override {                                                                           \
        return std::make_unique<DeviceStepper<MotionOf<Dynamics>, CudaMachine>>(motion, species,   \
                                                                                n);                \
    }
    CARROM_FOR_EACH_DYNAMICS_OF_GPUS(CARROM_DEFINE)
#undef CARROM_DEFINE
};

} // namespace

const DeviceKind& cuda_device() {
    static const CudaDevice device;
    return device;
}

} // namespace carrom
