// SPDX-License-Identifier: BSD-3-Clause
// The self-check on data that it sees at the end of a step: as the engines leave it, on every scene
// the tests have, and with one thing made wrong. Spoilt is a copy: the engines have no way to fail
// on purpose.
#include "check/state_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "catch.hpp"

#include "event_driven/event_driven_engine.hpp"
#include "local_discs.hpp"
#include "scene_tools.hpp"
#include "scenes.hpp"
#include "shape_parts.hpp"
#include "simulation/simulation.hpp"
#include "time_stepped.hpp"
#include "time_stepped/time_stepped_engine.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};

std::vector<Disc> share_of(const TestScene& scene, const Communicator& world) {
    std::vector<Disc> mine;
    for (const Disc& disc : reference::stored_states(scene.setting, scene.discs)) {
        if (static_cast<int>(disc.id % static_cast<DiscId>(world.size())) == world.rank())
            mine.push_back(disc);
    }
    return mine;
}

Scene checked_scene(const TestScene& test_scene, Method method) {
    Scene scene = scene_of(test_scene);
    scene.method = method;
    return scene;
}

std::unique_ptr<Engine> engine_of(const Scene& scene, StoredState state,
                                  const Communicator& world) {
    if (scene.method == Method::event_driven)
        return make_event_driven_engine(scene, std::move(state), world, {});
    return make_time_stepped_engine(scene, std::move(state), world, {});
}

/// The text of a failure in the first steps of a scene; empty if there is none, or the engine
/// refuses the scene.
std::string failure_of(const TestScene& test_scene, Method method, const Communicator& world) {
    Scene scene = checked_scene(test_scene, method);
    try {
        std::vector<InputDisc> mine;
        for (const InputDisc& disc : test_scene.discs) {
            if (static_cast<int>(disc.id % static_cast<DiscId>(world.size())) == world.rank())
                mine.push_back(disc);
        }
        Simulation simulation(scene, std::move(mine), world, {});
        simulation.check_every_step(scene);
        const std::int64_t last = std::min<std::int64_t>(test_scene.steps,
                                                         method == Method::event_driven ? 4
                                                         : world.size() == 1            ? 70
                                                                                        : 6);
        while (simulation.step() < last) simulation.advance_towards(last);
    } catch (const CheckFailure& failure) {
        return failure.what();
    } catch (const InputError&) { // overlaps, in the event-driven method
    } catch (const CollectiveError& error) {
        if (!test_scene.cascades_when_event_driven) return error.what();
    }
    return {};
}

TestScene gas_of(const Effects& effects) {
    TestScene scene = gas(64, 0.4, 0.3, 901);
    scene.setting.effects = effects;
    return scene;
}

/// Effects that a check has to make allowance for; `is_for_one`: in the time-stepped method too.
struct NamedEffects {
    const char* name;
    Effects effects;
    bool is_for_one;
};
std::vector<NamedEffects> all_effects() {
    Effects none, lossy, lossy_walls, thermal, piston, falling, pile, slowed, sinking;
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
    sinking = pile;
    sinking.drag = 0.05;
    Effects mixed, heaps, rubbing, rolling; // the last keeps its energy
    mixed.species = {{14, 1, 4}, {30, 0.8, 1}, {20, 0.5, 0.5}};
    heaps = pile;
    heaps.species = mixed.species;
    rubbing.contact = {ContactKind::rough, 0.9, 0.001, 0.3, 0.4, 0.5};
    rolling = mixed;
    rolling.contact = {
        ContactKind::rough, 1, 0.001, 1, std::numeric_limits<double>::infinity(), 0.3};
    return {{"no contact", none, true},
            {"restitution", lossy, true},
            {"lossy walls", lossy_walls, true},
            {"a thermal wall", thermal, true},
            {"pistons", piston, false},
            {"gravity", falling, false},
            {"a pile", pile, false},
            {"drag", slowed, false},
            {"gravity and drag", sinking, false},
            {"several classes", mixed, true},
            {"a pile of several classes", heaps, false},
            {"rough discs", rubbing, true},
            {"perfectly rough discs of several classes", rolling, true}};
}

/// What the check sees after the first step of a gas, and what it says when that has been spoilt.
class OneStep {
public:
    explicit OneStep(Method method, const Effects& effects = {})
        : world_(Communicator::world()), test_scene_(gas_of(effects)),
          scene_(checked_scene(test_scene_, method)),
          engine_(engine_of(scene_, {share_of(test_scene_, world_), 0}, world_)),
          check_(scene_, engine_->own(), 0, world_, {}, 0, engine_->spins()) {
        engine_->log_to(&log);
        engine_->advance_towards(1);
        local_view = copy_of(engine_->local_view());
        spins.assign(engine_->spins().begin(), engine_->spins().end());
    }

    /// This rank's own disc of that id, or null.
    Disc* own(DiscId id) {
        for (std::size_t i = 0; i < local_view.n_own; ++i) {
            if (local_view.discs[i].id == id) return &local_view.discs[i];
        }
        return nullptr;
    }
    void sort_into_cells() { local_view.sort_into_cells(scene_.box_size, scene_.radius); }
    const Scene& scene() const { return scene_; }
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

    /// The failure, after a check that all ranks have met the same one.
    std::optional<CheckFailure> look() {
        std::optional<CheckFailure> met;
        try {
            check_.look(local_view.view(), engine_->micro_steps_done(), log, spins);
        } catch (const CheckFailure& failure) {
            met = failure;
        }
        std::string text = met ? met->what() : "";
        world_.broadcast(text);
        CHECK(text == (met ? met->what() : ""));
        return met;
    }

    LocalDiscs local_view;
    std::vector<double> spins; ///< along the own discs, of rough ones
    std::vector<Collision> log;

private:
    Communicator world_;
    TestScene test_scene_;
    Scene scene_;
    std::unique_ptr<Engine> engine_;
    StateCheck check_;
};

/// Spoils a step under both rules and checks what is said of it: the invariant, the step, and the
/// disc if `disc` is given.
void expect(Invariant invariant, const std::function<std::optional<DiscId>(OneStep&)>& spoil) {
    for (const Method method : both) {
        INFO("rule " << (method == Method::time_stepped ? "time-stepped" : "event-driven"));
        OneStep step(method);
        const std::optional<DiscId> disc = spoil(step);
        const auto failure = step.look();
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

} // namespace

TEST_CASE("check: nothing is wrong in the scenes of the tests") {
    const Communicator world = Communicator::world();
    std::size_t number = 0;
    for (const TestScene& scene : small_scenes()) {
        ++number;
        for (const Method method : both) {
            if (is_left_to_others(number + (method == Method::time_stepped))) continue;
            if (method == Method::event_driven &&
                (scene.cascades_when_event_driven || scene.discs.size() > 100))
                continue;
            INFO(scene.name << (method == Method::time_stepped ? ", one" : ", all"));
            CHECK(failure_of(scene, method, world) == "");
        }
    }
}

TEST_CASE("check: nothing is wrong in a step that is not spoilt") {
    for (const Method method : both) CHECK(!OneStep(method).look().has_value());
}

TEST_CASE("check: nothing is wrong in scenes with effects") {
    const Communicator world = Communicator::world();
    std::size_t number = 0;
    for (const NamedEffects& named : all_effects()) {
        ++number;
        for (const Method method : both) {
            if (is_left_to_others(number + (method == Method::time_stepped))) continue;
            if (method == Method::time_stepped && !named.is_for_one) continue;
            TestScene scene = gas_of(named.effects);
            scene.steps = 60;
            scene.setting.sync_every = 7;
            scene.setting.micro_steps = 2;
            Scene checked = checked_scene(scene, method);
            std::vector<InputDisc> mine;
            for (const InputDisc& disc : scene.discs)
                if (static_cast<int>(disc.id % static_cast<DiscId>(world.size())) == world.rank())
                    mine.push_back(disc);
            Simulation simulation(checked, std::move(mine), world, {});
            simulation.check_every_step(checked);
            INFO(named.name << (method == Method::time_stepped ? ", one" : ", all"));
            CHECK_NOTHROW([&] {
                while (simulation.step() < scene.steps) simulation.advance_towards(scene.steps);
            }());
        }
    }
}

namespace {

/// The invariant that a check of a step with effects finds broken once `spoil` has had its way;
/// none if it finds nothing.
std::optional<Invariant> found_in(const Effects& effects,
                                  const std::function<void(OneStep&)>& spoil) {
    OneStep step(Method::event_driven, effects);
    spoil(step);
    const auto failure = step.look();
    return failure ? std::optional(failure->invariant) : std::nullopt;
}

} // namespace

TEST_CASE("check: with effects, what is wrong is found all the same") {
    const auto faster = [](DiscId id, double factor) {
        return [=](OneStep& step) {
            Disc* const disc = step.own(id);
            if (!disc) return;
            disc->x += disc->vx * (1 - factor) * (step.local_view.time - disc->tau); // where it was
            disc->vx *= factor;
        };
    };
    const auto free_disc_faster = [&](double factor) {
        return [=](OneStep& step) { faster(step.free_disc(), factor)(step); };
    };
    const auto collided_disc_faster = [&](double factor) {
        return [=](OneStep& step) { faster(step.first_pair().p, factor)(step); };
    };
    for (const NamedEffects& named : all_effects()) {
        INFO(named.name);
        CHECK(found_in(named.effects, [](OneStep&) {}) == std::nullopt);
        CHECK(found_in(named.effects, free_disc_faster(1 + 1e-9)) == Invariant::motion);
        CHECK(found_in(named.effects, [](OneStep& step) {
                  if (step.own(7)) ++step.own(7)->wall_collisions;
              }) == Invariant::counters);
        if (named.effects.contact.kind == ContactKind::none) continue;
        CHECK(found_in(named.effects, collided_disc_faster(3)) == Invariant::energy);
    }
    const auto turns_faster = [](OneStep& step, DiscId id) {
        if (const Disc* const disc = step.own(id))
            step.spins[static_cast<std::size_t>(disc - step.local_view.discs.data())] += 0.2;
    };
    for (const NamedEffects& named : all_effects()) {
        if (named.effects.contact.kind != ContactKind::rough) continue;
        CHECK(found_in(named.effects, [&](OneStep& step) {
                  turns_faster(step, step.free_disc());
              }) == Invariant::motion);
        CHECK(found_in(named.effects,
                       [&](OneStep& step) { turns_faster(step, step.first_pair().p); }) ==
              (named.effects.contact.restitution == 1
                   ? std::optional(Invariant::energy)
                   : std::nullopt)); // else it might be what is lost
    }
    Effects piston;
    piston.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.5};
    CHECK(found_in(piston, [](OneStep& step) { // inside the box as it was, outside as it is
              if (Disc* const disc = step.own(7))
                  disc->x += step.scene().box_size - step.scene().radius - 0.2 -
                             disc->x_at(step.local_view.time);
          }) == Invariant::in_box);
    Effects falling;
    falling.gravity.y = -0.03;
    CHECK(found_in(falling, collided_disc_faster(1 + 1e-9)) == Invariant::energy);
}

TEST_CASE("check: a number that is not finite") {
    expect(Invariant::finite, [](OneStep& step) {
        if (Disc* const disc = step.own(7)) disc->y = std::numeric_limits<double>::quiet_NaN();
        return 7;
    });
}

TEST_CASE("check: a disc that nobody owns any more") {
    expect(Invariant::owned_once, [](OneStep& step) {
        if (Disc* const disc = step.own(7)) {
            std::swap(*disc, step.local_view.discs[step.local_view.n_own - 1]);
            --step.local_view.n_own;
        }
        return 7;
    });
}

TEST_CASE("check: a disc that is owned twice") {
    expect(Invariant::owned_once, [](OneStep& step) {
        if (step.own(8)) step.own(8)->id = 7; // 8 is lost as well, but 7 comes first
        return 7;
    });
}

TEST_CASE("check: a disc that does not exist") {
    expect(Invariant::owned_once, [](OneStep& step) -> std::optional<DiscId> {
        if (step.own(0)) step.own(0)->id = 64;
        return std::nullopt;
    });
}

TEST_CASE("check: a disc outside the box, by little") {
    expect(Invariant::in_box, [](OneStep& step) {
        const double size = step.scene().box_size;
        if (Disc* const disc = step.own(7))
            disc->y += (size - step.scene().radius) * (1 + 1e-12) -
                       disc->y_at(step.local_view.time);
        return 7;
    });
}

TEST_CASE("check: a disc in another rank's strip") {
    if (Communicator::world().size() == 1) return;
    expect(Invariant::in_strip, [](OneStep& step) {
        if (Disc* const disc = step.own(7)) {
            const double from_left = step.scene().radius,
                         from_right = step.scene().box_size - step.scene().radius;
            const bool is_left = step.local_view.strips.owner(from_left) == step.world().rank();
            disc->x += (is_left ? from_right : from_left) - disc->x_at(step.local_view.time);
        }
        return 7;
    });
}

TEST_CASE("check: a disc in another cell than it is filed under") {
    expect(Invariant::in_cell, [](OneStep& step) {
        if (Disc* const disc = step.own(7)) {
            const double y = disc->y_at(step.local_view.time),
                         width = step.local_view.grid.geometry().cell_width;
            disc->y += y > step.scene().box_size / 2 ? -width : width;
        }
        return 7;
    });
}

TEST_CASE("check: collisions that are counted but have not happened") {
    expect(Invariant::counters, [](OneStep& step) {
        if (step.own(7)) ++step.own(7)->wall_collisions;
        return 7;
    });
    expect(Invariant::counters, [](OneStep& step) {
        if (step.own(7)) ++step.own(7)->pair_collisions;
        return 7;
    });
}

TEST_CASE("check: a pair's collision that one of the two has not counted") {
    expect(Invariant::counters, [](OneStep& step) {
        const DiscId q = step.first_pair().q;
        if (step.own(q)) --step.own(q)->pair_collisions;
        return q;
    });
}

TEST_CASE("check: a collision that is not in the log") {
    expect(Invariant::counters, [](OneStep& step) {
        const Collision lost = step.first_pair();
        std::erase_if(step.log, [&](const Collision& c) {
            return c.p == lost.p && c.q == lost.q && c.time == lost.time;
        });
        return lost.p;
    });
}

TEST_CASE("check: a velocity that has changed without a collision") {
    expect(Invariant::motion, [](OneStep& step) {
        const DiscId id = step.free_disc();
        if (Disc* const disc = step.own(id)) disc->vx = std::nextafter(disc->vx, 10);
        return id;
    });
}

TEST_CASE("check: energy that a collision has made up") {
    expect(Invariant::energy, [](OneStep& step) -> std::optional<DiscId> {
        const Collision pair = step.first_pair();
        if (step.own(pair.p)) step.own(pair.p)->vx *= 1 + 1e-11;
        return std::nullopt;
    });
}
