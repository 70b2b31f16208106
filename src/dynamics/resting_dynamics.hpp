// SPDX-License-Identifier: BSD-3-Clause
// The dynamics of scenes in which discs come to rest (effects.rest): another dynamics, in which
// some discs lie still in the box from one sync to the next, until something wakes them.
//
// At a sync scene/effects/rest.cpp decides which discs rest. Two resting discs have no events with
// each other, and a resting disc has none with walls and obstacles. That is what makes a heap at
// rest fast. Another disc meets a resting one as it meets a fixed disc: a quartic under gravity
// (falling_contact.hpp). If it comes slower than the waking speed along the line of centres, it
// leaves as from an obstacle. A faster one wakes the resting disc, and the two collide as others.
//
// The contact time makes contacts elastic only if discs come slower than the speed below which they
// may rest. Faster contacts always take energy and rub: otherwise a disc between two resting ones
// would fly to and fro for ever. Each of them takes some energy, so no cascade comes of that.
//
// A slow disc that is caught between bodies at rest would collide the more often, the less room it
// has. It comes to rest at a slow contact that follows its last one within an eighth of the contact
// time, and a faster one where hardly any time is left between contacts. A disc that slides down a
// single body flies for the whole contact time at each bounce, so it goes on. The first contact
// after a sync has no such predecessor.
#pragma once

#include <algorithm>
#include <cmath>

#include "dynamics/effect_dynamics.hpp"
#include "dynamics/falling_contact.hpp"
#include "dynamics/resting.hpp"
#include "dynamics/rubbing.hpp"

namespace carrom {

template <class Moving> class RestingDynamics : public Moving {
public:
    static constexpr bool may_rest = true;

    /// `effects` per micro-step. There is gravity, and no drag.
    RestingDynamics(const Box& box, double radius, const Effects& effects)
        : Moving(box, radius, effects), places_(box, effects.gravity), effect_(effects.contact),
          rubbing_({effect_.kind == ContactKind::rough ? effect_.tangential_restitution : -1,
                    effect_.friction, 0},
                   effect_),
          wake_(effects.rest.wake),
          guarded_speed_(effects.rest.speed) {}

    const RestingPlaces& resting_places() const { return places_; }

    /// A disc that rests moves in the frame of states.
    double squared_speed_at(const Disc& disc, double time) const {
        if (!disc.rests()) return squared_speed_of(disc);
        const double vx = places_.gravity().x * time, vy = places_.gravity().y * time;
        return vx * vx + vy * vy;
    }

    PairContact<double> event_contact(const Disc& p, const Disc& q) const {
        if (!p.rests() && !q.rests()) return Moving::event_contact(p, q);
        if (p.has_departed() || q.has_departed() || (p.rests() && q.rests())) return {};
        return p.rests() ? contact_at_rest(q, p) : contact_at_rest(p, q);
    }

    void collide_at(Disc& p, Disc& q, double time) const {
        const Contact contact = reach(p, q, time);
        if (contact.is_soft)
            return leave(p.rests() ? q : p, p.rests() ? p : q, contact, nullptr);
        wake_one(p, q, time);
        this->exchange_momentum_at(p, q, this->encounter(p, q, q.x - p.x, q.y - p.y),
                                   contact.is_guarded ? 1 : (1 + effect_.restitution) / 2);
    }
    void collide_at(Disc& p, Disc& q, double time, double& p_spin, double& q_spin) const {
        const Contact contact = reach(p, q, time);
        if (contact.is_soft)
            return leave(p.rests() ? q : p, p.rests() ? p : q, contact,
                         p.rests() ? &q_spin : &p_spin);
        wake_one(p, q, time);
        this->exchange_spin_at(p, q, this->encounter(p, q, q.x - p.x, q.y - p.y),
                               contact.is_guarded, p_spin, q_spin);
    }

    double x_wall_time(const Disc& disc) const {
        return disc.rests() ? Moving::never : Moving::x_wall_time(disc);
    }
    double y_wall_time(const Disc& disc) const {
        return disc.rests() ? Moving::never : Moving::y_wall_time(disc);
    }
    bool may_meet_wall(const Disc& disc, double time) const {
        return !disc.rests() && Moving::may_meet_wall(disc, time);
    }
    ObstacleContact first_obstacle(const Disc& disc, const ContactTimes& times) const {
        return disc.rests() ? ObstacleContact{} : Moving::first_obstacle(disc, times);
    }

private:
    /// From the resting disc to the other one, and the velocity of that, in the box.
    struct Approach {
        double x, y, vx, vy;
    };
    Approach approach(const Disc& mover, const Disc& resting) const {
        const Gravity& g = places_.gravity();
        return {(mover.x + RestingPlaces::fallen(g.x, mover.tau)) - places_.x_of(resting),
                (mover.y + RestingPlaces::fallen(g.y, mover.tau)) - places_.y_of(resting),
                mover.vx + g.x * mover.tau, mover.vy + g.y * mover.tau};
    }

    /// A function of the state of the disc that moves, and of the place of the other one.
    PairContact<double> contact_at_rest(const Disc& mover, const Disc& resting) const {
        const Approach to = approach(mover, resting);
        const double delay = falling_contact(to.x, to.y, to.vx, to.vy, places_.gravity().x,
                                             places_.gravity().y,
                                             this->pair_diameter(mover, resting));
        if (!(delay < Moving::never)) return {};
        return {mover.tau, delay};
    }

    struct Contact {
        bool is_soft = false; ///< one of the discs rests, and goes on resting
        bool is_guarded = false;
        bool catches_slow = false, catches_all = false; ///< the other disc comes to rest
    };
    /// Advances discs to their contact at `time`, but for one that rests.
    Contact reach(Disc& p, Disc& q, double time) const {
        const bool one_rests = p.rests() || q.rests();
        const double last = p.rests() ? q.tau : q.rests() ? p.tau : std::max(p.tau, q.tau);
        const double share = last > 0 ? (time - last) / effect_.contact_time : 1;
        if (!p.rests()) Moving::advance(p, time);
        if (!q.rests()) Moving::advance(q, time);
        Approach to;
        if (one_rests)
            to = p.rests() ? approach(q, p) : approach(p, q);
        else
            to = {q.x - p.x, q.y - p.y, q.vx - p.vx, q.vy - p.vy};
        const double distance = std::sqrt(to.x * to.x + to.y * to.y),
                     closing = -(to.vx * to.x + to.vy * to.y);
        const bool is_gentle = !(closing > guarded_speed_ * distance);
        return {one_rests && !(closing > wake_ * distance),
                time - last < effect_.contact_time && is_gentle,
                is_gentle && share < 0.125, is_gentle && share < 0x1p-12};
    }
    void wake_one(Disc& p, Disc& q, double time) const {
        if (p.rests()) places_.wake(p, time);
        if (q.rests()) places_.wake(q, time);
    }

    bool is_slow(const Approach& to, const Disc& mover, const double* spin) const {
        const double turning = spin ? *spin * this->species_table().of(mover.id).radius : 0;
        return to.vx * to.vx + to.vy * to.vy <= guarded_speed_ * guarded_speed_ &&
               std::fabs(turning) <= guarded_speed_;
    }

    /// The disc leaves as from an obstacle (Obstacles::rebound); the resting one is heavy.
    void leave(Disc& mover, Disc& resting, const Contact& contact, double* spin) const {
        const Gravity& g = places_.gravity();
        const Approach to = approach(mover, resting);
        const double distance = std::sqrt(to.x * to.x + to.y * to.y);
        const double nx = to.x / distance, ny = to.y / distance;
        const double normal = nx * to.vx + ny * to.vy;
        double away = (contact.is_guarded ? 1 : effect_.restitution) * std::fabs(normal);
        const double pull = -(nx * g.x + ny * g.y);
        if (pull > 0) away = std::max(away, 0.5 * pull * effect_.contact_time);
        mover.vx += (away - normal) * nx;
        mover.vy += (away - normal) * ny;
        mover.pair_collisions += 1;
        resting.pair_collisions += 1;
        if (contact.catches_all || (contact.catches_slow && is_slow(to, mover, spin))) {
            if (spin) *spin = 0;
            return places_.stop(mover, mover.x + RestingPlaces::fallen(g.x, mover.tau),
                                mover.y + RestingPlaces::fallen(g.y, mover.tau), mover.tau);
        }
        if (!rubbing_.acts()) return;
        const double change = rubbing_.rub(nx * to.vy - ny * to.vx, std::fabs(away - normal),
                                           {spin, this->species_table().of(mover.id).radius});
        mover.vx -= change * ny;
        mover.vy += change * nx;
    }

    RestingPlaces places_;
    ContactEffect effect_;
    Rubbing rubbing_;
    double wake_;
    double guarded_speed_; ///< the contact time does not act on faster contacts
};

using RestingMixedDynamics = RestingDynamics<MixedDynamics>;
using RestingRoughDynamics = RestingDynamics<RoughDynamics>;

} // namespace carrom
