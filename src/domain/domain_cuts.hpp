// SPDX-License-Identifier: BSD-3-Clause
// Cuts of a box into the domains of ranks: equal areas at first, equal weights later.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/axis.hpp"
#include "domain/domains.hpp"

namespace carrom {

/// Domains of equal area, `group_sizes[k]` of them in strip k.
Domains equal_domains(const Box& box, Axis axis, const std::vector<int>& group_sizes);

/// Weights of equal bins of [0, length].
class WeightBins {
public:
    /// How many bins are enough for so many parts of equal weight.
    static std::size_t n_for(int n_parts);
    /// `weights` outlive this.
    WeightBins(double length, std::span<std::uint64_t> weights)
        : length_(length), weights_(weights) {}

    void add(double place, std::uint64_t weight);
    /// The cuts between as many parts as there are sizes, of weights by their sizes.
    std::vector<double> cuts(const std::vector<int>& part_sizes) const;

private:
    double length_;
    std::span<std::uint64_t> weights_;
};

} // namespace carrom
