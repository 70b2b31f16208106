// SPDX-License-Identifier: BSD-3-Clause
// The kernels of the time-stepped method on a device, in the order in which a window runs them.
// Each kernel is a functor, and its call with i is the work of thread i. A machine
// (serial_machine.hpp, cuda_machine.hpp) calls it for all i, so that the same code runs on a GPU
// and, in tests, on the CPU.
//
//   PutIntoCells, Scatter    sort discs by their cells
//   Predict                  finds the first candidate of each disc
//
// and for each micro-step
//
//   Collect      lists the discs whose first candidate is in this micro-step
//   Match        marks discs as taken if they are each other's first candidate; other discs wait
//   Waiting      in rounds: waiting discs whose partner has been taken search again, then match
//   Carry        carries out the events of the discs that have been taken
//   Mark         lists the discs whose first candidate may have changed
//   Renew        finds the first candidate of these discs
//   EndMicroStep empties the lists, and cuts the window short if discs are too fast for it
//
// At a sync Restart advances all discs. Threads of a kernel are independent, except in the rounds,
// where the threads of a block wait for each other.
#pragma once

#include "gpu/world.hpp"

namespace carrom {

/// Resets the counters of a window, but not the totals since the stepper was made. `forgets_speed`
/// also resets the largest speed, after a sync.
template <class D> struct Begin {
    World<D> world;
    bool forgets_speed;

    CARROM_DEVICE void operator()(std::uint32_t /*i*/) const {
        world.counters->n_micro = world.counters->is_cut = 0;
        if (forgets_speed) world.counters->squared_speed = {};
    }
};

/// Computes the cell of slot i's disc and the disc's place in it. In a periodic box the disc
/// becomes the image that is in the box at the window's anchor.
template <class D> struct PutIntoCells {
    World<D> world;
    std::uint32_t *counts, *place_in_cell;

    CARROM_DEVICE std::uint32_t cell_of(const DiscState& disc) const {
        const double time = world.window.anchor();
        if constexpr (D::is_periodic) {
            const Periods& periods = world.dynamics.periods();
            return world.cells.of(periods.x_of(disc, time), periods.y_of(disc, time));
        } else {
            return world.cells.of(disc.x_at(time), disc.y_at(time));
        }
    }
    CARROM_DEVICE void operator()(std::uint32_t i) const {
        DiscState& disc = world.discs[i];
        if constexpr (D::is_periodic)
            set_image(disc, world.dynamics.periods().home(disc, world.window.anchor()));
        place_in_cell[i] = fetch_add(counts[cell_of(disc)], 1);
    }
};

/// Copies the disc of slot i to its place in its cell.
template <class D> struct Scatter {
    PutIntoCells<D> put;
    DiscState* sorted;

    CARROM_DEVICE void operator()(std::uint32_t i) const {
        const DiscState disc = put.world.discs[i];
        const std::uint32_t cell = put.cell_of(disc),
                            slot = put.world.cells.begins[cell] + put.place_in_cell[i];
        sorted[slot] = disc;
        put.world.cell[slot] = cell;
    }
};

template <class D> struct Predict {
    World<D> world;

    CARROM_DEVICE void operator()(std::uint32_t k) const {
        world.set_event(k, world.first_event(k, world.window.first_micro, false));
        world.taken[k] = 0;
        world.is_listed[k] = 0;
    }
};

/// Thread i handles eight discs, because most discs have no candidate in this micro-step.
template <class D> struct Collect {
    static constexpr std::uint32_t at_once = 8;
    World<D> world;
    int m;

    CARROM_DEVICE void operator()(std::uint32_t i) const {
        if (world.counters->is_cut != 0) return;
        const std::uint8_t wanted = world.number_of(m);
        const std::uint32_t end = std::min(world.n, (i + 1) * at_once);
        for (LocalIndex k = i * at_once; k < end; ++k)
            if (world.micro[k] == wanted) world.active[fetch_add(world.counters->n_active, 1)] = k;
    }
};

/// Whether disc k's first candidate, which must be in micro-step m, is a wall or a disc whose own
/// first candidate is disc k.
template <class D> CARROM_DEVICE bool is_mutual(const World<D>& world, LocalIndex k, int m) {
    const LocalIndex partner = world.partner[k];
    return partner == wall_index ||
           (world.micro[partner] == world.number_of(m) && world.partner[partner] == k);
}

template <class D> struct Match {
    World<D> world;
    int m;

    CARROM_DEVICE void operator()(std::uint32_t i) const {
        const LocalIndex k = world.active[i];
        carrom::add(world.counters->n_candidates, count(k));
        if (is_mutual(world, k, m))
            world.taken[k] = 1;
        else
            world.waiting[0][fetch_add(world.counters->n_waiting[0], 1)] = k;
    }

private:
    /// Counts disc k's candidates in this micro-step; a pair is counted at its disc with the lower
    /// id.
    CARROM_DEVICE std::uint64_t count(LocalIndex k) const {
        const DiscState disc = world.discs[k];
        std::uint64_t n = world.dynamics.may_meet_wall(disc, m + 1) &&
                          StepWalls(world.dynamics).time(disc, m) != never;
        world.for_each_meeting(k, m, [&](const NextEvent& event) {
            n += event.micro == world.number_of(m) && disc.id < world.discs[event.partner].id;
        });
        return n;
    }
};

/// Rounds over the discs that wait. In each round the first of all remaining candidates is mutual,
/// so at least one disc is taken and the rounds end.
template <class D> struct Waiting {
    World<D> world;
    int m;

    CARROM_DEVICE static int counter_of(int round) {
        return round < rounds_of_all ? round : rounds_of_all + (round - rounds_of_all) % 2;
    }
    CARROM_DEVICE const std::uint32_t* size(int round) const {
        return &world.counters->n_waiting[counter_of(round)];
    }
    /// Empties the list of the next round; only one thread may call it.
    CARROM_DEVICE void begin(int round) const {
        world.counters->n_waiting[counter_of(round + 1)] = 0;
    }
    CARROM_DEVICE void search(int round, std::uint32_t i) const {
        const LocalIndex k = world.waiting[round % 2][i], partner = world.partner[k];
        // the partner is a disc, because walls have been handled already
        if (world.taken[partner] == 0) return;
        NextEvent next = world.first_event(k, m, true);
        if (next.micro != world.number_of(m)) next = {};
        world.set_event(k, next);
    }
    CARROM_DEVICE void match(int round, std::uint32_t i) const {
        const LocalIndex k = world.waiting[round % 2][i];
        if (world.partner[k] == no_partner) return;
        if (is_mutual(world, k, m)) {
            world.taken[k] = 1;
            return;
        }
        std::uint32_t& n_next = world.counters->n_waiting[counter_of(round + 1)];
        world.waiting[(round + 1) % 2][fetch_add(n_next, 1)] = k;
    }
};

/// The thread of the disc with the lower id carries out the collision of a pair.
template <class D> struct Carry {
    World<D> world;
    int m;

    CARROM_DEVICE void operator()(std::uint32_t i) const {
        const LocalIndex k = world.active[i];
        world.is_listed[k] = 1;
        world.changed[fetch_add(world.counters->n_changed, 1)] = k;
        if (world.taken[k] == 0) return;
        const NextEvent event = world.event(k);
        if (event.partner == wall_index)
            bounce(k, event);
        else if (world.discs[k].id < world.discs[event.partner].id)
            collide(k, event, i);
    }

private:
    CARROM_DEVICE void bounce(LocalIndex k, const NextEvent& event) const {
        DiscState disc = world.discs[k];
        const WallStress<D> before(disc);
        StepWalls(world.dynamics).bounce(disc, m, event.time, nullptr);
        world.discs[k] = disc;
        carrom::add(world.counters->n_kept, 1);
        if (world.stress_scale == 0) return;
        DeviceStress sums = world.stress(k);
        DeviceTerms terms;
        before.add_to(terms, sums, world.dynamics, disc, m + event.time, world.flown);
    }
    CARROM_DEVICE void collide(LocalIndex k, const NextEvent& event, std::uint32_t thread) const {
        const D& dynamics = world.dynamics;
        const Image image{event.image_x, event.image_y};
        DiscState p = world.discs[k], q = world.displaced(event.partner, image);
        const PairStress<D> before(p, q);
        const Separation to = dynamics.separation_at(p, q, m + event.time);
        dynamics.collide(p, q, m + event.time, never);
        StepWalls(dynamics).stop(p, m, event.time);
        StepWalls(dynamics).stop(q, m, event.time);
        if (world.stress_scale != 0) {
            DeviceStress sums = world.stress(thread);
            DeviceTerms terms;
            before.add_to(terms, sums, dynamics, p, q, to, m + event.time, world.flown);
        }
        if constexpr (D::is_periodic) move_image(q, -image);
        world.discs[k] = p;
        world.discs[event.partner] = q;
        carrom::add(world.counters->n_kept, 1);
        world.counters->squared_speed.offer(
            std::max(dynamics.squared_speed(p), dynamics.squared_speed(q)));
    }
};

/// Lists discs near a disc that has a new state: those whose first candidate was with this disc,
/// and those that meet it, in the new state, before their first candidate.
template <class D> struct Mark {
    World<D> world;
    int m;

    CARROM_DEVICE void operator()(std::uint32_t i) const {
        const LocalIndex k = world.active[i];
        if (world.taken[k] == 0) return;
        const DiscState p = world.discs[k];
        world.cells.for_each_near(world.cell[k], [&](LocalIndex other, Image image) {
            if (other == k || world.is_listed[other] != 0) return;
            if (world.partner[other] != k && !comes_first(k, p, other, image)) return;
            if (raise(world.is_listed[other]))
                world.changed[fetch_add(world.counters->n_changed, 1)] = other;
        });
    }

private:
    CARROM_DEVICE bool comes_first(LocalIndex k, const DiscState& p, LocalIndex other,
                                   Image image) const {
        if (!world.dynamics.has_pairs()) return false;
        NextEvent event = world.meeting(p, other, image, m + 1);
        if (event.partner == no_partner) return false;
        event.partner = k; // the same event as stored at the other disc
        event.image_x = static_cast<std::int16_t>(-image.x);
        event.image_y = static_cast<std::int16_t>(-image.y);
        return world.is_before(other, event, world.event(other));
    }
};

template <class D> struct Renew {
    World<D> world;
    int m;

    CARROM_DEVICE void operator()(std::uint32_t i) const {
        const LocalIndex k = world.changed[i];
        world.set_event(k, world.first_event(k, m + 1, false));
        world.taken[k] = 0;
        world.is_listed[k] = 0;
    }
};

template <class D> struct EndMicroStep {
    World<D> world;

    CARROM_DEVICE void operator()(std::uint32_t /*i*/) const {
        DeviceCounters& counters = *world.counters;
        counters.n_active = counters.n_changed = 0;
        for (std::uint32_t& n : counters.n_waiting) n = 0;
        if (counters.is_cut != 0) return;
        counters.n_micro += 1;
        counters.is_cut = counters.squared_speed.value() > world.squared_window_speed ? 1 : 0;
    }
};

/// Carries out a sync: advances all discs to the time of the sync, which is time 0 afterwards.
template <class D> struct Restart {
    World<D> world;
    double time; ///< time of the sync
    bool ends_flights;

    CARROM_DEVICE void operator()(std::uint32_t i) const {
        DiscState disc = world.discs[i];
        if (ends_flights && world.stress_scale != 0) {
            FlightIntegral flight = world.dynamics.flight_integral_at(time);
            flight.weight += world.flown;
            DeviceStress sums = world.stress(i);
            DeviceTerms terms;
            add_flight_to(terms, sums, world.dynamics.mass_of(disc), disc, flight);
        }
        D::advance(disc, time);
        if constexpr (D::is_periodic) {
            world.dynamics.wrap(disc);
            set_image(disc, {});
        }
        disc.tau = 0;
        disc.has_collided = 0;
        world.discs[i] = disc;
        world.counters->squared_speed.offer(world.dynamics.squared_speed(disc));
    }
};

} // namespace carrom
