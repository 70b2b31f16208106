// SPDX-License-Identifier: BSD-3-Clause
// The laws of scenes that name effects, put together from policies (docs/architecture.md, "How a law is put together").
//
// A law is the plain one with some of its answers replaced; what an effect does not touch is the plain law's own code, so
// that an effect whose parameters make it none gives the plain law's bits.
#pragma once

#include "carrom/effects/contacts.hpp"
#include "carrom/effects/effects.hpp"
#include "carrom/effects/plain_law.hpp"
#include "carrom/effects/sides.hpp"

namespace carrom {

template <class Contact> class EffectLaw : public PlainLaw {
public:
    static constexpr bool has_pairs = Contact::has_pairs;
    static constexpr bool has_mirror_walls = false;

    /// `effects` per micro-step.
    EffectLaw(double box_size, double radius, const Effects& effects)
        : PlainLaw(box_size, radius), contact_(effects.contact), sides_(box_size, radius, effects) {}

    const Sides& sides() const { return sides_; }
    void begin_interval(std::int64_t n) { sides_.begin_interval(n); }

    PairContact<double> contact(const Disc& p, const Disc& q) const {
        if constexpr (has_pairs) return PlainLaw::contact(p, q);
        return {};
    }
    PairContact<double> exact_contact(const Disc& p, const Disc& q) const {
        if constexpr (has_pairs) return PlainLaw::exact_contact(p, q);
        return {};
    }

    void collide(Disc& p, Disc& q, double m, double t) const {
        collide_with(p, q, m + t, contact_.impulse());
        stop_at_wall(p, m, t);
        stop_at_wall(q, m, t);
    }
    void collide_at(Disc& p, Disc& q, double time) const { collide_with(p, q, time, contact_.impulse_at(p, q, time)); }

    /// The plain law's times; what happens at them is the sides' business. Walls are at rest under the rule "one".
    void bounce(Disc& disc, double m, double t) const {
        const double tx = axis_time(disc.x, disc.vx, disc.tau, m), ty = axis_time(disc.y, disc.vy, disc.tau, m);
        advance(disc, m + t);
        const bool x_reverses = tx == t || touches_wall(disc.x, disc.vx);
        const bool y_reverses = ty == t || touches_wall(disc.y, disc.vy);
        const bool goes_down = disc.vy < 0;
        if (x_reverses) sides_.reverse(disc, Axis::x);
        // A thermal wall may have turned the disc away from the other one.
        if (y_reverses && (goes_down ? disc.vy < 0 : disc.vy > 0)) sides_.reverse(disc, Axis::y);
        disc.wall_collisions += 1;
        stop_at_wall(disc, m, t);
    }

    double x_wall_time(const Disc& disc) const { return sides_.wall_time(disc, Axis::x); }
    double y_wall_time(const Disc& disc) const { return sides_.wall_time(disc, Axis::y); }
    bool may_meet_wall(const Disc& disc, double time) const {
        const double fastest = std::max(std::fabs(disc.vx), std::fabs(disc.vy)) + sides_.speed_gained_at(time);
        return sides_.may_meet(disc, time, tolerance() + time_rounding * time * fastest);
    }
    Extent walls_between(double begin, double end) const { return sides_.walls_between(begin, end); }
    void bounce_x_at(Disc& disc, double time) const { sides_.bounce_at(disc, Axis::x, time); }
    void bounce_y_at(Disc& disc, double time) const { sides_.bounce_at(disc, Axis::y, time); }

private:
    Contact contact_;
    Sides sides_;
};

using IdealGasLaw = EffectLaw<NoContact>;
using ElasticLaw = EffectLaw<ElasticContact>; ///< with sides or gravity that are not plain
using InelasticLaw = EffectLaw<InelasticContact>;

} // namespace carrom
