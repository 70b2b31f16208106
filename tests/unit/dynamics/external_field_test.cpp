// SPDX-License-Identifier: BSD-3-Clause
// Potentials: the spline passes through its numbers and equals a second, independent solution, and
// the force is its derivative.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "dynamics/external_field.hpp"
#include "numbers_of_any_size.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Box box{12, 7};

FieldValues random_values(Numbers& random, std::size_t columns, std::size_t rows) {
    FieldValues values{columns, rows, {}};
    for (std::size_t k = 0; k < columns * rows; ++k)
        values.numbers.push_back(random.uniform(-1, 1));
    return values;
}

double spacing(std::size_t n, bool is_periodic, double length) {
    return length / static_cast<double>(is_periodic ? n : std::max<std::size_t>(1, n - 1));
}

/// Compares with differences of fourth order, at a position far enough from the box's ends.
void check_slopes(const ExternalField& field, double x, double y) {
    constexpr double h = 1e-3;
    const auto at = [&](double dx, double dy) { return field.at(x + dx, y + dy, box).energy; };
    const FieldPoint point = field.at(x, y, box);
    const double slope_x = (8 * (at(h, 0) - at(-h, 0)) - (at(2 * h, 0) - at(-2 * h, 0))) / (12 * h),
                 slope_y = (8 * (at(0, h) - at(0, -h)) - (at(0, 2 * h) - at(0, -2 * h))) / (12 * h);
    CHECK(point.slope_x == Approx(slope_x).margin(3e-6));
    CHECK(point.slope_y == Approx(slope_y).margin(3e-6));
}

} // namespace

TEST_CASE("fields: the spline goes through its numbers, and is smooth") {
    Numbers random(71);
    for (const bool is_periodic : {true, false}) {
        for (const std::size_t n : {1u, 2u, 3u, 4u, 5u, 17u}) {
            const FieldValues values = random_values(random, n, 6);
            const FieldSpline spline(values, is_periodic, !is_periodic);
            const double hx = spacing(n, is_periodic, box.x), hy = spacing(6, !is_periodic, box.y);
            for (std::size_t k = 0; k < values.numbers.size(); ++k) {
                const double x = hx * static_cast<double>(k % n),
                             y = hy * static_cast<double>(k / n);
                CHECK(spline.at(x, y, box).energy == Approx(values.numbers[k]).margin(1e-13));
                const FieldPoint before = spline.at(x - 1e-9, y - 1e-9, box),
                                 after = spline.at(x + 1e-9, y + 1e-9, box);
                CHECK(before.slope_x == Approx(after.slope_x).margin(1e-6));
                CHECK(before.slope_y == Approx(after.slope_y).margin(1e-6));
            }
        }
    }
}

TEST_CASE("fields: a line between walls stays one, and goes on beyond them") {
    FieldValues values{5, 3, {}};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 5; ++column)
            values.numbers.push_back(0.5 * column - 2.0 * row);
    const FieldSpline spline(values, false, false);
    for (const double x : {-0.5, 0.0, 4.1, 11.9, 12.5})
        for (const double y : {-0.1, 3.3, 7.2}) {
            const FieldPoint point = spline.at(x, y, box);
            CHECK(point.energy == Approx(0.5 * x / 3 - 2 * y / 3.5).margin(1e-13));
            CHECK(point.slope_x == Approx(0.5 / 3).margin(1e-13));
            CHECK(point.slope_y == Approx(-2 / 3.5).margin(1e-13));
        }
}

TEST_CASE("fields: a sine on a grid is the sine, to the fourth power of the spacing") {
    double worst[2] = {0, 0};
    for (const int fine : {0, 1}) {
        const std::size_t n = fine == 0 ? 16 : 32;
        FieldValues values{n, 1, {}};
        for (std::size_t k = 0; k < n; ++k)
            values.numbers.push_back(
                std::sin(2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n)));
        ExternalField grid, sine;
        grid.kind = FieldKind::grid, sine.kind = FieldKind::sine;
        grid.amplitude = sine.amplitude = 0.7;
        grid.values = values;
        grid.spline = FieldSpline(values, true, true);
        for (double x = 0; x < box.x; x += 0.01)
            worst[fine] = std::max(
                worst[fine], std::fabs(grid.at(x, 1, box).energy - sine.at(x, 1, box).energy));
        CHECK(grid.largest_curvature(box) == Approx(sine.largest_curvature(box)).epsilon(0.03));
    }
    CHECK(worst[0] < 2e-4);
    CHECK(worst[1] < worst[0] / 14);
}

TEST_CASE("fields: forces are the derivatives of potentials, below the largest curvature") {
    Numbers random(72);
    std::vector<ExternalField> fields(4);
    fields[0].kind = FieldKind::trap;
    fields[0].stiffness_x = 0.3, fields[0].stiffness_y = -0.2, fields[0].centre_y = 2;
    fields[1].kind = FieldKind::sine;
    fields[1].amplitude = 0.4, fields[1].waves = 3, fields[1].phase = 0.5, fields[1].axis = Axis::y;
    for (const std::size_t k : {2u, 3u}) {
        fields[k].kind = FieldKind::grid;
        fields[k].amplitude = 0.3;
        fields[k].values = random_values(random, 9, 5);
        fields[k].spline = FieldSpline(fields[k].values, k == 2, k == 3);
    }
    for (const ExternalField& field : fields) {
        const double most = field.largest_curvature(box) * (1 + 1e-9);
        for (int k = 0; k < 200; ++k) {
            const double x = random.uniform(0.1, 11.9), y = random.uniform(0.1, 6.9);
            check_slopes(field, x, y);
            const FieldPoint here = field.at(x, y, box), there = field.at(x + 1e-4, y, box);
            CHECK(std::fabs(there.slope_x - here.slope_x) <= 1e-4 * most + 1e-14);
        }
    }
}

TEST_CASE("fields: strengths follow species by their ids") {
    ExternalField field;
    CHECK(field.strength_of(12) == 1);
    field.strengths = {2, -1};
    field.ends = {10, 15};
    CHECK(field.strength_of(0) == 2);
    CHECK(field.strength_of(9) == 2);
    CHECK(field.strength_of(10) == -1);
    CHECK(field.strength_of(14) == -1);
    CHECK(field.largest_strength() == 2);
}
