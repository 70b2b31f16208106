// SPDX-License-Identifier: BSD-3-Clause
// The hexatic order of one disc.
#pragma once

namespace carrom {

/// psi6 of one disc: the mean of exp(6 i angle) over its neighbours, each with the same weight.
struct BondOrder {
    double real = 0, imaginary = 0;
    /// Number of neighbours; -1 if the disc's centre is not in the box, so that it has no cell
    int n_neighbours = -1;

    bool has_cell() const { return n_neighbours >= 0; }
};

} // namespace carrom
