// SPDX-License-Identifier: BSD-3-Clause
// TOML scenes: a valid one, and each kind of error with the number and the lines of its problems.
#include "toml_scenes.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("a scene has what its text says and the defaults for the rest") {
    const SceneParameters scene = read_scene(good, "folder/s.toml");
    CHECK(scene.name == "folder/s.toml");
    CHECK(scene.text == good);
    CHECK(scene.box.x == 100);
    CHECK(scene.n_discs == 50);
    CHECK(scene.radius == 1);
    CHECK(scene.steps == 10);
    CHECK(scene.generator == Generator::random);
    CHECK(scene.seed == 3210);
    CHECK(scene.method == Method::event_driven);
    CHECK(scene.micro_steps == 1);
    CHECK(scene.sync_every == 64);
    CHECK(scene.text_output == TextOutput::none);
    CHECK(scene.warnings.empty());
    CHECK_FALSE(scene.reads_disc_lines());
    CHECK(scene.packing() == Approx(50 * 3.14159265358979 / 10000));
}

TEST_CASE("every key of a scene is taken over") {
    const SceneParameters scene = read_scene(
        "[box]\nsize = 1e2\n[discs]\ncount = 1e2\npacking = 0.25\ngenerator = 'lattice'\n"
        "speed = 0.5\nvelocities = \"uniform\"\nseed = 0x10\n"
        "[[discs.streams]]\nregion = [0, 1, 2.5, 3]\nvelocity = [-1, 0.5]\n"
        "[[discs.streams]]\nregion = [4, 5, 6, 7]\nvelocity = [0, 1]\n"
        "[time]\nsteps = 0\nmethod = 'time-stepped'\nmicro_steps = 8\nsync_every = 32\n"
        "[output]\ntext = 'every_step'\n[effects]\n",
        "s.toml");
    CHECK(scene.n_discs == 100);
    CHECK(scene.radius == Approx(100 * std::sqrt(0.25 / (100 * 3.14159265358979))));
    CHECK(scene.generator == Generator::lattice);
    CHECK(scene.speed == 0.5);
    CHECK(scene.velocities == VelocityKind::uniform);
    CHECK(scene.seed == 16);
    REQUIRE(scene.streams.size() == 2);
    CHECK(scene.streams[0].x_high == 2.5);
    CHECK(scene.streams[0].vx == -1);
    CHECK(scene.streams[1].y_low == 5);
    CHECK(scene.steps == 0);
    CHECK(scene.micro_steps == 8);
    CHECK(scene.sync_every == 32);
    CHECK(scene.text_output == TextOutput::every_step);
}

TEST_CASE("an accuracy stands in for the settings that it chooses, and the command line wins over "
          "the scene") {
    const std::string asks =
        "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = 5\naccuracy = 0.1\n";
    CHECK(read_scene(asks, "s.toml").accuracy == 0.1);
    const SceneParameters chosen = read_scene(asks, "s.toml",
                                              {"time.method=event-driven", "time.micro_steps=4"});
    CHECK_FALSE(chosen.accuracy);
    CHECK((chosen.method == Method::event_driven && chosen.micro_steps == 4));
    const SceneParameters asked = read_scene(good, "s.toml", {"time.accuracy=0.5"});
    CHECK(asked.accuracy == 0.5);
    CHECK_THROWS_AS(read_scene(asks + "micro_steps = 2\n", "s.toml"), InputError);
}

TEST_CASE("precision and arithmetic are knobs of both methods") {
    const SceneParameters plain = read_scene(good, "s.toml");
    CHECK((plain.precision == Precision::double_ && plain.arithmetic == Arithmetic::stable &&
           !plain.contraction));
    const SceneParameters other = read_scene(
        good, "s.toml",
        {"time.precision=single", "time.arithmetic=naive", "time.contraction=true"});
    CHECK((other.precision == Precision::single && other.arithmetic == Arithmetic::naive &&
           other.contraction));
    const SceneParameters exact = read_scene(
        good, "s.toml",
        {"time.method=event-driven", "time.precision=single", "time.arithmetic=naive"});
    CHECK((exact.method == Method::event_driven && exact.precision == Precision::single &&
           exact.arithmetic == Arithmetic::naive));
    CHECK_THROWS_AS(
        read_scene(good, "s.toml",
                   {"time.method=event-driven", "time.precision=single", "time.sync_every=5000"}),
        InputError);
    CHECK_THROWS_AS(read_scene(good, "s.toml", {"time.precision=single", "time.sync_every=5000"}),
                    InputError);
    CHECK_THROWS_AS(
        read_scene(good, "s.toml", {"time.precision=single", "box.size=1e20", "discs.radius=1e19"}),
        InputError);
}

TEST_CASE("discs can be listed in the scene or in a file beside it") {
    const SceneParameters listed = read_scene(
        "[box]\nsize = 10\n[discs]\nradius = 5\nlist = [[5, 5, 1, -1]]\n[time]\nsteps = 1\n",
        "s.toml");
    CHECK(listed.generator == Generator::file);
    CHECK(listed.n_discs == 1);
    CHECK(listed.listed_discs == std::vector<InputDisc>{{0, 5, 5, 1, -1}});
    CHECK_FALSE(listed.reads_disc_lines());

    const SceneParameters filed = read_scene(
        "[box]\nsize = 10\n[discs]\ncount = 3\nradius = 1\nfile = \"d.txt\"\n[time]\nsteps = 1\n",
        "folder/s.toml");
    CHECK(filed.reads_disc_lines());
    CHECK(discs_path(filed) == "folder/d.txt");
}

TEST_CASE("overrides replace what the text says, and what excludes them there") {
    const SceneParameters scene = read_scene(good, "s.toml",
                                             {"box.size=30", "discs.packing = 0.2",
                                              "output.text=ends", "discs.speed=2.5", "time.steps=5",
                                              "time.steps=6", "discs.velocities='uniform'"});
    CHECK(scene.box.x == 30);
    CHECK(scene.radius == Approx(30 * std::sqrt(0.2 / (50 * 3.14159265358979))));
    CHECK(scene.text_output == TextOutput::first_and_last);
    CHECK(scene.speed == 2.5);
    CHECK(scene.steps == 6);
    CHECK(scene.velocities == VelocityKind::uniform);

    const SceneParameters regenerated = read_scene(good, "s.toml", {"discs.generator=legacy"});
    CHECK(regenerated.generator == Generator::legacy);
    const std::string listed = "[box]\nsize = 10\n[discs]\nradius = 1\ncount = 1\nlist = [[5, 5, "
                               "1, -1]]\n[time]\nsteps = 1\n";
    CHECK(read_scene(listed, "s.toml", {"discs.generator=random"}).listed_discs.empty());
    CHECK(read_scene(listed, "s.toml", {"discs.list=[[2,3,4,5]]"}).listed_discs ==
          std::vector<InputDisc>{{0, 2, 3, 4, 5}});
}

TEST_CASE("a dense random scene becomes a lattice, and says so") {
    const SceneParameters scene = read_scene(good, "s.toml", {"discs.packing=0.7"});
    CHECK(scene.generator == Generator::lattice);
    REQUIRE(scene.warnings.size() == 1);
    CHECK(scene.warnings[0].find("lattice") != std::string::npos);
    CHECK(read_scene(good, "s.toml", {"discs.packing=0.5"}).generator == Generator::random);
}

TEST_CASE("micro-steps that are no power of two are allowed with a warning") {
    CHECK(read_scene(good, "s.toml", {"time.micro_steps=1024"}).warnings.empty());
    CHECK(read_scene(good, "s.toml", {"time.micro_steps=10"}).warnings.size() == 1);
}

TEST_CASE("one wrong value is one problem at its line") {
    struct Wrong {
        int line;
        std::string text;
    };
    const std::vector<Wrong> all = {
        {2, "size = nan"},        {2, "size = inf"},
        {2, "size = -inf"},       {2, "size = 0"},
        {2, "size = -5"},         {2, "size = '100'"},
        {2, "size = true"},       {2, "size = [1]"},
        {2, "size = 1e90"},       {2, "size = 1e-90"},
        {2, "size = 1979-05-27"}, {4, "count = 0"},
        {4, "count = -1"},        {4, "count = 1.5"},
        {4, "count = 1e19"},      {4, "count = 4294967295"},
        {4, "count = nan"},       {4, "count = 'many'"},
        {5, "radius = 0"},        {5, "radius = -1"},
        {5, "radius = nan"},      {5, "radius = 51"},
        {5, "radius = 9"},        {5, "packing = 0"},
        {5, "packing = 0.91"},    {5, "packing = nan"},
        {5, "packing = -0.1"},    {5, "packing = 0.9\ngenerator = 'lattice'"},
        {7, "steps = -1"},        {7, "steps = 0.5"},
        {7, "steps = 1e300"},     {7, "steps = 9223372036854775807"},
    };
    for (const Wrong& wrong : all) {
        CAPTURE(wrong.text);
        const auto problems = problems_in(with_line(wrong.line, wrong.text));
        CHECK(places_of(problems) == Texts{"s.toml:" + std::to_string(wrong.line)});
    }
}

TEST_CASE("one wrong further value is one problem at its line") {
    const Texts all = {"[discs]\nspeed = nan",
                       "[discs]\nspeed = -1",
                       "[discs]\nspeed = 1e100",
                       "[discs]\nvelocities = 'maxwel'",
                       "[discs]\nseed = -1",
                       "[discs]\ngenerator = 'latice'",
                       "[discs]\ngenerator = 'file'",
                       "[discs]\nfile = 3",
                       "[discs]\nfile = ''",
                       "[discs]\nlist = 3",
                       "[discs]\nlist = [[1, 2, 3, 4]]",
                       "[discs]\nradios = 1",
                       "[time]\nmethod = 'two'",
                       "[time]\nmethod = 1",
                       "[time]\ncollisions = 'one'",
                       "[time]\naccuracy = 0",
                       "[time]\nmethod = 'time-stepped'\naccuracy = 0.1",
                       "[time]\nmicro_steps = 0",
                       "[time]\nprecision = 'half'",
                       "[time]\narithmetic = 'exact'",
                       "[time]\ncontraction = 1",
                       "[time]\ncontraction = true",
                       "[time]\nsync_every = 0",
                       "[time]\nsync_every = 1e12",
                       "[output]\ntext = 'all'",
                       "[output]\ntrajectory = 'x'",
                       "[effects]\ngravity = 1",
                       "[speed]\n",
                       "\nspeed = 1"};
    for (const std::string& addition : all) {
        CAPTURE(addition);
        // TOML does not allow a second header of a table, so the addition replaces the header of
        // its table.
        const std::string table = addition.substr(0, addition.find('\n'));
        const std::string key = addition.substr(addition.find('\n') + 1);
        std::string text = good;
        std::int64_t line = 0;
        if (table.empty()) {
            text = key + '\n' + good;
            line = 1;
        } else if (const std::size_t at = good.find(table); at != std::string::npos) {
            text.insert(at + table.size() + 1, key + '\n');
            line = std::count(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(at), '\n') +
                   2;
        } else {
            text += addition + '\n';
            line = key.empty() ? 8 : 9;
        }
        CHECK(places_of(problems_in(text)) == Texts{"s.toml:" + std::to_string(line)});
    }
}

TEST_CASE("what goes wrong together is told where it can be mended") {
    CHECK(places_of(problems_in(with_line(4, "count = 10_000_000"))) ==
          Texts{"s.toml:5"}); // the radius is too large
    CHECK(places_of(problems_in(with_line(7, "steps = 3\nmicro_steps = 9007199254740992"))) ==
          Texts{"s.toml:7"});
}

TEST_CASE(
    "numbers too large for any type, and text that is not TOML, are one problem with a line") {
    CHECK(places_of(problems_in(with_line(4, "count = 10000000000000000000"))) ==
          Texts{"s.toml:4"});
    CHECK(places_of(problems_in(with_line(2, "[ = 3"))) == Texts{"s.toml:2"});
    CHECK(places_of(problems_in(with_line(7, "steps = "))) == Texts{"s.toml:7"});
    CHECK(places_of(problems_in(good + "[time]\n")) == Texts{"s.toml:8"});
    CHECK(places_of(problems_in(with_line(5, "radius = \xff"))) == Texts{"s.toml:5"});
}

TEST_CASE("what is missing is named") {
    const auto problems = problems_in("");
    CHECK(places_of(problems) == Texts{"s.toml", "s.toml", "s.toml", "s.toml"});
    for (const char* key : {"box.size", "discs.count", "discs.radius", "time.steps"})
        CHECK(mentions(problems, key));
}

TEST_CASE("all problems of a scene come at once, in the order of lines, those of overrides last") {
    const std::string text =
        "[box]\nsise = 10\nsize = nan\n[discs]\ncount = 0\npacking = 1.5\nradius = -1\nlist = [[1, "
        "2, 3],\n"
        "  [1, 2, 3, 'a']]\n[[discs.streams]]\nregion = [1, 2, 3]\nvelocity = [1, "
        "2]\n[[discs.streams]]\n"
        "regio = [1, 2, 3, 4]\nvelocity = [1, 2]\n[time]\nsteps = 'ten'\n[effects.charge]\ne = 1\n"
        "[output.movie]\nevery = 1\n[foo]\n";
    const auto problems = problems_in(text, {"box.sise=1", "time.steps=1.5", "nonsense",
                                             "effects.magnet.pull=1", "box.size=abc"});
    for (const Problem& problem : problems) UNSCOPED_INFO(to_string(problem));
    CHECK(places_of(problems) == Texts{"s.toml:2",
                                       "s.toml:3",
                                       "s.toml:5",
                                       "s.toml:6",
                                       "s.toml:7",
                                       "s.toml:7",
                                       "s.toml:8",
                                       "s.toml:9",
                                       "s.toml:10",
                                       "s.toml:11",
                                       "s.toml:13",
                                       "s.toml:14",
                                       "s.toml:17",
                                       "s.toml:18",
                                       "s.toml:20",
                                       "s.toml:22",
                                       "--set box.sise",
                                       "--set nonsense",
                                       "--set effects.magnet.pull",
                                       "--set box.size",
                                       "--set time.steps"});
    CHECK(mentions(problems, "did you mean 'box.size'?"));
    CHECK(mentions(problems, "did you mean 'region'?"));
    CHECK(mentions(problems, "no such key 'effects.charge'; [effects] has contact, gravity"));
    CHECK(mentions(problems, "no such key 'effects.magnet.pull'; [effects] has contact, gravity"));
    CHECK(mentions(problems, "no such key 'output.movie'; [output] has text, folder"));
}

TEST_CASE("outputs to files are read and checked") {
    const SceneParameters scene = read_scene(
        std::string(good) + "[output]\nfolder = 'a b'\ncollisions = "
                            "true\n[output.checkpoint]\nevery_steps = 1e3\nevery_minutes = 0.5\n"
                            "keep = 3\nat_end = false\n[output.trajectory]\nevery_steps = 7\n"
                            "fields = ['velocity', 'collisions']\nprecision = 'double'\n",
        "s.toml");
    REQUIRE(scene.checkpoint);
    CHECK(scene.checkpoint->folder == "a b/checkpoints");
    CHECK(scene.checkpoint->every_steps == 1000);
    CHECK(scene.checkpoint->every_minutes == 0.5);
    CHECK(scene.checkpoint->keep == 3);
    CHECK(!scene.checkpoint->at_end);
    REQUIRE(scene.trajectory);
    CHECK(scene.trajectory->file == "a b/trajectory.h5");
    CHECK(scene.trajectory->every_steps == 7);
    CHECK((!scene.trajectory->has_position && scene.trajectory->has_velocity &&
           scene.trajectory->has_collisions));
    CHECK(!scene.trajectory->is_single);
    REQUIRE(scene.collisions);
    CHECK(scene.collisions->file == "a b/collisions.h5");

    const SceneParameters plain = read_scene(
        good, "s.toml", {"output.folder=x", "output.trajectory.every_steps=1"});
    REQUIRE(plain.checkpoint);
    CHECK(plain.checkpoint->keep == 2);
    CHECK(plain.checkpoint->at_end);
    CHECK(!plain.checkpoint->every_steps);
    REQUIRE(plain.trajectory);
    CHECK((plain.trajectory->has_position && plain.trajectory->has_velocity &&
           plain.trajectory->is_single));
    CHECK(!plain.collisions);

    for (const char* wrong :
         {"[output]\nfolder = ''", "[output]\nfolder = 'a'\n[output.checkpoint]\nkeep = 0",
          "[output]\nfolder = 'a'\n[output.checkpoint]\nevery_steps = 0",
          "[output]\nfolder = 'a'\n[output.checkpoint]\nevery_minutes = 0",
          "[output]\nfolder = 'a'\n[output.checkpoint]\nat_end = 1",
          "[output]\nfolder = 'a'\n[output.checkpoint]\nevery = 1",
          "[output]\nfolder = 'a'\n[output.trajectory]\nfields = ['mass']",
          "[output]\nfolder = 'a'\n[output.trajectory]\nfields = [1]",
          "[output]\nfolder = 'a'\n[output.trajectory]\nfields = []",
          "[output]\nfolder = 'a'\n[output.trajectory]\nprecision = 'half'",
          "[output]\nfolder = 'a'\n[output.trajectory]\nfile = 'a'",
          "[output]\ncollisions = 'a'"}) {
        CAPTURE(wrong);
        CHECK(problems_in(std::string(good) + wrong + "\n").size() == 1);
    }
}

TEST_CASE("misspelt keys name the nearest known one") {
    const std::vector<std::pair<std::string, std::string>> pairs = {
        {"time.stepz=1", "time.steps"},     {"discs.pakcing=0.1", "discs.packing"},
        {"disks.radius=1", "discs.radius"}, {"steps=1", "time.steps"},
        {"output.txt=ends", "output.text"}, {"time.micro_step=2", "time.micro_steps"}};
    for (const auto& [wrong, right] : pairs) {
        CAPTURE(wrong);
        CHECK(mentions(problems_in(good, {wrong}), "did you mean '" + right + "'?"));
    }
    // An inner key has the same name: effects.obstacles.discs
    CHECK(mentions(problems_in(std::string(good) + "[disc]\ncount = 3\n"),
                   "no such key 'disc'; did you mean 'discs'?"));
}

TEST_CASE("where no known key is near none is guessed: those that there are get listed") {
    for (const char* wrong : {"a=1", "box.q=1", "foo=1", "discs.zzzzzzzqqqqq=1", "box.sidelength=3",
                              "time.tau=1", "output.trajectory.colour='x'"}) {
        CAPTURE(wrong);
        const auto problems = problems_in(good, {wrong});
        CHECK(problems.size() == 1);
        CHECK_FALSE(mentions(problems, "did you mean"));
    }
    CHECK(mentions(problems_in(good, {"foo=1"}),
                   "the tables [box], [discs], [time], [effects] and [output]"));
    CHECK(mentions(problems_in(good, {"box.sidelength=1"}), "[box] has size"));
    CHECK(mentions(problems_in(good, {"output.trajectory.colour=1"}),
                   "[output.trajectory] has every_steps, frames_per_decade, fields"));
    CHECK_FALSE(mentions(problems_in(good, {"time.method=exact"}), "did you mean"));
    CHECK(
        mentions(problems_in(good, {"time.method=evnt-driven"}), "did you mean \"event-driven\"?"));
}
