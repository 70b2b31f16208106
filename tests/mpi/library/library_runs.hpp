// SPDX-License-Identifier: BSD-3-Clause
// Scenes and sums that the tests of the library share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <carrom/carrom.hpp>

namespace carrom::test {

/// 300 discs that collide some times with each other and with walls.
inline Scene gas(const char* method, std::int64_t steps) {
    Scene scene;
    scene.set("box.size", 60).set("discs.count", 300).set("discs.radius", 0.75);
    scene.set("discs.speed", 0.5).set("discs.seed", 91);
    return scene.set("time.method", method).set("time.steps", steps);
}

inline std::string hash_of(const Simulation& simulation) {
    return to_string(simulation.totals().hash);
}

/// Sums over discs, written without the library.
struct Sums {
    double energy = 0, momentum_x = 0, momentum_y = 0;
    std::uint64_t wall_collisions = 0, pair_collisions = 0;
};
inline Sums sums_of(const std::vector<Disc>& discs) {
    Sums sums;
    for (const Disc& disc : discs) {
        sums.energy += 0.5 * (disc.vx * disc.vx + disc.vy * disc.vy);
        sums.momentum_x += disc.vx;
        sums.momentum_y += disc.vy;
        sums.wall_collisions += disc.wall_collisions;
        sums.pair_collisions += disc.pair_collisions;
    }
    return sums;
}

/// The texts of an InputError's problems, with their places; empty if `act` throws none.
template <class Act> std::string problems_of(const Act& act) {
    try {
        act();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

/// The code of the CollectiveError that `act` throws; `success` if it throws none.
template <class Act> ExitCode code_of(const Act& act) {
    try {
        act();
    } catch (const CollectiveError& error) {
        return error.code();
    }
    return ExitCode::success;
}

} // namespace carrom::test
