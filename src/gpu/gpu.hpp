// SPDX-License-Identifier: BSD-3-Clause
// Whether this program can use a GPU, and how to make engines on it.
//
// The module is the same for every build. A build with -DCARROM_CUDA=ON links the kernels, which
// `program_gpu` then has; tests put the serial device in their place.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/engine.hpp"
#include "gpu/stepper.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Makes an engine of the time-stepped method on the process's GPU. Throws CollectiveError if the
/// program was built without CUDA, if there is no GPU, if its driver is too old, if it has too
/// little memory, or if there are several ranks. **Collective.**
std::unique_ptr<Engine> make_gpu_engine(const SceneParameters& scene, StoredState state,
                                        const Communicator& communicator, const Tuning& tuning);

/// A function that makes engines, and the device for them.
struct Gpu {
    const DeviceKind* device = nullptr;
    std::unique_ptr<Engine> (*make_engine)(const DeviceKind& device, const SceneParameters& scene,
                                           StoredState state, const Communicator& communicator,
                                           const Tuning& tuning) = nullptr;
};
/// The GPUs of this program; it has none if it was built without CUDA.
Gpu& program_gpu();

/// See Gpu. Compiled only together with kernels.
std::unique_ptr<Engine> make_gpu_engine_on(const DeviceKind& device, const SceneParameters& scene,
                                           StoredState state, const Communicator& communicator,
                                           const Tuning& tuning);

} // namespace carrom
