// SPDX-License-Identifier: BSD-3-Clause
// Which discs of a heap hold each other: one step of contact dynamics (Moreau 1988; Jean, Comput.
// Methods Appl. Mech. Eng. 177, 235 (1999)) from rest, as a test.
//
// Discs as close as a given gap, and discs as close to a wall or an obstacle, are in contact. All
// begin at rest, gravity acts for one unit of time, and impulses at the contacts keep discs from
// approaching: normal ones that push, and tangential ones within Coulomb's cone. Gauss and Seidel's
// sweeps over the contacts, from the floor up, find the impulses. Discs that are left
// (nearly) at rest are held. Without friction the velocities are unique, because impulses minimise
// a convex function. With friction there may be several solutions, and this finds one of them.
//
// The answer depends on places, sizes and masses only, in the order of ids. So every rank that has
// the same list gets the same bits. Price: some 10 ns for each contact and sweep.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/disc.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

/// A disc that rests or is slow enough to rest, in the box.
struct HeapDisc {
    DiscId id = 0;
    double x = 0, y = 0;
    double radius = 0, mass = 1;
    std::uint64_t rests = 0; ///< 1 if it rests already

    friend bool operator==(const HeapDisc&, const HeapDisc&) = default;
};

/// What gravity leaves of itself, and what walls bear.
struct HeapForces {
    /// The largest component of each disc's acceleration, the surface's by its spin included, as a
    /// share of gravity's; 0 of discs that were not free.
    std::vector<double> left;
    /// What the sides of the box give to discs, across and along them: mass times acceleration.
    std::array<double, 4> normal{}, along{};
    int n_sweeps = 0;
};

class HeapBalance {
public:
    /// Discs are in contact across `effects.rest.gap`. Gravity must not be zero.
    HeapBalance(const Box& box, const Effects& effects);
    ~HeapBalance();
    HeapBalance(const HeapBalance&) = delete;
    HeapBalance& operator=(const HeapBalance&) = delete;

    /// Finds the contacts of `discs`, which are in the order of ids.
    void set_discs(std::span<const HeapDisc> discs);

    /// Lets gravity act on the discs that are free. All others stand fixed.
    HeapForces find(std::span<const std::uint8_t> is_free) const;

private:
    struct Contact;
    struct Body;

    void add_pairs(std::span<const HeapDisc> discs);
    void add_walls(std::span<const HeapDisc> discs);
    void add_obstacles(std::span<const HeapDisc> discs);
    void sort_contacts(std::span<const HeapDisc> discs);
    double push(Contact& contact, std::vector<Body>& bodies, double relaxation) const;
    double left_of(const Body& body) const;

    Box box_;
    std::array<Boundary, 4> boundaries_;
    ObstacleList obstacles_;
    Gravity gravity_;
    double gap_, pair_friction_;
    double turning_; ///< 1 over the moment of inertia in m r^2; 0 where discs do not turn
    std::vector<double> shares_;    ///< 1 over the mass, by disc
    std::vector<Contact> contacts_; ///< from the lowest up
};

} // namespace carrom
