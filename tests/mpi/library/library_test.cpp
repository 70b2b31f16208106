// SPDX-License-Identifier: BSD-3-Clause
// Scenes made in code. Results are compared with two discs computed by hand, with sums over the
// discs, and between rank counts.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <mpi.h>

#include "library_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

Scene empty_box(const char* method, std::int64_t steps) {
    Scene scene;
    scene.set("box.size", 100).set("discs.radius", 5);
    return scene.set("time.method", method).set("time.steps", steps);
}

const Disc* find(const std::vector<Disc>& discs, std::uint64_t id) {
    for (const Disc& disc : discs)
        if (disc.id == id) return &disc;
    return nullptr;
}

} // namespace

TEST_CASE("two discs that meet head on swap their velocities") {
    const Session session;
    for (const char* method : {"time-stepped", "event-driven"}) {
        Scene scene = empty_box(method, 50);
        // Discs in another order than their ids
        scene.set_discs(std::vector<Disc>{{.id = 1, .x = 80, .y = 50, .vx = -1},
                                          {.id = 0, .x = 20, .y = 50, .vx = 1}});
        Simulation simulation(session, scene);
        // They touch at step 25, 10 apart, at 45 and 55.
        simulation.advance(20);
        simulation.advance_to(50);
        const std::vector<Disc> discs = simulation.gathered_discs();
        if (!session.is_root()) {
            CHECK(discs.empty());
            continue;
        }
        CHECK(discs.size() == 2);
        if (discs.size() != 2) continue; // the check above has failed
        CHECK(discs[0] == Disc{.id = 0, .x = 20, .y = 50, .vx = -1, .pair_collisions = 1});
        CHECK(discs[1] == Disc{.id = 1, .x = 80, .y = 50, .vx = 1, .pair_collisions = 1});
    }
}

TEST_CASE("velocities are per step however many micro-steps there are") {
    const Session session;
    Scene scene = empty_box("time-stepped", 40);
    scene.set("time.micro_steps", 8);
    scene.set_discs(std::vector<Disc>{{.id = 0, .x = 80, .y = 25, .vx = 1}});
    Simulation simulation(session, scene);
    CHECK(simulation.scene().micro_steps == 8);
    simulation.advance_to_end(); // the wall stops its centre at 95, at step 15
    const std::vector<Disc> discs = simulation.discs();
    const Disc* const disc = find(discs, 0);
    if (disc != nullptr)
        CHECK(*disc == Disc{.id = 0, .x = 70, .y = 25, .vx = -1, .wall_collisions = 1});
    CHECK(simulation.totals().n_discs == 1);
    CHECK(simulation.totals().wall_collisions == 1);
    CHECK(simulation.totals().kinetic_energy == 0.5);
}

TEST_CASE("totals are sums over the discs of all ranks") {
    const Session session;
    for (const char* method : {"time-stepped", "event-driven"}) {
        Simulation simulation(session, gas(method, 60));
        CHECK(simulation.step() == 0);
        simulation.advance_to_end();
        const Totals totals = simulation.totals();
        const std::vector<Disc> all = simulation.gathered_discs();
        const Averages averages = simulation.averages();
        CHECK(totals.n_discs == 300);
        CHECK(averages.steps == 60);
        if (!session.is_root()) continue;
        CHECK(all.size() == 300);
        const Sums sums = sums_of(all);
        CHECK(totals.pair_collisions > 100);
        CHECK(sums.pair_collisions == 2 * totals.pair_collisions);
        CHECK(sums.wall_collisions == totals.wall_collisions);
        CHECK(sums.energy == Approx(totals.kinetic_energy).epsilon(1e-12));
        CHECK(sums.momentum_x == Approx(totals.momentum_x).margin(1e-10));
        CHECK(averages.collision_frequency.value ==
              Approx(static_cast<double>(sums.pair_collisions) / 300 / 60).epsilon(1e-12));
        for (std::size_t k = 0; k < all.size(); ++k) CHECK(all[k].id == k);
    }
}

TEST_CASE("one rank alone comes to the state that all ranks come to together") {
    const Session session;
    const Session alone(static_cast<int>(MPI_Comm_c2f(MPI_COMM_SELF)));
    CHECK(alone.size() == 1);
    for (const char* method : {"time-stepped", "event-driven"}) {
        Simulation together(session, gas(method, 40));
        Simulation mine(alone, gas(method, 40), {.threads = 2});
        together.advance_to(7); // steps may be divided among calls in any way
        together.advance_to_end();
        mine.advance_to_end();
        CHECK(hash_of(together) == hash_of(mine));
    }
}

TEST_CASE("a scene's text and the same keys set in code are one scene") {
    const Session session;
    const Scene text = Scene::from_text("[box]\nsize = 60\n[discs]\ncount = 300\nradius = 0.75\n"
                                        "speed = 0.5\nseed = 91\n[time]\nsteps = 20\n"
                                        "method = \"time-stepped\"\n");
    Simulation a(session, text), b(session, gas("time-stepped", 20));
    a.advance_to_end();
    b.advance_to_end();
    CHECK(hash_of(a) == hash_of(b));
    const SceneFacts facts = text.check();
    CHECK(facts.n_discs == 300);
    CHECK(facts.box == Box(60));
    CHECK(facts.steps == 20);
    CHECK_FALSE(facts.is_event_driven);
    CHECK(facts.packing == Approx(300 * 3.14159265358979 * 0.75 * 0.75 / 3600));
}

TEST_CASE("rough discs have the spins that they are given, times any micro-steps") {
    const Session session;
    Scene scene = empty_box("event-driven", 3);
    scene.set("time.micro_steps", 4).set("effects.contact.kind", "rough");
    scene.set("effects.contact.restitution", 1).set("effects.contact.tangential_restitution", 1);
    scene.set_discs(std::vector<Disc>{{.id = 0, .x = 20, .y = 50, .spin = 0.25},
                                      {.id = 1, .x = 60, .y = 50, .spin = -1.5}});
    Simulation simulation(session, scene);
    simulation.advance_to_end();
    const std::vector<Disc> discs = simulation.gathered_discs();
    if (!session.is_root()) return;
    REQUIRE(discs.size() == 2);
    CHECK(discs[0].spin == 0.25);
    CHECK(discs[1].spin == -1.5);
}

TEST_CASE("measurements are sampled as the run goes on, and no file is written") {
    const Session session;
    const std::string folder = "/tmp/carrom_library_test_measured";
    Scene scene = gas("event-driven", 20);
    scene.set("output.folder", folder);
    scene.set("output.measurements.quantities", "[\"velocities\"]");
    scene.set("output.measurements.every_steps", 5);
    Simulation simulation(session, scene);
    simulation.advance_to_end();
    bool has_speeds = false;
    for (const MeasuredTable& table : simulation.measurements()) {
        has_speeds = has_speeds || table.name == "speeds";
        REQUIRE(table.rows.size() == 100);
        CHECK(table.rows.front().size() == table.columns.size());
    }
    CHECK(has_speeds);
    CHECK_FALSE(std::filesystem::exists(folder));
    Simulation plain(session, gas("event-driven", 20));
    CHECK(plain.measurements().empty());
    plain.advance_to_end();
    CHECK(hash_of(plain) == hash_of(simulation));
}

TEST_CASE("every rank gets every problem of a scene at once") {
    const Session session;
    Scene wrong;
    wrong.set("box.size", -1).set("box.length", 3).set("time.steps", "many");
    const std::string problems = problems_of([&] { Simulation(session, wrong); });
    CHECK(problems.find("box.size: ") != std::string::npos);
    CHECK(problems.find("box.length: no such key") != std::string::npos);
    CHECK(problems.find("time.steps: ") != std::string::npos);
    CHECK(problems.find("discs.count") != std::string::npos);
    CHECK(problems.find("--set") == std::string::npos);
    CHECK(problems == problems_of([&] { wrong.check(); }));
    CHECK(problems_of([&] {
              Scene::from_file(session, "/nowhere/scene.toml");
          }).starts_with("/nowhere/scene.toml: cannot be opened"));
}

TEST_CASE("a pilot chooses the setting of a scene with an accuracy") {
    const Session session;
    Scene scene;
    scene.set("box.size", 60).set("discs.count", 300).set("discs.radius", 0.75);
    scene.set("discs.speed", 0.5).set("discs.seed", 91).set("time.steps", 20);
    // smaller than the resolution of a pilot, so the choice is known
    scene.set("time.accuracy", 0.001);
    std::vector<std::string> lines;
    Options options;
    options.messages = [&lines](const std::string& line) { lines.push_back(line); };
    Simulation chosen(session, scene, options);
    CHECK(chosen.scene().is_event_driven);
    chosen.advance_to_end();
    Simulation given(session, gas("event-driven", 20));
    given.advance_to_end();
    CHECK(hash_of(chosen) == hash_of(given));
    const bool is_said = std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
        return line.starts_with("accuracy 0.001: method = \"event-driven\"");
    });
    CHECK(is_said == session.is_root());
    CHECK(problems_of([&] {
              Simulation(session, scene.set("time.accuracy", -1));
          }).starts_with("time.accuracy: "));
}

TEST_CASE("wrong discs and steps are errors that name them") {
    const Session session;
    Scene scene = empty_box("event-driven", 5);
    const auto given = [&](std::vector<Disc> discs) {
        return problems_of([&] { Simulation(session, Scene(scene).set_discs(discs)); });
    };
    CHECK(given({{.id = 0, .x = 50, .y = 50}, {.id = 0, .x = 20, .y = 50}})
              .find("0 is there twice") != std::string::npos);
    CHECK(given({{.id = 0, .x = 50, .y = 50}, {.id = 2, .x = 20, .y = 50}}).find("1 is missing") !=
          std::string::npos);
    CHECK(given({{.id = 0, .x = 99, .y = 50}}).find("row 1") != std::string::npos);
    CHECK_FALSE(given({{.id = 0, .x = std::numeric_limits<double>::quiet_NaN()}}).empty());
    CHECK(given({{.id = 0, .x = 50, .y = 50}, {.id = 1, .x = 53, .y = 50}}).find("overlap") !=
          std::string::npos);
    CHECK_FALSE(given({}).empty());

    Simulation simulation(session, scene.set_discs(std::vector<Disc>{{.id = 0, .x = 50, .y = 50}}));
    CHECK(problems_of([&] { simulation.advance(6); }).find("time.steps = 5") != std::string::npos);
    simulation.advance(5);
    CHECK_FALSE(problems_of([&] { simulation.advance_to(4); }).empty());
    CHECK(simulation.step() == 5);
    CHECK_FALSE(problems_of([&] { Simulation(session, scene, {.threads = -1}); }).empty());
}

TEST_CASE("a body's errors become exit codes") {
    const Session session;
    CHECK(session.run([] { return 0; }) == 0);
    CHECK(session.run([&] { return session.rank() == session.size() - 1 ? 7 : 0; }) == 7);
    CHECK(session.run([]() -> int { throw CollectiveError("none", ExitCode::output_failure); }) ==
          4);
    CHECK(session.run([]() -> int { throw InputError({{"a test", 0, "of exit codes"}}); }) == 2);
}

TEST_CASE("objects that were moved from say so") {
    const Session session;
    Simulation first(session, gas("event-driven", 5));
    Simulation second = std::move(first);
    const auto is_told = [](const auto& act) {
        return problems_of(act).find("was moved from") != std::string::npos;
    };
    CHECK(is_told([&] { static_cast<void>(first.step()); }));
    CHECK(is_told([&] { first.advance(1); }));
    CHECK(is_told([&] { static_cast<void>(first.totals()); }));
    first = std::move(second);
    first.advance(1);
    CHECK(first.step() == 1);
}

TEST_CASE("ranks that do different things all get an error") {
    const Session session;
    const bool is_odd = session.rank() == session.size() - 1 && session.size() > 1;
    const bool is_alone = session.size() == 1;
    const std::string other = problems_of(
        [&] { Simulation(session, gas("event-driven", is_odd ? 6 : 5)); });
    CHECK((is_alone || other.find("has another scene") != std::string::npos));
    const std::string threads = problems_of(
        [&] { Simulation(session, gas("event-driven", 5), {.threads = is_odd ? -1 : 1}); });
    CHECK((is_alone || threads.find("-1 threads") != std::string::npos));
    Simulation simulation(session, gas("event-driven", 5));
    CHECK((is_alone || problems_of([&] {
                           simulation.advance_to(is_odd ? 2 : 1);
                       }).find("different calls") != std::string::npos));
    CHECK((is_alone || problems_of([&] {
                           if (is_odd)
                               static_cast<void>(simulation.averages());
                           else
                               static_cast<void>(simulation.totals());
                       }).find("different calls") != std::string::npos));
    const std::vector<Problem> mine(is_odd ? 1 : 0, Problem{"velocities", 0, "have two columns"});
    CHECK(problems_of([&] { session.agree_on(mine); }) ==
          (is_alone ? "" : "velocities: have two columns"));
    simulation.advance_to(3);
    CHECK(simulation.step() == 3);
}
