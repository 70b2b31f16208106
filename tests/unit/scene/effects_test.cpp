// SPDX-License-Identifier: BSD-3-Clause
// Effects in a scene: values that are read, and error messages.
#include "catch.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/compare.hpp"
#include "scene/effects/effect.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;
using test::has;
using test::problems_of;
using test::problems_with;

namespace {

using Texts = std::vector<std::string>;

const std::string& good = test::good_scene;

} // namespace

TEST_CASE("effects are read, parameters of others are refused by name") {
    const SceneParameters scene = read_scene(
        good + "[effects.contact]\nkind = 'restitution'\nrestitution = 0.9\ncontact_time = 0.01\n",
        "s.toml");
    CHECK(scene.effects.contact == ContactEffect{ContactKind::restitution, 0.9, 0.01});
    CHECK_FALSE(read_scene(good, "s.toml").effects.are_any());
    CHECK(read_scene(good, "s.toml", {"effects.contact.kind=none"}).effects.contact.kind ==
          ContactKind::none);

    CHECK(has(problems_with({"effects.contact.restitution=0.5"}),
              "no meaning without effects.contact.kind = \"restitution\""));
    CHECK(has(problems_with({"effects.contact.kind=none", "effects.contact.contact_time=0.1"}),
              "no meaning without"));
    CHECK(has(problems_with({"effects.contact.kind=restitution"}),
              "'effects.contact.restitution' is missing"));
    CHECK(
        has(problems_with({"effects.contact.kind=restitution", "effects.contact.restitution=1.5"}),
            "from 0 to 1, not 1.5"));
    CHECK(has(problems_with({"effects.contact.kind=restitution", "effects.contact.restitution=0.5",
                             "effects.contact.contact_time=17"}),
              "at most 16 steps"));
    CHECK(has(problems_with({"effects.contact.kind=bouncy"}),
              "\"elastic\", \"none\", \"restitution\" or \"rough\""));
    CHECK(has(problems_with({"effects.contact.restitutoin=0.5"}),
              "did you mean 'effects.contact.restitution'?"));
    CHECK(has(problems_with({"effects.contact.kind=none", "time.precision=single"}),
              "cannot have time.precision = \"single\" together with effects"));
    CHECK(has(problems_with({"effects.contact.kind=none", "time.accuracy=0.1"}),
              "cannot have time.accuracy together with effects"));
}

TEST_CASE("sides are read, and contradictions explained") {
    const SceneParameters scene = read_scene(good, "s.toml",
                                             {"box.left.kind=thermal", "box.left.temperature=2",
                                              "box.right.kind=moving", "box.right.speed=-0.5",
                                              "box.top.restitution=0.5", "effects.thermal.seed=7",
                                              "time.method=event-driven"});
    CHECK(scene.effects.boundaries[0] == Boundary{BoundaryKind::thermal, 1, 2, 0});
    CHECK(scene.effects.boundaries[1] == Boundary{BoundaryKind::moving, 1, 0, -0.5});
    CHECK(scene.effects.boundaries[2] == Boundary{});
    CHECK(scene.effects.boundaries[3] == Boundary{BoundaryKind::wall, 0.5, 0, 0});
    CHECK(scene.effects.thermal_seed == 7);
    CHECK(has(problems_with({"box.left.temperature=2"}),
              "no meaning without box.left.kind = \"thermal\""));
    CHECK(has(problems_with({"box.left.kind=thermal"}), "'box.left.temperature' is missing"));
    CHECK(has(problems_with(
                  {"box.left.kind=thermal", "box.left.temperature=1", "box.left.restitution=0.5"}),
              "no meaning without box.left.kind = \"wall\", \"moving\" or \"oscillating\""));
    CHECK(has(problems_with({"box.top.speed=1"}), "no meaning without box.top.kind = \"moving\""));
    CHECK(has(problems_with({"box.top.kind=moving", "box.top.speed=1", "time.method=time-stepped"}),
              "cannot have a moving wall together with time.method = \"time-stepped\": walls are "
              "at rest there; take time.method = \"event-driven\""));
    const std::string all = "time.method=event-driven";
    CHECK(has(problems_with({"box.right.kind=moving", "box.right.speed=-9.9", all}),
              "too small for its discs"));
    CHECK(has(problems_with({"box.right.kind=moving", "box.right.speed=11", all}),
              "more than twice as long"));
    CHECK(has(problems_with({"box.left.kind=moving", "box.left.speed=-0.1", all}),
              "let the opposite one move out"));
    CHECK(has(problems_with({"effects.thermal.seed=1"}),
              "no meaning without a side of kind = \"thermal\""));
    CHECK(has(problems_with({"effects.contact.contact_time=0.1"}),
              "no meaning without collisions that take or give energy, or a force that discs "
              "fall in"));
    CHECK(has(problems_with({"box.middle.kind=wall"}), "no such key"));
    CHECK(read_scene(good, "s.toml", {"box.left.kind=open"}).effects.boundaries[0] ==
          Boundary{BoundaryKind::open, 1, 0, 0});
    CHECK(has(problems_with({"box.left.kind=open", "box.left.restitution=0.5"}),
              "no meaning without box.left.kind = \"wall\", \"moving\" or \"oscillating\""));
    CHECK(has(problems_with({"box.left.kind=open", "box.top.kind=moving", "box.top.speed=1", all}),
              "cannot have an open side together with walls that move"));
}

TEST_CASE("obstacles are read, each wrong one is named") {
    const SceneParameters scene = read_scene(good, "s.toml",
                                             {"effects.obstacles.discs=[[10, 20, 3], [40, 50, 0]]",
                                              "effects.obstacles.segments=[[0, 0, 30, 40]]",
                                              "effects.obstacles.restitution=0.5"});
    CHECK(scene.effects.fixed_bodies.discs == std::vector<FixedDisc>{{10, 20, 3}, {40, 50, 0}});
    CHECK(scene.effects.fixed_bodies.segments == std::vector<Segment>{{0, 0, 30, 40}});
    CHECK(scene.effects.fixed_bodies.restitution == 0.5);
    CHECK(has(problems_with({"effects.obstacles.discs=[[10, 20]]"}),
              "row 1 of 'effects.obstacles.discs' must be numbers, [x, y, radius]"));
    CHECK(has(problems_with({"effects.obstacles.discs=[[10, 20, 1], [110, 20, 1]]"}),
              "row 2 of 'effects.obstacles.discs': the centre (110, 20) is not in the box"));
    CHECK(has(problems_with({"effects.obstacles.discs=[[10, 20, -1]]"}),
              "the radius must be from 0 to 100, not -1"));
    CHECK(has(problems_with({"effects.obstacles.segments=[[10, 20, 10, 120]]"}),
              "row 1 of 'effects.obstacles.segments'"));
    CHECK(has(problems_with({"effects.obstacles.segments=[[10, 20, 10, 20]]"}),
              "a point is a fixed disc of radius 0"));
    CHECK(has(problems_with({"effects.obstacles.restitution=0.5"}),
              "no meaning without 'effects.obstacles.discs', 'segments', 'arcs', 'polygons' or a "
              "'box.shape'"));
    CHECK(
        has(problems_with({"effects.obstacles.discs=[[10, 20, 1]]", "discs.generator=triangular"}),
            "know nothing of obstacles"));
    CHECK(has(problems_with({"effects.obstacles.discs=[[10, 20, 1]]", "box.top.kind=moving",
                             "box.top.speed=1", "time.method=event-driven"}),
              "cannot have obstacles together with walls that move"));
    const SceneParameters other = read_scene(good, "s.toml",
                                             {"effects.obstacles.discs=[[10, 20, 4], [40, 50, 0]]",
                                              "effects.obstacles.segments=[[0, 0, 30, 40]]"});
    CHECK(physical_differences(scene, other).size() == 2);
}

TEST_CASE("gravity is read, and refused where the falling frame would leave the box") {
    CHECK(read_scene(good, "s.toml", {"effects.gravity.y=-0.02", "time.method=event-driven"})
              .effects.gravity == Acceleration{0, -0.02});
    CHECK(has(problems_with({"effects.gravity.y=-0.02", "time.method=time-stepped"}),
              "take time.method = \"event-driven\""));
    CHECK(has(
        problems_with({"effects.gravity.x=1", "time.method=event-driven", "time.sync_every=64"}),
        "time.sync_every = 10 or less will do"));
    CHECK(problems_with({"effects.gravity.x=1", "time.method=event-driven", "time.sync_every=10"})
              .empty());
    // By default syncs are as frequent as gravity requires. In 8 steps discs fall by 32, which is
    // less than half the box, 50.
    const auto sync_every = [](const Texts& texts) {
        return read_scene(good, "s.toml", texts).sync_every;
    };
    CHECK(sync_every({"effects.gravity.x=1", "time.method=event-driven"}) == 8);
    CHECK(sync_every({"effects.gravity.x=0.02", "time.method=event-driven"}) == 64);
    CHECK(has(problems_with({"effects.gravity.y=1000", "time.method=event-driven"}),
              "take more time.micro_steps"));
}

TEST_CASE("drag is read, and refused beside what it does not go with yet") {
    const std::string all = "time.method=event-driven";
    CHECK(read_scene(good, "s.toml", {"effects.drag.rate=0.02", all}).effects.drag == 0.02);
    CHECK(has(problems_with({"effects.drag.rate=0.02", "time.method=time-stepped"}),
              "take time.method = \"event-driven\""));
    CHECK(has(problems_with({"effects.drag.rate=-1", all}), "must be at least 0, not -1"));
    CHECK(has(problems_with({"effects.drag.rate=0.1", all}), "a smaller time.sync_every"));
    CHECK(problems_with({"effects.drag.rate=0.02", "effects.gravity.y=-0.01", all}).empty());
    CHECK(problems_with({"effects.drag.rate=0.02", "box.right.kind=moving", "box.right.speed=0.01",
                         "effects.contact.contact_time=0.01", all})
              .empty());
    CHECK(has(problems_with({"effects.drag.rate=0.02", "effects.gravity.y=-0.01",
                             "effects.obstacles.discs=[[5, 5, 1]]", all}),
              "cannot have obstacles together with drag and a force in flight at once"));
    CHECK(has(problems_with({"effects.gravity.x=0.03", "time.sync_every=64", all}),
              "time.sync_every = 57 or less"));
    CHECK(problems_with({"effects.gravity.x=0.03", "effects.drag.rate=0.02", all})
              .empty()); // with drag a disc falls in a sync interval by 42 instead of 61
}

TEST_CASE("rough discs are read, and refused beside what does not go with them yet") {
    const Texts rough{"effects.contact.kind=rough", "effects.contact.restitution=0.9",
                      "effects.contact.tangential_restitution=0.5"};
    const auto with = [&](Texts more) {
        more.insert(more.begin(), rough.begin(), rough.end());
        return more;
    };
    const ContactEffect contact = read_scene(good, "s.toml",
                                             with({"effects.contact.friction=0.3",
                                                   "effects.contact.moment_of_inertia=0.8"}))
                                      .effects.contact;
    CHECK(contact == ContactEffect{ContactKind::rough, 0.9, 0, 0.5, 0.3, 0.8});
    CHECK(std::isinf(read_scene(good, "s.toml", rough).effects.contact.friction));
    CHECK(has(problems_with({"effects.contact.friction=0.3"}),
              "no meaning without effects.contact.kind = \"rough\""));
    CHECK(has(problems_with({"effects.contact.kind=rough"}),
              "'effects.contact.tangential_restitution' is missing"));
    CHECK(has(problems_with(with({"effects.contact.tangential_restitution=1.5"})),
              "from -1 to 1, not 1.5"));
    CHECK(has(problems_with(with({"effects.drag.rate=0.01", "time.method=event-driven"})),
              "cannot have drag together with rough discs"));
    CHECK(problems_with(with({"output.folder=kept"})).empty());

    constexpr SideColumn turning = SideColumn::spin;
    const std::string folder = "output.folder=t", every = "output.trajectory.every_steps=1",
                      fields = "output.trajectory.fields=[\"position\", \"angular_velocity\"]";
    CHECK(read_scene(good, "s.toml", with({folder, every})).trajectory->columns.has(turning));
    CHECK(!read_scene(good, "s.toml", {folder, every}).trajectory->columns.has(turning));
    const TrajectoryOutput named = *read_scene(good, "s.toml", with({folder, fields})).trajectory;
    CHECK((named.has_position && !named.has_velocity && named.columns.has(turning)));
    CHECK(has(problems_with({folder, fields}),
              "needs discs that turn, effects.contact.kind = \"rough\""));
}

TEST_CASE("classes of discs are read, by table and by list") {
    const std::string box = "[box]\nsize = 100\n[time]\nsteps = 10\n";
    const std::string two = "[[discs.species]]\ncount = 3\nradius = 2\nmass = "
                            "7\n[[discs.species]]\ncount = 40\nradius = 0.5\n";
    const SceneParameters scene = read_scene(box + two, "s.toml");
    CHECK(scene.effects.species == std::vector<Species>{{3, 2, 7}, {40, 0.5, 1}});
    CHECK(scene.n_discs == 43);
    CHECK(scene.radius == 2);
    CHECK(scene.packing() == Approx(3.14159265358979 * (3 * 4 + 40 * 0.25) / 1e4));
    CHECK(summary_of(scene.effects) ==
          "3 discs of radius 2 and mass 7, 40 discs of radius 0.5 and mass 1");

    const SceneParameters listed = read_scene(
        box + "[discs]\nlist = [[10, 10, 0, 0, 2, 3], [20, 20, 1, 0, "
              "2, 3], [0.5, 50, 0, 0, 0.5, 1]]\n",
        "s.toml");
    CHECK(listed.effects.species == std::vector<Species>{{2, 2, 3}, {1, 0.5, 1}});
    CHECK(listed.listed_discs[1] == InputDisc{1, 20, 20, 1, 0});

    const auto problems = [&](const std::string& text, const Texts& overrides = {}) {
        std::string all;
        for (const Problem& problem :
             problems_of([&] { read_scene(box + text, "s.toml", overrides); }))
            all += problem.text + '\n';
        return all;
    };
    CHECK(has(problems(two, {"discs.radius=1"}),
              "'discs.radius' has no meaning where 'discs.species', 'discs.list' or"));
    CHECK(has(problems(two, {"discs.count=44"}),
              "'discs.species' has 43 discs, but 'discs.count' has 44"));
    CHECK(has(problems(two, {"effects.contact.kind=none"}),
              "cannot have several species together with effects.contact.kind = \"none\""));
    CHECK(has(problems(two, {"time.precision=single"}), "together with effects"));
    CHECK(has(problems(two, {"discs.generator=legacy"}), "has no meaning") ==
          false); // the override removes the species
    CHECK(has(problems("[[discs.species]]\ncount = 3\nradius = -2\n"),
              "row 1 of 'discs.species': the radius must be"));
    CHECK(has(problems("[[discs.species]]\ncount = 3.5\nradius = 2\n"),
              "row 1 of 'discs.species': its count must be a whole number"));
    CHECK(has(problems("[[discs.species]]\ncount = 3\nradius = 2\nmas = 1\n"),
              "row 1 of 'discs.species' has no 'mas'; did you mean 'mass'?"));
    CHECK(has(problems("[[discs.species]]\ncount = 3\n"), "row 1 of 'discs.species' needs radius"));
    CHECK(has(problems("[[discs.species]]\ncount = 3\nradius = 60\n"), "does not fit into a box"));
    CHECK(has(problems("[discs]\nlist = [[10, 10, 0, 0, 2, 3], [20, 20, 1, 0]]\n"),
              "other rows have six numbers"));
    CHECK(has(problems("[discs]\nlist = [[10, 10, 0, 0, 2, 0]]\n"),
              "row 1 of 'discs.list': the mass must be"));
    CHECK(has(problems("[discs]\nlist = [[1, 10, 0, 0, 2, 3]]\n"), "is not inside the box"));
    CHECK(physical_differences(
              scene, read_scene(box + two + "[[discs.species]]\ncount = 1\nradius = 1\n", "s.toml"))
              .size() == 2);
}

TEST_CASE("periodic sides are read, in pairs, where they make sense") {
    const Texts along_y{"box.bottom.kind=periodic", "box.top.kind=periodic"};
    const Effects effects = read_scene(good, "s.toml", along_y).effects;
    CHECK(effects.is_periodic_y());
    CHECK_FALSE(effects.is_periodic_x());
    const auto with = [&along_y](std::initializer_list<std::string> more) {
        Texts texts = along_y;
        texts.insert(texts.end(), more);
        return problems_with(texts);
    };
    const std::string in_flow = problems_with(
        {"box={left = {kind = \"periodic\"}, right = {kind = \"periodic\"}, "
         "bottom = {kind = \"sheared\"}, top = {kind = \"sheared\"}}",
         "effects.shear.rate=0.1", "effects.gravity.y=-0.01"});
    CHECK(has(in_flow, "nothing stops discs in a flow without walls"));
    CHECK_FALSE(has(in_flow, "would fall for ever")); // the first message is enough
    CHECK(has(problems_with({"box.left.kind=periodic"}),
              "box.left.kind and box.right.kind must both be \"periodic\", or neither"));
    CHECK(has(problems_with({"box.top.kind=periodic"}),
              "box.bottom.kind and box.top.kind must both be \"periodic\", or neither"));
    CHECK(has(with({"box.top.restitution=0.5"}),
              "no meaning without box.top.kind = \"wall\", \"moving\" or \"oscillating\""));
    CHECK(has(with({"box.top.temperature=1"}), "no meaning without box.top.kind = \"thermal\""));
    CHECK(has(with({"box.top.speed=1"}), "no meaning without box.top.kind = \"moving\""));
    CHECK(
        has(with({"effects.gravity.y=-0.01", "time.method=event-driven"}), "would fall for ever"));
    CHECK_FALSE(
        has(with({"effects.gravity.x=-0.01", "time.method=event-driven"}), "would fall for ever"));
    for (const Texts& stopped :
         {Texts{"effects.drag.rate=0.01"}, Texts{"box.left.kind=thermal", "box.left.temperature=1"},
          Texts{"box.right.tangential_restitution=0"},
          Texts{"box.right.tangential_restitution=1", "box.left.restitution=0.9"},
          Texts{"effects.obstacles.discs=[[5, 5, 1]]", "effects.obstacles.restitution=0.9"},
          Texts{"effects.obstacles.discs=[[5, 5, 1]]",
                "effects.obstacles.tangential_restitution=0.5"}}) {
        Texts texts = along_y;
        texts.insert(texts.end(), {"effects.gravity.y=-0.01", "time.method=event-driven"});
        texts.insert(texts.end(), stopped.begin(), stopped.end());
        CHECK(problems_with(texts).empty());
    }
    CHECK(has(with({"effects.gravity.y=-0.01", "time.method=event-driven",
                    "box.right.tangential_restitution=1"}),
              "would fall for ever")); // nothing takes energy
    CHECK(has(with({"effects.gravity.y=-0.01", "time.method=event-driven",
                    "effects.obstacles.discs=[[5, 5, 1]]"}),
              "would fall for ever")); // obstacles reflect discs, but nothing takes energy
    CHECK(with({"effects.obstacles.discs=[[0,100,40]]"}).empty());
    CHECK(has(with({"effects.obstacles.discs=[[50,50,5], [50,50,99]]"}),
              "row 2 of 'effects.obstacles.discs': the radius must be at most 98, not 99"));
    CHECK(has(with({"box.left.kind=open"}),
              "cannot have a periodic side together with an open side"));
    CHECK(with({"effects.contact.kind=rough", "effects.contact.restitution=0.9",
                "effects.contact.tangential_restitution=0.5"})
              .empty());
    CHECK_FALSE(has(with({"effects.drag.rate=0.02", "time.method=event-driven"}), "drag"));
    CHECK(has(with({"discs.radius=26", "discs.count=1"}), "too small to be periodic"));
}

TEST_CASE("periodic sides bound what can be measured, and the sizes of discs") {
    const Texts along_y{"box.bottom.kind=periodic", "box.top.kind=periodic"};
    const auto measuring = [&](const char* names, bool is_around) {
        Texts texts = is_around ? Texts{"box.left.kind=periodic", "box.right.kind=periodic"}
                                : Texts{};
        texts.insert(texts.end(), along_y.begin(), along_y.end());
        texts.insert(texts.end(), {"output.folder=tables",
                                   std::string("output.measurements.quantities=") + names});
        return problems_with(texts);
    };
    CHECK(has(measuring("[\"wall_pressure\"]", true),
              "cannot have \"wall_pressure\" together with a box that is periodic all round"));
    CHECK_FALSE(has(measuring("[\"wall_pressure\"]", false), "wall_pressure"));
    CHECK_FALSE(has(measuring("[\"displacement\"]", true), "periodic"));
    const std::string two = "[[discs.species]]\ncount = 1\nradius = 2\nmass = "
                            "7\n[[discs.species]]\ncount = 4\nradius = 0.5\n";
    const auto mixed_in = [&](const std::string& size) {
        return problems_of([&] {
            read_scene("[box]\nsize = " + size + "\n[time]\nsteps = 10\n" + two, "s.toml", along_y);
        });
    };
    CHECK(mixed_in("100").empty());
    const Texts measuring_g{"output.folder=tables",
                            "output.measurements.quantities=[\"radial_distribution\"]"};
    Texts all_round{"box.left.kind=periodic", "box.right.kind=periodic"};
    all_round.insert(all_round.end(), along_y.begin(), along_y.end());
    for (const bool is_all_round : {false, true}) {
        Texts texts = is_all_round ? all_round : along_y;
        texts.insert(texts.end(), measuring_g.begin(), measuring_g.end());
        const auto found = problems_of(
            [&] { read_scene("[box]\nsize = 100\n[time]\nsteps = 10\n" + two, "s.toml", texts); });
        CHECK(found.empty() == is_all_round);
        if (!is_all_round) CHECK(has(found.front().text, "needs a box that is periodic all round"));
    }
    const auto small = mixed_in("7.9"); // the box must have four radii of the largest disc
    CHECK(std::any_of(small.begin(), small.end(), [](const Problem& problem) {
        return problem.text.find("too small to be periodic") != std::string::npos;
    }));
}

TEST_CASE("a restart cannot change effects") {
    const Texts there{"effects.gravity.y=-0.02", "time.method=event-driven",
                      "box.top.restitution=0.5"};
    const Texts here{"effects.gravity.y=-0.01", "time.method=event-driven", "box.top.kind=thermal",
                     "box.top.temperature=1"};
    const std::vector<std::string> differences = physical_differences(
        read_scene(good, "s.toml", there), read_scene(good, "s.toml", here));
    CHECK(differences.size() == 4); // gravity, and the side's kind, restitution and temperature
    CHECK(physical_differences(read_scene(good, "s.toml", there), read_scene(good, "s.toml", there))
              .empty());
}

TEST_CASE("active discs are read, and refused without a friction") {
    const Texts bath{"effects.thermostat.kind=langevin", "effects.thermostat.rate=0.01",
                     "effects.thermostat.temperature=0.5"};
    const auto with = [&](Texts more) {
        more.insert(more.begin(), bath.begin(), bath.end());
        return more;
    };
    const Texts active = with({"effects.activity.speed=0.2",
                               "effects.activity.rotational_diffusion=0.01",
                               "effects.activity.tumble_rate=0.02", "effects.activity.seed=7"});
    const SceneParameters scene = read_scene(good, "s.toml", active);
    CHECK(scene.effects.activity == Activity{0.2, 0, 0.01, 0.02, 7});
    CHECK(has(summary_of(scene.effects),
              "active discs of speed 0.2, rotational diffusion 0.01, tumble rate 0.02"));
    CHECK(side_columns_of(scene).has(SideColumn::direction));
    CHECK_FALSE(side_columns_of(read_scene(good, "s.toml", bath)).has(SideColumn::direction));
    CHECK(first_number(scene, SideColumn::direction, 1) !=
          first_number(scene, SideColumn::direction, 2));
    CHECK(has(reason_without_z(scene.effects), "swim pressure"));

    CHECK(has(problems_with({"effects.activity.speed=0.2"}),
              "cannot have active discs together with no friction"));
    CHECK(has(problems_with(with({"effects.activity.tumble_rate=0.02"})),
              "no meaning without effects.activity.speed or effects.activity.force"));
    CHECK(has(problems_with(with(
                  {"effects.activity.speed=0.2", "effects.activity.rotational_diffusion=0.1"})),
              "acts more than 4 times between two syncs"));
    CHECK(has(problems_with({"output.folder=t", "output.trajectory.fields=[\"direction\"]"}),
              "needs discs that propel themselves"));
}
