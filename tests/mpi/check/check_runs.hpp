// SPDX-License-Identifier: BSD-3-Clause
// Runs and single steps for tests of the self-check: correct ones, and ones with a single error.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catch.hpp"

#include "check/state_check.hpp"
#include "event_driven/event_driven_engine.hpp"
#include "local_discs.hpp"
#include "scene_tools.hpp"
#include "scenes.hpp"
#include "shape_parts.hpp"
#include "simulation/disc_system.hpp"
#include "time_stepped.hpp"
#include "time_stepped/time_stepped_engine.hpp"

namespace carrom::test {

inline constexpr Method both[] = {Method::time_stepped, Method::event_driven};

inline DiscStates share_of(const TestScene& scene, const Communicator& world) {
    DiscStates mine;
    for (const DiscState& disc : reference::stored_states(scene.setting, scene.discs)) {
        if (static_cast<int>(disc.id % static_cast<DiscId>(world.size())) == world.rank())
            mine.push_back(disc);
    }
    return mine;
}

inline SceneParameters checked_scene(const TestScene& test_scene, Method method) {
    SceneParameters scene = scene_of(test_scene);
    scene.method = method;
    return scene;
}

inline std::unique_ptr<Engine> engine_of(const SceneParameters& scene, StoredState state,
                                         const Communicator& world) {
    if (scene.method == Method::event_driven)
        return make_event_driven_engine(scene, std::move(state), world, {});
    return make_time_stepped_engine(scene, std::move(state), world, {});
}

/// The message of a self-check that fails in the first steps of a scene; empty if no check fails
/// or if the engine rejects the scene.
inline std::string failure_of(const TestScene& test_scene, Method method,
                              const Communicator& world) {
    SceneParameters scene = checked_scene(test_scene, method);
    try {
        std::vector<InputDisc> mine;
        for (const InputDisc& disc : test_scene.discs) {
            if (static_cast<int>(disc.id % static_cast<DiscId>(world.size())) == world.rank())
                mine.push_back(disc);
        }
        DiscSystem system(scene, std::move(mine), world, {});
        system.check_every_step(scene);
        const std::int64_t last = std::min<std::int64_t>(test_scene.steps,
                                                         method == Method::event_driven ? 4
                                                         : world.size() == 1            ? 70
                                                                                        : 6);
        while (system.step() < last) system.advance_towards(last);
    } catch (const CheckFailure& failure) {
        return failure.what();
    } catch (const InputError&) { // overlaps are errors in the event-driven method
    } catch (const CollectiveError& error) {
        if (!test_scene.cascades_when_event_driven) return error.what();
    }
    return {};
}

inline TestScene gas_of(const Effects& effects) {
    TestScene scene = gas(64, 0.4, 0.3, 901);
    scene.setting.effects = effects;
    return scene;
}

/// Effects for which the check needs an allowance. `is_for_one`: also for the time-stepped method.
struct NamedEffects {
    const char* name;
    Effects effects;
    bool is_for_one;
};
inline std::vector<NamedEffects> named_effects() {
    Effects none, lossy, lossy_walls, thermal, piston, falling, pile, slowed, sinking, shaken;
    none.contact.kind = ContactKind::none;
    lossy.contact = {ContactKind::restitution, 0.8, 0.001};
    lossy_walls.boundaries[0].restitution = lossy_walls.boundaries[3].restitution = 0.6;
    thermal.boundaries[1] = {BoundaryKind::thermal, 1, 2, 0};
    piston.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.05};
    piston.boundaries[2] = {BoundaryKind::moving, 0.9, 0, 0.03};
    falling.gravity = {0.01, -0.03};
    pile = lossy;
    pile.gravity = {0, -0.1};
    pile.boundaries[2].restitution = 0.3;
    slowed.drag = 0.05;
    shaken = pile;
    shaken.boundaries[1] = {BoundaryKind::oscillating, 1, 0, 0, 0.3, 5, 0.1};
    shaken.boundaries[2] = {BoundaryKind::oscillating, 0.8, 0, 0, 0.2, 7.3, 0};
    sinking = pile;
    sinking.drag = 0.05;
    Effects mixed, heaps, rubbing, rolling, growing; // `rolling` keeps its energy
    mixed.species = {{14, 1, 4}, {30, 0.8, 1}, {20, 0.5, 0.5}};
    heaps = pile;
    heaps.species = mixed.species;
    rubbing.contact = {ContactKind::rough, 0.9, 0.001, 0.3, 0.4, 0.5};
    rolling = mixed;
    rolling.contact = {
        ContactKind::rough, 1, 0.001, 1, std::numeric_limits<double>::infinity(), 0.3};
    growing = mixed;
    growing.growth = 0.004;
    growing.boundaries[1].restitution = 0.9;
    return {{"no contact", none, true},
            {"restitution", lossy, true},
            {"lossy walls", lossy_walls, true},
            {"a thermal wall", thermal, true},
            {"pistons", piston, false},
            {"gravity", falling, false},
            {"a pile", pile, false},
            {"drag", slowed, false},
            {"gravity and drag", sinking, false},
            {"oscillating walls", shaken, false},
            {"several species", mixed, true},
            {"a pile of several species", heaps, false},
            {"rough discs", rubbing, true},
            {"perfectly rough discs of several species", rolling, true},
            {"growing discs", growing, false}};
}

/// The state after the first step of a gas, as it is passed to the check. A test may introduce an
/// error before the check.
class OneStep {
public:
    explicit OneStep(Method method, const Effects& effects = {})
        : world_(Communicator::world()), test_scene_(gas_of(effects)),
          scene_(checked_scene(test_scene_, method)),
          engine_(engine_of(scene_, {share_of(test_scene_, world_), 0}, world_)),
          check_(scene_, engine_->species_table(), engine_->own(), 0, world_, {}, 0,
                 engine_->side_columns()[SideColumn::spin]) {
        engine_->log_to(&log);
        engine_->advance_towards(1);
        local_view = copy_of(engine_->local_view());
        const std::span<const double> now = engine_->side_columns()[SideColumn::spin];
        spins.assign(now.begin(), now.end());
        departed.assign(engine_->departed().begin(), engine_->departed().end());
    }

    /// This rank's own disc of that id, or null.
    DiscState* own(DiscId id) {
        for (std::size_t i = 0; i < local_view.n_own; ++i) {
            if (local_view.discs[i].id == id) return &local_view.discs[i];
        }
        return nullptr;
    }
    void sort_into_cells() { local_view.sort_into_cells(scene_.box.x, scene_.radius); }
    const SceneParameters& scene() const { return scene_; }
    const Communicator& world() const { return world_; }

    /// The first collision of a pair on any rank, the same on all.
    Collision first_pair() const {
        Collision first;
        first.time = std::numeric_limits<double>::infinity();
        for (const Collision& collision : log) {
            if (collision.q != Collision::wall && collision.time < first.time) first = collision;
        }
        for (const Collision& other : world_.all_gather(first)) {
            if (other.time < first.time) first = other;
        }
        return first;
    }
    /// A disc that has collided with nothing, the same on all ranks.
    DiscId free_disc() const {
        std::vector<std::uint64_t> n_collisions(64, 0);
        for (const Collision& collision : log) {
            ++n_collisions[collision.p];
            if (collision.q != Collision::wall) ++n_collisions[collision.q];
        }
        world_.sum(n_collisions);
        return static_cast<DiscId>(std::find(n_collisions.begin(), n_collisions.end(), 0) -
                                   n_collisions.begin());
    }

    /// The failure, if there is one; also checks that all ranks have the same one.
    std::optional<CheckFailure> inspect() {
        std::optional<CheckFailure> met;
        try {
            check_.inspect(local_view.view(), engine_->micro_steps_done(), log,
                           {spins, swapped_radii, departed});
        } catch (const CheckFailure& failure) {
            met = failure;
        }
        std::string text = met ? met->what() : "";
        world_.broadcast(text);
        CHECK(text == (met ? met->what() : ""));
        return met;
    }

    LocalDiscs local_view;
    std::vector<double> spins;         ///< spins of the own discs, if discs are rough
    std::vector<double> swapped_radii; ///< radii of the own discs; empty if radii do not change
    std::vector<DiscState> departed;
    std::vector<Collision> log;

private:
    Communicator world_;
    TestScene test_scene_;
    SceneParameters scene_;
    std::unique_ptr<Engine> engine_;
    StateCheck check_;
};

/// Introduces an error into a step under both methods. Compares the failure with the expected
/// invariant, the step, and the disc if `disc` is given.
inline void expect(Invariant invariant,
                   const std::function<std::optional<DiscId>(OneStep&)>& spoil) {
    for (const Method method : both) {
        INFO("rule " << (method == Method::time_stepped ? "time-stepped" : "event-driven"));
        OneStep step(method);
        const std::optional<DiscId> disc = spoil(step);
        const auto failure = step.inspect();
        CHECK(failure.has_value());
        if (!failure) continue;
        INFO(failure->what());
        CHECK(failure->invariant == invariant);
        CHECK(failure->code() == ExitCode::broken_invariant);
        CHECK(failure->step == 1);
        CHECK((failure->rank >= 0 && failure->rank < step.world().size()));
        if (!disc) continue;
        CHECK(failure->disc == *disc);
        const bool is_own = step.own(*disc) != nullptr;
        if (is_own && invariant != Invariant::owned_once)
            CHECK(failure->rank == step.world().rank());
        const auto& around = failure->discs_around;
        CHECK(around.size() == 12);
        CHECK(std::any_of(around.begin(), around.end(),
                          [&](const InputDisc& d) { return d.id == *disc; }));
    }
}

} // namespace carrom::test
