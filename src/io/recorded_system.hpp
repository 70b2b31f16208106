// SPDX-License-Identifier: BSD-3-Clause
// What a file tells other programs about the discs of all its frames.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <carrom/box.hpp>

#include "dynamics/species.hpp"

namespace carrom {

struct RecordedSystem {
    std::string program_version;
    std::uint64_t n_discs = 0;
    Box box;
    double radius = 0;            ///< the largest radius
    std::vector<Species> species; ///< empty where all discs have that radius and mass 1
    bool is_periodic_x = false, is_periodic_y = false;
    std::array<bool, 4> open_boundaries{}; ///< left, right, bottom, top: discs may be beyond these
    std::array<double, 4> amplitudes{};    ///< of walls that swing: discs may be so far beyond
    /// The point of the box that is (0, 0) for users. Positions in files count from its corner.
    std::array<double, 2> origin{};
    std::string length_unit, time_unit; ///< "nm", "ps"; empty if the scene names none
};

} // namespace carrom
