// SPDX-License-Identifier: BSD-3-Clause
// The self-check allows for effects, and still finds errors.
#include <numbers>

#include "check_runs.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("check: nothing is wrong in scenes with effects") {
    const Communicator world = Communicator::world();
    std::size_t number = 0;
    for (const NamedEffects& named : named_effects()) {
        ++number;
        for (const Method method : both) {
            if (is_left_to_others(number + (method == Method::time_stepped))) continue;
            if (method == Method::time_stepped && !named.is_for_one) continue;
            TestScene scene = gas_of(named.effects);
            scene.steps = 30;
            scene.setting.sync_every = 7;
            scene.setting.micro_steps = 2;
            SceneParameters checked = checked_scene(scene, method);
            std::vector<InputDisc> mine;
            for (const InputDisc& disc : scene.discs)
                if (static_cast<int>(disc.id % static_cast<DiscId>(world.size())) == world.rank())
                    mine.push_back(disc);
            DiscSystem system(checked, std::move(mine), world, {});
            system.check_every_step(checked);
            INFO(named.name << (method == Method::time_stepped ? ", one" : ", all"));
            CHECK_NOTHROW([&] {
                while (system.step() < scene.steps) system.advance_towards(scene.steps);
            }());
        }
    }
}

namespace {

/// The invariant that is reported as broken after `spoil` has changed a step with effects;
/// nothing if the check finds no error.
std::optional<Invariant> found_in(const Effects& effects,
                                  const std::function<void(OneStep&)>& spoil) {
    OneStep step(Method::event_driven, effects);
    spoil(step);
    const auto failure = step.inspect();
    return failure ? std::optional(failure->invariant) : std::nullopt;
}

} // namespace

TEST_CASE("check: with effects, what is wrong is found all the same") {
    const auto faster = [](DiscId id, double factor) {
        return [=](OneStep& step) {
            DiscState* const disc = step.own(id);
            if (!disc) return;
            // as if it had had this velocity all the time
            disc->x += disc->vx * (1 - factor) * (step.local_view.time - disc->tau);
            disc->vx *= factor;
        };
    };
    const auto free_disc_faster = [&](double factor) {
        return [=](OneStep& step) { faster(step.free_disc(), factor)(step); };
    };
    const auto collided_disc_faster = [&](double factor) {
        return [=](OneStep& step) { faster(step.first_pair().p, factor)(step); };
    };
    for (const NamedEffects& named : named_effects()) {
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
        if (const DiscState* const disc = step.own(id))
            step.spins[static_cast<std::size_t>(disc - step.local_view.discs.data())] += 0.2;
    };
    for (const NamedEffects& named : named_effects()) {
        if (named.effects.contact.kind != ContactKind::rough) continue;
        CHECK(found_in(named.effects, [&](OneStep& step) {
                  turns_faster(step, step.free_disc());
              }) == Invariant::motion);
        CHECK(found_in(named.effects,
                       [&](OneStep& step) { turns_faster(step, step.first_pair().p); }) ==
              (named.effects.contact.restitution == 1
                   ? std::optional(Invariant::energy)
                   : std::nullopt)); // a smaller excess might be energy that collisions take
    }
    Effects piston;
    piston.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.5};
    CHECK(found_in(piston, [](OneStep& step) { // inside the box at the start, but outside of it now
              if (DiscState* const disc = step.own(7))
                  disc->x += step.scene().box.x - step.scene().radius - 0.2 -
                             disc->x_at(step.local_view.time);
          }) == Invariant::in_box);
    Effects falling;
    falling.gravity.y = -0.03;
    CHECK(found_in(falling, collided_disc_faster(1 + 1e-9)) == Invariant::energy);
}

TEST_CASE("check: a disc beyond an oscillating wall is found where the wall is") {
    Effects shaken; // at step 1 the right wall is 0.35 inside
    shaken.boundaries[1] = {BoundaryKind::oscillating, 1, 0, 0, 0.5, 8, std::numbers::pi};
    const auto beside_wall = [](double gap) {
        return [=](OneStep& step) {
            if (DiscState* const disc = step.own(7))
                disc->x += step.scene().box.x - step.scene().radius - gap -
                           disc->x_at(step.local_view.time);
        };
    };
    CHECK(found_in(shaken, beside_wall(0.2)) == Invariant::in_box);
    CHECK(found_in(shaken, beside_wall(0.4)) != Invariant::in_box);
}

namespace {

/// A gas whose left side is open.
Effects open_at_left() {
    Effects effects;
    effects.boundaries[0] = {BoundaryKind::open, 1, 0, 0};
    return effects;
}

/// Removes a disc from the own discs, as if it had left the box at x.
void let_out(OneStep& step, DiscId id, double x) {
    LocalDiscs& now = step.local_view;
    for (std::size_t i = 0; i < now.n_own; ++i) {
        if (now.discs[i].id != id) continue;
        DiscState disc = now.discs[i];
        disc.x = x;
        disc.depart();
        step.departed.push_back(disc);
        now.discs.erase(now.discs.begin() + static_cast<std::ptrdiff_t>(i));
        --now.n_own;
        break;
    }
    step.sort_into_cells();
}

} // namespace

TEST_CASE("check: discs may leave by an open side, and in no other way") {
    const Effects open = open_at_left();
    CHECK(!found_in(open, [](OneStep&) {}));
    // The log lacks the departure of the disc.
    CHECK(found_in(open, [](OneStep& step) {
              let_out(step, step.free_disc(), -step.scene().radius);
          }) == Invariant::departed);
    // The departure is in the log, so only the position can be wrong.
    const auto depart_at = [](double radii_outside) {
        return [=](OneStep& step) {
            const DiscId id = step.free_disc();
            const bool is_mine = step.own(id) != nullptr;
            if (is_mine) step.log.push_back({0, 0.5, 0, id, Collision::wall, 0});
            if (is_mine) step.own(id)->wall_collisions += 1;
            let_out(step, id, -radii_outside * step.scene().radius);
        };
    };
    CHECK(!found_in(open, depart_at(1)));
    CHECK(found_in(open, depart_at(1.001)) == Invariant::departed);
}

TEST_CASE("check: the radius in the column is the one that a disc collides with") {
    const auto with_radii = [](double factor) {
        return [=](OneStep& step) {
            step.swapped_radii.assign(step.local_view.n_own, step.scene().radius);
            for (std::size_t i = 0; i < step.local_view.n_own; ++i)
                if (step.local_view.discs[i].id == 7) step.swapped_radii[i] *= factor;
        };
    };
    CHECK(!found_in({}, with_radii(1)));
    CHECK(found_in({}, with_radii(1 - 0x1p-52)) == Invariant::radius);
}
