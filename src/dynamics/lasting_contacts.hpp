// SPDX-License-Identifier: BSD-3-Clause
// Finds the pairs of discs, and the discs at walls and fixed bodies, that are so close at a sync
// that they may press on each other before the next sync. The cells that are searched are as wide
// as the largest distance between the centres of such a pair.
//
// A contact that is left out costs time but causes no error, because its discs collide instead.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/pair_table.hpp"
#include "dynamics/surface_table.hpp"

namespace carrom {

/// The state of a disc at a sync, of which all ranks have a copy.
struct HeapDisc {
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;
    double spin = 0;

    friend bool operator==(const HeapDisc&, const HeapDisc&) = default;
};

/// A contact of disc `a` with disc `b`, or with a wall or a fixed body if `b` is `fixed_body`.
/// The normal (nx, ny) points from a to b, and the tangent is (-ny, nx).
struct LastingContact {
    static constexpr std::uint32_t fixed_body = 0xffffffff;

    std::uint32_t a = 0, b = fixed_body; ///< indices in the list of discs
    /// For a wall the number of its side; for a fixed body 4 plus its index in the list of fixed
    /// discs, then segments, then arcs
    std::int64_t body = -1;
    double nx = 0, ny = 0;
    double gap = 0;      ///< distance between the surfaces
    double distance = 0; ///< distance between the centres of a pair
    double friction = 0; ///< coefficient of Coulomb's friction
    double velocity = 0; ///< velocity of the fixed body's surface along the tangent
};

class LastingContactFinder {
public:
    LastingContactFinder(const Box& box, const Effects& effects);

    /// The contacts whose gap is less than `widest_gap`, in an order that depends only on the discs
    /// and their order. `radii` are in the order of `discs`.
    std::vector<LastingContact> find(std::span<const HeapDisc> discs, std::span<const double> radii,
                                     double widest_gap) const;

private:
    struct Search;

    void add_pairs(Search& search) const;
    void add_walls(Search& search) const;
    void add_fixed_bodies(Search& search) const;
    void add_arc(Search& search, const Arc& arc, LastingContact& contact) const;
    static void begin_at(const SurfaceTable& surface, std::uint32_t i, const HeapDisc& disc,
                         LastingContact& contact);

    Box box_;
    Effects effects_;
    double pair_friction_; ///< friction of pairs without a row of their own
    PairTable pairs_;
    std::array<SurfaceTable, SurfaceContacts::n_surfaces> surfaces_;
};

} // namespace carrom
