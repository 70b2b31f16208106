// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/contact_impulses.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace carrom {

namespace {

/// A sweep changes each impulse by this factor times the change that its own contact needs
/// (over-relaxation), so that forces spread through a heap in fewer sweeps. With friction, sweeps
/// with a larger factor do not converge.
constexpr double relaxation = 1.3;
/// Sweeps end when one of them changes no contact's velocity by more than this fraction of g times
/// the sync interval.
constexpr double small_change = 0.005;
/// The largest number of sweeps for n connected contacts is this plus the square root of n. Sweeps
/// may end before the solution is reached, because the next sync continues from their result.
constexpr double sweeps_at_most = 20;
/// The same number for discs that may flow for ever (may_flow_on). In a flow the contacts change
/// from sync to sync, so the previous impulses are a poor start, and the collisions that inaccurate
/// impulses would cause take more time than additional sweeps.
constexpr double sweeps_of_flow = 400;

} // namespace

bool may_flow_on(const Effects& effects) {
    return (effects.acceleration().x != 0 && effects.is_periodic_x()) ||
           (effects.acceleration().y != 0 && effects.is_periodic_y());
}

/// A disc, or all fixed bodies, with the mean velocity until the next sync; `turning` is the spin
/// times the radius.
struct ContactImpulses::Body {
    double vx = 0, vy = 0, turning = 0;
    double share = 0; ///< inverse mass; 0 for fixed bodies
};

struct ContactImpulses::Contact {
    std::uint32_t a = 0, b = 0; ///< indices of bodies; for a fixed body b is the last index
    std::uint32_t part = 0;
    std::int64_t body = -1; ///< number of the wall or fixed body, as in LastingContact
    double nx = 0, ny = 0;
    double friction = 0, velocity = 0;
    double approach = 0; ///< the largest allowed speed of approach
    double mass = 0;     ///< reduced mass of the two bodies
    double height = 0;
    double distance = 0;
    double normal = 0, tangential = 0; ///< impulses on body b
};

struct ContactImpulses::Part {
    std::size_t first = 0, end = 0;
};

ContactImpulses::ContactImpulses(const Box& box, const Effects& effects,
                                 const SpeciesTable& species, double interval)
    : finder_(box, effects), effects_(effects), species_(species),
      rows_(rows_of(effects.fixed_bodies, box)),
      rows_of_pieces_(rows_of_pieces(effects.fixed_bodies, box)), interval_(interval),
      pull_(std::hypot(effects.acceleration().x, effects.acceleration().y) * interval),
      fall_x_((0.5 * effects.acceleration().x) * interval),
      fall_y_((0.5 * effects.acceleration().y) * interval), rest_gap_(pull_ * interval / 8),
      turning_(effects.contact.kind == ContactKind::rough ? 1 / effects.contact.inertia : 0),
      sweeps_(may_flow_on(effects) ? sweeps_of_flow : sweeps_at_most) {}

LastingForces ContactImpulses::act(std::span<HeapDisc> discs,
                                   std::vector<KeptImpulse>& kept) const {
    std::vector<Contact> contacts = lasting_contacts(discs, kept);
    std::vector<Body> bodies(discs.size() + 1); // the last one stands for all fixed bodies
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const SizeAndMass& body = species_.of(discs[i].id);
        bodies[i] = {discs[i].vx + fall_x_, discs[i].vy + fall_y_, discs[i].spin * body.radius,
                     1 / body.mass};
    }
    int n_sweeps = 0;
    for (const Part& part : connected_parts(contacts, discs.size())) {
        const std::span<Contact> own = std::span(contacts).subspan(part.first,
                                                                   part.end - part.first);
        n_sweeps = std::max(n_sweeps, sweep(own, bodies));
        stop_slow(own, bodies);
    }
    LastingForces forces = forces_of(contacts, discs, bodies);
    forces.n_sweeps = n_sweeps;
    kept = kept_of(contacts, discs);
    set_velocities(contacts, bodies, discs);
    return forces;
}

LastingForces ContactImpulses::forces_of(std::span<const Contact> contacts,
                                         std::span<const HeapDisc> discs,
                                         std::span<const Body> bodies) const {
    LastingForces forces;
    forces.walls.resize(WallImpulse::n_sides + rows_.size());
    for (std::size_t k = 0; k < forces.walls.size(); ++k) forces.walls[k].side = k;
    for (const Contact& contact : contacts) {
        if (!(contact.normal > 0)) continue;
        const HeapDisc& a = discs[contact.a];
        PairImpulse pair; // impulses on disc a
        pair.ix = -(contact.normal * contact.nx - contact.tangential * contact.ny);
        pair.iy = -(contact.normal * contact.ny + contact.tangential * contact.nx);
        pair.p_vx = 0.5 * (a.vx + bodies[contact.a].vx - fall_x_);
        pair.p_vy = 0.5 * (a.vy + bodies[contact.a].vy - fall_y_);
        if (contact.b < discs.size()) {
            const HeapDisc& b = discs[contact.b];
            pair.p = a.id, pair.q = b.id;
            pair.x = a.x, pair.y = a.y;
            pair.dx = contact.nx * contact.distance, pair.dy = contact.ny * contact.distance;
            pair.q_vx = 0.5 * (b.vx + bodies[contact.b].vx - fall_x_);
            pair.q_vy = 0.5 * (b.vy + bodies[contact.b].vy - fall_y_);
            forces.pairs.push_back(pair);
        } else if (contact.body < 4) {
            WallImpulse& wall = forces.walls[static_cast<std::size_t>(contact.body)];
            wall.normal += contact.normal;
            wall.along += contact.body < 2 ? pair.iy : pair.ix;
            wall.energy += pair.ix * pair.p_vx + pair.iy * pair.p_vy;
        } else {
            const auto piece = static_cast<std::size_t>(contact.body) - WallImpulse::n_sides;
            add_fixed_body(forces.walls[WallImpulse::n_sides + rows_of_pieces_[piece]], contact, a,
                           pair);
        }
    }
    return forces;
}

void ContactImpulses::add_fixed_body(WallImpulse& wall, const Contact& contact,
                                     const HeapDisc& disc, const PairImpulse& given) const {
    const BodyRow& row = rows_[wall.side - WallImpulse::n_sides];
    const double radius = species_.of(disc.id).radius, x = disc.x + radius * contact.nx - row.x,
                 y = disc.y + radius * contact.ny - row.y;
    wall.normal += contact.normal;
    wall.ix += given.ix;
    wall.iy += given.iy;
    wall.torque += y * given.ix - x * given.iy;
    wall.energy += given.ix * given.p_vx + given.iy * given.p_vy;
}

std::vector<KeptImpulse> ContactImpulses::kept_of(std::span<const Contact> contacts,
                                                  std::span<const HeapDisc> discs) {
    std::vector<KeptImpulse> kept;
    for (const Contact& contact : contacts)
        if (contact.normal > 0)
            kept.push_back(
                {discs[contact.a].id, key_of(contact, discs), contact.normal, contact.tangential});
    std::sort(kept.begin(), kept.end(), [](const KeptImpulse& p, const KeptImpulse& q) {
        return std::tuple(p.a, p.b) < std::tuple(q.a, q.b);
    });
    return kept;
}

/// Discs without impulses keep their velocities and spins, bit for bit.
void ContactImpulses::set_velocities(std::span<const Contact> contacts,
                                     std::span<const Body> bodies,
                                     std::span<HeapDisc> discs) const {
    std::vector<std::uint8_t> is_pressed(discs.size() + 1);
    for (const Contact& contact : contacts)
        if (contact.normal > 0) is_pressed[contact.a] = is_pressed[contact.b] = 1;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        if (is_pressed[i] == 0) continue;
        discs[i].vx = bodies[i].vx - fall_x_;
        discs[i].vy = bodies[i].vy - fall_y_;
        discs[i].spin = bodies[i].turning / species_.of(discs[i].id).radius;
    }
}

std::int64_t ContactImpulses::key_of(const Contact& contact, std::span<const HeapDisc> discs) {
    return contact.b < discs.size() ? static_cast<std::int64_t>(discs[contact.b].id)
                                    : -1 - contact.body;
}

std::vector<ContactImpulses::Contact> ContactImpulses::lasting_contacts(
    std::span<const HeapDisc> discs, std::span<const KeptImpulse> kept) const {
    std::vector<double> radii(discs.size());
    for (std::size_t i = 0; i < discs.size(); ++i) radii[i] = species_.of(discs[i].id).radius;
    const double speed = effects_.lasting_speed;
    std::vector<Contact> contacts;
    for (const LastingContact& one : finder_.find(discs, radii, speed * interval_ + rest_gap_)) {
        const bool is_pair = one.b != LastingContact::fixed_body;
        const HeapDisc& a = discs[one.a];
        double wx = -a.vx - fall_x_, wy = -a.vy - fall_y_;
        if (is_pair) wx = discs[one.b].vx - a.vx, wy = discs[one.b].vy - a.vy;
        if (!(wx * one.nx + wy * one.ny > -speed)) continue;
        Contact contact;
        contact.a = one.a;
        contact.b = is_pair ? one.b : static_cast<std::uint32_t>(discs.size());
        contact.body = one.body;
        contact.nx = one.nx;
        contact.ny = one.ny;
        contact.friction = one.friction;
        contact.velocity = one.velocity;
        contact.distance = one.distance;
        // Discs closer than the rest gap are not pushed apart, because impulses would increase
        // without limit if the discs had no room.
        contact.approach = std::max(one.gap - rest_gap_, 0.0) / interval_;
        contact.mass = 1 / (1 / species_.of(a.id).mass +
                            (is_pair ? 1 / species_.of(discs[one.b].id).mass : 0));
        contact.height = -(effects_.acceleration().x * (a.x + radii[one.a] * one.nx) +
                           effects_.acceleration().y * (a.y + radii[one.a] * one.ny));
        const std::tuple key(a.id, key_of(contact, discs));
        const auto found = std::lower_bound(
            kept.begin(), kept.end(), key,
            [](const KeptImpulse& p, const auto& wanted) { return std::tuple(p.a, p.b) < wanted; });
        if (found != kept.end() && std::tuple(found->a, found->b) == key) {
            contact.normal = found->normal;
            contact.tangential = found->tangential;
        }
        contacts.push_back(contact);
    }
    return contacts;
}

/// Sorts contacts by connected component, and within each component by height, lowest first.
std::vector<ContactImpulses::Part> ContactImpulses::connected_parts(std::vector<Contact>& contacts,
                                                                    std::size_t n) const {
    std::vector<std::uint32_t> root(n);
    std::iota(root.begin(), root.end(), 0);
    const auto root_of = [&](std::uint32_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (const Contact& contact : contacts) {
        if (contact.b == n) continue;
        const std::uint32_t p = root_of(contact.a), q = root_of(contact.b);
        root[std::max(p, q)] = std::min(p, q);
    }
    for (Contact& contact : contacts) contact.part = root_of(contact.a);
    std::sort(contacts.begin(), contacts.end(), [](const Contact& p, const Contact& q) {
        return std::tuple(p.part, p.height, p.a, p.b, p.body) <
               std::tuple(q.part, q.height, q.a, q.b, q.body);
    });
    std::vector<Part> parts;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        if (k == 0 || contacts[k].part != contacts[k - 1].part) parts.push_back({k, k});
        parts.back().end = k + 1;
    }
    return parts;
}

void ContactImpulses::give(const Contact& contact, const Change& change,
                           std::vector<Body>& bodies) const {
    Body &a = bodies[contact.a], &b = bodies[contact.b];
    const double ix = change.normal * contact.nx - change.along * contact.ny,
                 iy = change.normal * contact.ny + change.along * contact.nx;
    a.vx -= a.share * ix;
    a.vy -= a.share * iy;
    a.turning -= a.share * turning_ * change.along;
    b.vx += b.share * ix;
    b.vy += b.share * iy;
    b.turning -= b.share * turning_ * change.along;
}

ContactImpulses::Change ContactImpulses::change_of(const Contact& contact,
                                                   const std::vector<Body>& bodies) const {
    const Body &a = bodies[contact.a], &b = bodies[contact.b];
    const double nx = contact.nx, ny = contact.ny, wx = b.vx - a.vx, wy = b.vy - a.vy;
    const double mass = relaxation * contact.mass;
    const double normal = std::max(contact.normal - mass * (wx * nx + wy * ny + contact.approach),
                                   0.0);
    Change change{normal - contact.normal, 0};
    if (!(contact.friction > 0)) return change;
    const double slip = contact.velocity + (wy * nx - wx * ny) - (a.turning + b.turning);
    const double limit = contact.friction * normal;
    change.along = std::clamp(contact.tangential - mass / (1 + turning_) * slip, -limit, limit) -
                   contact.tangential;
    return change;
}

/// Changes nothing if the impulses are already accurate, so that a heap at rest repeats its state.
/// Returns the number of sweeps.
int ContactImpulses::sweep(std::span<Contact> part, std::vector<Body>& bodies) const {
    for (const Contact& contact : part) give(contact, {contact.normal, contact.tangential}, bodies);
    const double small = small_change * pull_;
    const auto is_small = [&](const Contact& contact, const Change& change) {
        return std::fabs(change.normal) + std::fabs(change.along) <= small * contact.mass;
    };
    bool is_settled = std::all_of(part.begin(), part.end(), [&](const Contact& contact) {
        return is_small(contact, change_of(contact, bodies));
    });
    const double most = sweeps_ + std::sqrt(static_cast<double>(part.size()));
    int n_sweeps = 0;
    for (; n_sweeps < most && !is_settled; ++n_sweeps) {
        is_settled = true;
        for (Contact& contact : part) {
            const Change change = change_of(contact, bodies);
            contact.normal += change.normal;
            contact.tangential += change.along;
            give(contact, change, bodies);
            is_settled = is_settled && is_small(contact, change);
        }
    }
    return n_sweeps;
}

void ContactImpulses::stop_slow(std::span<const Contact> part, std::vector<Body>& bodies) const {
    const double least = least_motion * pull_;
    const auto stop = [least](Body& body) {
        if (std::fabs(body.vx) < least && std::fabs(body.vy) < least &&
            std::fabs(body.turning) < least)
            body.vx = body.vy = body.turning = 0;
    };
    for (const Contact& contact : part) {
        if (!(contact.normal > 0)) continue;
        stop(bodies[contact.a]);
        stop(bodies[contact.b]);
    }
}

} // namespace carrom
