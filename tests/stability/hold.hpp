// SPDX-License-Identifier: BSD-3-Clause
// Compares worst values with their bounds. tests/stability/table.sh makes the tables in
// docs/data/hard_cases from them.
#pragma once

#include "catch.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace carrom::test {

/// Checks that `worst` <= `bound`. If $CARROM_STABILITY_TABLE names a file, appends a line to it:
/// family, case, method (or "both" if the case does not depend on it), bound, worst value.
inline void hold(const char* family, const std::string& what, const std::string& method,
                 double worst, double bound) {
    INFO(family << ": " << what << ", rule " << method);
    CHECK(worst <= bound);
    const char* const path = std::getenv("CARROM_STABILITY_TABLE");
    if (path == nullptr) return;
    std::FILE* const file = std::fopen(path, "a");
    REQUIRE(file != nullptr);
    std::fprintf(file, "%s\t%s\t%s\t%.3g\t%.3g\n", family, what.c_str(), method.c_str(), bound,
                 worst);
    std::fclose(file);
}

} // namespace carrom::test
