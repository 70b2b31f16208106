// SPDX-License-Identifier: BSD-3-Clause
#include "run/failure_scene.hpp"

#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>

#include "run/files/destinations.hpp"
#include "run/files/report_file.hpp"
#include "scene/limits.hpp"
#include "scene/scene_text.hpp"

namespace carrom {

namespace {

/// The factor by which radii had grown when the failed step began.
double size_before(const SceneParameters& scene, const CheckFailure& failure) {
    return scene.effects.size_at(static_cast<double>(failure.step - 1));
}

/// Text of a scene of one step that begins with the surrounding discs, which `discs_file` lists.
std::string text_around(const SceneParameters& scene, const CheckFailure& failure,
                        const std::string& discs_file) {
    std::string text = fmt::format("# {}\n# Discs as they were at step {}; their ids in {}:",
                                   failure.what(), failure.step - 1, scene.name);
    for (std::size_t i = 0; i < failure.discs_around.size(); ++i)
        text += fmt::format(" {} was {};", i, failure.discs_around[i].id);
    text.back() = '.';
    if (!scene.effects.contact.pairs.empty())
        text += "\n# All pairs have the common numbers of contacts here; see effects.contact.pairs "
                "there.";
    if (has_boundary(scene.effects, BoundaryKind::moving))
        text += "\n# Moving walls begin at the box's sides here; they have moved there.";
    SceneParameters around = scene;
    if (scene.origin.is_on())
        text +=
            "\n# Places count from the lower left corner of the box here, which keeps all bits.";
    around.origin = {};
    constexpr double turn = 2 * std::numbers::pi;
    for (Boundary& side : around.effects.boundaries)
        if (side.amplitude != 0)
            side.phase = turn *
                         std::remainder(side.phase / turn +
                                            static_cast<double>(failure.step - 1) / side.period,
                                        1);
    around.n_discs = failure.discs_around.size();
    around.generator = Generator::file;
    around.draws_velocities = false;
    around.velocities = VelocityKind::maxwell;
    around.discs_file = discs_file;
    around.listed_discs.clear();
    around.disc_columns.clear();
    if (!scene.effects.species.empty())
        around.disc_columns = {DiscColumn::radius, DiscColumn::mass};
    around.effects.contact.pairs.clear();
    around.first_numbers = {};
    around.effects.swap = {}; // other discs would exchange their radii
    around.groups.clear();
    around.freeze.clear(); // the frozen discs are obstacles already
    around.frozen.clear();
    if (!failure.spins.empty()) around.disc_columns.push_back(disc_column_of(SideColumn::spin));
    around.steps = 1;
    const double grown = size_before(scene, failure);
    around.radius *= grown;
    around.effects.growth /= grown;
    around.text_output = TextOutput::none;
    around.checkpoint.reset();
    around.trajectory.reset();
    around.collisions.reset();
    around.measurements.reset();
    return text + '\n' + scene_text(around);
}

std::string disc_lines(const SceneParameters& scene, const CheckFailure& failure) {
    const SpeciesTable species_table(scene.effects.species, scene.radius);
    const std::vector<InputDisc>& discs = failure.discs_around;
    std::string text;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        text += fmt::format("{} {} {} {} {}", i, discs[i].x, discs[i].y, discs[i].vx, discs[i].vy);
        if (const SizeAndMass& body = species_table.of(discs[i].id); !scene.effects.species.empty())
            text += fmt::format(" {} {}",
                                (failure.radii.empty() ? body.radius : failure.radii[i]) *
                                    size_before(scene, failure),
                                body.mass);
        text += failure.spins.empty() ? "\n" : fmt::format(" {}\n", failure.spins[i]);
    }
    return text;
}

} // namespace

std::string write_failure_scene(const std::string& folder, const SceneParameters& scene,
                                const CheckFailure& failure) {
    if (failure.discs_around.empty()) return "there are no discs around it to show";
    const std::string name = fmt::format("check_step_{}_disc_{}", failure.step, failure.disc);
    const std::filesystem::path place = folder;
    const std::string scene_path = (place / (name + ".toml")).string(),
                      discs_path = (place / (name + ".discs")).string();
    std::string write_error;
    for (const Problem& problem :
         problems_with({{"the scene", scene_path, Output::scene},
                        {"the list of its discs", discs_path, Output::scene}},
                       {{"the scene that ran", scene.name}}))
        if (write_error.empty()) write_error = problem.place + ' ' + problem.text;
    if (write_error.empty()) write_error = write_whole_file(discs_path, disc_lines(scene, failure));
    if (write_error.empty())
        write_error = write_whole_file(scene_path, text_around(scene, failure, name + ".discs"));
    if (!write_error.empty()) return "the discs around it could not be written: " + write_error;
    return fmt::format("{} discs around it, from the step before, are in {}",
                       failure.discs_around.size(), scene_path);
}

CollectiveError reported(const CheckFailure& failure, const SceneParameters& scene,
                         const Communicator& ranks) {
    std::string sentence;
    if (ranks.is_root()) sentence = write_failure_scene("", scene, failure);
    ranks.broadcast(sentence);
    return CollectiveError(fmt::format("{}\n{}", failure.what(), sentence), failure.code());
}

} // namespace carrom
