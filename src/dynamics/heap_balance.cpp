// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/heap_balance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace carrom {

namespace {

/// Over-relaxation takes heaps of some ten layers a tenth of the sweeps. Under friction it leaves
/// impulses that go up and down, which a last part of plain sweeps takes away.
constexpr double over = 1.9, over_for = 0.6;
/// Sweeps end when no impulse changes by more than this share of a disc's weight.
constexpr double small_change = 1e-5;
/// A held disc is left with less than this share of what gravity gives.
constexpr double held_below = 0.01;
constexpr std::uint32_t fixed = 0xffffffff;

double friction_of(const Surface& surface) { return surface.rubs() ? surface.friction : 0; }

} // namespace

/// With the normal (nx, ny) from a to b, which may be fixed, and the tangent (-ny, nx).
struct HeapBalance::Contact {
    std::uint32_t a = 0, b = fixed;
    int side = -1; ///< the wall, if it is one
    double nx = 0, ny = 0;
    double friction = 0, velocity = 0; ///< of the fixed surface, along the tangent
    double height = 0;
    double normal = 0, tangential = 0; ///< impulses on b
};

/// `turning` is the spin times the radius.
struct HeapBalance::Body {
    double vx = 0, vy = 0, turning = 0;
    double share = 1; ///< 1 over the mass
};

HeapBalance::HeapBalance(const Box& box, const Effects& effects)
    : box_(box), boundaries_(effects.boundaries), obstacles_(effects.obstacles),
      gravity_(effects.gravity), gap_(effects.rest.gap),
      pair_friction_(effects.contact.kind == ContactKind::rough &&
                             effects.contact.tangential_restitution != -1
                         ? effects.contact.friction
                         : 0),
      turning_(effects.contact.kind == ContactKind::rough ? 1 / effects.contact.inertia : 0) {}

void HeapBalance::add_pairs(std::span<const HeapDisc> discs, std::vector<Contact>& contacts) const {
    std::vector<std::uint32_t> order(discs.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        return std::tuple(discs[i].x, discs[i].id) < std::tuple(discs[j].x, discs[j].id);
    });
    double largest = 0;
    for (const HeapDisc& disc : discs) largest = std::max(largest, disc.radius);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const HeapDisc& left = discs[order[i]];
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            const HeapDisc& right = discs[order[j]];
            if (right.x - left.x > left.radius + largest + gap_) break;
            const double reach = left.radius + right.radius + gap_, dx = right.x - left.x,
                         dy = right.y - left.y, square = dx * dx + dy * dy;
            if (!(square < reach * reach) || square == 0) continue;
            const double distance = std::sqrt(square);
            Contact contact;
            contact.a = order[i];
            contact.b = order[j];
            contact.nx = dx / distance;
            contact.ny = dy / distance;
            contact.friction = pair_friction_;
            contacts.push_back(contact);
        }
    }
}

/// Walls that heat or move hold nothing.
void HeapBalance::add_walls(std::span<const HeapDisc> discs, std::vector<Contact>& contacts) const {
    for (int side = 0; side < 4; ++side) {
        const Boundary& wall = boundaries_[static_cast<std::size_t>(side)];
        if (wall.kind != BoundaryKind::wall) continue;
        for (std::uint32_t i = 0; i < discs.size(); ++i) {
            const double place = side < 2 ? discs[i].x : discs[i].y,
                         length = side < 2 ? box_.x : box_.y;
            const double distance = side % 2 == 0 ? place : length - place;
            if (!(distance < discs[i].radius + gap_)) continue;
            Contact contact;
            contact.a = i;
            contact.side = side;
            const double sign = side % 2 == 0 ? -1 : 1;
            contact.nx = side < 2 ? sign : 0;
            contact.ny = side < 2 ? 0 : sign;
            contact.friction = friction_of(wall.surface);
            // along +x or +y in the scene
            contact.velocity = wall.surface.velocity * (side < 2 ? contact.nx : -contact.ny);
            contacts.push_back(contact);
        }
    }
}

void HeapBalance::add_obstacles(std::span<const HeapDisc> discs,
                                std::vector<Contact>& contacts) const {
    const auto add = [&](std::uint32_t i, double x, double y, double radius) {
        const double dx = x - discs[i].x, dy = y - discs[i].y,
                     distance = std::sqrt(dx * dx + dy * dy);
        if (!(distance < discs[i].radius + radius + gap_) || distance == 0) return;
        Contact contact;
        contact.a = i;
        contact.nx = dx / distance;
        contact.ny = dy / distance;
        contact.friction = friction_of(obstacles_.surface);
        contact.velocity = -obstacles_.surface.velocity; // counterclockwise around the body
        contacts.push_back(contact);
    };
    for (std::uint32_t i = 0; i < discs.size(); ++i) {
        for (const FixedDisc& body : obstacles_.discs) add(i, body.x, body.y, body.radius);
        for (const Segment& line : obstacles_.segments) {
            const double ux = line.x1 - line.x0, uy = line.y1 - line.y0;
            const double share = std::clamp(((discs[i].x - line.x0) * ux +
                                             (discs[i].y - line.y0) * uy) /
                                                (ux * ux + uy * uy),
                                            0.0, 1.0);
            add(i, line.x0 + share * ux, line.y0 + share * uy, 0);
        }
    }
}

/// From the highest contact down.
std::vector<HeapBalance::Contact> HeapBalance::contacts_of(std::span<const HeapDisc> discs) const {
    std::vector<Contact> contacts;
    add_pairs(discs, contacts);
    add_walls(discs, contacts);
    add_obstacles(discs, contacts);
    for (Contact& contact : contacts) {
        const HeapDisc& disc = discs[contact.a];
        contact.height = -(gravity_.x * (disc.x + disc.radius * contact.nx) +
                           gravity_.y * (disc.y + disc.radius * contact.ny));
    }
    std::sort(contacts.begin(), contacts.end(), [&](const Contact& p, const Contact& q) {
        return std::tuple(-p.height, p.a, p.b, p.nx, p.ny) <
               std::tuple(-q.height, q.a, q.b, q.nx, q.ny);
    });
    return contacts;
}

/// Makes the impulses of one contact right for the present velocities. Returns by how much they
/// change.
double HeapBalance::push(Contact& contact, std::vector<Body>& bodies, double relaxation) const {
    Body& a = bodies[contact.a];
    Body none;
    none.share = 0;
    Body& b = contact.b == fixed ? none : bodies[contact.b];
    const double nx = contact.nx, ny = contact.ny, wx = b.vx - a.vx, wy = b.vy - a.vy;
    const double shares = a.share + b.share;
    const double normal = std::max(contact.normal - relaxation * (wx * nx + wy * ny) / shares, 0.0);
    const double pushed = normal - contact.normal;
    contact.normal = normal;
    double rubbed = 0;
    if (contact.friction > 0) {
        const double slip = contact.velocity + (wy * nx - wx * ny) - (a.turning + b.turning);
        const double most = normal == 0 ? 0 : contact.friction * normal;
        const double tangential = std::clamp(
            contact.tangential - relaxation * slip / (shares * (1 + turning_)), -most, most);
        rubbed = tangential - contact.tangential;
        contact.tangential = tangential;
    }
    const double ix = pushed * nx - rubbed * ny, iy = pushed * ny + rubbed * nx;
    a.vx -= a.share * ix;
    a.vy -= a.share * iy;
    a.turning -= a.share * turning_ * rubbed;
    b.vx += b.share * ix;
    b.vy += b.share * iy;
    b.turning -= b.share * turning_ * rubbed;
    return std::fabs(pushed) + std::fabs(rubbed);
}

HeapForces HeapBalance::find(std::span<const HeapDisc> discs) const {
    HeapForces forces;
    std::vector<Contact> contacts = contacts_of(discs);
    std::vector<Body> bodies(discs.size());
    const double pull = std::hypot(gravity_.x, gravity_.y);
    double least_mass = discs.empty() ? 1 : discs.front().mass;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        bodies[i] = {gravity_.x, gravity_.y, 0, 1 / discs[i].mass};
        least_mass = std::min(least_mass, discs[i].mass);
    }
    const double most = std::max(400.0, 40 * std::sqrt(static_cast<double>(discs.size())));
    double change = pull / least_mass;
    for (; forces.n_sweeps < most && change > small_change * pull * least_mass; ++forces.n_sweeps) {
        const double relaxation = forces.n_sweeps < over_for * most ? over : 1;
        change = 0;
        for (auto contact = contacts.rbegin(); contact != contacts.rend(); ++contact)
            change = std::max(change, push(*contact, bodies, relaxation));
    }
    forces.is_held.resize(discs.size());
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const Body& body = bodies[i];
        const double left = std::max({std::fabs(body.vx), std::fabs(body.vy),
                                      std::fabs(body.turning)});
        forces.is_held[i] = left < held_below * pull;
    }
    for (const Contact& contact : contacts)
        if (contact.side >= 0)
            forces.on_walls[static_cast<std::size_t>(contact.side)] += contact.normal;
    return forces;
}

} // namespace carrom
