// SPDX-License-Identifier: BSD-3-Clause
#include "measure/measurement.hpp"
#include "measure/speeds.hpp"

#include <algorithm>
#include <cmath>

#include "engine/state_sums.hpp"

namespace carrom {

bool is_name_of_table(std::string_view name) {
    if (const std::size_t line = name.rfind('_');
        line + 1 < name.size() &&
        name.find_first_not_of("0123456789", line + 1) == std::string_view::npos)
        name = name.substr(0, line);
    for (const MeasuredQuantity& one : measured_quantities())
        if (name == one.declared.name ||
            std::ranges::find(one.other_tables, name) != one.other_tables.end())
            return true;
    return false;
}

void count(std::vector<std::uint64_t>& counts, double place) {
    if (place >= 0 && place < static_cast<double>(counts.size()))
        ++counts[static_cast<std::size_t>(place)];
}

void add_over(const Communicator& ranks, std::vector<std::uint64_t>&& mine,
              std::vector<std::uint64_t>& sums) {
    ranks.sum(std::span(mine));
    for (std::size_t k = 0; k < mine.size(); ++k) sums[k] += mine[k];
}

namespace {

/// The root mean square of a velocity component of the lightest discs, at the temperature of the
/// discs or of the hottest thermal wall, whichever is higher; 0 if both are 0.
double thermal_speed(const SceneParameters& scene, const Totals& totals) {
    double temperature = totals.kinetic_energy / static_cast<double>(totals.n_discs);
    for (const Boundary& side : scene.effects.boundaries)
        temperature = std::max(temperature, side.temperature);
    double lightest = 1;
    for (const Species& each : scene.effects.species) lightest = std::min(lightest, each.mass);
    return std::sqrt(temperature / lightest);
}

} // namespace

double driven_speed(const SceneParameters& scene) {
    double speed = std::sqrt(
        2 * (scene.effects.acceleration().largest_x() + scene.effects.acceleration().largest_y()) *
        scene.box.longest());
    for (const Boundary& side : scene.effects.boundaries)
        speed = std::max(speed, std::fabs(side.speed));
    speed = std::max(speed, 2 * largest_wall_speed(scene.effects));
    return speed;
}

double usual_speed(const MeasuredRun& run) {
    const double thermal = thermal_speed(run.scene, run.system.energies()),
                 driven = driven_speed(run.scene);
    return thermal > 0 ? thermal : driven > 0 ? driven : 1;
}

VelocityChange change_until_half_way(const MeasuredRun& run) {
    const Effects& effects = run.scene.effects;
    if (effects.lasting_speed == 0) return {};
    const double micro_steps = 0.5 * static_cast<double>(run.scene.sync_every) - run.system.clock(),
                 steps = micro_steps / static_cast<double>(run.scene.micro_steps);
    return {effects.acceleration().x * steps, effects.acceleration().y * steps};
}

} // namespace carrom
