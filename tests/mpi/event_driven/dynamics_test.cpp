// SPDX-License-Identifier: BSD-3-Clause
// Conservation of energy, no overlaps, and the same state at every stop and after every restart, in
// the event-driven method. Also the scenes that it rejects.
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "catch.hpp"
#include <omp.h>

#include "core/errors.hpp"
#include "core/state_hash.hpp"
#include "event_driven.hpp"
#include "event_driven_runs.hpp"
#include "gathered.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

DiscSystem start(const TestScene& scene, const Communicator& world, Tuning tuning = {}) {
    SceneParameters all = scene_of(scene);
    all.method = Method::event_driven;
    tuning.threads = omp_get_max_threads();
    tuning.discs_per_thread = 1;
    return {all, {dealt_discs(scene, world, 3), 0}, world, tuning};
}

double deepest_overlap(const std::vector<DiscState>& discs, double time, double sigma) {
    double deepest = -sigma;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double dx = discs[i].x_at(time) - discs[j].x_at(time),
                         dy = discs[i].y_at(time) - discs[j].y_at(time);
            deepest = std::max(deepest, sigma - std::sqrt(dx * dx + dy * dy));
        }
    }
    return deepest;
}

/// The number of collisions whose pair has collided before, without another collision of either
/// disc in between.
std::size_t n_repeated(std::vector<Collision> log, std::size_t n_discs) {
    const auto key = [](const Collision& c) {
        return std::tuple(static_cast<double>(c.micro_step) + c.time, c.generation, c.p,
                          c.q != Collision::wall, c.q);
    };
    std::sort(log.begin(), log.end(),
              [&key](const Collision& a, const Collision& b) { return key(a) < key(b); });
    std::vector<DiscId> last_partner(n_discs, Collision::wall);
    std::size_t n = 0;
    for (const auto& [micro_step, time, generation, p, q, impulse] : log) {
        if (q != Collision::wall) {
            n += last_partner[p] == q && last_partner[q] == p;
            last_partner[q] = p;
        }
        last_partner[p] = q;
    }
    return n;
}

/// The message with which a run of the scene ends early; empty if it does not.
std::string failure_of(const TestScene& scene, const Communicator& world, int& code) {
    try {
        DiscSystem system = start(scene, world);
        while (system.step() < scene.steps) system.advance_towards(scene.steps);
    } catch (const InputError& error) {
        code = static_cast<int>(ExitCode::bad_input);
        return error.what();
    } catch (const CollectiveError& error) {
        code = static_cast<int>(error.code());
        return error.what();
    }
    code = 0;
    return {};
}

} // namespace

TEST_CASE("exact: energy is kept to 1e-12, no discs overlap by more than 64 ulp of the box, none "
          "collide twice at one contact") {
    const Communicator world = Communicator::world();
    for (const double packing : {0.2, 0.7}) {
        TestScene scene = gas(1600, packing, 0.4, 91);
        scene.steps = 30;
        DiscSystem system = start(scene, world);
        const Totals before = system.totals();
        std::vector<Collision> log;
        system.log_to(&log);
        while (system.step() < scene.steps) {
            system.advance_towards(std::min(system.step() + 5, scene.steps));
            const std::vector<DiscState> all = gathered(system.discs(), world);
            const double ulp = std::nextafter(scene.setting.box_size, 1e300) -
                               scene.setting.box_size;
            CHECK(deepest_overlap(all, system.clock(), 2 * scene.setting.radius) <= 64 * ulp);
        }
        const Totals after = system.totals();
        const std::vector<Collision> all_log = gathered(std::span<const Collision>(log), world);
        CHECK(all_log.size() == after.pair_collisions + after.wall_collisions);
        CHECK(n_repeated(all_log, scene.discs.size()) == 0);
        CHECK(after.pair_collisions > 4 * scene.discs.size());
        CHECK(after.overlapping_pairs == 0);
        CHECK(after.kinetic_energy == Approx(before.kinetic_energy).epsilon(1e-12));
    }
}

TEST_CASE("exact: every stop has the reference's state, and a run may start again from it") {
    const Communicator world = Communicator::world();
    for (TestScene scene : {gas(64, 0.5, 0.7, 92), zigzag(24, "tied", 93), lattice(6, 1.25),
                            break_shot(4, 0.5, 3, 0.1)}) {
        if (scene.name.find("lattice") != std::string::npos) {
            for (InputDisc& disc : scene.discs) disc.vx = disc.id % 2 == 0 ? 0.25 : -0.25;
        }
        scene.setting.sync_every = 3;
        scene.setting.micro_steps = 2;
        SceneParameters all = scene_of(scene);
        all.method = Method::event_driven;
        reference::EventDrivenReference reference(scene.setting, scene.discs);
        StoredState state{dealt_discs(scene, world, 4), 0};
        for (int step = 1; step <= 8; ++step) {
            reference.run_steps(1);
            Tuning tuning;
            tuning.threads = omp_get_max_threads();
            DiscSystem system(all, state, world, tuning);
            while (system.step() < step) system.advance_towards(step);
            state = {{system.discs().begin(), system.discs().end()}, system.micro_steps_done()};
            INFO(scene.name << ", step " << step);
            CHECK(system.clock() == reference.clock());
            CHECK(to_string(system.totals().hash) == to_string(hash_of(reference.discs())));
        }
    }
}

TEST_CASE("exact: discs that overlap are refused on all ranks, the first pairs named") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(100, 0.3, 0.1, 94);
    for (const std::size_t i : {20u, 50u, 90u}) {
        scene.discs[i].x = scene.discs[i - 1].x + 0.5;
        scene.discs[i].y = scene.discs[i - 1].y;
    }
    int code = 0;
    const std::string text = failure_of(scene, world, code);
    CHECK(code == 2);
    INFO(text);
    CHECK(text.find("pairs of discs overlap") != std::string::npos);
    CHECK(text.find(std::to_string(std::min(scene.discs[19].id, scene.discs[20].id)) + " and ") !=
          std::string::npos);
}

TEST_CASE("exact: collisions without end are reported on all ranks with the disc and the time") {
    const Communicator world = Communicator::world();
    TestScene filling = empty_scene("a disc that fills its box", 2, 1, 4);
    add_disc(filling, 1, 1, 0.5, 0);
    TestScene line = cradle(9, 0.5, 0, 1);
    line.steps = 4;
    for (const TestScene& scene : {filling, line}) {
        int code = 0;
        const std::string text = failure_of(scene, world, code);
        INFO(scene.name << ": " << text);
        CHECK(code == 3);
        CHECK(text.find("collides without end") != std::string::npos);
    }
}
