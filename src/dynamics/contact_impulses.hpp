// SPDX-License-Identifier: BSD-3-Clause
// Contact dynamics at a sync: impulses that keep slow discs from colliding until the next sync.
//
// Between two syncs, a time T apart, a disc falls by g T^2 / 2, so a disc that lies on others would
// collide with them again and again. Instead it gets, at the sync, the impulse that its supports
// give it during the time T, as in the time-stepping scheme of contact dynamics (Moreau 1988; Jean,
// Comput. Methods Appl. Mech. Eng. 177, 235 (1999)). With w = v + g T / 2, the mean velocity until
// the next sync, the impulses P at the contacts satisfy
//
//   gap + T w_n >= rest gap,   P_n >= 0,   with equality in at least one of the two;
//   |P_t| <= mu P_n, directed against the slip
//
// A disc at rest in a heap then has w = 0: it flies up by g T^2 / 8, the rest gap, and is back at
// the next sync. All discs of the heap move together, so they do not collide and need no computing
// time. Pairs that approach faster than `lasting_speed` (effects.hpp) have no lasting contact; they
// collide. Pairs whose impulse is inaccurate may also collide, so an inaccurate impulse never
// causes an overlap.
//
// Gauss-Seidel sweeps with over-relaxation visit the contacts from the lowest to the highest. They
// end when the impulses have converged, or after a maximum number of sweeps. Then discs in contact
// whose w is below `least_motion` times g T are stopped (w = 0), so that a heap at rest repeats its
// state bit for bit. The result depends only on the discs in order of id, so all ranks get the same
// bits. Cost: about 10 ns per contact and sweep.
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

/// True if discs fall along a periodic axis. They may then flow for ever.
bool may_flow_on(const Effects& effects);

/// The impulse of a contact of disc `a`, from which the solution at the next sync starts. `b` is
/// the other disc's id, or negative for a wall or a fixed body.
struct KeptImpulse {
    DiscId a = 0;
    std::int64_t b = 0;
    double normal = 0, tangential = 0;

    friend bool operator==(const KeptImpulse&, const KeptImpulse&) = default;
};

struct LastingForces {
    std::vector<PairImpulse> pairs;
    std::vector<WallImpulse> walls; ///< impulses of the four sides, then of each fixed body's row
    int n_sweeps = 0;               ///< largest number of sweeps that a connected component needed
};

class ContactImpulses {
public:
    static constexpr double least_motion = 0.01;

    /// `effects` and `interval` have times in micro-steps. The acceleration must not be zero.
    ContactImpulses(const Box& box, const Effects& effects, const SpeciesTable& species,
                    double interval);

    /// Sets new velocities and spins of `discs`, which are in order of id. `kept` contains the
    /// impulses of the previous sync; this function replaces them by the new ones.
    LastingForces act(std::span<HeapDisc> discs, std::vector<KeptImpulse>& kept) const;

private:
    struct Body;
    struct Contact;
    struct Part;
    struct Change {
        double normal = 0, along = 0;
    };

    /// The impulses of contacts whose normal impulse is positive. `discs` have the velocities
    /// before the impulses, and `bodies` have the mean velocities until the next sync.
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
    std::vector<BodyRow> rows_; ///< rows of the scene's fixed bodies
    /// For each piece of a fixed body, the index of its row in `rows_`
    std::vector<std::uint32_t> rows_of_pieces_;
    double interval_, pull_;
    double fall_x_, fall_y_; ///< velocity gained in half a sync interval, g T / 2
    double rest_gap_;
    double turning_; ///< m r^2 divided by the moment of inertia; 0 if discs do not turn
    double sweeps_;  ///< maximum number of sweeps, without the term for the number of contacts
};

} // namespace carrom
