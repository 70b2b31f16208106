// SPDX-License-Identifier: BSD-3-Clause
// Properties that hold for every scene, on random ones drawn for trouble (troubled_scenes.hpp), for both rules:
// the reference's bits; no disc lost; energy to 1e-12; nothing outside the box; counters that agree with the log; the
// log in order; transposed scenes have transposed bits; another storage order has the same bits. With effects drawn as well
// (troubled_effects.hpp): the reference's bits, no disc lost, a log that agrees, another storage order.
//
// A scene that fails is made small and printed; kept in tests/stability/regressions it is tried for ever after.
// $CARROM_TEST_SCENES sets how many scenes are drawn, $CARROM_TEST_SEED where they begin.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "event_driven.hpp"
#include "hold.hpp"
#include "runs.hpp"
#include "troubled_effects.hpp"
#include "troubled_scenes.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr CollisionRule both[] = {CollisionRule::one, CollisionRule::all};

std::uint64_t n_endless = 0; ///< scenes that are left out, for want of a reference

/// The state that the rule's reference ends in; none if it is in collisions without end.
std::optional<std::vector<Disc>> reference_discs(const TestScene& scene, CollisionRule rule) {
    if (rule == CollisionRule::one) {
        reference::OneRuleReference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        return std::vector<Disc>(reference.discs().begin(), reference.discs().end());
    }
    try {
        reference::EventDrivenReference reference(scene.setting, scene.discs, 20000);
        reference.run_steps(scene.steps);
        return std::vector<Disc>(reference.discs().begin(), reference.discs().end());
    } catch (const std::runtime_error&) {
        ++n_endless;
        return std::nullopt;
    }
}

bool is_transposed(const Disc& a, const Disc& b) {
    return a.x == b.y && a.y == b.x && a.vx == b.vy && a.vy == b.vx && a.tau == b.tau && a.wall_collisions == b.wall_collisions &&
           a.pair_collisions == b.pair_collisions;
}

/// Whether the log counts what the discs count, in times that are in order and in range.
bool log_agrees(const TestScene& scene, CollisionRule rule, const Totals& totals) {
    std::uint64_t n_walls = 0, n_pairs = 0;
    double last = 0;
    for (const Collision& collision : collisions_of(scene, rule)) {
        const double time = static_cast<double>(collision.micro_step) + collision.time;
        if (time < last || time > static_cast<double>(scene.steps * scene.setting.micro_steps)) return false;
        if (collision.q != Collision::wall && collision.p >= collision.q) return false;
        last = time;
        ++(collision.q == Collision::wall ? n_walls : n_pairs);
    }
    return n_walls == totals.wall_collisions && n_pairs == totals.pair_collisions;
}

bool has_same_bits_in_another_order(const TestScene& scene, CollisionRule rule, const Outcome& end) {
    Tuning tuning;
    tuning.window = 0.37;
    tuning.cell_width = 0.5;
    return run(scene, rule, tuning, 7).totals.hash == end.totals.hash;
}

/// The first property that does not hold whatever the effects; empty if all do. **Collective.**
std::string broken_with_effects(const TestScene& scene, CollisionRule rule) {
    const auto expected = reference_discs(scene, rule);
    if (!expected) return {};
    const Outcome end = run(scene, rule);
    if (end.discs.size() != scene.discs.size()) return "discs are lost";
    if (end.totals.hash != hash_of(*expected)) return "other bits than the reference";
    if (!log_agrees(scene, rule, end.totals)) return "log and counters do not agree";
    if (!has_same_bits_in_another_order(scene, rule, end)) return "other bits in another storage order";
    return {};
}

/// The same for plain scenes. **Collective.**
std::string broken_property(const TestScene& scene, CollisionRule rule) {
    const auto expected = reference_discs(scene, rule);
    if (!expected) return {};
    const Outcome start_of_run = outcome_of(start(scene, rule)), end = run(scene, rule);
    if (end.discs.size() != scene.discs.size()) return "discs are lost";
    if (end.totals.hash != hash_of(*expected)) return "other bits than the reference";
    const double energy = squared_speeds(start_of_run), speed = std::sqrt(energy);
    if (std::fabs(squared_speeds(end) - energy) > 1e-12 * energy) return "the energy has changed";
    const double latest = std::max(64.0, static_cast<double>(std::min(scene.setting.sync_every, scene.steps * scene.setting.micro_steps)));
    if (farthest_outside(end, scene.setting) > 4 * ulp_of(scene.setting.box_size) + speed * ulp_of(latest / 2)) return "a disc is outside";
    if (!log_agrees(scene, rule, end.totals)) return "log and counters do not agree";
    if (!has_same_bits_in_another_order(scene, rule, end)) return "other bits in another storage order";
    const Outcome mirror = run(transposed(scene), rule);
    if (!std::equal(end.discs.begin(), end.discs.end(), mirror.discs.begin(), is_transposed)) return "not bitwise transposed";
    return {};
}

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
    const char* const text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// `draw(seed, rule)` makes the scenes, which are drawn `how`; `broken(scene, rule)` says what is wrong with one.
template <class Draw>
void try_scenes(const std::string& how, std::uint64_t first, std::uint64_t count, const Draw& draw,
                std::string (*broken_in)(const TestScene&, CollisionRule) = broken_property) {
    for (const CollisionRule rule : both) {
        double n_broken = 0;
        n_endless = 0;
        for (std::uint64_t seed = first; seed < first + count && n_broken < 3; ++seed) {
            const TestScene scene = draw(seed, rule);
            const std::string broken = broken_in(scene, rule);
            if (broken.empty()) continue;
            n_broken += 1;
            const TestScene small = shrunk(scene, [&](const TestScene& trial) { return broken_in(trial, rule) == broken; });
            FAIL_CHECK(scene.name << ", rule " << name_of(rule) << ": " << broken << "; small:\n" << toml_of(small));
        }
        CHECK(n_endless <= count / 4);
        hold("property", std::to_string(count) + " random scenes drawn " + how + ": a property broken", name_of(rule), n_broken, 0);
    }
}

TestScene troubled(std::uint64_t seed, CollisionRule) { return troubled_scene(seed); }
TestScene troubled_with_effects(std::uint64_t seed, CollisionRule rule) { return with_effects(troubled_scene(seed), rule, seed); }
TestScene wildly_troubled(std::uint64_t seed, CollisionRule rule) { return wildly_troubled_scene(seed, rule == CollisionRule::one); }

} // namespace

TEST_CASE("property: random scenes drawn for trouble", "[property]") {
    const std::uint64_t few = Communicator::world().size() == 1 ? 300 : 12;
    try_scenes("for trouble", number_from("CARROM_TEST_SEED", 1), number_from("CARROM_TEST_SCENES", few), troubled);
}

TEST_CASE("property: random scenes drawn wildly", "[property]") {
    const std::uint64_t few = Communicator::world().size() == 1 ? 100 : 6;
    try_scenes("wildly", number_from("CARROM_TEST_SEED", 1), number_from("CARROM_TEST_SCENES", few), wildly_troubled);
}

TEST_CASE("property: random scenes drawn for trouble, with effects", "[property]") {
    const std::uint64_t few = Communicator::world().size() == 1 ? 100 : 6;
    try_scenes("for trouble, with effects", number_from("CARROM_TEST_SEED", 1), number_from("CARROM_TEST_SCENES", few), troubled_with_effects,
               broken_with_effects);
}

TEST_CASE("property: fifty thousand random scenes with effects", "[property][.hours]") {
    try_scenes("for trouble, with effects", 1000000, 50000, troubled_with_effects, broken_with_effects);
}

TEST_CASE("property: a million random scenes", "[property][.hours]") { try_scenes("for trouble", 1000000, 1000000, troubled); }

TEST_CASE("property: twenty thousand random scenes drawn wildly", "[property][.hours]") {
    try_scenes("wildly", 1000000, 20000, wildly_troubled);
}

TEST_CASE("property: scenes that have failed before", "[property]") {
    std::size_t n_scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(CARROM_REGRESSIONS)) {
        const auto [scene, rules] = read_regression(entry.path().string());
        for (const CollisionRule rule : rules) {
            INFO(scene.name << ", rule " << name_of(rule));
            CHECK((scene.setting.effects.are_any() ? broken_with_effects : broken_property)(scene, rule) == "");
        }
        ++n_scenes;
    }
    CHECK(n_scenes > 0);
}
