// SPDX-License-Identifier: BSD-3-Clause
// What each effect of a scene costs. Laws are compiled into the kernels, where nothing of an effect
// could be timed without slowing it down. So a sample of the scene is run with that effect alone,
// and without any, in turns.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace carrom {

struct EffectCost {
    std::string name;
    std::optional<double> time_ratio; ///< of the scene with this effect alone to the scene without;
                                      ///< nothing where a sample would take too long
    double time_share =
        0; ///< of the time of stepping, what this effect has made it longer by; 0 to 1
    double bytes_per_disc = 0; ///< of memory and of checkpoints, beyond a plain disc's
};

/// What is known of the run that effects are measured for.
struct CostsOfRun {
    std::uint64_t n_discs = 0;           ///< in the box
    double kinetic_energy = 0;           ///< of all discs, as in Totals
    double seconds_per_disc_step = 1e-6; ///< of processor time
    double budget = 0.1; ///< seconds that all samples together may take, more or less
};

/// Each effect of the scene by itself. A sample is a part of the box with as many of its discs as
/// the budget allows (500 to 16,000, or all there are), as dense and as fast as the scene's: on a
/// lattice, those of several sizes at random up to a packing of 0.4 and against as many equal ones;
/// obstacles are those of a typical part of the box. What single sides cost is told for the whole
/// box, whose sides are longer. A sample that is not done in several times its share of the budget
/// has no ratio. One thread, not collective. Times depend on the machine.
std::vector<EffectCost> effect_costs(const Scene& scene, const CostsOfRun& run);

} // namespace carrom
