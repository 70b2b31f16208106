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
/// Sweeps end when no impulse changes by more than this share of the lightest disc's weight.
constexpr double small_change = 1e-4;
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
    double share = 0; ///< 1 over the mass, 0 of what stands fixed
};

HeapBalance::~HeapBalance() = default;

HeapBalance::HeapBalance(const Box& box, const Effects& effects)
    : box_(box), boundaries_(effects.boundaries), obstacles_(effects.obstacles),
      gravity_(effects.gravity), gap_(effects.rest.gap),
      pair_friction_(effects.contact.kind == ContactKind::rough &&
                             effects.contact.tangential_restitution != -1
                         ? effects.contact.friction
                         : 0),
      turning_(effects.contact.kind == ContactKind::rough ? 1 / effects.contact.inertia : 0) {}

void HeapBalance::add_pairs(std::span<const HeapDisc> discs) {
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
            contacts_.push_back(contact);
        }
    }
}

/// Walls that heat or move hold nothing.
void HeapBalance::add_walls(std::span<const HeapDisc> discs) {
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
            contacts_.push_back(contact);
        }
    }
}

void HeapBalance::add_obstacles(std::span<const HeapDisc> discs) {
    const auto add = [&](std::uint32_t i, double x, double y, double radius) {
        const double dx = x - discs[i].x, dy = y - discs[i].y, square = dx * dx + dy * dy,
                     reach = discs[i].radius + radius + gap_;
        if (!(square < reach * reach) || square == 0) return;
        const double distance = std::sqrt(square);
        Contact contact;
        contact.a = i;
        contact.nx = dx / distance;
        contact.ny = dy / distance;
        contact.friction = friction_of(obstacles_.surface);
        contact.velocity = -obstacles_.surface.velocity; // counterclockwise around the body
        contacts_.push_back(contact);
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

void HeapBalance::set_discs(std::span<const HeapDisc> discs) {
    contacts_.clear();
    shares_.clear();
    for (const HeapDisc& disc : discs) shares_.push_back(1 / disc.mass);
    add_pairs(discs);
    add_walls(discs);
    add_obstacles(discs);
    for (Contact& contact : contacts_) {
        const HeapDisc& disc = discs[contact.a];
        contact.height = -(gravity_.x * (disc.x + disc.radius * contact.nx) +
                           gravity_.y * (disc.y + disc.radius * contact.ny));
    }
    std::sort(contacts_.begin(), contacts_.end(), [](const Contact& p, const Contact& q) {
        return std::tuple(p.height, p.a, p.b, p.nx, p.ny) <
               std::tuple(q.height, q.a, q.b, q.nx, q.ny);
    });
}

/// Makes the impulses of one contact right for the present velocities. Returns by how much they
/// change.
double HeapBalance::push(Contact& contact, std::vector<Body>& bodies, double relaxation) const {
    Body& a = bodies[contact.a];
    Body none;
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

double HeapBalance::left_of(const Body& body) const {
    return std::max({std::fabs(body.vx), std::fabs(body.vy), std::fabs(body.turning)}) /
           std::hypot(gravity_.x, gravity_.y);
}

HeapForces HeapBalance::find(std::span<const std::uint8_t> is_free) const {
    HeapForces forces;
    std::vector<Body> bodies(shares_.size());
    double largest_share = 0, n_free = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (is_free[i] == 0) continue;
        bodies[i] = {gravity_.x, gravity_.y, 0, shares_[i]};
        largest_share = std::max(largest_share, shares_[i]);
        n_free += 1;
    }
    std::vector<Contact> contacts;
    for (const Contact& contact : contacts_)
        if (is_free[contact.a] != 0 || (contact.b != fixed && is_free[contact.b] != 0))
            contacts.push_back(contact);
    const double most = std::min(400.0, 40 * std::sqrt(n_free));
    const double small = small_change * std::hypot(gravity_.x, gravity_.y) / largest_share;
    for (double change = 2 * small; forces.n_sweeps < most && change > small; ++forces.n_sweeps) {
        const double relaxation = forces.n_sweeps < over_for * most ? over : 1;
        change = 0;
        for (Contact& contact : contacts)
            change = std::max(change, push(contact, bodies, relaxation));
    }
    for (std::size_t i = 0; i < bodies.size(); ++i)
        forces.left.push_back(is_free[i] != 0 ? left_of(bodies[i]) : 0);
    for (const Contact& contact : contacts) {
        if (contact.side < 0) continue;
        const auto side = static_cast<std::size_t>(contact.side);
        forces.normal[side] += contact.normal;
        // The tangent is (-ny, nx), and impulses are on the wall.
        forces.along[side] -= contact.tangential * (side < 2 ? contact.nx : -contact.ny);
    }
    return forces;
}

} // namespace carrom
