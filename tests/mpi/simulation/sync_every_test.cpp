// SPDX-License-Identifier: BSD-3-Clause
// Averages do not depend on how often states are synchronised, and those of the temperature are
// integrals over time. Syncs round states, so trajectories diverge after some fifteen collisions of
// each disc. These runs are shorter.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "catch.hpp"
#include <omp.h>

#include "averaging.hpp"
#include "scene_tools.hpp"
#include "simulation/disc_system.hpp"

using namespace carrom;

namespace {

constexpr std::size_t n_discs = 144;
constexpr std::int64_t n_steps = 64;

struct GasKind {
    std::string name;
    std::function<void(Effects&)> change;
    bool only_event_driven = false;
};

/// Contact times are short, because a sync resets them, which would change the physics.
std::vector<GasKind> kinds() {
    const auto for_each_side = [](Effects& effects, const Boundary& side) {
        effects.boundaries.fill(side);
    };
    const double any_friction = std::numeric_limits<double>::infinity();
    return {
        {"elastic", [](Effects&) {}},
        {"elastic, periodic",
         [=](Effects& e) { for_each_side(e, {.kind = BoundaryKind::periodic}); }},
        {"inelastic", [](Effects& e) { e.contact = {ContactKind::restitution, 0.8, 1e-7}; }},
        {"inelastic, periodic",
         [=](Effects& e) {
             e.contact = {ContactKind::restitution, 0.8, 1e-7};
             for_each_side(e, {.kind = BoundaryKind::periodic});
         }},
        {"rough",
         [=](Effects& e) { e.contact = {ContactKind::rough, 0.9, 1e-7, 0.5, any_friction, 0.5}; }},
        {"several species", [](Effects& e) { e.species = {{44, 1, 3}, {100, 0.8, 0.5}}; }},
        {"thermal",
         [=](Effects& e) {
             for_each_side(e, {.kind = BoundaryKind::thermal, .temperature = 0.1});
         }},
        {"walls that lose energy",
         [=](Effects& e) {
             for_each_side(e, {.restitution = 0.5});
             e.contact.contact_time = 1e-7; // the contact time holds at walls, too
         }},
        {"dragged", [](Effects& e) { e.drag = 0.02; }, true},
        {"falling", [](Effects& e) { e.gravity = {0.001, -0.004}; }, true},
        {"dragged and falling",
         [](Effects& e) {
             e.drag = 0.02;
             e.gravity.y = -0.004;
         },
         true},
        {"moving wall",
         [](Effects& e) { e.boundaries[1] = {.kind = BoundaryKind::moving, .speed = -0.02}; },
         true},
        {"open side", [](Effects& e) { e.boundaries[3].kind = BoundaryKind::open; }},
        {"growing", [](Effects& e) { e.growth = 0.002; }, true},
    };
}

struct Result {
    Averages averages;
    /// from the energies at all steps, with linear changes between steps
    double sampled_temperature = 0;
};

Result run(const GasKind& kind, Method method, std::int64_t sync_every) {
    const Communicator world = Communicator::world();
    test::TestScene test = test::gas(n_discs, 0.3, 0.1, 91);
    test.steps = n_steps;
    test.setting.sync_every = sync_every;
    kind.change(test.setting.effects);
    SceneParameters scene = test::scene_of(test);
    scene.method = method;
    Tuning tuning;
    tuning.threads = omp_get_max_threads();
    DiscSystem system(scene, world.is_root() ? test.discs : std::vector<InputDisc>{}, world,
                      tuning);
    test::Averaging averaging(scene, system, world);
    Result result;
    for (std::int64_t step = 0; step <= n_steps; ++step) {
        averaging.advance_to(step);
        const double weight = step == 0 || step == n_steps ? 0.5 : 1;
        result.sampled_temperature += weight * system.energies().kinetic_energy /
                                      static_cast<double>(n_discs * n_steps);
    }
    result.averages = averaging.averages();
    return result;
}

/// Equal to within a tenth of the error, or to a thousandth of the value if there is no error.
void check_same(std::string_view name, const Estimate& one, const Estimate& other) {
    const double error = std::isfinite(one.error) ? 0.1 * one.error : 1e-3 * std::fabs(one.value);
    CAPTURE(name, one.value, other.value, one.error);
    CHECK(std::isnan(one.value) == std::isnan(other.value));
    if (!std::isnan(one.value)) CHECK(std::fabs(one.value - other.value) <= error);
}

} // namespace

TEST_CASE("averages: sync_every does not change them, whatever changes the energy") {
    for (const GasKind& kind : kinds()) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            if (kind.only_event_driven && method == Method::time_stepped) continue;
            const Result often = run(kind, method, 1);
            CAPTURE(kind.name, static_cast<int>(method), often.averages.n_blocks);
            for (const std::int64_t sync_every : {7, 64}) {
                CAPTURE(sync_every);
                const Result other = run(kind, method, sync_every);
                const auto expected = often.averages.named(), found = other.averages.named();
                for (std::size_t k = 0; k < expected.size(); ++k)
                    check_same(expected[k].first, expected[k].second, found[k].second);
            }
            const bool has_drift = kind.name.find("periodic") != std::string::npos,
                       loses_discs = kind.name == "open side";
            if (has_drift || loses_discs) continue; // here kT is not the energy per disc
            CHECK(often.averages.temperature.value ==
                  Approx(often.sampled_temperature).epsilon(0.003));
        }
    }
}
