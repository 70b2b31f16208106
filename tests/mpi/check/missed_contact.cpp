// SPDX-License-Identifier: BSD-3-Clause
// Ends like a run whose search has missed a contact: disc 5 has flown into disc 9 without a
// collision.
//
// missed_contact RULE: writes the nearby discs to the working folder and ends with code 70 on every
// rank. In the event-driven method discs are rough and have two masses.
#include <cstdio>
#include <string>

#include "check/check_failure.hpp"
#include "check/state_check.hpp"
#include "local_discs.hpp"
#include "parallel/mpi.hpp"
#include "run/failure_scene.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Thirty discs in rows at rest, except disc 5, which reaches disc 9 half-way through the second
/// step.
std::vector<DiscState> thirty_discs() {
    std::vector<DiscState> discs;
    for (DiscId id = 0; id < 30; ++id) {
        DiscState& disc = discs.emplace_back();
        disc.id = id;
        disc.x = 5 + 10 * static_cast<double>(id % 6);
        disc.y = 5 + 10 * static_cast<double>(id / 6);
    }
    discs[5].x = discs[9].x - 8;
    discs[5].y = discs[9].y;
    discs[5].vx = 4;
    return discs;
}

} // namespace

int main(int argc, char** argv) {
    const Mpi mpi(argc, argv);
    return run_on_all(Communicator::world(), [&](const Communicator& world) {
        SceneParameters scene;
        scene.name = "thirty discs";
        scene.box = 60;
        scene.radius = 1;
        scene.n_discs = 30;
        scene.method = argc > 1 && std::string(argv[1]) == "event-driven" ? Method::event_driven
                                                                          : Method::time_stepped;
        if (scene.method == Method::event_driven) {
            scene.effects.species = {{9, 1, 2.5}, {21, 1, 0.5}};
            scene.effects.contact = {ContactKind::rough, 0.9, 0.002, 0.5, 0.25, 0.5};
            scene.effects.contact.rows = {{9, 0}, {30, 1}};
            scene.effects.contact.pairs = {{1, 2, 0.75, 0.125, 0.375}, {1, 1, 0.5, 0.5, 0.5}};
            scene.effects.surface_contacts.rows[1] = {{2, 0.25, 0.75, 0.125}};
            scene.effects.boundaries[3] = {BoundaryKind::thermal, 1, 2, 0};
            scene.effects.thermal_seed = 77;
        }
        const std::vector<DiscState> discs = thirty_discs();
        const auto at = [&](double time) {
            return view_by_hand(discs, time, scene.box.x, scene.radius, world.rank(), world.size());
        };
        const LocalDiscs start = at(0);
        const auto spins_of = [&](const LocalDiscs& local_view) {
            std::vector<double> spins;
            for (std::size_t i = 0; i < local_view.n_own && scene.method == Method::event_driven;
                 ++i)
                spins.push_back(0.125 * static_cast<double>(local_view.discs[i].id));
            return spins;
        };
        StateCheck check(scene, SpeciesTable(scene.effects.species, scene.radius),
                         std::span(start.discs).first(start.n_own), 0, world, {}, 0,
                         spins_of(start));
        try {
            for (const std::int64_t step : {1, 2}) {
                const LocalDiscs now = at(static_cast<double>(step));
                check.inspect(now.view(), step, {}, {spins_of(now)});
            }
        } catch (const CheckFailure& failure) {
            throw reported(failure, scene, world);
        }
        return 0;
    });
}
