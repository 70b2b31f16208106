// SPDX-License-Identifier: BSD-3-Clause
// A device that is the CPU, for tests (serial_machine.hpp).
#pragma once

#include "gpu/stepper.hpp"

namespace carrom {

const DeviceKind& serial_device();

} // namespace carrom
