// SPDX-License-Identifier: BSD-3-Clause
// Converts Python's arguments to scenes, checkpoints, communicators and changed arrays.
#include "parts.hpp"

#include <utility>

namespace carrom::python {

namespace {

/// The session of all MPI ranks, if this process has made one; end_session releases it.
std::shared_ptr<Session> of_process;

Options options_of(int threads, const std::shared_ptr<std::vector<std::string>>& lines) {
    return {.threads = threads,
            .messages = [lines](const std::string& line) { lines->push_back(line); },
            .counts_images = true};
}

void check_rows(std::size_t rows, std::uint64_t wanted, const char* what) {
    if (rows != wanted)
        throw InputError({{what, 0,
                           "has " + std::to_string(rows) + " rows; there are " +
                               std::to_string(wanted) + " discs"}});
}

} // namespace

std::shared_ptr<Session> session_of(std::optional<int> communicator) {
    if (communicator) return std::make_shared<Session>(*communicator);
    if (!of_process) of_process = std::make_shared<Session>();
    return of_process;
}

void end_session(bool is_forked) {
    if (is_forked) static_cast<void>(new std::shared_ptr<Session>(std::move(of_process)));
    of_process.reset();
}

Core new_core(const std::string& text, bool is_file, const std::vector<std::string>& settings,
              int threads, std::optional<int> communicator) {
    const nb::gil_scoped_release others_run;
    std::shared_ptr<Session> session = session_of(communicator);
    auto lines = std::make_shared<std::vector<std::string>>();
    Scene scene = is_file ? Scene::from_file(*session, text) : Scene::from_text(text);
    for (const std::string& setting : settings) {
        const std::size_t end = setting.find('=');
        scene.set(setting.substr(0, end), setting.substr(end + 1));
    }
    Simulation simulation(*session, scene, options_of(threads, lines));
    return {std::move(session), lines, std::move(simulation)};
}

Core core_from_checkpoint(const std::string& path, const std::vector<std::string>& settings,
                          int threads, std::optional<int> communicator) {
    const nb::gil_scoped_release others_run;
    std::shared_ptr<Session> session = session_of(communicator);
    auto lines = std::make_shared<std::vector<std::string>>();
    Simulation simulation = Simulation::from_checkpoint(*session, path, settings,
                                                        options_of(threads, lines));
    return {std::move(session), lines, std::move(simulation)};
}

void agree_on(const Core& core, const std::vector<std::string>& problems) {
    const nb::gil_scoped_release others_run;
    std::vector<Problem> mine;
    for (const std::string& text : problems)
        mine.push_back({"rank " + std::to_string(core.session->rank()), 0, text});
    core.session->agree_on(mine);
}

void change(Core& core, std::optional<GivenPairs> positions, std::optional<GivenPairs> velocities,
            std::optional<GivenNumbers> spins) {
    const std::uint64_t n = core.simulation.scene().n_discs;
    if (positions) check_rows(positions->shape(0), n, "positions");
    if (velocities) check_rows(velocities->shape(0), n, "velocities");
    if (spins) check_rows(spins->shape(0), n, "spins");
    const nb::gil_scoped_release others_run;
    std::vector<Disc> discs = core.simulation.discs();
    for (Disc& disc : discs) {
        if (positions) {
            disc.x = positions->data()[2 * disc.id];
            disc.y = positions->data()[2 * disc.id + 1];
        }
        if (velocities) {
            disc.vx = velocities->data()[2 * disc.id];
            disc.vy = velocities->data()[2 * disc.id + 1];
        }
        if (spins) disc.spin = spins->data()[disc.id];
    }
    core.simulation.change_discs(discs);
}

} // namespace carrom::python
