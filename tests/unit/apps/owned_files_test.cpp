// SPDX-License-Identifier: BSD-3-Clause
// The owner of a file, by the folder that it is in, and the kind of its content, by its first
// bytes.
#include <filesystem>
#include <fstream>

#include "catch.hpp"
#include <unistd.h>

#include "run/files/destinations.hpp"
#include "run/files/owned_files.hpp"

using namespace carrom;

namespace {

namespace fs = std::filesystem;

/// A folder with a run in `run`, without one in `own`, and with replicas in `many`.
class Folders {
public:
    Folders() {
        for (const char* name :
             {"run/checkpoints", "run/trajectory", "own", "many/0000/checkpoints"})
            fs::create_directories(top / name);
        write("run/scene.toml", "[box]\n");
        write("many/0000/scene.toml", "[box]\n");
        write("many/replicas.csv", "replica,seed,state_hash\n");
    }
    ~Folders() { fs::remove_all(top); }
    Folders(const Folders&) = delete;
    Folders& operator=(const Folders&) = delete;

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(top / name) << text;
    }
    std::string operator()(const std::string& name) const { return (top / name).string(); }

    const fs::path top = fs::canonical(fs::temp_directory_path()) /
                         ("carrom_owned_" + std::to_string(::getpid()));
};

} // namespace

TEST_CASE("a run owns its files by folder, through links and other spellings") {
    const Folders in;
    const std::string ours = "a file of the run in " + in("run");
    for (const char* name : {"run/scene.toml", "run/report.json", "run/.carrom.lock",
                             "run/trajectory/0001.h5", "run/checkpoints/any", "run/trajectory/a/b",
                             "run/collisions/0001.h5", "run/../run/./scene.toml"})
        CHECK(owner_of_file(in(name), "") == ours);
    CHECK(owner_of_file(in("run/lines.txt"), "").empty());
    CHECK(owner_of_file(in("own/report.json"), "").empty());
    CHECK(owner_of_file(in("own/report.json"), in("own")) == "a file of the run in " + in("own"));
    CHECK(owner_of_file(in("own/measurements/a.csv"), in("own/")) ==
          "a file of the run in " + in("own"));
    fs::create_symlink("../run/scene.toml", in.top / "own/link");
    CHECK(owner_of_file(in("own/link"), "") == ours);
    in.write("elsewhere", "a checkpoint that was moved");
    fs::create_symlink("../../elsewhere", in.top / "run/checkpoints/link");
    CHECK(owner_of_file(in("run/checkpoints/link"), "") == ours);
    CHECK(owner_of_folder(in("run/checkpoints/new")).find("a folder of the run") == 0);
    CHECK(owner_of_folder(in("run/new")).empty());
    const std::string of_many = "a file of the replicas in " + in("many");
    for (const char* name : {"many/replicas.csv", "many/replicas.json", "many/velocities.csv"})
        CHECK(owner_of_file(in(name), "") == of_many);
    CHECK(owner_of_file(in("many/0000/report.json"), "") ==
          "a file of the run in " + in("many/0000"));
}

TEST_CASE("files hold what their first bytes say") {
    const Folders in;
    const auto content = [&in](const std::string& name, const std::string& text) {
        in.write(name, text);
        return content_of(in(name));
    };
    CHECK(content("a", "\x89HDF\r\n\x1a\n and more") == FileContent::hdf5);
    CHECK(content("a", " \n{\"version\": 1}") == FileContent::report);
    CHECK(content("a.toml", "text") == FileContent::scene);
    CHECK(content("a.in", "5\n") == FileContent::scene);
    CHECK(content("a", "# gas.toml: thermo\nstep,x\n") == FileContent::table);
    CHECK(content("a", "0 0 1.5 2.5 0 0\n") == FileContent::other);
    CHECK(content("a", " ") == FileContent::other);
    CHECK(content("a.toml", "") == FileContent::nothing);
    CHECK(content_of(in("none")) == FileContent::nothing);
    CHECK(content_of("/dev/zero") == FileContent::nothing);
}

TEST_CASE("an output replaces what it writes, and nothing else") {
    const Folders in;
    in.write("report", "{}\n");
    in.write("lines", "0 0 1 1 0 0\n");
    const auto n_problems = [&in](Output output, const std::string& name) {
        return problems_with({{"--output", in(name), output}}, {}).size();
    };
    CHECK(n_problems(Output::report, "report") == 0);
    CHECK(n_problems(Output::report, "lines") == 1);
    CHECK(n_problems(Output::text, "lines") == 0);
    CHECK(n_problems(Output::text, "report") == 1);
    CHECK(n_problems(Output::text, "new") == 0);
    CHECK(n_problems(Output::folder, "run/trajectory/more") == 1);
    CHECK(n_problems(Output::folder, "run") == 0);
    CHECK(n_problems(Output::of_folder, "run/report.json") == 0);
    const std::vector<Destination> twice = {{"--output", in("new"), Output::text},
                                            {"--report", in("own/../new"), Output::report}};
    CHECK(problems_with(twice, {}).size() == 1);
    CHECK(problems_with({{"-o", in("run"), Output::folder}}, {{"the checkpoint", in("run")}})
              .empty()); // --restart FOLDER -o FOLDER
    CHECK(problems_with(twice, {{"the input", in("new")}}).size() == 3);
}
