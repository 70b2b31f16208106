// SPDX-License-Identifier: BSD-3-Clause
// What each disc is: its radius and its mass, which a run never changes.
//
// Classes come in the order of ids, so a disc's class follows from its id: no array, no byte in
// messages and checkpoints. A few classes are found by as many comparisons; many are spread into a
// table by id, 16 bytes a disc on every rank.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/disc.hpp"

namespace carrom {

/// So many discs of a kind, their ids following those of the class before.
struct Species {
    std::uint64_t count = 0;
    double radius = 0;
    double mass = 1;

    friend bool operator==(const Species&, const Species&) = default;
};

struct Body {
    double radius = 0;
    double mass = 1;
};

/// Copies share what they hold.
class SpeciesTable {
public:
    /// `classes`, or where there are none all discs of one radius and mass 1.
    SpeciesTable(std::span<const Species> species, double radius);

    const Body& of(DiscId id) const {
        if (by_id_) return by_id_[id];
        const Range* range = ranges_;
        while (id >= range->end) ++range;
        return range->body;
    }

private:
    struct Range {
        DiscId end = std::numeric_limits<DiscId>::max();
        Body body;
    };
    struct Table {
        std::vector<Range> ranges;
        std::vector<Body> by_id; ///< empty where ranges are few
    };

    std::shared_ptr<const Table> table_;
    const Range* ranges_ = nullptr;
    const Body* by_id_ = nullptr;
};

} // namespace carrom
