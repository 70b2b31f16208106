// SPDX-License-Identifier: BSD-3-Clause
// Discs that a program changes between steps, copies in memory, and arrays by id. Results
// are compared with two discs computed by hand, with uninterrupted runs, and between rank counts.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <mpi.h>

#include "library_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

Scene periodic_gas(const char* method, std::int64_t steps) {
    Scene scene = gas(method, steps);
    for (const char* side : {"left", "right", "bottom", "top"})
        scene.set(std::string("box.") + side + ".kind", "periodic");
    return scene;
}

/// Reverses the velocities of all discs.
void reverse(Simulation& simulation) {
    std::vector<Disc> discs = simulation.discs();
    for (Disc& disc : discs) disc.vx = -disc.vx, disc.vy = -disc.vy;
    simulation.change_discs(discs);
}

double farthest(const std::vector<Disc>& a, const std::vector<Disc>& b) {
    double farthest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
        farthest = std::max({farthest, std::fabs(a[i].x - b[i].x), std::fabs(a[i].y - b[i].y)});
    return farthest;
}

} // namespace

TEST_CASE("changes: a disc that is turned round comes back from where it was") {
    const Session session;
    Scene scene;
    scene.set("box.size", 100).set("discs.radius", 5).set("time.steps", 50);
    scene.set("time.method", "event-driven");
    scene.set_discs(std::vector<Disc>{{.id = 0, .x = 20, .y = 50, .vx = 1}});
    Simulation simulation(session, scene);
    simulation.advance(10);
    std::vector<Disc> discs = simulation.discs();
    for (Disc& disc : discs) disc.vx = -2, disc.y = 30;
    simulation.change_discs(discs);
    // The disc flies from 30 to the wall at 5 in 12.5 steps, and back for 7.5 steps
    simulation.advance(20);
    discs = simulation.gathered_discs();
    if (session.is_root())
        CHECK(discs ==
              std::vector<Disc>{{.id = 0, .x = 20, .y = 30, .vx = 2, .wall_collisions = 1}});
    CHECK(simulation.averages().first_step == 10);
}

TEST_CASE("changes: all discs turned round retrace their paths") {
    const Session session;
    for (const Scene& scene : {gas("event-driven", 40), periodic_gas("event-driven", 40)}) {
        Simulation simulation(session, scene);
        const std::vector<Disc> start = simulation.gathered_discs();
        simulation.advance(12);
        const std::uint64_t there = simulation.totals().pair_collisions;
        reverse(simulation);
        simulation.advance(12);
        CHECK(there > 20);
        CHECK(simulation.totals().pair_collisions == 2 * there);
        CHECK(farthest(start, simulation.gathered_discs()) < 1e-8);
    }
}

TEST_CASE("changes: what is there already changes no bit, and copies go on alike") {
    const Session session;
    Scene measured = periodic_gas("event-driven", 40);
    measured.set("output.measurements.quantities", "[\"displacement\", \"velocities\"]");
    measured.set("output.measurements.every_steps", 4);
    for (const Scene& scene : {gas("time-stepped", 40), gas("event-driven", 40), measured}) {
        Simulation cut(session, scene), whole(session, scene);
        whole.advance_to_end();
        cut.advance(13);
        const std::string before = hash_of(cut);
        cut.change_discs(cut.discs());
        CHECK(hash_of(cut) == before);
        CHECK(cut.averages().first_step == 0);
        Simulation twin = cut.copy();
        CHECK(hash_of(twin) == before);
        reverse(cut); // the copy is not affected
        CHECK(hash_of(cut) != before);
        CHECK(hash_of(twin) == before);
        twin.advance_to_end();
        CHECK(hash_of(twin) == hash_of(whole));
        CHECK(twin.averages().pressure.value == whole.averages().pressure.value);
        const auto tables = twin.measurements(), wanted = whole.measurements();
        CHECK(tables.size() == wanted.size());
        for (std::size_t k = 0; k < std::min(tables.size(), wanted.size()); ++k)
            CHECK(tables[k].rows == wanted[k].rows);
    }
}

TEST_CASE("changes: one rank alone and all ranks together come to the same state") {
    const Session session;
    const Session alone(static_cast<int>(MPI_Comm_c2f(MPI_COMM_SELF)));
    for (const Scene& scene : {gas("time-stepped", 30), periodic_gas("event-driven", 30)}) {
        Simulation together(session, scene), mine(alone, scene, {.threads = 2});
        for (Simulation* simulation : {&together, &mine}) {
            simulation->advance(7);
            std::vector<Disc> discs = simulation->discs();
            for (Disc& disc : discs)
                if (disc.id % 3 == 0) disc.vx = 0.25 * disc.vx + 0.01, disc.vy = -disc.vy;
            simulation->change_discs(discs);
            simulation->advance_to_end();
        }
        CHECK(hash_of(together) == hash_of(mine));
    }
}

TEST_CASE("changes: numbers and places that cannot be are refused, and nothing changes") {
    const Session session;
    Simulation simulation(session, gas("event-driven", 20));
    simulation.advance(5);
    const std::string before = hash_of(simulation);
    const auto refused = [&](const auto& spoil) {
        std::vector<Disc> discs = simulation.discs();
        for (Disc& disc : discs)
            if (disc.id == 7) spoil(disc);
        const std::string problems = problems_of([&] { simulation.change_discs(discs); });
        CHECK(hash_of(simulation) == before);
        return problems;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused([&](Disc& disc) { disc.vx = nan; }) == "disc 7: has a number that is not finite");
    CHECK(refused([](Disc& disc) { disc.x = 0.5; }).find("or in a wall") != std::string::npos);
    CHECK(refused([](Disc& disc) { disc.y = 60; }).find("outside") != std::string::npos);
    CHECK(refused([](Disc& disc) {
              disc.spin = 1;
          }).starts_with("change_discs: discs are smooth, and only rough discs turn"));
    std::vector<Disc> turning = simulation.discs();
    for (Disc& disc : turning) disc.spin = 1;
    const std::string spins = problems_of([&] { simulation.change_discs(turning); });
    CHECK(spins.find("smooth") != std::string::npos);
    CHECK(spins.find('\n') == std::string::npos); // one line for all discs
    CHECK(refused([](Disc& disc) { disc.id = 8; }).find("each of this rank's") !=
          std::string::npos);
    std::vector<Disc> all = simulation.gathered_discs();
    double place[] = {all.empty() ? 0 : all[3].x, all.empty() ? 0 : all[3].y};
    MPI_Bcast(static_cast<double*>(place), 2, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    CHECK(refused([&](Disc& disc) {
              disc.x = place[0];
              disc.y = place[1];
          }).find("discs overlap: 3 and 7 (by 1.5)") != std::string::npos);
    simulation.advance(1);
    CHECK(simulation.step() == 6);
}

TEST_CASE("changes: arrays by id hold what discs have") {
    const Session session;
    Scene scene = gas("event-driven", 10);
    Simulation simulation(session, scene);
    simulation.advance(10);
    std::vector<double> places(600, -1), velocities(600, -1), spins(300, -1);
    std::vector<std::int64_t> counts(600, -1);
    simulation.read_positions(places);
    simulation.read_velocities(velocities);
    simulation.read_spins(spins);
    simulation.read_collisions(counts);
    std::size_t n_written = 0;
    for (const Disc& disc : simulation.discs()) {
        CHECK(places[2 * disc.id] == disc.x);
        CHECK(places[2 * disc.id + 1] == disc.y);
        CHECK(velocities[2 * disc.id] == disc.vx);
        CHECK(velocities[2 * disc.id + 1] == disc.vy);
        CHECK(spins[disc.id] == 0);
        CHECK(counts[2 * disc.id] == static_cast<std::int64_t>(disc.wall_collisions));
        CHECK(counts[2 * disc.id + 1] == static_cast<std::int64_t>(disc.pair_collisions));
        ++n_written;
    }
    CHECK(static_cast<std::size_t>(std::count(spins.begin(), spins.end(), 0.0)) == n_written);
    CHECK(problems_of([&] { simulation.read_positions(spins); }) ==
          "read_positions: has room for 300 numbers; it wants 600");
    CHECK(simulation.kinds() == std::vector<DiscKind>(300, DiscKind{0.75, 1, 0}));
    Scene mixed;
    mixed.set("box.size", 60).set("time.steps", 1).set("time.method", "event-driven");
    mixed.set("discs.species", "[{count = 2, radius = 1, mass = 4}, {count = 3, radius = 0.5}]");
    CHECK(Simulation(session, mixed).kinds() ==
          std::vector<DiscKind>{{1, 4, 0}, {1, 4, 0}, {0.5, 1, 1}, {0.5, 1, 1}, {0.5, 1, 1}});
}
