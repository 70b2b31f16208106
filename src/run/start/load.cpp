// SPDX-License-Identifier: BSD-3-Clause
#include "run/start/load.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "initial_state/closed_regions.hpp"
#include "machine/machine.hpp"
#include "parallel/agreement.hpp"
#include "run/files/outputs.hpp"
#include "run/memory_check.hpp"
#include "scene/effects/effect.hpp"
#include "scene/limits.hpp"
#include "simulation/first_discs.hpp"

namespace carrom {

namespace {

/// Warns of speeds that suggest wrong units. Scenes of the course program get no warning, because
/// such speeds are normal there. **Collective.**
void warn_of_units(const RunOptions& options, const SceneParameters& scene,
                   const std::vector<InputDisc>& discs, const Communicator& ranks) {
    if (scene.lines_before_discs > 0) return;
    double fastest = 0;
    for (const InputDisc& disc : discs) fastest = std::max(fastest, std::hypot(disc.vx, disc.vy));
    double later = std::max(largest_wall_speed(scene.effects), usual_speed_of_effects(scene));
    for (const Boundary& side : scene.effects.boundaries)
        later = std::max({later, std::fabs(side.speed), std::sqrt(side.temperature)});
    const std::string warning = units_warning(ranks.max(fastest), later, scene);
    if (!warning.empty()) options.messages.warn("{}: warning: {}\n", scene.name, warning);
}

/// Warns of closed regions in which a generator may have put discs unnoticed. Listed discs are
/// where their author wants them, so they give no warning. **Collective.**
void warn_of_closed_regions(const RunOptions& options, const SceneParameters& scene,
                            const std::vector<InputDisc>& discs, const Communicator& ranks) {
    if (scene.generator == Generator::file) return;
    const ShutInDiscs found = find_shut_in(scene, discs, ranks);
    if (found.n_discs == 0) return;
    options.messages.warn("{}: warning: {} of {} discs begin in {} region{} that effects.obstacles "
                          "shut off from the largest one, and cannot leave; leave a gap, or list "
                          "the discs (discs.list, discs.file)\n",
                          scene.name, found.n_discs, scene.n_discs, found.n_regions,
                          found.n_regions == 1 ? "" : "s");
}

/// Reads the checkpoint of the plan, if there is one. **Collective.**
void go_on(const StartPlan& plan, Loaded& loaded, const Communicator& ranks) {
    std::optional<RunStart> start = read_restart(plan.restart, plan.options, loaded.scene, ranks);
    if (start) loaded.start = std::move(*start);
}

/// Claims the outputs. Reads the checkpoint again if a newer one was written before the lock was
/// taken. **Collective.**
void claim(StartPlan& plan, Loaded& loaded, const Communicator& ranks) {
    const RunOptions& options = plan.options;
    try {
        if (!loaded.start.stored) check_memory(loaded.scene, ranks);
        loaded.locks = claim_outputs(options, loaded.scene, files_read_for(options, loaded.scene),
                                     outputs_named_by(options), ranks);
        // A killed run may have stored a newer checkpoint between the first reading and the lock.
        if (has_other_checkpoints(plan.restart, ranks)) {
            options.messages.note("another checkpoint has come meanwhile\n");
            loaded.start.stored.reset(); // frees the memory of the old state for the new one
            go_on(plan, loaded, ranks);
        }
        if (plan.restart.goes_on() && !loaded.start.stored)
            begin_anew(plan.restart, options, loaded.scene, ranks);
    } catch (const InputError& error) { // thrown on every rank
        std::vector<Problem> all;
        if (ranks.is_root()) all = error.problems();
        if (ranks.is_root() && !loaded.start.stored)
            append(all, disc_line_problems_of(loaded.scene, plan.source.stream.get()));
        agree_on_problems(ranks, all);
    }
}

/// Reads or generates the initial discs unless the run continues, and warns of likely mistakes.
/// **Collective.**
void make_discs(const StartPlan& plan, Loaded& loaded, const Communicator& ranks) {
    const RunOptions& options = plan.options;
    SceneParameters& scene = loaded.scene;
    Tuning tuning = options.tuning;
    tuning.threads = options.threads.value_or(default_threads(ranks));
    check_threads(tuning.threads, ranks);
    const std::string crowded = warning_of_crowded_threads(tuning.threads, scene.n_discs, ranks);
    if (!crowded.empty()) options.messages.warn("warning: {}\n", crowded);
    if (!loaded.start.stored)
        loaded.start.discs = first_discs_and_frozen(scene, plan.source.stream.get(), ranks, tuning);
    if (!loaded.start.stored && !scene.frozen.empty())
        options.messages.note("{} discs are frozen; {} move\n", scene.frozen.size(), scene.n_discs);
    warn_of_units(options, scene, loaded.start.discs, ranks);
    if (!loaded.start.stored) warn_of_closed_regions(options, scene, loaded.start.discs, ranks);
    for (const std::string& warning : scene.warnings)
        options.messages.warn("{}: warning: {}\n", scene.name, warning);
}

} // namespace

Loaded carry_out(StartPlan plan, const Communicator& ranks) {
    Loaded loaded;
    loaded.scene = std::move(plan.scene);
    go_on(plan, loaded, ranks);
    if (plan.restart.goes_on()) {
        std::vector<Problem> missing; // a run that continues and writes files needs a folder
        check_folder(loaded.scene, missing);
        if (!missing.empty()) throw InputError(missing);
    }
    claim(plan, loaded, ranks);
    make_discs(plan, loaded, ranks);
    return loaded;
}

} // namespace carrom
