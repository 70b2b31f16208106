// SPDX-License-Identifier: BSD-3-Clause
// Linked into a copy of the program, it provides the serial device in place of a GPU.
#include "gpu/gpu.hpp"
#include "gpu/serial_device.hpp"

namespace carrom {

namespace {

const bool is_replaced = [] {
    program_gpu() = {&serial_device(), &make_gpu_engine_on};
    return true;
}();

} // namespace

} // namespace carrom
