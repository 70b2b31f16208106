// SPDX-License-Identifier: BSD-3-Clause
// An effect that acts at syncs. Between syncs discs fly and collide as without it.
//
// At a sync all states are at one time and in the box's own coordinates. The effect on a disc may
// depend on that disc's state, on discs near it, on exact sums over all discs, and on random
// numbers (functions of the seed, the disc and the number of syncs). So any number of ranks and
// threads gives the same bits, and a restart needs only the number of syncs and the values that an
// effect keeps (`kept`).
//
// The engine calls each effect once per sync, never for single pairs. Scenes without such an effect
// have an empty list of effects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/disc_state.hpp"
#include "core/exact_sum.hpp"
#include "core/random_numbers.hpp"
#include "dynamics/species.hpp"

namespace carrom {

/// The impulse and energy that a side of the box, or a fixed body, gives to discs at a sync.
struct WallImpulse {
    static constexpr std::size_t n_sides = 4;

    std::size_t side = 0;              ///< number of the side, or `n_sides` plus a fixed body's row
    double normal = 0;                 ///< impulse on discs, away from the side
    double along = 0;                  ///< impulse on discs along the side, towards +x or +y
    double energy = 0;                 ///< change of the discs' kinetic energy
    double ix = 0, iy = 0, torque = 0; ///< as in WallEvent; only for fixed bodies
};

/// The impulse between two discs at a sync.
struct PairImpulse {
    DiscId p = 0, q = 0;       ///< p is the lower id
    double x = 0, y = 0;       ///< centre of p
    double dx = 0, dy = 0;     ///< vector from the centre of p to the centre of q
    double ix = 0, iy = 0;     ///< impulse that p gets; q gets the opposite
    double p_vx = 0, p_vy = 0; ///< mean of p's velocities before and after the sync
    double q_vx = 0, q_vy = 0;
};

/// The discs of a rank at a sync, with velocities and spins per micro-step. Between sheared sides
/// velocities are relative to the flow, so that an effect acts as in a gas at rest.
struct SyncDiscs {
    const SpeciesTable& species;     ///< the radius and the mass of each disc
    std::span<DiscState> discs = {}; ///< includes departed discs, which effects must not change
    /// Spins in the order of `discs`; empty unless discs are rough
    std::span<double> spins = {};
    /// Angles in the order of `discs`; empty unless discs are active
    std::span<double> directions = {};
    /// Radii in the order of `discs`; empty unless discs exchange them
    std::span<double> radii = {};
    /// Number of syncs since the scene's start, including this one
    std::int64_t n_syncs = 0;

    using Part = std::function<void(std::size_t begin, std::size_t end)>;
    /// Calls `part` for ranges of indices that together cover all discs, on several threads in
    /// parallel. `part` must not throw.
    std::function<void(const Part& part)> in_parts = {};
    /// Calls `visit(index, other, distance)`, on one thread, for each disc of this rank and each
    /// other disc, or image of one, within the reach that effects have requested
    /// (SyncEffect::reach).
    using VisitNear = std::function<void(std::size_t index, DiscId other, double distance)>;
    std::function<void(const VisitNear& visit)> visit_near_pairs = {};
    /// Replaces each sum by its sum over all ranks. **Collective.**
    std::function<void(std::span<ExactSum>)> add_over_ranks = {};
    /// Returns, on every rank, the largest of the numbers that the ranks pass. **Collective.**
    std::function<double(double)> largest_over_ranks = {};
    /// Returns, on every rank, the bytes that all ranks pass, in order of rank. **Collective.**
    std::function<std::vector<std::byte>(std::span<const std::byte>)> gather_over_ranks = {};
    /// Records the impulse of a side or a fixed body, with times in micro-steps. Only one rank
    /// calls this, on behalf of all ranks. It is empty unless walls are measured.
    std::function<void(const WallImpulse&)> record_wall = {};
    /// Records the impulse between two discs, with times in micro-steps. Only one rank calls this,
    /// on behalf of all ranks. It is empty unless stress or pairs are measured.
    std::function<void(const PairImpulse&)> record_pair = {};

    /// Adds the terms of all discs in the box to `sums`, which must be 0. `term(i, parts)` adds the
    /// terms of disc i to `parts`, a copy of `sums`. **Collective.**
    template <class Term> void add_up(std::vector<ExactSum>& sums, const Term& term) const;
};

template <class Term> void SyncDiscs::add_up(std::vector<ExactSum>& sums, const Term& term) const {
    const std::vector<ExactSum> none = sums;
    std::mutex lock;
    in_parts([&](std::size_t begin, std::size_t end) {
        std::vector<ExactSum> mine = none;
        for (std::size_t i = begin; i < end; ++i)
            if (!discs[i].has_departed()) term(i, mine);
        const std::lock_guard guard(lock);
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += mine[k];
    });
    add_over_ranks(sums);
}

/// The common factor of the radii of all discs, for an effect that changes it at syncs. Positions
/// and velocities do not change. All functions return the same on all ranks.
class SizeChange {
public:
    virtual ~SizeChange() = default;

    /// The factor by which all radii are multiplied at present.
    virtual double size() const = 0;
    /// The largest value that the factor can have after this sync.
    virtual double largest_at(std::int64_t n_syncs) const = 0;
    /// Changes the factor of all radii. `room` is the largest factor at which no two discs overlap;
    /// it may exceed `largest_at`.
    virtual void change(std::int64_t n_syncs, double room) = 0;
};

/// A range of factors for the side of the box along x. The side along y is divided by the same
/// factor, so that the area does not change.
struct StretchRange {
    double least = 1, most = 1;
};

/// The sides of a periodic box, for an effect that changes them at syncs. The box keeps its area,
/// and positions are stretched with the sides. All functions return the same on all ranks.
class ShapeChange {
public:
    virtual ~ShapeChange() = default;

    /// The box with its present sides.
    virtual Box box() const = 0;
    /// The largest factor by which a change makes a side longer or shorter.
    virtual double largest_stretch() const = 0;
    /// Changes the sides. No two discs overlap after a stretch by a factor within `room`, which
    /// contains 1 and may be wider than `largest_stretch` allows.
    virtual void stretch(std::int64_t n_syncs, const StretchRange& room) = 0;
};

/// A disc that has come in through an open side during the interval before a sync. It enters at the
/// line where discs depart.
struct Arrival {
    std::size_t side = 0;
    DiscId first = 0, end = 0; ///< the disc gets an id from `first` to `end` - 1
    double flown = 0;          ///< time between the disc's arrival and the sync
    /// Position along the side: 0 and 1 are the ends of the range that the disc's centre may have
    double across = 0;
    bool has_low_wall = true, has_high_wall = true; ///< whether walls bound the side's two ends
    double inwards = 0, along = 0;                  ///< velocity at arrival, for a mass of 1
};

/// The numbers of arriving discs that came in, and of those that were not let in.
struct ArrivalCounts {
    std::uint64_t in = 0;            ///< discs that came in
    std::uint64_t without_place = 0; ///< not let in, because a disc or a fixed body was in the way
    std::uint64_t without_disc = 0;  ///< not let in, because no departed disc was left to return
};

/// Lets departed discs come back into the box. All functions return the same on all ranks.
class DiscSource {
public:
    virtual ~DiscSource() = default;

    virtual std::vector<Arrival> arrivals(std::int64_t n_syncs) const = 0;
    virtual void count(const ArrivalCounts& these) = 0;
};

class SyncEffect {
public:
    SyncEffect() = default;
    virtual ~SyncEffect() = default;
    SyncEffect(const SyncEffect&) = delete;
    SyncEffect& operator=(const SyncEffect&) = delete;

    /// Called before all other functions. `species` is the run's table; copies of it share memory.
    virtual void learn(const SpeciesTable& /*species*/) {}
    /// The largest distance of the pairs that the effect needs at this sync; 0 if it needs no
    /// pairs. It is the same on all ranks.
    virtual double reach(std::int64_t /*n_syncs*/) const { return 0; }
    /// Changes velocities, spins, directions and radii of discs, and nothing else. **Collective.**
    virtual void act(const SyncDiscs& at) = 0;
    /// The change of radii, for an effect that changes them; null for all others. At most one
    /// effect may change radii.
    virtual SizeChange* sizes() { return nullptr; }
    /// The change of the box's sides, for an effect that changes them; null for all others. Only an
    /// effect that changes radii may change sides.
    virtual ShapeChange* shape() { return nullptr; }
    /// The source of an effect that lets discs in; null for all others. At most one effect has one.
    virtual DiscSource* source() { return nullptr; }

    /// Whether `begin` does anything.
    virtual bool begins() const { return false; }
    /// Like `act`, but called immediately before the flights that follow a sync or the scene's
    /// start. Outputs at a sync contain the state between `act` and `begin`. **Collective.**
    virtual void begin(const SyncDiscs& /*at*/) {}

    /// The numbers, besides the states of discs, that the effect needs at the next sync; they are
    /// equal on all ranks. A checkpoint stores them, and a restart passes them to `go_on`.
    virtual std::vector<std::int64_t> kept() const { return {}; }
    virtual void go_on(std::span<const std::int64_t> /*kept*/) {}
};

using SyncEffects = std::vector<std::unique_ptr<SyncEffect>>;

} // namespace carrom
