// SPDX-License-Identifier: BSD-3-Clause
// How a collision changes the velocities and spins of two discs. The law is one part of a dynamics
// (dynamics.hpp), and is plain data.
//
//   elastic       the relative velocity along the line of centres is reversed
//   restitution   this velocity is multiplied by `-restitution`; 1: same bits as elastic
//   rough         discs with spin: normal and tangential restitution, Coulomb's friction
//                 (Walton and Braun, J. Rheol. 30, 949 (1986); Luding, Phys. Rev. E 52, 4442
//                 (1995)). Where surfaces stick, their relative velocity is multiplied by
//                 `-tangential_restitution`. They slide if sticking would take a tangential
//                 impulse of more than `friction` times the normal impulse. A guarded contact
//                 is smooth.
//
// The coefficients depend on the species of both discs (pair_table.hpp).
//
// The law is chosen at run time. A collision with all its consequences takes some 2,900
// instructions, so one more branch costs almost nothing.
//
// A law needs the time `since` the last collision of either disc, because the guard
// (contact_guard.hpp) may make the contact elastic. The time-stepped method passes `never`, because
// it needs no guard: a disc collides at most once in a micro-step there.
#pragma once

#include <cmath>
#include <type_traits>

#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "dynamics/contact_guard.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/encounter.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/pair_table.hpp"
#include "dynamics/species.hpp"

namespace carrom {

/// The spins of two colliding discs; null where discs do not turn.
struct Spins {
    double *p = nullptr, *q = nullptr;
};

class Law {
public:
    /// `effects` have times in micro-steps; `radius` is the largest radius of a disc. `pairs`
    /// refers to a table that another object owns.
    Law(const Effects& effects, double radius, const PairView& pairs)
        : kind_(effects.contact.kind), common_(PairFactors::common(effects.contact)), pairs_(pairs),
          inertia_(effects.contact.inertia), guard_(effects, radius) {}

    /// False in an ideal gas: discs pass through each other.
    CARROM_DEVICE bool has_pairs() const { return kind_ != ContactKind::none; }
    CARROM_DEVICE bool has_spin() const { return kind_ == ContactKind::rough; }
    CARROM_DEVICE bool is_elastic() const { return kind_ == ContactKind::elastic; }

    /// Sets the velocities and spins after a collision. `met` has the separation of the centres and
    /// the relative velocity of the surfaces, without spins.
    template <class Real>
    [[gnu::always_inline]] CARROM_DEVICE Loss meet(DiscState& p, DiscState& q,
                                                   const Encounter<Real>& met,
                                                   const SizeAndMass& p_has,
                                                   const SizeAndMass& q_has, double since,
                                                   const Spins& spins) const {
        Loss loss;
        if (is_elastic()) {
            const double half = (p_has.mass + q_has.mass) / 2;
            push_apart(p, q, met, Real{1}, static_cast<Real>(q_has.mass / half),
                       static_cast<Real>(p_has.mass / half));
        } else {
            const Encounter<double> seen{met.ex, met.ey, met.wx, met.wy};
            loss = has_spin() ? meet_rough(p, q, seen, p_has, q_has, since, spins)
                              : meet_smooth(p, q, seen, p_has, q_has, since);
        }
        p.pair_collisions += 1;
        q.pair_collisions += 1;
        return loss;
    }

private:
    CARROM_DEVICE const PairFactors& factors_of(const DiscState& p, const DiscState& q) const {
        if (!pairs_.are_any()) [[likely]]
            return common_;
        return pairs_.of(p.id, q.id);
    }
    /// The normal impulse of discs that approach at `speed`, in units of the impulse of an elastic
    /// contact. It is (1 + e) / 2, which is `normal`, at any speed.
    CARROM_DEVICE double normal_at(double normal, double /*speed*/) const { return normal; }

    /// `impulse` is in units of the impulse of an elastic contact. The velocity of a disc of mass m
    /// changes by this times 2 m' / (m + m') times the normal relative velocity, where m' is the
    /// mass of the other disc. For equal masses 2 m' / (m + m') is exactly 1, so this factor
    /// changes no bit.
    template <class Real>
    [[gnu::always_inline]] CARROM_DEVICE static void push_apart(DiscState& p, DiscState& q,
                                                                const Encounter<Real>& met,
                                                                Real impulse, Real p_share,
                                                                Real q_share) {
        const Real k = impulse * met.rate();
        p.vx = static_cast<Real>(p.vx) + k * p_share * met.ex;
        p.vy = static_cast<Real>(p.vy) + k * p_share * met.ey;
        q.vx = static_cast<Real>(q.vx) - k * q_share * met.ex;
        q.vy = static_cast<Real>(q.vy) - k * q_share * met.ey;
    }

    [[gnu::always_inline]] CARROM_DEVICE Loss meet_smooth(DiscState& p, DiscState& q,
                                                          const Encounter<double>& met,
                                                          const SizeAndMass& p_has,
                                                          const SizeAndMass& q_has,
                                                          double since) const {
        const double square = met.square(), k = met.rate(),
                     normal = normal_at(factors_of(p, q).normal, -k * std::sqrt(square));
        const bool is_guarded = guard_.holds(since, k);
        const double half = (p_has.mass + q_has.mass) / 2,
                     reduced_mass = p_has.mass * q_has.mass / (2 * half);
        push_apart(p, q, met, is_guarded ? 1 : normal, q_has.mass / half, p_has.mass / half);
        return guard_.loss(reduced_mass * normal_loss(normal, k) * square, k * k * square,
                           is_guarded);
    }

    /// Like meet_smooth, with an additional impulse s along the surfaces, which turns both discs in
    /// the same sense. Here s and k are velocities divided by the distance between the centres.
    /// With s = 0 the bits equal those of meet_smooth. Spins are angles per micro-step,
    /// counterclockwise.
    CARROM_DEVICE Loss meet_rough(DiscState& p, DiscState& q, const Encounter<double>& met,
                                  const SizeAndMass& p_has, const SizeAndMass& q_has, double since,
                                  const Spins& spins) const {
        const auto [ex, ey, wx, wy] = met;
        const double square = met.square(), distance = std::sqrt(square), rate = met.rate();
        const bool is_guarded = guard_.holds(since, rate);
        const PairFactors& factors = factors_of(p, q);
        const double normal = normal_at(factors.normal, -rate * distance), lossy = normal * rate,
                     k = is_guarded ? rate : lossy;
        const double slip = (wy * ex - wx * ey) / square -
                            (*spins.p * p_has.radius + *spins.q * q_has.radius) / distance;
        const double rubbed = tangential(factors, slip, lossy), s = is_guarded ? 0 : rubbed;
        const double half = (p_has.mass + q_has.mass) / 2, p_share = q_has.mass / half,
                     q_share = p_has.mass / half;
        p.vx = p.vx + (k * p_share * ex - s * p_share * ey);
        p.vy = p.vy + (k * p_share * ey + s * p_share * ex);
        q.vx = q.vx - (k * q_share * ex - s * q_share * ey);
        q.vy = q.vy - (k * q_share * ey + s * q_share * ex);
        const double turn = s * distance / inertia_;
        *spins.p = *spins.p + turn * p_share / p_has.radius;
        *spins.q = *spins.q + turn * q_share / q_has.radius;
        // An impulse s changes the slip by 2 s (1 + 1 / inertia).
        const double along = 2 * rubbed * (slip - rubbed * (1 + 1 / inertia_));
        return guard_.loss(p_has.mass * q_has.mass / (2 * half) * square *
                               (normal_loss(normal, rate) + along),
                           rate * rate * square, is_guarded);
    }

    /// The energy that restitution takes, (1 - e^2) k^2 / 2, for a reduced mass of 1 and centres at
    /// a distance of 1. `k` is the speed of approach.
    CARROM_DEVICE static double normal_loss(double normal, double k) {
        return 2 * normal * (1 - normal) * k * k;
    }
    /// The tangential impulse for the surfaces' relative velocity `slip` and the normal impulse
    /// `k`; all three are in the same unit.
    CARROM_DEVICE static double tangential(const PairFactors& factors, double slip, double k) {
        const double sticking = factors.tangential * slip, most = factors.friction * std::fabs(k);
        return std::fabs(sticking) > most ? std::copysign(most, sticking) : sticking;
    }

    ContactKind kind_;
    PairFactors common_; ///< factors of pairs without a row of their own
    PairView pairs_;
    double inertia_;
    ContactGuard guard_;
};
static_assert(std::is_trivially_copyable_v<Law>);

} // namespace carrom
