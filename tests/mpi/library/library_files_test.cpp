// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints and trajectories of the library: a run with stops and restarts equals the
// uninterrupted one, and files contain the discs of the simulation.
#include "catch.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <mpi.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include "library_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// A folder of all ranks, removed at the end.
class Folder {
public:
    explicit Folder(const Session& session) : session_(session) {
        int process = static_cast<int>(::getpid());
        MPI_Bcast(&process, 1, MPI_INT, 0, MPI_COMM_WORLD);
        path_ = "/tmp/carrom_library_test_" + std::to_string(process);
        if (session_.is_root()) std::filesystem::create_directories(path_);
        MPI_Barrier(MPI_COMM_WORLD);
    }
    ~Folder() {
        MPI_Barrier(MPI_COMM_WORLD);
        if (session_.is_root()) std::filesystem::remove_all(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string file(const char* name) const { return path_ + "/" + name; }

private:
    const Session& session_;
    std::string path_;
};

} // namespace

TEST_CASE("going on from a checkpoint gives the bits of the uninterrupted run") {
    const Session session;
    const Folder folder(session);
    for (const char* method : {"time-stepped", "event-driven"}) {
        Scene scene = gas(method, 30);
        scene.set("time.micro_steps", 2).set("time.sync_every", 6);
        const std::string path = folder.file("state.h5");
        {
            Simulation first(session, scene);
            first.advance_to_end();
            first.write_checkpoint(path);
        }
        Simulation whole(session, scene.set("time.steps", 70));
        whole.advance_to_end();
        Simulation second = Simulation::from_checkpoint(session, path, {"time.steps=70"});
        CHECK(second.step() == 30);
        CHECK(second.scene().steps == 70);
        second.advance_to_end();
        CHECK(hash_of(second) == hash_of(whole));
        CHECK(second.gathered_discs() == whole.gathered_discs());
    }
}

TEST_CASE("checkpoints are written on a schedule, and the newest of a folder is gone on from") {
    const Session session;
    const Folder folder(session);
    const std::string place = folder.file("of_run/checkpoints");
    const auto names = [&] {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(place))
            found.push_back(entry.path().filename().string());
        std::sort(found.begin(), found.end());
        return found;
    };
    const auto name = [](int step) {
        std::string digits = std::to_string(step);
        return "checkpoint-" + std::string(12 - digits.size(), '0') + digits + ".h5";
    };
    Scene scene = gas("event-driven", 50);
    Simulation whole(session, scene);
    whole.keep_checkpoints({.folder = place, .every_steps = 12, .keep = 3});
    whole.advance_to(11);
    CHECK(names().empty());
    whole.advance(30); // beyond steps 12, 24 and 36
    MPI_Barrier(MPI_COMM_WORLD);
    CHECK(names() == std::vector<std::string>{name(12), name(24), name(36)});
    {
        Simulation second = Simulation::from_checkpoint(session, place);
        CHECK(second.step() == 36);
        second.advance_to_end();
        whole.advance_to_end();
        CHECK(hash_of(second) == hash_of(whole));
    }
    MPI_Barrier(MPI_COMM_WORLD);
    const std::vector<std::string> last = names(); // older files are removed while the run advances
    CHECK(std::count(last.begin(), last.end(), name(48)) == 1);
    CHECK(std::count(last.begin(), last.end(), name(50)) == 1);
    CHECK(std::count(last.begin(), last.end(), name(12)) == 0);

    CHECK(problems_of([&] { whole.keep_checkpoints({.folder = place}); }).find("before") !=
          std::string::npos);
    Simulation other(session, scene);
    const std::string problems = problems_of(
        [&] { other.keep_checkpoints({.folder = "", .every_steps = -1, .keep = 0}); });
    for (const char* wrong : {"folder", "every_steps = -1", "keep = 0"})
        CHECK(problems.find(wrong) != std::string::npos);
    const std::string cut = folder.file("cut") + std::string("\0off", 4);
    CHECK(problems_of([&] { other.keep_checkpoints({.folder = cut}); }).find("NUL") !=
          std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.file("cut")));
    if (session.is_root()) std::ofstream(folder.file("plain")) << "a file";
    MPI_Barrier(MPI_COMM_WORLD);
    CHECK(code_of([&] { other.keep_checkpoints({.folder = folder.file("plain") + "/inside"}); }) ==
          ExitCode::output_failure);
}

TEST_CASE("a scene begins with the discs of a checkpoint or of a frame") {
    const Session session;
    const Folder folder(session);
    Simulation first(session, gas("event-driven", 25));
    TrajectoryWriter writer(first, folder.file("frames.h5"), {.single_precision = false});
    first.advance_to(20);
    writer.append();
    const std::vector<Disc> early = first.gathered_discs();
    first.advance_to_end();
    writer.append();
    first.write_checkpoint(folder.file("state.h5"));
    const auto begun_from = [&](const char* file, int step) {
        Scene scene;
        scene.set("box.size", 60).set("discs.radius", 0.75).set("time.steps", 10);
        scene.set("discs.from", folder.file(file));
        if (step > 0) scene.set("discs.from_step", step);
        return Simulation(session, scene).gathered_discs();
    };
    const auto same_places = [](const std::vector<Disc>& a, const std::vector<Disc>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Disc& p, const Disc& q) {
            return p.id == q.id && p.x == q.x && p.y == q.y && p.vx == q.vx && p.vy == q.vy;
        });
    };
    CHECK(same_places(begun_from("state.h5", 0), first.gathered_discs()));
    CHECK(same_places(begun_from("frames.h5", 20), early));
    CHECK(problems_of([&] { begun_from("frames.h5", 21); }).find("no frame of step 21") !=
          std::string::npos);
    CHECK(code_of([&] { begun_from("nothing.h5", 0); }) == ExitCode::bad_input);
}

TEST_CASE("measurements go on from a checkpoint") {
    const Session session;
    const Folder folder(session);
    Scene scene = gas("event-driven", 40);
    scene.set("output.measurements.quantities", "[\"velocities\", \"wall_pressure\"]");
    scene.set("output.measurements.every_steps", 4);
    Simulation whole(session, scene);
    whole.advance_to(18);
    whole.write_checkpoint(folder.file("state.h5"));
    Simulation second = Simulation::from_checkpoint(session, folder.file("state.h5"));
    whole.advance_to_end();
    second.advance_to_end();
    const auto a = whole.measurements(), b = second.measurements();
    REQUIRE(a.size() == b.size());
    CHECK(a.size() >= 3);
    for (std::size_t k = 0; k < a.size(); ++k) {
        CHECK(a[k].name == b[k].name);
        CHECK(a[k].rows == b[k].rows);
    }
}

TEST_CASE("a checkpoint is read as a file of one frame") {
    const Session session;
    const Folder folder(session);
    Simulation simulation(session, gas("event-driven", 25));
    simulation.advance_to_end();
    simulation.write_checkpoint(folder.file("state.h5"));
    const std::vector<Disc> discs = simulation.gathered_discs();
    const FrameReader file(session, folder.file("state.h5"));
    CHECK(file.steps() == std::vector<std::int64_t>{25});
    CHECK(file.n_discs() == 300);
    CHECK(file.box() == Box(60));
    CHECK(file.state_hash() == hash_of(simulation));
    if (!session.is_root()) return;
    CHECK(file.read(0) == discs);
    CHECK(file.read(0, 17, 19) == std::vector<Disc>(discs.begin() + 17, discs.begin() + 19));
    CHECK_FALSE(problems_of([&] { file.read(1); }).empty());
    CHECK_FALSE(problems_of([&] { file.read(0, 0, 301); }).empty());
}

TEST_CASE("a trajectory shows the discs of each step that was added") {
    const Session session;
    const Folder folder(session);
    const std::string path = folder.file("frames.h5");
    const TrajectoryFields fields{.collisions = true, .single_precision = false};
    std::vector<std::vector<Disc>> shown;
    Simulation simulation(session, gas("time-stepped", 30));
    {
        TrajectoryWriter writer(simulation, path, fields);
        writer.append();
        shown.push_back(simulation.gathered_discs());
        CHECK_FALSE(problems_of([&] { writer.append(); }).empty());
        simulation.advance(10);
        writer.append();
        shown.push_back(simulation.gathered_discs());
        writer.describe();
    }
    simulation.advance(10);
    TrajectoryWriter writer = TrajectoryWriter::going_on(simulation, path, fields);
    writer.append();
    shown.push_back(simulation.gathered_discs());
    const FrameReader file(session, path);
    CHECK(file.steps() == std::vector<std::int64_t>{0, 10, 20});
    CHECK(file.state_hash().empty());
    for (std::size_t frame = 0; session.is_root() && frame < shown.size(); ++frame)
        CHECK(file.read(frame) == shown[frame]);

    Simulation other(session, gas("event-driven", 30));
    other.advance(25);
    CHECK(code_of([&] { TrajectoryWriter::going_on(other, path, fields); }) == ExitCode::bad_input);
    CHECK_FALSE(problems_of([&] { TrajectoryWriter(other, path, {.spins = true}); }).empty());
}

TEST_CASE("files that are wrong, and places that cannot be written to, have their codes") {
    const Session session;
    const Folder folder(session);
    const std::string path = folder.file("state.h5");
    Simulation simulation(session, gas("time-stepped", 3));
    simulation.advance_to_end();
    CHECK(code_of([&] { simulation.write_checkpoint(folder.file("none/state.h5")); }) ==
          ExitCode::output_failure);
    CHECK(code_of([&] { TrajectoryWriter(simulation, folder.file("none/frames.h5")); }) ==
          ExitCode::output_failure);
    simulation.write_checkpoint(path);
    CHECK(problems_of([&] {
              Simulation::from_checkpoint(session, path, {"box.size=61"});
          }).find("box.size") != std::string::npos);
    CHECK_FALSE(
        problems_of([&] { Simulation::from_checkpoint(session, path, {"time.steps=2"}); }).empty());
    if (session.is_root()) {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(-200, std::ios::end);
        file.put('\x5a').put('\x5a');
    }
    MPI_Barrier(MPI_COMM_WORLD);
    CHECK(code_of([&] { Simulation::from_checkpoint(session, path); }) == ExitCode::bad_input);
    CHECK(code_of([&] { FrameReader(session, path); }) == ExitCode::bad_input);
    CHECK(code_of([&] { FrameReader(session, folder.file("nothing.h5")); }) == ExitCode::bad_input);
}

TEST_CASE("checkpoints and trajectories do not replace what is no plain file") {
    const Session session;
    const Folder folder(session);
    Simulation simulation(session, gas("event-driven", 1));
    const std::string pipe = folder.file("pipe"), victim = folder.file("victim");
    const std::string device = folder.file("device");
    bool has_device = false; // only root can make a device file
    if (session.is_root()) {
        CHECK(::mkfifo(pipe.c_str(), 0600) == 0);
        has_device = ::mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 3)) == 0;
        std::ofstream(victim) << "mine";
    }
    MPI_Bcast(&has_device, 1, MPI_CXX_BOOL, 0, MPI_COMM_WORLD);
    const auto code_of = [](const auto& write) {
        try {
            write();
        } catch (const CollectiveError& error) {
            CHECK(std::string(error.what()).find("is no") != std::string::npos);
            return static_cast<int>(error.code());
        }
        return 0;
    };
    for (const std::string& path : {pipe, device, victim + '\0' + "more", std::string()}) {
        if (path == device && !has_device) continue;
        CHECK(code_of([&] { simulation.write_checkpoint(path); }) == 4);
        CHECK(code_of([&] { TrajectoryWriter(simulation, path).append(); }) == 4);
    }
    if (!session.is_root()) return;
    CHECK(std::filesystem::is_fifo(pipe));
    CHECK(std::filesystem::is_character_file(device) == has_device);
    CHECK(std::filesystem::file_size(victim) == 4);
}

TEST_CASE("writers and readers that were moved from say so") {
    const Session session;
    const Folder folder(session);
    Simulation simulation(session, gas("event-driven", 2));
    TrajectoryWriter first(simulation, folder.file("frames.h5"));
    TrajectoryWriter second = std::move(first);
    second.append();
    const auto is_told = [](const auto& act) {
        return problems_of(act).find("was moved from") != std::string::npos;
    };
    CHECK(is_told([&] { first.append(); }));
    CHECK(is_told([&] { first.describe(); }));
    FrameReader reader(session, folder.file("frames.h5"));
    const FrameReader other = std::move(reader);
    CHECK(other.steps().size() == 1);
    CHECK(is_told([&] { static_cast<void>(reader.steps()); }));
    CHECK(is_told([&] { static_cast<void>(reader.n_discs()); }));
    CHECK(is_told([&] { static_cast<void>(reader.read(0)); }));
}
