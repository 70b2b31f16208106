// SPDX-License-Identifier: BSD-3-Clause
// Single kernels against plain code with the same results.
#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include "catch.hpp"

#include "gpu/device_cells.hpp"
#include "gpu/device_sums.hpp"
#include "scene_tools.hpp"

using namespace carrom;

TEST_CASE("sums in pieces are the exact sums of the host") {
    test::Random random(7);
    for (const double bound : {1.0, 0x1p40, 0x1p-300}) {
        ExactSum exact(bound);
        std::vector<StressPieces> stripes(5);
        for (std::size_t k = 0; k < 1000; ++k) {
            // Terms from less than a unit to the largest possible one
            const double term = random.uniform(-1, 1) * bound *
                                std::ldexp(0x1p-11, -static_cast<int>(random.index(130)));
            exact.add(term);
            DeviceSum(stripes[k % 5].xy, exact.scale()).add(term);
        }
        StressSums sums(bound);
        add_stripes(stripes, sums);
        CHECK(sums.xy.low_word() == exact.low_word());
        CHECK(sums.xy.high_word() == exact.high_word());
        CHECK(sums.xx.value() == 0);
    }
}

TEST_CASE("terms of stress are rounded on a device as on the host") {
    test::Random random(8);
    StressSums host(0x1p20);
    StressTerms waiting;
    std::vector<StressPieces> stripes(1);
    DeviceStress device(stripes[0], host.xx.scale());
    for (int k = 0; k < 500; ++k) {
        const double size = std::ldexp(1.0, -static_cast<int>(random.index(120)));
        const double ix = random.uniform(-1, 1) * size, iy = random.uniform(-1, 1) * size;
        const Separation to{random.uniform(-9, 9), random.uniform(-9, 9)};
        waiting.add(ix, iy, to, host);
        DeviceTerms{}.add(ix, iy, to, device);
    }
    waiting.add_to(host);
    StressSums sums(0x1p20);
    add_stripes(stripes, sums);
    for (std::size_t k = 0; k < 4; ++k) {
        CHECK(sums.parts()[k]->low_word() == host.parts()[k]->low_word());
        CHECK(sums.parts()[k]->high_word() == host.parts()[k]->high_word());
    }
}

TEST_CASE("cells around a cell hold every place within the reach, in each image once") {
    test::Random random(9);
    const double width = 10, height = 7;
    for (const double reach : {0.3, 2.0, 6.0, 17.0})
        for (const bool x_repeats : {false, true})
            for (const bool y_repeats : {false, true}) {
                const Periods periods{x_repeats ? width : 0, y_repeats ? height : 0, 0, 0};
                DeviceCells cells = cells_for({width, height}, periods, reach, 60);
                std::vector<std::uint32_t> begins(cells.n_cells() + 1, 0);
                std::vector<std::pair<double, double>> places;
                for (int k = 0; k < 60; ++k)
                    places.emplace_back(random.uniform(0, width), random.uniform(0, height));
                std::ranges::sort(places, {}, [&](const auto& place) {
                    return cells.of(place.first, place.second);
                });
                for (const auto& [x, y] : places) ++begins[cells.of(x, y) + 1];
                for (std::size_t c = 1; c < begins.size(); ++c) begins[c] += begins[c - 1];
                cells.begins = begins.data();
                const auto [x, y] = places[random.index(places.size())];
                std::set<std::tuple<std::uint32_t, int, int>> found;
                cells.for_each_near(cells.of(x, y), [&](std::uint32_t slot, Image image) {
                    CHECK(found.emplace(slot, image.x, image.y).second);
                });
                const int most_x = x_repeats ? 3 : 0, most_y = y_repeats ? 4 : 0;
                for (std::uint32_t k = 0; k < places.size(); ++k)
                    for (int right = -most_x; right <= most_x; ++right)
                        for (int up = -most_y; up <= most_y; ++up) {
                            const double dx = places[k].first + right * width - x,
                                         dy = places[k].second + up * height - y;
                            if (dx * dx + dy * dy < reach * reach)
                                CHECK(found.count({k, right, up}) == 1);
                        }
            }
}
