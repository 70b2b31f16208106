// SPDX-License-Identifier: BSD-3-Clause
#include "io/trajectory.hpp"

#include <carrom/trajectory.hpp>

#include <fmt/format.h>

#include "io/frame_file.hpp"
#include "library/live_part.hpp"
#include "library/session_state.hpp"
#include "library/simulation_state.hpp"
#include "parallel/agreement.hpp"
#include "parallel/meeting.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

TrajectoryOutput wanted_of(const TrajectoryFields& fields, const SceneParameters& scene,
                           const std::string& path) {
    std::vector<Problem> problems;
    if (fields.spins && !scene.effects.have_spins())
        problems.push_back({path, 0, "only rough discs have spins (effects.contact.kind)"});
    if (fields.directions && !scene.effects.activity.is_on())
        problems.push_back({path, 0, "only active discs have directions (effects.activity)"});
    if (!problems.empty()) throw InputError(std::move(problems));
    TrajectoryOutput wanted;
    wanted.file = path;
    wanted.has_velocity = fields.velocities;
    wanted.has_collisions = fields.collisions;
    wanted.columns = {};
    if (fields.spins) wanted.columns.add(SideColumn::spin);
    if (fields.directions) wanted.columns.add(SideColumn::direction);
    wanted.is_single = fields.single_precision;
    return wanted;
}

/// Returns the simulation's state when all ranks have reached this call. **Collective.**
const Simulation::State& met(const Simulation& simulation, const char* call,
                             const std::string& path) {
    const Simulation::State& state = simulation.state();
    meet(state.run().ranks(), call, hash_of_argument(path));
    return state;
}

} // namespace

struct TrajectoryWriter::State {
    State(const Simulation::State& of_simulation, const std::string& path,
          const TrajectoryFields& fields)
        : simulation(of_simulation), file(path),
          trajectory(path, layout_of(run().scene(), wanted_of(fields, run().scene(), path)),
                     run().ranks()) {}

    const Run& run() const { return simulation.run(); }

    /// a reference to the State, because its run is replaced when discs are changed
    const Simulation::State& simulation;
    std::string file;
    carrom::Trajectory trajectory;
    std::int64_t last_step = -1; ///< step of the last frame; the same on all ranks
};

TrajectoryWriter::TrajectoryWriter(const Simulation& simulation, const std::string& path,
                                   const TrajectoryFields& fields)
    : state_(std::make_unique<State>(met(simulation, "TrajectoryWriter", path), path, fields)) {
    state_->trajectory.begin();
}

TrajectoryWriter TrajectoryWriter::going_on(const Simulation& simulation, const std::string& path,
                                            const TrajectoryFields& fields) {
    auto state = std::make_unique<State>(met(simulation, "TrajectoryWriter::going_on", path), path,
                                         fields);
    const Run& run = state->run();
    state->last_step = state->trajectory.go_on(run.step(), [&run](const CheckpointHeader& there) {
        return first_difference(there, run.scene());
    });
    run.ranks().broadcast(state->last_step); // only rank 0 has read the file
    state->trajectory.commit();
    return TrajectoryWriter(std::move(state));
}

TrajectoryWriter::TrajectoryWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
TrajectoryWriter::TrajectoryWriter(TrajectoryWriter&&) noexcept = default;
TrajectoryWriter::~TrajectoryWriter() = default;

void TrajectoryWriter::append() {
    State& state = live_part(state_, "TrajectoryWriter");
    meet(state.run().ranks(), "TrajectoryWriter::append");
    const DiscSystem& system = state.run().system();
    const std::int64_t step = system.step();
    if (step <= state.last_step)
        throw InputError({{state.file, 0, fmt::format("step {} has a frame already", step)}});
    state.trajectory.append(step, system.shown(), system.clock(), system.side_columns());
    state.trajectory.commit();
    state.last_step = step;
}

void TrajectoryWriter::describe() {
    State& state = live_part(state_, "TrajectoryWriter");
    meet(state.run().ranks(), "TrajectoryWriter::describe");
    state.trajectory.describe();
}

struct FrameReader::State {
    std::string path;
    FrameFile file;
};

FrameReader::FrameReader(const Session& session, const std::string& path) {
    const Communicator& ranks = ranks_of(session);
    meet(ranks, "FrameReader", hash_of_argument(path));
    check_damage(path, ranks);
    std::string failure;
    try {
        state_.reset(new State{path, FrameFile(path)});
        if (state_->file.summary().kind == FileKind::collisions)
            failure = path + ": is a log of collisions; it has no frames";
    } catch (const InputError& error) {
        failure = error.what();
    }
    agree(ranks, failure.empty(), failure, ExitCode::bad_input);
}

FrameReader::FrameReader(FrameReader&&) noexcept = default;
FrameReader::~FrameReader() = default;

const std::vector<std::int64_t>& FrameReader::steps() const {
    return live_part(state_, "FrameReader").file.summary().steps;
}
std::uint64_t FrameReader::n_discs() const {
    return live_part(state_, "FrameReader").file.summary().n_rows;
}
Box FrameReader::box() const {
    const FileSummary& summary = live_part(state_, "FrameReader").file.summary();
    Box largest = summary.box;
    for (const Box& box : summary.boxes)
        largest = {std::max(largest.x, box.x), std::max(largest.y, box.y)};
    return largest;
}
std::string FrameReader::state_hash() const {
    return live_part(state_, "FrameReader").file.summary().state_hash;
}

std::vector<Disc> FrameReader::read(std::size_t frame) const { return read(frame, 0, n_discs()); }

std::vector<Disc> FrameReader::read(std::size_t frame, std::uint64_t begin,
                                    std::uint64_t end) const {
    if (frame >= steps().size() || begin > end || end > n_discs())
        throw InputError({{live_part(state_, "FrameReader").path, 0,
                           fmt::format("has {} frames of {} discs; it has no discs {} to {} of "
                                       "frame {}",
                                       steps().size(), n_discs(), begin, end, frame)}});
    Rows rows;
    live_part(state_, "FrameReader").file.read_shown(frame, begin, end, rows);
    std::vector<Disc> discs(end - begin);
    const auto take = [&](std::string_view column, auto field) {
        const std::size_t place = live_part(state_, "FrameReader").file.summary().place_of(column);
        for (std::size_t i = 0; place < rows.size() && i < discs.size(); ++i)
            discs[i].*
                field = static_cast<std::remove_cvref_t<decltype(discs[i].*field)>>(rows[place][i]);
    };
    for (std::size_t i = 0; i < discs.size(); ++i) discs[i].id = begin + i;
    take("x", &Disc::x);
    take("y", &Disc::y);
    take("vx", &Disc::vx);
    take("vy", &Disc::vy);
    take(info_of(SideColumn::spin).shown, &Disc::spin);
    take("wall_collisions", &Disc::wall_collisions);
    take("pair_collisions", &Disc::pair_collisions);
    return discs;
}

} // namespace carrom
