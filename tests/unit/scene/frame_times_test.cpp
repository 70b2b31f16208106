// SPDX-License-Identifier: BSD-3-Clause
// The steps that have frames, compared with lists written by hand.
#include <limits>
#include <vector>

#include "catch.hpp"

#include "scene/frame_times.hpp"

using namespace carrom;

namespace {

std::vector<std::int64_t> frames_up_to(const TrajectoryOutput& output, std::int64_t last) {
    std::vector<std::int64_t> steps = {0};
    while (next_frame(output, steps.back()) <= last)
        steps.push_back(next_frame(output, steps.back()));
    return steps;
}

TrajectoryOutput frames(std::int64_t every, std::int64_t per_decade) {
    TrajectoryOutput output;
    output.every_steps = every;
    output.frames_per_decade = per_decade;
    return output;
}

} // namespace

TEST_CASE("frames: regular steps, or steps that grow by a factor") {
    CHECK(frames_up_to(frames(5, 0), 22) == std::vector<std::int64_t>{0, 5, 10, 15, 20});
    CHECK(frames_up_to(frames(1, 1), 20000) ==
          std::vector<std::int64_t>{0, 1, 10, 100, 1000, 10000});
    // 3 times 10^(k/4): 3, 5.33, 9.49, 16.9, 30, 53.3, 94.9
    CHECK(frames_up_to(frames(3, 4), 100) == std::vector<std::int64_t>{0, 3, 5, 9, 17, 30, 53, 95});
    // 10^(k/10) is 1, 1.26, 1.58, 2.0 ...; a step that occurs twice has one frame
    CHECK(frames_up_to(frames(1, 10), 11) == std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 8, 10});
}

TEST_CASE("frames: the last one before a step is one that the steps before lead to") {
    for (const std::int64_t per_decade : {0, 1, 3, 7, 10, 100}) {
        for (const std::int64_t every : {1, 2, 7, 1000}) {
            const TrajectoryOutput output = frames(every, per_decade);
            const std::vector<std::int64_t> steps = frames_up_to(output, 40000);
            std::size_t k = 0;
            for (std::int64_t step = 0; step < 40000; step += step < 3000 ? 1 : 17) {
                while (k + 1 < steps.size() && steps[k + 1] <= step) ++k;
                CHECK(last_frame(output, step) == steps[k]);
            }
        }
    }
    CHECK(next_frame(frames(1, 1), std::int64_t{1} << 53) ==
          std::numeric_limits<std::int64_t>::max());
}
