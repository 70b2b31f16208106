// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include "apps/run_command/progress.hpp"

namespace carrom {

TEST_CASE("progress tells share, rate and the time that is left") {
    CHECK(progress_text(100, 0, 400, 50) == "step 100 of 400 (25.0 %), 2 steps/s, 0:02:30 left");
    CHECK(progress_text(36000, 0, 72000, 36000) ==
          "step 36000 of 72000 (50.0 %), 1 steps/s, 10:00:00 left");
}

TEST_CASE("progress counts from where the run began") {
    CHECK(progress_text(150, 100, 200, 10) == "step 150 of 200 (50.0 %), 5 steps/s, 0:00:10 left");
}

TEST_CASE("progress promises nothing before the first step is done") {
    CHECK(progress_text(0, 0, 10, 3) == "step 0 of 10 (0.0 %), 0 steps/s");
    CHECK(progress_text(0, 0, 0, 0) == "step 0 of 0 (0.0 %), 0 steps/s");
}

} // namespace carrom
