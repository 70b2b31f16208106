// SPDX-License-Identifier: BSD-3-Clause
// Species: mass and, before growth, radius of each disc. During a run only swaps change them.
//
// Species are in order of id, so a disc's species follows from its id and takes no memory in
// arrays, messages and checkpoints. If there are few species, a disc's species is found by
// comparing ids. If there are many, each rank has a table with an entry for every disc of the
// scene: the number of its species (2 bytes) for up to 65,536 species, otherwise its radius and
// mass (16 bytes).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/device.hpp"
#include "core/disc_state.hpp"

namespace carrom {

/// A group of equal discs. Their ids follow the ids of the preceding species.
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

/// Finds radius and mass in a table that another object owns; plain data.
class SpeciesView {
public:
    struct Range {
        DiscId end = std::numeric_limits<DiscId>::max();
        SizeAndMass values;
    };

    /// `sizes` is null if there are few species; `species_of_id` is null if `sizes` has an entry
    /// for each disc.
    SpeciesView(const Range* ranges, const SizeAndMass* sizes, const std::uint16_t* species_of_id)
        : ranges_(ranges), sizes_(sizes), species_of_id_(species_of_id) {}

    CARROM_DEVICE const SizeAndMass& of(DiscId id) const {
        if (sizes_) return sizes_[species_of_id_ ? species_of_id_[id] : id];
        const Range* range = ranges_;
        while (id >= range->end) ++range;
        return range->values;
    }

private:
    const Range* ranges_;
    const SizeAndMass* sizes_;
    const std::uint16_t* species_of_id_;
};

/// Owns the table; copies share its memory. A run makes one table for its dynamics, and other code
/// gets a copy from Engine::species_table.
class SpeciesTable {
public:
    /// Without species all discs have this radius and mass 1. If `radii_change`, each disc has an
    /// entry of its own.
    SpeciesTable(std::span<const Species> species, double radius, bool radii_change = false);

    /// Sets the radius in all copies of the table. Only for a table whose radii change; no other
    /// thread may read the table meanwhile.
    void set_radius(DiscId id, double radius) { table_->sizes[id].radius = radius; }

    const SizeAndMass& of(DiscId id) const { return view_.of(id); }
    SpeciesView view() const { return view_; }
    /// A view of copies of the table's parts. `copy(numbers, n)` copies one part to memory that
    /// must outlive the view, and returns its address.
    template <class Copy> SpeciesView copied_by(const Copy& copy) const {
        const SpeciesView::Range* ranges = copy(table_->ranges.data(), table_->ranges.size());
        if (table_->sizes.empty()) return {ranges, nullptr, nullptr};
        const SizeAndMass* sizes = copy(table_->sizes.data(), table_->sizes.size());
        if (table_->species_of_id.empty()) return {ranges, sizes, nullptr};
        return {ranges, sizes, copy(table_->species_of_id.data(), table_->species_of_id.size())};
    }

private:
    struct Table {
        std::vector<SpeciesView::Range> ranges;
        /// Radius and mass of each species or of each disc; may be empty
        std::vector<SizeAndMass> sizes;
        std::vector<std::uint16_t> species_of_id; ///< empty if `sizes` has an entry for each disc

        void spread(std::span<const Species> species, DiscId n_discs, bool radii_change);
    };

    static std::shared_ptr<Table> table_of(std::span<const Species> species, double radius,
                                           bool radii_change);
    static SpeciesView view_of(const Table& table);

    std::shared_ptr<Table> table_;
    SpeciesView view_;
};

} // namespace carrom
