// SPDX-License-Identifier: BSD-3-Clause
// Contact dynamics at a sync: impulses that keep slow discs from colliding until the next sync.
//
// Between two syncs, a time T apart, a disc falls by g T^2 / 2. A disc that lies on others would
// collide again and again. Instead it gets at the sync the impulse that its supports give it in the
// time T, as in the time-stepping scheme of contact dynamics (Moreau 1988; Jean, Comput. Methods
// Appl. Mech. Eng. 177, 235 (1999)). With w = v + g T / 2, the mean velocity until the next sync,
// the impulses P at the contacts are such that
//
//   gap + T w_n >= rest gap,   P_n >= 0,   with equality in at least one of the two;
//   |P_t| <= mu P_n, directed against the slip
//
// A disc of a heap then has w = 0: it flies up by g T^2 / 8, the rest gap, and is back at the next
// sync. All discs of the heap move together, so they do not collide and cost nothing. Pairs that
// approach faster than `lasting_speed` (effects.hpp) are no lasting contacts, and collide. Pairs
// with inaccurate impulses collide, too, so that such an impulse never makes an overlap.
//
// Gauss-Seidel sweeps with over-relaxation go over the contacts from the lowest up. They end when
// impulses have converged, or after the largest number of sweeps. Then discs in contact whose w is
// below `least_motion` times g T stop (w = 0), so that a heap at rest repeats its state bit by bit.
// The result is a function of the discs in the order of ids, so all ranks have the same bits. Cost:
// some 10 ns for each contact and sweep.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/container.hpp"
#include "dynamics/lasting_contacts.hpp"
#include "dynamics/species.hpp"
#include "dynamics/sync_effect.hpp"

namespace carrom {

/// Whether discs fall along a periodic axis, so that they may flow for ever.
bool may_flow_on(const Effects& effects);

/// The impulse of a contact, from which the solution at the next sync begins. `b` is a disc's id,
/// or negative for walls and fixed bodies.
struct KeptImpulse {
    DiscId a = 0;
    std::int64_t b = 0;
    double normal = 0, tangential = 0;

    friend bool operator==(const KeptImpulse&, const KeptImpulse&) = default;
};

struct LastingForces {
    std::vector<PairImpulse> pairs;
    std::vector<WallImpulse> walls; ///< impulses of the four sides, then of rows of fixed bodies
    int n_sweeps = 0;               ///< largest number of sweeps that a connected component needed
};

class ContactImpulses {
public:
    static constexpr double least_motion = 0.01;

    /// `effects` and `interval` have times in micro-steps. The acceleration must not be zero.
    ContactImpulses(const Box& box, const Effects& effects, const SpeciesTable& species,
                    double interval);

    /// Gives new velocities and spins to `discs`, which are in the order of ids. `kept` are the
    /// impulses of the last sync, which this function replaces by the new ones.
    LastingForces act(std::span<HeapDisc> discs, std::vector<KeptImpulse>& kept) const;

private:
    struct Body;
    struct Contact;
    struct Part;
    struct Change {
        double normal = 0, along = 0;
    };

    /// The impulses of contacts that press; `discs` hold the velocities before the impulses.
    LastingForces forces_of(std::span<const Contact> contacts, std::span<const HeapDisc> discs,
                            std::span<const Body> bodies) const;
    void add_fixed_body(WallImpulse& wall, const Contact& contact, const HeapDisc& disc,
                        const PairImpulse& given) const;
    static std::vector<KeptImpulse> kept_of(std::span<const Contact> contacts,
                                            std::span<const HeapDisc> discs);
    void set_velocities(std::span<const Contact> contacts, std::span<const Body> bodies,
                        std::span<HeapDisc> discs) const;
    static std::int64_t key_of(const Contact& contact, std::span<const HeapDisc> discs);
    std::vector<Contact> lasting_contacts(std::span<const HeapDisc> discs,
                                          std::span<const KeptImpulse> kept) const;
    std::vector<Part> connected_parts(std::vector<Contact>& contacts, std::size_t n) const;
    void give(const Contact& contact, const Change& change, std::vector<Body>& bodies) const;
    Change change_of(const Contact& contact, const std::vector<Body>& bodies) const;
    int sweep(std::span<Contact> part, std::vector<Body>& bodies) const;
    void stop_slow(std::span<const Contact> part, std::vector<Body>& bodies) const;

    LastingContactFinder finder_;
    Effects effects_;
    SpeciesTable species_;
    std::vector<BodyRow> rows_;                 ///< rows of fixed bodies
    std::vector<std::uint32_t> rows_of_pieces_; ///< row in `rows_` of each piece of a body
    double interval_, pull_;
    double fall_x_, fall_y_; ///< speed gained in half a sync interval, g T / 2
    double rest_gap_;
    double turning_; ///< 1 over the moment of inertia in m r^2; 0 where discs do not turn
    double sweeps_;  ///< largest number of sweeps, without the term for the number of contacts
};

} // namespace carrom
