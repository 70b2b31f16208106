// SPDX-License-Identifier: BSD-3-Clause
// Combinations of effects. Together the runs contain every pair of choices from different rows of
// the table below (pairwise covering), and each run is compared with the reference bit by bit. A
// new effect needs a new choice here, and a line of `excluded` for each choice that excludes it.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"

#include "core/state_hash.hpp"
#include "dynamics/falling_contact.hpp"
#include "effect_runs.hpp"
#include "event_driven.hpp"
#include "scene_tools.hpp"
#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// The scene and the settings of a run.
struct Plan {
    TestScene scene;
    Method method = Method::event_driven;
    Tuning tuning;
    bool is_restarted = false;
};

struct Choice {
    std::string name;
    std::function<void(Plan&)> apply;
};
using Row = std::vector<Choice>;

Choice side_choice(std::size_t number, const char* kind, const Boundary& side) {
    return {std::string(boundary_names[number]) + " " + kind,
            [=](Plan& plan) { plan.scene.setting.effects.boundaries[number] = side; }};
}

Row sides_of(std::size_t number) {
    const double inwards = number % 2 == 0 ? 0.02 : -0.02;
    Row row{side_choice(number, "wall", {}),
            side_choice(number, "lossy", {BoundaryKind::wall, 0.7, 0, 0}),
            side_choice(number, "thermal", {BoundaryKind::thermal, 1, 0.2, 0}),
            side_choice(number, "moving", {BoundaryKind::moving, 0.9, 0, inwards})};
    if (number == 1 || number == 2) // one side of each axis, a low and a high one
        row.push_back(
            side_choice(number, "oscillating",
                        {BoundaryKind::oscillating, 0.9, 0, 0, 0.3, 2.3, number == 2 ? 3.2 : 0.1}));
    if (number % 2 == 0) row.push_back(side_choice(number, "open", {BoundaryKind::open, 1, 0, 0}));
    return row;
}

/// Makes two opposite sides periodic.
Choice seams(const char* name, std::size_t low_side) {
    return {name, [=](Plan& plan) {
                for (const std::size_t side : {low_side, low_side + 1})
                    plan.scene.setting.effects.boundaries[side] = {BoundaryKind::periodic, 1, 0, 0};
            }};
}

Choice shape(const TestScene& scene) {
    return {scene.name, [=](Plan& plan) {
                plan.scene = scene;
                plan.scene.steps = 12;
                plan.scene.setting.sync_every = 5;
                plan.scene.setting.micro_steps = 2;
            }};
}

Choice contact(const char* name, const ContactEffect& effect) {
    return {name, [=](Plan& plan) { plan.scene.setting.effects.contact = effect; }};
}

Choice motion(const char* name, double x, double y, double drag) {
    return {name, [=](Plan& plan) {
                plan.scene.setting.effects.gravity = {x, y};
                set_drag(plan.scene, drag);
            }};
}

Choice window(const char* name, std::optional<double> length) {
    return {name, [=](Plan& plan) {
                plan.tuning.window = length;
                plan.tuning.rebalance_above = length ? 0 : 1.05;
                plan.tuning.ranks_across = length ? 2 : 1;
            }};
}

/// Makes the discs in the second and the last quarter of the ids smaller and lighter.
void split_into_species(Plan& plan) {
    const double radius = plan.scene.setting.radius;
    const std::uint64_t n = plan.scene.discs.size();
    plan.scene.setting.effects.species = {{n / 4, radius, 2},
                                          {n / 4, 0.7 * radius, 0.6},
                                          {n / 4, radius, 2},
                                          {n - 3 * (n / 4), 0.7 * radius, 0.6}};
}

/// Adds a few obstacles, and removes the discs that overlap them.
void put_obstacles(Plan& plan) {
    reference::Setting& setting = plan.scene.setting;
    const double size = setting.box_size;
    setting.effects.fixed_bodies = {
        {{0.3 * size, 0.4 * size, 0.05 * size}, {0.7 * size, 0.6 * size, 0}},
        {{0, 0.3 * size, 0.25 * size, 0.2 * size},
         {0.55 * size, 0.8 * size, 0.7 * size, 0.75 * size}},
        0.8};
    make_room_for_obstacles(plan.scene);
    // species of the remaining discs
    if (!setting.effects.species.empty()) split_into_species(plan);
}

/// The first row makes the scene, the other rows change it.
std::vector<Row> table() {
    return {{shape(gas(200, 0.05, 0.8, 701)), shape(gas(144, 0.6, 0.3, 702)),
             shape(break_shot(5, 0.5, 3, 0.1))},
            {{"time-stepped", [](Plan& plan) { plan.method = Method::time_stepped; }},
             {"event-driven", [](Plan& plan) { plan.method = Method::event_driven; }}},
            {contact("elastic", {}), contact("no contact", {ContactKind::none, 1, 0.001}),
             contact("restitution", {ContactKind::restitution, 0.85, 0.002}),
             contact("rough", {ContactKind::rough, 0.9, 0.002, 0.4, 0.3, 0.5})},
            {{"one size", [](Plan&) {}}, {"several species", split_into_species}},
            sides_of(0),
            sides_of(1),
            sides_of(2),
            sides_of(3),
            {{"no seams", [](Plan&) {}}, seams("seams along x", 0), seams("seams along y", 2)},
            {motion("free", 0, 0, 0), motion("gravity down", 0, -0.04, 0),
             motion("gravity aslant", 0.02, -0.03, 0), motion("drag", 0, 0, 0.2),
             motion("both down", 0, -0.04, 0.2), motion("both aslant", 0.02, -0.03, 0.2)},
            {{"nothing in the way", [](Plan&) {}}, {"obstacles", put_obstacles}},
            {{"constant radii", [](Plan&) {}},
             {"growing", [](Plan& plan) { plan.scene.setting.effects.growth = 0.006; }}},
            {window("own windows", {}), window("short windows", 0.3), window("long windows", 2.7)},
            {{"uninterrupted", [](Plan&) {}},
             {"restarted", [](Plan& plan) { plan.is_restarted = true; }}}};
}

/// Whether two choices are for the same side, which can have only one kind.
bool takes_the_place_of(const std::string& a, const std::string& b) {
    const bool is_side = a == "seams along x" ? b.starts_with("left ") || b.starts_with("right ")
                                              : a == "seams along y" && (b.starts_with("bottom ") ||
                                                                         b.starts_with("top "));
    return is_side && !b.ends_with(" wall");
}

/// Pairs of choices that the reader of scenes rejects, by the ends of their names.
bool is_excluded(const std::string& a, const std::string& b) {
    static const std::vector<std::pair<std::string, std::string>> excluded = {
        {"time-stepped", "moving"},
        {"time-stepped", "oscillating"},
        {"time-stepped", "gravity down"},
        {"time-stepped", "gravity aslant"},
        {"time-stepped", "drag"},
        {"time-stepped", "both down"},
        {"rough", "drag"},
        {"rough", "both down"},
        {"rough", "both aslant"},
        {"several species", "no contact"},
        {"time-stepped", "both aslant"},
        {"obstacles", "both down"},
        {"obstacles", "both aslant"},
        {"obstacles", "moving"},
        {"open", "moving"},
        {"oscillating", "obstacles"},
        {"oscillating", "open"},
        {"oscillating", "drag"},
        {"oscillating", "both down"},
        {"oscillating", "both aslant"},
        {"seams along x", "open"},
        {"seams along y", "open"},
        {"seams along y", "both down"},
        {"seams along x", "both aslant"},
        {"seams along y", "both aslant"},
        {"seams along x", "gravity aslant"},
        {"seams along y", "gravity aslant"},
        {"seams along y", "gravity down"},
        {"growing", "time-stepped"},
        {"growing", "no contact"},
        {"growing", "rough"},
        {"growing", "thermal"},
        {"growing", "moving"},
        {"growing", "oscillating"},
        {"growing", "open"},
        {"growing", "gravity down"},
        {"growing", "gravity aslant"},
        {"growing", "drag"},
        {"growing", "both down"},
        {"growing", "both aslant"},
        {"growing", "obstacles"}};
    const auto is = [](const std::string& name, const std::string& end) {
        return name == end || name.ends_with(' ' + end);
    };
    if (takes_the_place_of(a, b) || takes_the_place_of(b, a)) return true;
    return std::any_of(excluded.begin(), excluded.end(), [&](const auto& pair) {
        return (is(a, pair.first) && is(b, pair.second)) ||
               (is(b, pair.first) && is(a, pair.second));
    });
}

using Picked = std::vector<std::size_t>; ///< the number of a choice for each row

constexpr std::size_t open = ~std::size_t{0};

class Covering {
public:
    explicit Covering(const std::vector<Row>& rows) : rows_(rows) {
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = i + 1; j < rows.size(); ++j)
                for (std::size_t a = 0; a < rows[i].size(); ++a)
                    for (std::size_t b = 0; b < rows[j].size(); ++b)
                        if (!is_excluded(rows[i][a].name, rows[j][b].name))
                            missing_.push_back({i, a, j, b});
    }

    /// Greedy: of several runs that begin with missing pairs, chooses the one that contains most
    /// missing pairs.
    std::vector<Picked> runs() {
        constexpr std::size_t most_tries = 16;
        std::vector<Picked> all;
        while (!missing_.empty()) {
            Picked picked;
            std::size_t most = 0;
            for (std::size_t k = 0; k < missing_.size();
                 k += (missing_.size() + most_tries - 1) / most_tries) {
                const Picked tried = run_with(missing_[k]);
                const std::size_t n = n_met(tried);
                if (n > most) picked = tried;
                most = std::max(n, most);
            }
            std::erase_if(missing_,
                          [&](const Pair& p) { return picked[p.i] == p.a && picked[p.j] == p.b; });
            all.push_back(picked);
        }
        return all;
    }

private:
    struct Pair {
        std::size_t i, a, j, b;
    };

    /// Fills each open row with the choice that adds most missing pairs.
    Picked run_with(const Pair& first) const {
        Picked picked(rows_.size(), open);
        picked[first.i] = first.a;
        picked[first.j] = first.b;
        for (std::size_t i = 0; i < rows_.size(); ++i)
            if (picked[i] == open) picked[i] = best(picked, i);
        return picked;
    }
    std::size_t n_met(const Picked& picked) const {
        return static_cast<std::size_t>(
            std::count_if(missing_.begin(), missing_.end(),
                          [&](const Pair& p) { return picked[p.i] == p.a && picked[p.j] == p.b; }));
    }
    bool fits(const Picked& picked, std::size_t row, std::size_t choice) const {
        for (std::size_t i = 0; i < rows_.size(); ++i)
            if (i != row && picked[i] != open &&
                is_excluded(rows_[i][picked[i]].name, rows_[row][choice].name))
                return false;
        return true;
    }
    std::size_t best(const Picked& picked, std::size_t row) const {
        std::size_t found = open, most = 0;
        for (std::size_t choice = 0; choice < rows_[row].size(); ++choice) {
            if (!fits(picked, row, choice)) continue;
            const auto n = static_cast<std::size_t>(
                std::count_if(missing_.begin(), missing_.end(), [&](const Pair& p) {
                    return (p.i == row && p.a == choice && picked[p.j] == p.b) ||
                           (p.j == row && p.b == choice && picked[p.i] == p.a);
                }));
            if (found == open || n > most) {
                found = choice;
                most = n;
            }
        }
        return found;
    }

    const std::vector<Row>& rows_;
    std::vector<Pair> missing_;
};

StateHash reference_hash(const Plan& plan, const Communicator& world) {
    StateHash hash;
    const auto run_with = [&]<class Reference>(Reference reference) {
        reference.run_steps(plan.scene.steps);
        hash = hash_of(reference.discs());
        for (std::size_t i = 0; i < reference.spins().size(); ++i)
            hash += hash_of(SideColumn::spin, i, reference.spins()[i]);
    };
    if (world.is_root()) {
        if (plan.method == Method::time_stepped)
            run_with(reference::TimeSteppedReference(plan.scene.setting, plan.scene.discs));
        else
            run_with(reference::EventDrivenReference(plan.scene.setting, plan.scene.discs));
    }
    world.broadcast(hash);
    return hash;
}

StateHash engine_hash(const Plan& plan, const Communicator& world) {
    DiscSystem first = system_of(plan.scene, plan.method, world, plan.tuning);
    advance_to(first, plan.is_restarted ? plan.scene.steps / 2 : plan.scene.steps);
    if (!plan.is_restarted) return first.totals().hash;
    SceneParameters scene = scene_of(plan.scene);
    scene.method = plan.method;
    const StoredState state{{first.discs().begin(), first.discs().end()},
                            first.micro_steps_done(),
                            SideColumns(first.side_columns())};
    DiscSystem second(scene, state, world, plan.tuning);
    advance_to(second, plan.scene.steps);
    return second.totals().hash;
}

/// Gives the references the functions that they do not compute from the scene's numbers.
void hand_to_reference(reference::Setting& setting) {
    set_thermal_seed(setting, setting.effects.thermal_seed);
    set_oscillation(setting);
    setting.falling_contact = falling_contact;
}

} // namespace

TEST_CASE(
    "effects: every two of them together have the references' bits, in one piece and restarted") {
    const Communicator world = Communicator::world();
    const std::vector<Row> rows = table();
    const std::vector<Picked> runs = Covering(rows).runs();
    CHECK(runs.size() < 60);
    for (const Picked& picked : runs) {
        Plan plan;
        std::string name;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            REQUIRE(picked[i] != open);
            rows[i][picked[i]].apply(plan);
            name += (name.empty() ? "" : "; ") + rows[i][picked[i]].name;
        }
        hand_to_reference(plan.scene.setting);
        INFO(name);
        CHECK(to_string(engine_hash(plan, world)) == to_string(reference_hash(plan, world)));
    }
    // Compares with the table itself: each of its pairs is in a run or excluded.
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = i + 1; j < rows.size(); ++j)
            for (std::size_t a = 0; a < rows[i].size(); ++a)
                for (std::size_t b = 0; b < rows[j].size(); ++b) {
                    const bool is_met = std::any_of(runs.begin(), runs.end(), [&](const Picked& p) {
                        return p[i] == a && p[j] == b;
                    });
                    INFO(rows[i][a].name << " and " << rows[j][b].name);
                    CHECK(is_met != is_excluded(rows[i][a].name, rows[j][b].name));
                }
}
