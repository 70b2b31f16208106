// SPDX-License-Identifier: BSD-3-Clause
// The plan of how a run begins, from options and names of files alone. No disc is made, and the
// checkpoints of these tests are empty files.
#include "run/start/start_plan.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "catch.hpp"

#include "core/errors.hpp"

using namespace carrom;

namespace {

/// A folder of the test with a scene of one disc; removed at the end.
class Place {
public:
    explicit Place(const Communicator& world)
        : world_(world), path_("start_plan_" + std::to_string(world.size())) {
        if (world_.is_root()) {
            std::filesystem::remove_all(path_);
            std::filesystem::create_directories(path_);
        }
        write("one.toml", "[box]\nsize = 10\n\n[discs]\ncount = 1\nradius = 1\nspeed = 1\n\n"
                          "[time]\nsteps = 10\n");
    }
    ~Place() {
        world_.barrier();
        if (world_.is_root()) std::filesystem::remove_all(path_);
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    std::string of(const std::string& name) const { return path_ + "/" + name; }
    /// **Collective.**
    void write(const std::string& name, const std::string& text = "") const {
        if (world_.is_root()) {
            std::filesystem::create_directories(std::filesystem::path(of(name)).parent_path());
            std::ofstream(of(name)) << text;
        }
        world_.barrier();
    }

private:
    const Communicator& world_;
    std::string path_;
};

std::string planned(const RunOptions& options, const Communicator& world) {
    return text_of(plan_start(options, {}, world));
}

/// Whether the text of the problems contains these words.
bool is_refused(const RunOptions& options, const std::string& words, const Communicator& world) {
    try {
        plan_start(options, {}, world);
    } catch (const InputError& error) {
        return std::string(error.what()).find(words) != std::string::npos;
    }
    return false;
}

} // namespace

TEST_CASE("a plan without a restart begins with the scene") {
    const Communicator world = Communicator::world();
    const Place place(world);
    RunOptions options;
    options.input = place.of("one.toml");
    options.overrides = {"time.steps=7"};
    const StartPlan plan = plan_start(options, {}, world);
    CHECK(text_of(plan) == "scene of " + options.input + "\nbegins at step 0\nwith time.steps=7\n");
    CHECK(plan.scene.steps == 7);
    CHECK(plan.scene.n_discs == 1);
}

TEST_CASE("a plan to resume lists the checkpoints of the run's folder, newest first") {
    const Communicator world = Communicator::world();
    const Place place(world);
    for (const char* name :
         {"run/checkpoints/checkpoint-000000000020.h5",
          "run/checkpoints/checkpoint-000000000100.h5", "run/checkpoints/notes.txt"})
        place.write(name);
    RunOptions options;
    options.input = place.of("one.toml");
    options.folder = place.of("run");
    options.overrides = {"output.folder=" + options.folder};
    options.resume = true;
    const std::string expected = "goes on from the newest checkpoint in " + options.folder +
                                 "/checkpoints, or begins at step 0\n  " + options.folder +
                                 "/checkpoints/checkpoint-000000000100.h5\n  " + options.folder +
                                 "/checkpoints/checkpoint-000000000020.h5\nwith output.folder=" +
                                 options.folder + "\n";
    CHECK(planned(options, world) == "scene of " + options.input + "\n" + expected);
    options.input.clear(); // the checkpoint has the scene
    CHECK(planned(options, world) == "scene of the checkpoint\n" + expected);
    options.resume = false;
    options.restart = "latest";
    CHECK(planned(options, world) == "scene of the checkpoint\n" + expected);
}

TEST_CASE("a run that was killed before its first checkpoint begins with the copy of its scene") {
    const Communicator world = Communicator::world();
    const Place place(world);
    place.write("run/scene.toml", "# --set time.steps=5\n[box]\nsize = 10\n\n[discs]\ncount = 1\n"
                                  "radius = 1\nspeed = 1\n\n[time]\nsteps = 10\n");
    RunOptions options;
    options.folder = place.of("run");
    options.overrides = {"output.folder=" + options.folder};
    options.resume = true;
    const StartPlan plan = plan_start(options, {}, world);
    CHECK(plan.options.input == options.folder + "/scene.toml");
    CHECK(plan.options.overrides ==
          std::vector<std::string>{"time.steps=5", "output.folder=" + options.folder});
    CHECK(plan.scene.steps == 5);
    CHECK(plan.restart.from == RestartPlan::From::own_folder);
    CHECK(plan.restart.candidates.empty());
    options.input = place.of("one.toml"); // a named scene has priority over the copy
    CHECK(plan_start(options, {}, world).scene.steps == 10);
}

TEST_CASE("a plan to restart from a file or from a folder names it") {
    const Communicator world = Communicator::world();
    const Place place(world);
    place.write("kept/checkpoint-000000000003.h5");
    place.write("run/checkpoints/checkpoint-000000000004.h5");
    RunOptions options;
    options.restart = place.of("kept/checkpoint-000000000003.h5");
    CHECK(planned(options, world) ==
          "scene of the checkpoint\ngoes on from " + options.restart + "\n");
    options.restart = place.of("kept");
    CHECK(planned(options, world) == "scene of the checkpoint\ngoes on from the newest checkpoint "
                                     "in " +
                                         options.restart + "\n  " + options.restart +
                                         "/checkpoint-000000000003.h5\n");
    options.restart = place.of("run"); // the folder of a run, whose checkpoints are in a subfolder
    const StartPlan plan = plan_start(options, {}, world);
    CHECK(plan.restart.place == options.restart + "/checkpoints");
    CHECK(plan.restart.candidates.size() == 1);
}

TEST_CASE("a plan sees checkpoints that come after it") {
    const Communicator world = Communicator::world();
    const Place place(world);
    place.write("kept/checkpoint-000000000003.h5");
    RunOptions options;
    options.restart = place.of("kept");
    RestartPlan plan = plan_restart(options, {}, world);
    CHECK_FALSE(has_other_checkpoints(plan, world));
    place.write("kept/checkpoint-000000000005.h5");
    CHECK(has_other_checkpoints(plan, world));
    REQUIRE(plan.candidates.size() == 2);
    CHECK(plan.candidates.front() == place.of("kept/checkpoint-000000000005.h5"));
    CHECK_FALSE(has_other_checkpoints(plan, world));
    RestartPlan beginning;
    CHECK_FALSE(has_other_checkpoints(beginning, world));
}

TEST_CASE("options that lead to no start are an error of the plan") {
    const Communicator world = Communicator::world();
    const Place place(world);
    RunOptions options;
    options.resume = true;
    CHECK(is_refused(options, "name the folder of the run with -o, or the scene", world));
    options.input = place.of("one.toml");
    CHECK(is_refused(options, "the run has no folder to search", world));
    options.resume = false;
    options.overrides = {"time.steps=-1", "box.size=0"};
    CHECK(is_refused(options, "time.steps", world)); // all problems are reported together
    CHECK(is_refused(options, "box.size", world));
    options.overrides = {"output.trajectory.every_steps=1"};
    CHECK(is_refused(options, "'output.folder' is missing", world));
}
