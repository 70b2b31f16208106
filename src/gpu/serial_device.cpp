// SPDX-License-Identifier: BSD-3-Clause
// The kernels on the CPU, for tests.
#include "gpu/serial_device.hpp"

#include "gpu/device_stepper.hpp"
#include "gpu/serial_machine.hpp"

namespace carrom {

namespace {

class SerialDevice final : public DeviceKind {
public:
    DeviceFacts facts() const override {
        constexpr std::uint64_t plenty = std::uint64_t{1} << 40;
        return {"serial device", plenty, plenty};
    }
#define CARROM_DEFINE(Dynamics)                                                                    \
    std::unique_ptr<Stepper> make_stepper(const MotionOf<Dynamics>& motion,                        \
                                          const SpeciesTable& species, std::uint32_t n_discs)      \
        const override {                                                                           \
        return std::make_unique<DeviceStepper<MotionOf<Dynamics>, SerialMachine>>(motion, species, \
                                                                                  n_discs);        \
    }
    CARROM_FOR_EACH_DYNAMICS_OF_GPUS(CARROM_DEFINE)
#undef CARROM_DEFINE
};

} // namespace

const DeviceKind& serial_device() {
    static const SerialDevice device;
    return device;
}

} // namespace carrom
