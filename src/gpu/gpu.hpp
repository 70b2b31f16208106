// SPDX-License-Identifier: BSD-3-Clause
// Whether this program can use a GPU, and how to make engines on it.
//
// This header is the same for every build. A build with -DCARROM_CUDA=ON links the kernels, and
// `program_gpu` then returns them; tests replace them by the serial device.
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

/// A device, and a function that makes engines on it.
struct Gpu {
    const DeviceKind* device = nullptr;
    std::unique_ptr<Engine> (*make_engine)(const DeviceKind& device, const SceneParameters& scene,
                                           StoredState state, const Communicator& communicator,
                                           const Tuning& tuning) = nullptr;
};
/// The GPU of this program; null pointers if it was built without CUDA.
Gpu& program_gpu();

/// The value of Gpu::make_engine in builds with kernels; other builds do not compile it.
std::unique_ptr<Engine> make_gpu_engine_on(const DeviceKind& device, const SceneParameters& scene,
                                           StoredState state, const Communicator& communicator,
                                           const Tuning& tuning);

} // namespace carrom
