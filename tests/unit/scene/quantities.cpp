// SPDX-License-Identifier: BSD-3-Clause
// Declares the quantities of programs that measure. Naming the list links it to this test.
#include "measure/measurement.hpp"

namespace carrom::test {

extern const bool scenes_know_quantities;
const bool scenes_know_quantities = !measured_quantities().empty();

} // namespace carrom::test
