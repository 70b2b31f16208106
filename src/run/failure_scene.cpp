// SPDX-License-Identifier: BSD-3-Clause
#include "run/failure_scene.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "run/files/destinations.hpp"
#include "run/files/report_file.hpp"
#include "scene/disc_columns.hpp"
#include "scene/limits.hpp"
#include "scene/scene_text.hpp"

namespace carrom {

namespace {

/// The factor by which radii had grown when the failed step began.
double size_before(const SceneParameters& scene, const CheckFailure& failure) {
    return scene.effects.size_at(static_cast<double>(failure.step - 1));
}

/// The row of `discs.species` to which a disc belongs, counted from 0; 0 if there are no rows.
std::size_t row_of(const SceneParameters& scene, DiscId id) {
    for (const SpeciesRow& row : scene.effects.contact.rows)
        if (id < row.end) return row.row;
    return 0;
}

/// Each disc becomes a row of `discs.species`, because discs that shared a row may differ by now.
void set_species(SceneParameters& around, const SceneParameters& scene,
                 const CheckFailure& failure) {
    const SpeciesTable table(scene.effects.species, scene.radius);
    std::vector<double> old_rows; // former rows of the discs, counted from 1
    ContactEffect& contact = around.effects.contact;
    std::vector<double>& strengths = around.effects.field.strengths;
    contact.rows.clear();
    strengths.clear();
    for (std::size_t i = 0; i < failure.discs_around.size(); ++i) {
        const DiscId id = failure.discs_around[i].id;
        const SizeAndMass& body = table.of(id);
        const double radius = failure.radii.empty() ? body.radius : failure.radii[i];
        const std::size_t n_species = around.effects.species.size();
        add_species(around.effects.species, {1, radius * size_before(scene, failure), body.mass});
        if (!scene.effects.field.strengths.empty() && around.effects.species.size() > n_species)
            strengths.push_back(scene.effects.field.strength_of(id));
        contact.rows.push_back({i + 1, i});
        old_rows.push_back(static_cast<double>(row_of(scene, id) + 1));
    }
    contact.pairs.clear();
    const auto number = [](std::size_t i) { return static_cast<double>(i + 1); };
    for (const ContactPair& pair : scene.effects.contact.pairs)
        for (std::size_t i = 0; i < old_rows.size(); ++i)
            for (std::size_t j = i + 1; j < old_rows.size(); ++j)
                if (std::minmax(old_rows[i], old_rows[j]) == std::minmax(pair.first, pair.second)) {
                    contact.pairs.push_back(pair);
                    contact.pairs.back().first = number(i);
                    contact.pairs.back().second = number(j);
                }
    for (std::vector<SurfaceContact>& rows : around.effects.surface_contacts.rows) {
        const std::vector<SurfaceContact> all = std::exchange(rows, {});
        for (const SurfaceContact& row : all)
            for (std::size_t i = 0; i < old_rows.size(); ++i)
                if (old_rows[i] == row.species) {
                    rows.push_back(row);
                    rows.back().species = number(i);
                }
    }
}

/// The text of a scene that runs one step from the surrounding discs, which `discs_file` lists.
std::string text_around(const SceneParameters& scene, const CheckFailure& failure,
                        const std::string& discs_file) {
    std::string text = fmt::format("# {}\n# Discs as they were at step {}; their ids in {}:",
                                   failure.what(), failure.step - 1, scene.name);
    for (std::size_t i = 0; i < failure.discs_around.size(); ++i)
        text += fmt::format(" {} was {};", i, failure.discs_around[i].id);
    text.back() = '.';
    if (has_boundary(scene.effects, BoundaryKind::moving))
        text += "\n# Moving walls begin at the box's sides here; they have moved there.";
    SceneParameters around = scene;
    if (scene.origin.is_on())
        text +=
            "\n# Places count from the lower left corner of the box here, which keeps all bits.";
    around.origin = {};
    constexpr double turn = 2 * std::numbers::pi;
    for (Boundary& side : around.effects.boundaries) side.inlet = {}; // no discs enter
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
    around.sizes.reset();
    around.regions.clear();
    around.effects.species.clear();
    around.first_numbers = {};
    if (!scene.effects.species.empty()) set_species(around, scene, failure);
    around.effects.swap = {}; // otherwise discs would exchange their radii
    around.groups.clear();
    around.freeze.clear(); // because the frozen discs are already among the fixed bodies
    around.frozen.clear();
    if (!failure.spins.empty()) around.disc_columns.push_back(disc_column_of(SideColumn::spin));
    around.steps = 1;
    const double grown = size_before(scene, failure);
    around.radius *= grown;
    around.effects.begin_at(grown);
    around.text_output = TextOutput::none;
    around.checkpoint.reset();
    around.trajectory.reset();
    around.collisions.reset();
    around.measurements.reset();
    return text + '\n' + scene_text(around);
}

std::string disc_lines(const CheckFailure& failure) {
    const std::vector<InputDisc>& discs = failure.discs_around;
    std::string text;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        text += fmt::format("{} {} {} {} {}", i, discs[i].x, discs[i].y, discs[i].vx, discs[i].vy);
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
    if (write_error.empty()) write_error = write_whole_file(discs_path, disc_lines(failure));
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
