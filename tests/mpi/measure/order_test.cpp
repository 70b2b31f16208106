// SPDX-License-Identifier: BSD-3-Clause
// psi6 and Voronoi neighbours, compared with bisectors of all pairs and with lattices. Discs of
// different radii have the neighbours of the radical tessellation.
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"
#include "parallel/exchange.hpp"
#include "simulation/disc_order.hpp"
#include "statistics/voronoi_cell.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Boundary repeated{BoundaryKind::periodic, 1, 0, 0};

struct Case {
    const char* name;
    Method method;
    Effects effects;
    std::size_t n_discs = 120;
    double height = 1; ///< height of the box over its width
};

std::vector<Case> cases() {
    Effects none, around, along_y, piston, apart, mixed, growing;
    around.boundaries.fill(repeated);
    along_y.boundaries[2] = along_y.boundaries[3] = repeated;
    along_y.gravity = {-0.003, 0};
    piston.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.05};
    piston.species = {{60, 1, 2}, {60, 0.5, 1}};
    apart = around;
    apart.contact.kind = ContactKind::none;
    mixed = around;
    mixed.species = {{10, 1, 1}, {50, 0.1, 1}, {60, 0.6, 1}};
    growing = mixed;
    growing.growth = 0.001;
    return {{"walls", Method::time_stepped, none},
            {"periodic", Method::event_driven, around},
            {"periodic along y, with gravity", Method::event_driven, along_y},
            {"a piston, two species", Method::event_driven, piston},
            {"discs that overlap", Method::time_stepped, apart},
            {"four discs", Method::event_driven, around, 4},
            {"periodic, three sizes", Method::time_stepped, mixed},
            {"three sizes that grow", Method::event_driven, growing},
            {"a flat box", Method::event_driven, around, 121, 1.5}};
}

TestScene test_of(const Case& each) {
    TestScene test = gas(each.n_discs, 0.3, 0.7, 78);
    test.setting.effects = each.effects;
    test.setting.box_height = each.height * test.setting.box_size; // room above the discs
    test.setting.micro_steps = 2;
    test.setting.sync_every = 24;
    test.steps = 60;
    return test;
}

SceneParameters with_psi6(const TestScene& test, Method method) {
    SceneParameters scene = measured(test, method, 9, 5);
    MeasurementOutput& output = *scene.measurements;
    output.quantities = {"radial_distribution", "psi6", "thermo"};
    output.give("largest_distance", std::min({output.settings["largest_distance"].value,
                                              scene.box.x / 2, scene.box.y / 2}));
    return scene;
}

struct Point {
    DiscId id = 0;
    double x = 0, y = 0;
    double squared_radius = 0; ///< squared radius of the disc; 0 if all discs are equal
};

std::vector<Point> all_points(const DiscSystem& system, const Communicator& world) {
    std::vector<Point> mine;
    for (const DiscState& disc : system.shown())
        mine.push_back({disc.id, disc.x_at(system.clock()), disc.y_at(system.clock())});
    std::vector<std::vector<Point>> out(static_cast<std::size_t>(world.size()), mine);
    std::vector<Point> all = send_to_owners(world, out).items;
    std::sort(all.begin(), all.end(), [](const Point& a, const Point& b) { return a.id < b.id; });
    return all;
}

void set_radii(std::vector<Point>& points, const Effects& effects, double step) {
    for (Point& point : points) {
        DiscId end = 0;
        for (const Species& one : effects.species) {
            const bool is_of_it = point.id >= end && point.id < end + one.count;
            if (is_of_it)
                point.squared_radius = std::pow(one.radius * (1 + effects.growth * step), 2);
            end += one.count;
        }
    }
}

/// Neighbours by the definition. Consider the line of points with equally long tangents to both
/// discs, which for equal radii is the bisector. Two discs are neighbours if some point of this
/// line is in the box and tangents from it to all other discs are longer.
class Bisectors {
public:
    Bisectors(std::vector<Point> points, const Extent& box, bool is_periodic_x, bool is_periodic_y)
        : points_(std::move(points)), box_(box) {
        const int across = is_periodic_x ? 2 : 0, along = is_periodic_y ? 2 : 0;
        for (const Point& p : points_)
            for (int n = -across; n <= across; ++n)
                for (int m = -along; m <= along; ++m)
                    images_.push_back({p.id, p.x + n * (box.x_high - box.x_low),
                                       p.y + m * (box.y_high - box.y_low), p.squared_radius});
        if (is_periodic_x) box_.x_low = -1e9, box_.x_high = 1e9;
        if (is_periodic_y) box_.y_low = -1e9, box_.y_high = 1e9;
    }

    std::vector<std::complex<double>> psi6(std::vector<double>& counts) const {
        std::vector<std::complex<double>> result;
        for (const Point& p : points_) {
            std::complex<double> sum = 0;
            int n = 0;
            for (const Point& q : images_) {
                if ((q.x == p.x && q.y == p.y) || !are_neighbours(p, q)) continue;
                sum += std::polar(1.0, 6 * std::atan2(q.y - p.y, q.x - p.x));
                ++n;
            }
            counts[static_cast<std::size_t>(std::min(n, 12))] += 1;
            result.push_back(n > 0 ? sum / static_cast<double>(n) : 0);
        }
        return result;
    }

private:
    bool are_neighbours(const Point& p, const Point& q) const {
        const double along_x = p.y - q.y, along_y = q.x - p.x,
                     square = along_x * along_x + along_y * along_y,
                     share = 0.5 + (p.squared_radius - q.squared_radius) / (2 * square);
        const double x = p.x + share * (q.x - p.x), y = p.y + share * (q.y - p.y);
        double low = -1e9, high = 1e9;
        const auto keep = [&](double slope, double limit) { // keeps points with slope t <= limit
            if (slope > 0) high = std::min(high, limit / slope);
            if (slope < 0) low = std::max(low, limit / slope);
            if (slope == 0 && limit < 0) high = low;
        };
        keep(along_x, box_.x_high - x), keep(-along_x, x - box_.x_low);
        keep(along_y, box_.y_high - y), keep(-along_y, y - box_.y_low);
        for (const Point& other : images_) {
            if ((other.x == p.x && other.y == p.y) || (other.x == q.x && other.y == q.y)) continue;
            const double ex = other.x - p.x, ey = other.y - p.y;
            keep(ex * along_x + ey * along_y,
                 (ex * ex + ey * ey + p.squared_radius - other.squared_radius) / 2 -
                     ex * (x - p.x) - ey * (y - p.y));
            if (high - low < 1e-9) return false;
        }
        return true;
    }

    std::vector<Point> points_, images_;
    Extent box_;
};

/// The expected tables.
struct ByHand {
    std::vector<double> psi6, neighbours = std::vector<double>(13, 0),
                              moduli = std::vector<double>(20, 0), pairs = moduli, g6 = moduli;

    void add(const std::vector<Point>& points, const Extent& box, const SceneParameters& scene) {
        const bool x = scene.effects.is_periodic_x(), y = scene.effects.is_periodic_y();
        const auto orders = Bisectors(points, box, x, y).psi6(neighbours);
        std::complex<double> all = 0;
        for (std::size_t i = 0; i < orders.size(); ++i) {
            all += orders[i];
            moduli[std::min<std::size_t>(static_cast<std::size_t>(20 * std::abs(orders[i])), 19)] +=
                1;
            for (std::size_t j = 0; j < i; ++j) {
                const auto nearest = [](double d, double length, bool is_periodic) {
                    return is_periodic ? std::remainder(d, length) : d;
                };
                const double bin = 20 / scene.measurements->settings.at("largest_distance").value *
                                   std::hypot(nearest(points[i].x - points[j].x, scene.box.x, x),
                                              nearest(points[i].y - points[j].y, scene.box.y, y));
                if (!(bin < 20)) continue;
                pairs[static_cast<std::size_t>(bin)] += 1;
                g6[static_cast<std::size_t>(bin)] += (std::conj(orders[i]) * orders[j]).real();
            }
        }
        psi6.push_back(std::abs(all) / static_cast<double>(orders.size()));
    }
};

} // namespace

TEST_CASE("measurements: psi6 and neighbours are those of bisectors of all pairs") {
    const Communicator world = Communicator::world();
    for (const Case& each : cases()) {
        INFO(each.name);
        const TestScene test = test_of(each);
        const SceneParameters scene = with_psi6(test, each.method);
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        ByHand expected;
        for (std::int64_t step = 5; step <= 32; step += 9) {
            advance_to(system, sampler, step);
            std::vector<Point> points = all_points(system, world);
            set_radii(points, scene.effects, static_cast<double>(step));
            expected.add(points, extent_at(scene.effects, scene.box, static_cast<double>(step)),
                         scene);
        }
        const std::vector<MeasuredTable> tables = sampler.tables();
        CHECK(column_of(tables, "neighbours", "count") == expected.neighbours);
        CHECK(column_of(tables, "psi6_distribution", "count") == expected.moduli);
        CHECK(column_of(tables, "psi6_correlation", "pairs") == expected.pairs);
        const std::vector<double> psi6 = column_of(tables, "psi6_history", "psi6"),
                                  g6 = column_of(tables, "psi6_correlation", "g6");
        REQUIRE(psi6.size() == 4);
        CHECK(psi6 == column_of(tables, "thermo", "psi6"));
        for (std::size_t k = 0; k < psi6.size(); ++k)
            CHECK(psi6[k] == Approx(expected.psi6[k]).margin(1e-12));
        for (std::size_t k = 0; k < g6.size(); ++k)
            CHECK(g6[k] * expected.pairs[k] == Approx(expected.g6[k]).margin(1e-9));
        if (scene.effects.is_periodic_x() && scene.effects.is_periodic_y()) {
            double sum = 0; // Euler: six neighbours on average
            const std::vector<double> counts = column_of(tables, "neighbours", "count");
            for (std::size_t k = 0; k < counts.size(); ++k)
                sum += counts[k] * static_cast<double>(k);
            CHECK(sum == 6.0 * 4 * static_cast<double>(each.n_discs));
        }
    }
}

TEST_CASE("measurements: the structure factor is that of sums over all discs") {
    const Communicator world = Communicator::world();
    const Case each = cases().back();
    const TestScene test = test_of(each);
    SceneParameters scene = with_psi6(test, each.method);
    leave_out(scene, "psi6");
    scene.measurements->quantities.push_back("structure_factor");
    const double kx = 2 * std::numbers::pi / scene.box.x, ky = 2 * std::numbers::pi / scene.box.y,
                 largest = 8.7 * kx, n_discs = static_cast<double>(each.n_discs);
    scene.measurements->give("largest_wavenumber", largest);
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    std::vector<double> sums(20, 0), counts(20, 0);
    double highest = 0;
    advance_to(system, sampler, 5);
    const std::vector<Point> points = all_points(system, world);
    for (int n = -9; n <= 9; ++n) {
        for (int m = -14; m <= 14; ++m) {
            const double k = std::hypot(kx * n, ky * m);
            if (k > largest || k == 0) continue;
            std::complex<double> mode = 0;
            for (const Point& p : points) mode += std::polar(1.0, kx * n * p.x + ky * m * p.y);
            sums[static_cast<std::size_t>(k / largest * 20)] += std::norm(mode) / 2;
            counts[static_cast<std::size_t>(k / largest * 20)] += 0.5;
            highest = std::max(highest, std::norm(mode) / n_discs);
        }
    }
    const std::vector<MeasuredTable> tables = sampler.tables();
    CHECK(column_of(tables, "structure_factor", "count") == counts);
    CHECK(column_of(tables, "structure_factor_peak", "S")[0] == Approx(highest).epsilon(1e-10));
    const std::vector<double> s = column_of(tables, "structure_factor", "S");
    for (std::size_t k = 0; k < 20; ++k)
        CHECK((counts[k] == 0 ? std::isnan(s[k])
                              : s[k] == Approx(sums[k] / counts[k] / n_discs).epsilon(1e-10)));
}

TEST_CASE("measurements: psi6 goes on from what was stored, to the same tables") {
    const Communicator world = Communicator::world();
    const Case each = cases()[1];
    const TestScene test = test_of(each);
    const SceneParameters scene = with_psi6(test, each.method);
    check_going_on(scene, test, 33, 60, world);
}

TEST_CASE("measurements: in a square lattice psi6 is 0, each disc with four neighbours") {
    const Communicator world = Communicator::world();
    TestScene test = lattice(12, 1.5);
    test.setting.effects.boundaries.fill(repeated);
    test.setting.box_size = 12 * 1.5;
    const SceneParameters scene = scene_of(test);
    DiscSystem system = system_of(scene, test, world);
    const HexaticSums sums = hexatic_order(system, 5, 10);
    CHECK(sums.neighbours[4] == 144);
    CHECK(sums.modulus.value() == Approx(0).margin(1e-12));
}

TEST_CASE("measurements: in a triangular lattice without end psi6 is 1") {
    const Communicator world = Communicator::world();
    TestScene test = empty_scene("triangular", 12, 0.25, 0);
    test.setting.effects.boundaries.fill(repeated);
    test.setting.box_height = 14 * std::sqrt(0.75);
    for (int row = 0; row < 14; ++row)
        for (int k = 0; k < 12; ++k)
            add_disc(test, 0.1 + k + 0.5 * (row % 2), 0.1 + row * std::sqrt(0.75));
    const SceneParameters scene = scene_of(test);
    DiscSystem system = system_of(scene, test, world);
    const HexaticSums sums = hexatic_order(system, 5, 10);
    CHECK(sums.neighbours[6] == 12 * 14);
    CHECK(sums.real.value() == Approx(12 * 14).epsilon(1e-13));
    CHECK(sums.imaginary.value() == Approx(0).margin(1e-10));
    for (std::size_t k = 2; k < 10; ++k) // bins from the first neighbours on
        CHECK(sums.products[k].value() ==
              Approx(static_cast<double>(sums.pairs[k])).epsilon(1e-12));
}

TEST_CASE("measurements: in a piece of a triangular lattice psi6 is 1 inside") {
    const Communicator world = Communicator::world();
    TestScene test = empty_scene("triangular", 400, 0.5, 0);
    test.setting.effects.boundaries.fill(repeated);
    for (int row = 0; row < 11; ++row)
        for (int k = 0; k < 11; ++k)
            add_disc(test, 20 + k + 0.5 * (row % 2), 20 + row * std::sqrt(0.75));
    const SceneParameters scene = scene_of(test);
    DiscSystem system = system_of(scene, test, world);
    const HexaticSums sums = hexatic_order(system, 1.5, 1000);
    CHECK(sums.neighbours[6] >= 81); // the discs inside
    CHECK(sums.moduli.back() >= 81); // the bin from 0.999 on
    std::vector<Point> points;
    for (const InputDisc& disc : test.discs) points.push_back({disc.id, disc.x, disc.y});
    std::vector<double> counts(13, 0);
    const auto orders = Bisectors(points, {0, 400, 0, 400}, true, true).psi6(counts);
    std::complex<double> all = 0;
    for (const auto& order : orders) all += order;
    for (std::size_t k = 0; k < counts.size(); ++k)
        CHECK(static_cast<double>(sums.neighbours[k]) == counts[k]);
    CHECK(sums.real.value() == Approx(all.real()).margin(1e-9));
    CHECK(std::abs(orders[60] - 1.0) < 1e-13); // the disc in the middle
}

TEST_CASE("measurements: a Voronoi cell of six equal neighbours is a hexagon") {
    VoronoiCell cell;
    cell.begin(-5, 5, -5, 5);
    for (int k = 0; k < 6; ++k)
        cell.cut(std::cos(k * std::numbers::pi / 3), std::sin(k * std::numbers::pi / 3), k);
    cell.cut(0, std::sqrt(3.0), 6);
    int n_sides = 0;
    cell.for_each_side([&](int point, double squared_length) {
        if (point == 6) return; // touches a corner at most
        CHECK(squared_length == Approx(1.0 / 3));
        ++n_sides;
    });
    CHECK(n_sides == 6);
    CHECK(cell.squared_radius() == Approx(1.0 / 3));
}
