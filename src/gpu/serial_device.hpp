// SPDX-License-Identifier: BSD-3-Clause
// The CPU as a device, for tests (serial_machine.hpp).
#pragma once

#include "gpu/stepper.hpp"

namespace carrom {

const DeviceKind& serial_device();

} // namespace carrom
