// SPDX-License-Identifier: BSD-3-Clause
// Properties of every scene, tested on random ones in which errors are likely
// (troubled_scenes.hpp), for both methods: the reference's bits; no disc lost; energy to 1e-12;
// nothing outside the box; counters that agree with the log; the log in order; transposed scenes
// have transposed bits; another order in memory has the same bits. With random effects
// (troubled_effects.hpp): the reference's bits, no disc lost, a log that agrees, another order in
// memory. With discs that differ, turn, leave and meet obstacles (troubled_bodies.hpp): the same,
// each disc's own counters, energy, the self-check, and a restart.
//
// A scene that fails is reduced and printed. If it is added to tests/stability/regressions, it is
// tested in every run. $CARROM_TEST_SCENES sets how many scenes are drawn, $CARROM_TEST_SEED the
// first seed.
#include "catch.hpp"
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "core/errors.hpp"
#include "core/state_hash.hpp"
#include "event_driven.hpp"
#include "hold.hpp"
#include "regressions.hpp"
#include "runs.hpp"
#include "troubled_bodies.hpp"
#include "troubled_effects.hpp"
#include "troubled_scenes.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};

std::uint64_t n_cascades = 0; ///< scenes that are left out, because their reference does not end

struct State {
    std::vector<DiscState> discs;
    std::vector<double> spins; ///< spins of rough discs

    StateHash hash() const {
        StateHash sum = hash_of(discs);
        for (std::size_t id = 0; id < spins.size(); ++id)
            sum += hash_of(SideColumn::spin, id, spins[id]);
        return sum;
    }
};

template <class Reference> State state_after(Reference reference, std::int64_t steps) {
    reference.run_steps(steps);
    return {{reference.discs().begin(), reference.discs().end()},
            {reference.spins().begin(), reference.spins().end()}};
}

/// The final state of the method's reference; none in a collision cascade.
std::optional<State> reference_state(const TestScene& scene, Method method) {
    if (method == Method::time_stepped)
        return state_after(reference::TimeSteppedReference(scene.setting, scene.discs),
                           scene.steps);
    try {
        return state_after(reference::EventDrivenReference(scene.setting, scene.discs, 20000),
                           scene.steps);
    } catch (const std::runtime_error&) {
        ++n_cascades;
        return std::nullopt;
    }
}

bool is_transposed(const DiscState& a, const DiscState& b) {
    return a.x == b.y && a.y == b.x && a.vx == b.vy && a.vy == b.vx && a.tau == b.tau &&
           a.wall_collisions == b.wall_collisions && a.pair_collisions == b.pair_collisions;
}

/// Whether the log agrees with the discs' counters, and its times are in order and in range.
bool log_agrees(const TestScene& scene, Method method, const Totals& totals) {
    std::uint64_t n_walls = 0, n_pairs = 0;
    double last = 0;
    for (const Collision& collision : collisions_of(scene, method)) {
        const double time = static_cast<double>(collision.micro_step) + collision.time;
        if (time < last || time > static_cast<double>(scene.steps * scene.setting.micro_steps))
            return false;
        if (collision.q != Collision::wall && collision.p >= collision.q) return false;
        last = time;
        ++(collision.q == Collision::wall ? n_walls : n_pairs);
    }
    return n_walls == totals.wall_collisions && n_pairs == totals.pair_collisions;
}

bool has_same_bits_in_another_order(const TestScene& scene, Method method, const Outcome& end,
                                    double window = 0.37) {
    Tuning tuning;
    tuning.window = window;
    tuning.cell_width = 0.5;
    tuning.ranks_across = 2;
    return run(scene, method, tuning, 7).totals.hash == end.totals.hash;
}

/// The first property that fails, of those that hold under any effects; empty if all hold.
/// **Collective.**
std::string broken_with_effects(const TestScene& scene, Method method) {
    const auto expected = reference_state(scene, method);
    if (!expected) return {};
    const Outcome end = run(scene, method);
    if (end.discs.size() != scene.discs.size()) return "discs are lost";
    if (end.totals.hash != expected->hash()) return "other bits than the reference";
    if (!log_agrees(scene, method, end.totals)) return "log and counters do not agree";
    if (!has_same_bits_in_another_order(scene, method, end))
        return "other bits in another storage order";
    return {};
}

/// Whether the log agrees with the counters of each disc.
bool counters_agree(const TestScene& scene, Method method, const std::vector<DiscState>& discs) {
    std::vector<std::array<std::uint64_t, 2>> n(discs.size());
    for (const Collision& collision : collisions_of(scene, method)) {
        ++n[collision.p][collision.q != Collision::wall];
        if (collision.q != Collision::wall) ++n[collision.q][1];
    }
    return std::all_of(discs.begin(), discs.end(), [&n](const DiscState& disc) {
        return n[disc.id] == std::array{disc.wall_collisions, disc.pair_collisions};
    });
}

/// Twice the energy of motion and of spins.
long double energy_of(const State& state, const reference::Setting& setting) {
    long double sum = 0;
    for (const DiscState& disc : state.discs) {
        const long double turning = state.spins.empty()
                                        ? 0
                                        : setting.radius_of(disc.id) * state.spins[disc.id];
        const long double vx = disc.vx, vy = disc.vy;
        sum += setting.mass_of(disc.id) *
               (vx * vx + vy * vy + setting.effects.contact.inertia * turning * turning);
    }
    return sum;
}

/// Energy never grows if nothing gives any, and is constant if nothing takes any either. (Under
/// gravity the self-check tests it.)
bool energy_is_right(const TestScene& scene, const State& end) {
    const Effects& effects = scene.setting.effects;
    const auto has_side = [&effects](auto is_so) {
        return std::any_of(effects.boundaries.begin(), effects.boundaries.end(), is_so);
    };
    if (effects.gravity.is_on() || has_side([](const Boundary& side) {
            return side.kind == BoundaryKind::thermal || side.speed != 0;
        }))
        return true;
    const State start{reference::stored_states(scene.setting, scene.discs),
                      reference::stored_spins(scene.setting, scene.discs.size())};
    const long double before = energy_of(start, scene.setting),
                      growth = energy_of(end, scene.setting) - before;
    const ContactEffect& contact = effects.contact;
    const bool keeps_slip = contact.tangential_restitution == -1 || contact.friction == 0 ||
                            (contact.tangential_restitution == 1 && std::isinf(contact.friction));
    const bool are_lossy = contact.restitution < 1 ||
                           (contact.kind == ContactKind::rough && !keeps_slip) ||
                           effects.drag > 0 || effects.fixed_bodies.restitution < 1;
    const bool may_take = are_lossy || has_side([](const Boundary& side) {
                              return side.restitution < 1 || side.kind == BoundaryKind::open;
                          });
    return (may_take ? growth : std::fabs(growth)) <= 1e-12L * before;
}

/// Whether the program accepts the scene written as TOML, and reads the same scene.
bool reads_back(const TestScene& scene, Method method) {
    const auto [read, methods] = regression_of(toml_of(scene, method), "drawn.toml");
    const auto has_no_spin = [](const std::vector<double>& spins) {
        return std::all_of(spins.begin(), spins.end(), [](double spin) { return spin == 0; });
    };
    const std::vector<double>&spins = scene.setting.first_spins,
          &spins_read = read.setting.first_spins;
    return read.discs == scene.discs && read.setting.effects == scene.setting.effects &&
           read.setting.radius == scene.setting.radius &&
           (spins_read == spins || (has_no_spin(spins) && has_no_spin(spins_read)));
}

/// Whether the same run has the same bits if it is stopped half-way and restarted.
bool has_same_bits_begun_again(const TestScene& scene, Method method, const Outcome& end) {
    SceneParameters again = scene_of(scene);
    again.method = method;
    Tuning tuning;
    tuning.threads = omp_get_max_threads();
    tuning.discs_per_thread = 1;
    tuning.ranks_across = 3;
    DiscSystem first = start(scene, method);
    run_to(first, scene.steps / 2);
    DiscSystem second(again,
                      {{first.discs().begin(), first.discs().end()},
                       first.micro_steps_done(),
                       SideColumns(first.side_columns())},
                      Communicator::world(), tuning);
    run_to(second, scene.steps);
    return second.totals().hash == end.totals.hash;
}

/// Runs the scene with a self-check at every step, except in boxes with open sides.
Outcome run_checked(const TestScene& scene, Method method) {
    SceneParameters checked = scene_of(scene);
    checked.method = method;
    DiscSystem system = start(scene, method);
    if (!scene.setting.effects.have_open_boundaries()) system.check_every_step(checked);
    run_to(system, scene.steps);
    return outcome_of(system);
}

/// The first property that a run breaks, or empty text, for discs that differ, turn and leave,
/// among obstacles. Text after a colon is printed but not compared. **Collective.**
std::string broken_among_bodies(const TestScene& scene, Method method) {
    if (!is_clear(scene)) return "drawn with an overlap";
    try {
        if (!reads_back(scene, method)) return "another scene when read back";
        const auto expected = reference_state(scene, method);
        if (!expected) return {};
        const Outcome end = run_checked(scene, method);
        if (end.discs.size() != scene.discs.size()) return "discs are lost";
        if (end.totals.hash != expected->hash()) return "other bits than the reference";
        if (!energy_is_right(scene, *expected)) return "the energy has changed";
        if (!log_agrees(scene, method, end.totals) || !counters_agree(scene, method, end.discs))
            return "log and counters do not agree";
        if (!has_same_bits_in_another_order(scene, method, end) ||
            !has_same_bits_in_another_order(scene, method, end, 2.7))
            return "other bits in another storage order";
        if (!has_same_bits_begun_again(scene, method, end)) return "other bits after a restart";
    } catch (const InputError& error) {
        return std::string("refused: ") + error.what();
    } catch (const CollectiveError& error) {
        return std::string("ends: ") + error.what();
    }
    return {};
}

/// The first property that a run of a plain scene breaks, or empty text. **Collective.**
std::string broken_property(const TestScene& scene, Method method) {
    const auto expected = reference_state(scene, method);
    if (!expected) return {};
    const Outcome start_of_run = outcome_of(start(scene, method)), end = run(scene, method);
    if (end.discs.size() != scene.discs.size()) return "discs are lost";
    if (end.totals.hash != expected->hash()) return "other bits than the reference";
    const double energy = squared_speeds(start_of_run), speed = std::sqrt(energy);
    if (std::fabs(squared_speeds(end) - energy) > 1e-12 * energy) return "the energy has changed";
    const double latest = std::max(
        64.0, static_cast<double>(
                  std::min(scene.setting.sync_every, scene.steps * scene.setting.micro_steps)));
    if (farthest_outside(end, scene.setting) >
        4 * ulp_of(scene.setting.box_size) + speed * ulp_of(latest / 2))
        return "a disc is outside";
    if (!log_agrees(scene, method, end.totals)) return "log and counters do not agree";
    if (!has_same_bits_in_another_order(scene, method, end))
        return "other bits in another storage order";
    const Outcome mirror = run(transposed(scene), method);
    if (!std::equal(end.discs.begin(), end.discs.end(), mirror.discs.begin(), is_transposed))
        return "not bitwise transposed";
    return {};
}

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
    const char* const text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// `draw(seed, method)` makes the scenes, whose kind is `how`; `broken(scene, method)` describes
/// what fails in one.
template <class Draw>
void try_scenes(const std::string& how, std::uint64_t first, std::uint64_t count, const Draw& draw,
                std::string (*broken_in)(const TestScene&, Method) = broken_property) {
    for (const Method method : both) {
        double n_broken = 0;
        n_cascades = 0;
        for (std::uint64_t seed = first; seed < first + count && n_broken < 3; ++seed) {
            const TestScene scene = draw(seed, method);
            const std::string broken = broken_in(scene, method);
            if (broken.empty()) continue;
            n_broken += 1;
            const auto kind = [](const std::string& text) {
                return text.substr(0, text.find(':'));
            };
            const TestScene small = shrunk(scene, [&](const TestScene& trial) {
                try {
                    return kind(broken_in(trial, method)) == kind(broken);
                } catch (const InputError&) { // positions may overlap after rounding
                    return false;
                }
            });
            FAIL_CHECK(scene.name << ", rule " << name_of(method) << ": " << broken << "; small:\n"
                                  << toml_of(small, method));
        }
        CHECK(n_cascades <= count / 4);
        hold("property",
             std::to_string(count) + " random scenes drawn " + how + ": a property broken",
             name_of(method), n_broken, 0);
    }
}

TestScene troubled(std::uint64_t seed, Method) { return troubled_scene(seed); }
TestScene troubled_with_effects(std::uint64_t seed, Method method) {
    return with_effects(troubled_scene(seed), method, seed);
}
TestScene wildly_troubled(std::uint64_t seed, Method method) {
    return wildly_troubled_scene(seed, method == Method::time_stepped);
}

} // namespace

TEST_CASE("property: random scenes drawn for trouble", "[property]") {
    const std::uint64_t few = Communicator::world().size() == 1 ? 200 : 8;
    try_scenes("for trouble", number_from("CARROM_TEST_SEED", 1),
               number_from("CARROM_TEST_SCENES", few), troubled);
}

TEST_CASE("property: random scenes drawn wildly", "[property]") {
    const std::uint64_t few = Communicator::world().size() == 1 ? 100 : 6;
    try_scenes("wildly", number_from("CARROM_TEST_SEED", 1), number_from("CARROM_TEST_SCENES", few),
               wildly_troubled);
}

TEST_CASE("property: random scenes drawn for trouble, with effects", "[property]") {
    const std::uint64_t few = Communicator::world().size() == 1 ? 50 : 4;
    try_scenes("for trouble, with effects", number_from("CARROM_TEST_SEED", 1),
               number_from("CARROM_TEST_SCENES", few), troubled_with_effects, broken_with_effects);
}

TEST_CASE("property: random scenes of bodies drawn for trouble", "[property]") {
    const std::uint64_t few = Communicator::world().size() == 1 ? 100 : 6;
    try_scenes("of bodies, for trouble", number_from("CARROM_TEST_SEED", 1),
               number_from("CARROM_TEST_SCENES", few), troubled_bodies, broken_among_bodies);
}

TEST_CASE("property: fifty thousand random scenes of bodies", "[property][.hours]") {
    try_scenes("of bodies, for trouble", 1000000, 50000, troubled_bodies, broken_among_bodies);
}

TEST_CASE("property: fifty thousand random scenes with effects", "[property][.hours]") {
    try_scenes("for trouble, with effects", 1000000, 50000, troubled_with_effects,
               broken_with_effects);
}

TEST_CASE("property: a million random scenes", "[property][.hours]") {
    try_scenes("for trouble", 1000000, 1000000, troubled);
}

TEST_CASE("property: twenty thousand random scenes drawn wildly", "[property][.hours]") {
    try_scenes("wildly", 1000000, 20000, wildly_troubled);
}

TEST_CASE("property: scenes that have failed before", "[property]") {
    std::size_t n_scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(CARROM_REGRESSIONS)) {
        const auto [scene, methods] = read_regression(entry.path().string());
        for (const Method method : methods) {
            INFO(scene.name << ", rule " << name_of(method));
            CHECK((scene.setting.effects.are_any() ? broken_among_bodies
                                                   : broken_property)(scene, method) == "");
        }
        ++n_scenes;
    }
    CHECK(n_scenes > 0);
}
