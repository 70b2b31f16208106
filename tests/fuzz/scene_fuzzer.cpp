// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer on both readers of scenes. The first byte chooses: TOML, or the legacy text format.
//
// Every text must give a valid scene, or an InputError that names a problem. A crash, a hang, any
// other exception and every finding of the sanitizers is a bug. docs/understanding/hard-cases.md
// has the commands.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/errors.hpp"
#include "measure/measurement.hpp"
#include "scene/read_scene.hpp"

namespace {

void demand(bool claim) {
    if (!claim) std::abort();
}

void check(const carrom::SceneParameters& scene) {
    // declares the quantities to the readers of scenes
    demand(!carrom::measured_quantities().empty());
    demand(scene.n_discs > 0 && scene.steps >= 0 && scene.micro_steps > 0 && scene.sync_every > 0);
    demand(std::isfinite(scene.box.x) && scene.radius > 0 && scene.box.x >= 2 * scene.radius);
    for (const carrom::InputDisc& disc : scene.listed_discs) {
        demand(disc.id < scene.n_discs && std::isfinite(disc.vx) && std::isfinite(disc.vy));
        demand(disc.x > 0 && disc.x < scene.box.x && disc.y > 0 && disc.y < scene.box.x);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    try {
        check(carrom::read_scene(text, data[0] % 2 == 0 ? "scene.toml" : "scene.in"));
    } catch (const carrom::InputError& error) {
        demand(!error.problems().empty());
    }
    return 0;
}
