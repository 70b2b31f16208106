// SPDX-License-Identifier: BSD-3-Clause
// Species: the radius and the mass of each disc, which a run never changes.
//
// Species come in the order of ids, so a disc's species follows from its id: no array,
// no byte in messages and checkpoints. Few species are found by comparisons; many are
// spread into a table by id, 16 bytes a disc on every rank.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/disc.hpp"

namespace carrom {

/// A number of equal discs. Their ids follow those of the species before.
struct Species {
    std::uint64_t count = 0;
    double radius = 0;
    double mass = 1;

    friend bool operator==(const Species&, const Species&) = default;
};

struct SizeAndMass {
    double radius = 0;
    double mass = 1;
};

/// Copies share their tables.
class SpeciesTable {
public:
    /// Without species all discs have this radius and mass 1.
    SpeciesTable(std::span<const Species> species, double radius);

    const SizeAndMass& of(DiscId id) const {
        if (by_id_) return by_id_[id];
        const Range* range = ranges_;
        while (id >= range->end) ++range;
        return range->values;
    }

private:
    struct Range {
        DiscId end = std::numeric_limits<DiscId>::max();
        SizeAndMass values;
    };
    struct Table {
        std::vector<Range> ranges;
        std::vector<SizeAndMass> by_id; ///< empty if there are few ranges
    };

    std::shared_ptr<const Table> table_;
    const Range* ranges_ = nullptr;
    const SizeAndMass* by_id_ = nullptr;
};

} // namespace carrom
