// SPDX-License-Identifier: BSD-3-Clause
// Trajectories and logs of collisions on 1 to 7 ranks: data that are read equal the given data, in
// order, and a restart cuts the file back.
#include "io/trajectory.hpp"

#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "checkpoint_tools.hpp"
#include "io/collision_log.hpp"
#include "io/frame_file.hpp"

using namespace carrom;
using test::TestFolder;

namespace {

/// Numbers that are exact in single precision, different for every disc and step.
DiscState disc_at(DiscId id, std::int64_t step) {
    DiscState disc;
    disc.id = id;
    disc.tau = 0.5;
    disc.vx = 0.25 * static_cast<double>(id % 64);
    disc.vy = -0.125 * static_cast<double>(step);
    disc.x = static_cast<double>(id) + 0.5;
    disc.y = static_cast<double>(step);
    disc.wall_collisions = (id + static_cast<std::uint64_t>(step)) & 0xffffffff;
    disc.pair_collisions = (2 * id) & 0xffffffff;
    return disc;
}

double spin_of(const DiscState& disc) { return disc.vx - 0.5; }

SideColumns spins_of(const std::vector<DiscState>& discs) {
    std::vector<double> spins;
    for (const DiscState& disc : discs) spins.push_back(spin_of(disc));
    SideColumns columns;
    columns.add(SideColumn::spin, spins);
    return columns;
}

std::vector<DiscState> share(std::uint64_t n, std::int64_t step, const Communicator& world) {
    std::vector<DiscState> mine;
    for (DiscId id = n; id-- > 0;)
        if ((id * 31 + static_cast<std::uint64_t>(step)) %
                static_cast<std::uint64_t>(world.size()) ==
            static_cast<std::uint64_t>(world.rank()))
            mine.push_back(disc_at(id, step));
    return mine;
}

TrajectoryLayout layout_of(std::uint64_t n) {
    TrajectoryLayout layout;
    layout.system.program_version = "0.0.1";
    layout.system.n_discs = n;
    layout.system.radius = 1;
    layout.system.box = 64;
    layout.velocity_unit = 4;
    layout.has_collisions = true;
    return layout;
}

/// Whether rank 0 reads exactly these frames; true on other ranks.
bool holds(const std::string& path, std::uint64_t n, const std::vector<std::int64_t>& steps,
           const Communicator& world, bool are_turning = false, double box_size = 64) {
    world.barrier();
    bool is_right = true;
    if (world.is_root()) {
        const FrameFile file(path);
        is_right = file.summary().kind == FileKind::trajectory && file.summary().n_rows == n &&
                   file.summary().steps == steps &&
                   file.summary().has("angular_velocity") == are_turning &&
                   (steps.empty() || file.summary().box == Box(box_size)) &&
                   file.summary().program_version == "0.0.1";
        Rows rows;
        is_right = is_right && file.summary().columns.size() == (are_turning ? 7u : 6u);
        for (std::size_t frame = 0; is_right && frame < steps.size(); ++frame) {
            file.read(frame, 0, n, rows);
            for (DiscId id = 0; id < n; ++id) {
                const DiscState disc = disc_at(id, steps[frame]);
                const std::vector<double> wanted = {disc.x + disc.vx,
                                                    disc.y + disc.vy,
                                                    4 * disc.vx,
                                                    4 * disc.vy,
                                                    static_cast<double>(disc.pair_collisions),
                                                    static_cast<double>(disc.wall_collisions),
                                                    4 * spin_of(disc)};
                for (std::size_t k = 0; k < rows.size(); ++k)
                    is_right = is_right && rows[k][id] == wanted[k];
            }
        }
    }
    world.barrier();
    return is_right;
}

} // namespace

TEST_CASE("frames are read as they were given, in the order of ids") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    for (const std::uint64_t n : {1u, 5u, 3000u, 70000u}) {
        for (const bool is_single : {true, false}) {
            const std::string path = folder.file("t.h5");
            TrajectoryLayout layout = layout_of(n);
            layout.is_single = is_single;
            if (!is_single) layout.columns.add(SideColumn::spin);
            Trajectory trajectory(path, layout, world);
            const auto append = [&](std::int64_t step) {
                const std::vector<DiscState> mine = share(n, step, world);
                const SideColumns columns = spins_of(mine);
                trajectory.append(step, mine, 1.5, columns.spans());
            };
            const auto is_right = [&](const std::vector<std::int64_t>& steps) {
                return holds(path, n, steps, world, !is_single);
            };
            trajectory.begin();
            CHECK(is_right({}));
            append(0);
            append(7);
            CHECK(is_right({})); // the frames are not yet committed
            trajectory.commit();
            CHECK(is_right({0, 7}));
            trajectory.describe();
            CHECK(is_right({0, 7}));
            CHECK((!world.is_root() || std::filesystem::exists(folder.file("t.xdmf"))));
        }
    }
}

TEST_CASE("going on takes a trajectory back to its last commit, and further back if asked") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string path = folder.file("t.h5");
    {
        Trajectory killed(path, layout_of(300), world);
        killed.begin();
        for (std::int64_t step = 0; step < 10; ++step) {
            killed.append(step, share(300, step, world), 1.5);
            if (step == 5) killed.commit();
        }
    } // frames that are never committed, as after a kill
    Trajectory trajectory(path, layout_of(300), world);
    trajectory.go_on(20);
    trajectory.commit();
    CHECK(holds(path, 300, {0, 1, 2, 3, 4, 5}, world));
    trajectory.go_on(2);
    // cutting back changes nothing before the run begins
    CHECK(holds(path, 300, {0, 1, 2, 3, 4, 5}, world));
    trajectory.commit();
    CHECK(holds(path, 300, {0, 1, 2}, world));
    trajectory.append(4, share(300, 4, world), 1.5);
    trajectory.commit();
    CHECK(holds(path, 300, {0, 1, 2, 4}, world));

    Trajectory other(path, layout_of(301), world);
    bool is_refused = false;
    try {
        other.go_on(4);
    } catch (const CollectiveError& error) {
        is_refused = error.code() == ExitCode::bad_input;
    }
    CHECK(is_refused);
    CHECK(holds(path, 300, {0, 1, 2, 4}, world));
}

TEST_CASE("going on to another last step gives its frames the box of that step") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string path = folder.file("t.h5");
    const auto layout_with = [](double box_size) {
        TrajectoryLayout layout = layout_of(40);
        layout.system.box = box_size;
        return layout;
    };
    Trajectory first(path, layout_with(64), world);
    first.begin();
    for (std::int64_t step = 0; step < 300; ++step)
        first.append(step, share(40, step, world), 1.5); // many frames
    first.commit();
    std::vector<std::int64_t> steps(300);
    std::iota(steps.begin(), steps.end(), 0);
    {
        Trajectory killed(path, layout_with(80), world);
        killed.go_on(299);
        CHECK(holds(path, 40, steps, world, false, 64));
    } // frames that are never committed
    CHECK_THROWS_AS(Trajectory(path, layout_of(41), world).go_on(299), CollectiveError);
    CHECK(holds(path, 40, steps, world, false, 64));
    for (const double box_size : {80.0, 72.0}) { // a longer box, then a shorter one
        Trajectory trajectory(path, layout_with(box_size), world);
        trajectory.go_on(steps.back());
        trajectory.commit();
        steps.push_back(steps.back() + 1);
        trajectory.append(steps.back(), share(40, steps.back(), world), 1.5);
        trajectory.commit();
        CHECK(holds(path, 40, steps, world, false, box_size));
    }
    Trajectory none(path, layout_with(64), world);
    none.go_on(-1);
    none.commit();
    CHECK(holds(path, 40, {}, world));
}

namespace {

LoggedCollision collision(std::int64_t k) {
    return {k / 10 + 1, 0.5 * static_cast<double>(k), k, k % 3 == 0 ? -1 : k + 1,
            0.1 * static_cast<double>(k)};
}

bool has_row(const Rows& rows, std::size_t row, const LoggedCollision& wanted) {
    return rows[0][row] == static_cast<double>(wanted.step) && rows[1][row] == wanted.time &&
           rows[2][row] == static_cast<double>(wanted.p) &&
           rows[3][row] == static_cast<double>(wanted.q) && rows[4][row] == wanted.impulse;
}

} // namespace

TEST_CASE("a log of collisions keeps the order of the ranks and is cut back") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string path = folder.file("c.h5");
    const auto append = [&](CollisionLog& log, std::int64_t begin, std::int64_t end) {
        std::vector<LoggedCollision> mine; // a rank has a slice of the collisions
        const std::int64_t n = end - begin, p = world.size(), r = world.rank();
        for (std::int64_t k = begin + n * r / p; k < begin + n * (r + 1) / p; ++k)
            mine.push_back(collision(k));
        log.append(mine, end == 0 ? 0 : collision(end - 1).step);
    };
    const auto holds_log = [&](std::int64_t n) {
        world.barrier();
        bool is_right = true;
        if (world.is_root()) {
            const FrameFile file(path);
            Rows rows;
            is_right = file.summary().kind == FileKind::collisions &&
                       file.summary().n_rows == static_cast<std::uint64_t>(n);
            if (is_right) file.read(0, 0, file.summary().n_rows, rows);
            for (std::int64_t k = 0; is_right && k < n; ++k)
                is_right = has_row(rows, static_cast<std::size_t>(k), collision(k));
        }
        world.barrier();
        return is_right;
    };
    {
        CollisionLog killed(path, layout_of(100).system, world);
        killed.begin();
        append(killed, 0, 0);
        append(killed, 0, 3);
        append(killed, 3, 40000);
        CHECK(holds_log(0));
        killed.commit();
        CHECK(holds_log(40000));
        append(killed, 40000, 50000);
        CHECK(holds_log(40000)); // later rows are not yet committed
    }
    CollisionLog log(path, layout_of(100).system, world);
    log.go_on(100000);
    log.commit();
    CHECK(holds_log(40000));
    if (world.is_root()) CHECK(log.gaps() == std::vector<std::int64_t>{4001, 100000});
    log.go_on(1234);
    if (world.is_root()) CHECK(log.gaps().empty());
    CHECK(holds_log(40000)); // cutting back changes nothing before the run begins
    log.commit();
    CHECK(holds_log(12340));
    append(log, 12340, 12350);
    log.commit();
    CHECK(holds_log(12350));
    append(log, 12350, 400000); // so many rows lie in several segments
    log.commit();
    CHECK(holds_log(400000));
    CHECK((!world.is_root() || std::filesystem::exists(folder.file("c/0002.h5"))));
    log.go_on(12);
    log.commit();
    CHECK(holds_log(120));
    CHECK((!world.is_root() || !std::filesystem::exists(folder.file("c/0002.h5"))));
}
