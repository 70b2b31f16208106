// SPDX-License-Identifier: BSD-3-Clause
// The description of the system of discs in a file, which is valid for all frames of the file.
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
    std::vector<Species> species; ///< empty if all discs have that radius and mass 1
    bool is_periodic_x = false, is_periodic_y = false;
    /// Whether the left, right, bottom and top sides are open; discs may then be outside of them
    std::array<bool, 4> open_boundaries{};
    /// Amplitudes of swinging walls: discs may be outside of the box by at most these distances
    std::array<double, 4> amplitudes{};
    /// The origin of users' coordinates. It and positions in files are relative to the box's lower
    /// left corner.
    std::array<double, 2> origin{};
    /// Units, such as "nm" and "ps"; empty if the scene names no units
    std::string length_unit, time_unit;
};

} // namespace carrom
