// SPDX-License-Identifier: BSD-3-Clause
// Profiles on a grid, compared with sums over all discs of each cell; also in runs with a restart
// inside a block.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "engine/engine.hpp"
#include "measured_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr std::size_t n_x = 5, n_y = 3;

/// The discs of a cell, for each sample of a block.
using ProfileCell = std::vector<std::vector<SeenDisc>>;

double mass_of(const SeenDisc& disc) { return disc.id < 100 ? 1 : 4; }

struct CentredSums {
    double mass = 0, vx = 0, vy = 0, xx = 0, xy = 0, yy = 0, heat_x = 0, heat_y = 0;
};

/// Two passes: first the velocity of the centre of mass, then squares relative to it.
CentredSums centred(const std::vector<SeenDisc>& discs) {
    CentredSums sums;
    for (const SeenDisc& disc : discs) {
        sums.mass += mass_of(disc);
        sums.vx += mass_of(disc) * disc.vx;
        sums.vy += mass_of(disc) * disc.vy;
    }
    sums.vx /= sums.mass, sums.vy /= sums.mass;
    for (const SeenDisc& disc : discs) {
        const double a = disc.vx - sums.vx, b = disc.vy - sums.vy, m = mass_of(disc);
        sums.xx += m * a * a, sums.xy += m * a * b, sums.yy += m * b * b;
        sums.heat_x += m * (a * a + b * b) / 2 * a;
        sums.heat_y += m * (a * a + b * b) / 2 * b;
    }
    return sums;
}

/// Squares and heat relative to the mean of each sample. For n discs this leaves (n - 1) / n of the
/// squares, and (n - 1)(n - 2) / n^2 of the third powers.
std::vector<double> row_of_cell(const ProfileCell& cell, double area) {
    std::vector<SeenDisc> all;
    CentredSums about;
    double in_pair = 0, in_three = 0;
    for (const std::vector<SeenDisc>& discs : cell) {
        all.insert(all.end(), discs.begin(), discs.end());
        const double n = static_cast<double>(discs.size());
        if (n < 2) continue;
        const CentredSums one = centred(discs);
        const double of_squares = n / (n - 1);
        about.xx += of_squares * one.xx, about.xy += of_squares * one.xy;
        about.yy += of_squares * one.yy;
        in_pair += n;
        if (n < 3) continue;
        const double of_heat = n * n / ((n - 1) * (n - 2));
        about.heat_x += of_heat * one.heat_x, about.heat_y += of_heat * one.heat_y;
        in_three += n;
    }
    const CentredSums mean = centred(all);
    const double n = static_cast<double>(all.size()),
                 per_area = 1 / (area * static_cast<double>(cell.size()));
    return {n,
            in_pair,
            n * per_area,
            mean.vx,
            mean.vy,
            (about.xx + about.yy) / (2 * in_pair),
            n / in_pair * about.xx * per_area,
            n / in_pair * about.xy * per_area,
            n / in_pair * about.yy * per_area,
            n / in_three * about.heat_x * per_area,
            n / in_three * about.heat_y * per_area};
}

SceneParameters with_profiles(const TestScene& test, Method method) {
    SceneParameters scene = measured(test, method, 5, 3);
    scene.measurements->quantities = {"profiles"};
    scene.measurements->give("profile_columns", n_x);
    scene.measurements->give("profile_rows", n_y);
    scene.measurements->give("profile_samples", 3);
    return scene;
}

TestScene profiled_mixture() {
    TestScene test = gas(300, 0.2, 0.5, 91);
    test.setting.effects.species = {{100, test.setting.radius, 1}, {200, test.setting.radius, 4}};
    test.setting.sync_every = 16;
    test.steps = 40;
    return test;
}

} // namespace

TEST_CASE("measurements: profiles are what the discs of each cell give") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        const TestScene test = profiled_mixture();
        const SceneParameters scene = with_profiles(test, method);
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        std::vector<std::vector<double>> expected;
        std::vector<ProfileCell> cells(n_x * n_y);
        std::size_t n_samples = 0;
        for (std::int64_t step = 0; step <= 40; ++step) {
            advance_to(system, sampler, step);
            if (step < 3 || (step - 3) % 5 != 0) continue;
            for (ProfileCell& cell : cells) cell.emplace_back();
            for (const SeenDisc& disc : seen_discs(system, world)) {
                const auto column = static_cast<std::size_t>(disc.x / scene.box.x * n_x),
                           row = static_cast<std::size_t>(disc.y / scene.box.y * n_y);
                cells[row * n_x + column].back().push_back(disc);
            }
            if (++n_samples % 3 != 0) continue;
            for (const ProfileCell& cell : cells)
                expected.push_back(row_of_cell(cell, scene.box.area() / (n_x * n_y)));
            cells.assign(n_x * n_y, {});
        }
        const std::vector<MeasuredTable> tables = sampler.tables();
        const MeasuredTable& table = table_of(tables, "profiles");
        REQUIRE(table.rows.size() == expected.size());
        REQUIRE(table.rows.size() == 2 * n_x * n_y); // eight samples are two whole blocks
        double total = 0;
        for (std::size_t k = 0; k < expected.size(); ++k) {
            total += table.rows[k][3];
            CHECK(table.rows[k][0] == (k < n_x * n_y ? 13 : 28));
            // all columns except those of contacts
            for (std::size_t column = 0; column < expected[k].size(); ++column)
                CHECK(table.rows[k][3 + column + (column < 9 ? 0 : 3)] ==
                      Approx(expected[k][column]).epsilon(1e-11).margin(1e-13));
        }
        CHECK(total == 2 * 3 * 300);
    }
}

/// Records this rank's collisions of pairs.
struct Recorded : PairFollower {
    void take(std::span<const PairEvent> more) override {
        events.insert(events.end(), more.begin(), more.end());
    }
    std::vector<PairEvent> events;
};

/// The share of the line that lies in the rectangle, by clipping it at one edge after another.
double share_within(const PairEvent& event, double left, double right, double bottom, double top) {
    double from = 0, to = 1;
    const auto clip = [&](double at, double along, double low, double high) {
        if (along == 0) {
            if (at < low || at >= high) to = from;
            return;
        }
        const double a = (low - at) / along, b = (high - at) / along;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    };
    clip(event.x, event.dx, left, right);
    clip(event.y, event.dy, bottom, top);
    return std::max(to - from, 0.0);
}

/// Impulse times distance, xx and xy, and energy times distance, of all images of the lines that
/// lie in a cell.
std::array<double, 4> contact_sums(const std::vector<PairEvent>& events, double left, double bottom,
                                   double width, double height, const Box& box) {
    std::array<double, 4> sums{};
    for (const PairEvent& event : events) {
        double share = 0;
        for (const int i : {-1, 0, 1})
            for (const int j : {-1, 0, 1})
                share += share_within(event, left + i * box.x, left + width + i * box.x,
                                      bottom + j * box.y, bottom + height + j * box.y);
        // Pairs are elastic, so p loses what q gains.
        const double mass = event.p < 100 ? 1 : 4, ux = event.p_vx - event.ix / mass,
                     uy = event.p_vy - event.iy / mass,
                     lost = mass *
                            (ux * ux + uy * uy - event.p_vx * event.p_vx -
                             event.p_vy * event.p_vy) /
                            2;
        sums[0] -= share * event.ix * event.dx;
        sums[1] -= share * (event.ix * event.dy + event.iy * event.dx) / 2;
        sums[2] += share * lost * event.dx;
        sums[3] += share * lost * event.dy;
    }
    return sums;
}

TEST_CASE("measurements: collisions' stress is shared along the line between centres") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene test = profiled_mixture();
        for (Boundary& side : test.setting.effects.boundaries) side.kind = BoundaryKind::periodic;
        SceneParameters scene = with_profiles(test, method);
        scene.measurements->give("profile_columns", 13);
        scene.measurements->give("profile_rows", 22); // some cells are lower than a radius
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        advance_to(system, sampler, 13);
        Recorded recorded;
        system.engine().followers_of_pairs().add(recorded);
        std::vector<Collision> log;
        system.log_to(&log);
        advance_to(system, sampler, 28);
        system.log_to(nullptr);
        system.engine().followers_of_pairs().forget(recorded);
        std::vector<double> impulses, logged_impulses;
        for (const PairEvent& event : recorded.events)
            impulses.push_back(std::hypot(event.ix, event.iy));
        for (const Collision& collision : log)
            if (collision.q != Collision::wall) logged_impulses.push_back(collision.impulse);
        std::sort(impulses.begin(), impulses.end());
        std::sort(logged_impulses.begin(), logged_impulses.end());
        REQUIRE(impulses.size() == logged_impulses.size());
        REQUIRE(world.sum(std::uint64_t{impulses.size()}) > 100);
        for (std::size_t k = 0; k < impulses.size(); ++k)
            CHECK(impulses[k] == Approx(logged_impulses[k]).epsilon(1e-9));
        const std::vector<MeasuredTable> tables = sampler.tables();
        const std::vector<double> xx = column_of(tables, "profiles", "contact_xx"),
                                  xy = column_of(tables, "profiles", "contact_xy"),
                                  yy = column_of(tables, "profiles", "contact_yy"),
                                  vx = column_of(tables, "profiles", "vx"),
                                  vy = column_of(tables, "profiles", "vy"),
                                  heat_x = column_of(tables, "profiles", "contact_heat_x"),
                                  heat_y = column_of(tables, "profiles", "contact_heat_y");
        const std::vector<std::vector<PairEvent>> copies(static_cast<std::size_t>(world.size()),
                                                         recorded.events);
        const std::vector<PairEvent> events = send_to_owners(world, copies).items;
        const double width = scene.box.x / 13, height = scene.box.y / 22;
        for (std::size_t cell = 0; cell < 13 * 22; ++cell) {
            const std::array<double, 4> sums = contact_sums(
                events, static_cast<double>(cell % 13) * width,
                static_cast<double>(cell / 13) * height, width, height, scene.box);
            const double per = 1 / (width * height * 15); // impulses are summed over 15 steps
            CHECK(xx[13 * 22 + cell] == Approx(sums[0] * per).margin(1e-9));
            CHECK(xy[13 * 22 + cell] == Approx(sums[1] * per).margin(1e-9));
            // relative to the mean of the discs in the cell, if there are any
            const std::size_t k = 13 * 22 + cell;
            if (std::isnan(vx[k])) continue;
            CHECK(heat_x[k] + vx[k] * xx[k] + vy[k] * xy[k] == Approx(sums[2] * per).margin(1e-9));
            CHECK(heat_y[k] + vx[k] * xy[k] + vy[k] * yy[k] == Approx(sums[3] * per).margin(1e-9));
        }
    }
}

/// The same run on another grid.
std::vector<MeasuredTable> profiles_on(const TestScene& test, Method method, double columns,
                                       double rows, const Communicator& world) {
    SceneParameters scene = with_profiles(test, method);
    scene.measurements->give("profile_columns", columns);
    scene.measurements->give("profile_rows", rows);
    scene.measurements->give("profile_species", 1);
    scene.measurements->quantities = {"profiles", "pressure"};
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    advance_to(system, sampler, 33);
    return sampler.tables();
}

TEST_CASE("measurements: any grid of profiles adds up to the same totals") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        for (const bool is_periodic : {false, true}) {
            TestScene test = profiled_mixture();
            if (is_periodic)
                for (Boundary& side : test.setting.effects.boundaries)
                    side.kind = BoundaryKind::periodic;
            const std::vector<MeasuredTable> one = profiles_on(test, method, 1, 1, world),
                                             many = profiles_on(test, method, 13, 22, world);
            REQUIRE(table_of(one, "profiles_total").rows.size() == 2);
            CHECK(table_of(one, "profiles_total").rows == table_of(many, "profiles_total").rows);
            // Half the trace of the collisions' part is P - N kT / A. The quantity "pressure" has
            // both numbers from other sums. The first block is two intervals long, and the second
            // one three.
            const std::vector<double> pressures = column_of(one, "pressure_history", "pressure"),
                                      kT = column_of(one, "pressure_history", "temperature"),
                                      xx = column_of(one, "profiles_total", "contact_xx"),
                                      yy = column_of(one, "profiles_total", "contact_yy");
            const double density = 300 / test.setting.box().area();
            const auto contact = [&](std::size_t k) { return pressures[k] - density * kT[k]; };
            CHECK((xx[0] + yy[0]) / 2 == Approx((contact(0) + contact(1)) / 2).epsilon(1e-10));
            CHECK((xx[1] + yy[1]) / 2 ==
                  Approx((contact(2) + contact(3) + contact(4)) / 3).epsilon(1e-10));
            // In each cell the sum over species is the total.
            for (const char* column : {"count", "contact_xx", "contact_xy", "contact_yy"}) {
                const std::vector<double> all = column_of(many, "profiles", column),
                                          light = column_of(many, "profiles_1", column),
                                          heavy = column_of(many, "profiles_2", column);
                for (std::size_t k = 0; k < all.size(); ++k)
                    CHECK(light[k] + heavy[k] == Approx(all[k]).epsilon(1e-12).margin(1e-15));
            }
        }
    }
}

TEST_CASE("measurements: profiles go on inside a block") {
    const Communicator world = Communicator::world();
    const TestScene test = profiled_mixture();
    const SceneParameters scene = with_profiles(test, Method::event_driven);
    // At the stop one sample of the second block has been taken.
    check_going_on(scene, test, 21, 40, world);
}
