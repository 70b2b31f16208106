// SPDX-License-Identifier: BSD-3-Clause
// Assigns rectangles of the box (domains) to ranks. Cuts along the strips' axis divide the box into
// strips. Each strip belongs to a group of ranks, which divide the strip across this axis. A group
// of one rank owns a whole strip. All of this is arithmetic without MPI.
//
// With few ranks each group has one rank, because whole strips have the fewest neighbours. With
// many ranks whole strips would be so narrow that a rank would have more halo discs than own discs.
// Rectangles that are almost squares have the smallest halos. Each strip has its own cuts, so that
// all domains can have equal work in any distribution of discs.
//
// All lists of ranks are computed from numbers that are equal on all ranks (see strips.hpp). So the
// lists are symmetric, and no disc is missed because of rounding.
#pragma once

#include <utility>
#include <vector>

#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "domain/strips.hpp"

namespace carrom {

/// A rectangle that a rank owns: its range along the strips' axis, and its range across it.
struct Domain {
    Strip along, across;

    bool is_empty() const { return along.is_empty() || across.is_empty(); }
    bool holds(double place, double place_across) const {
        return along.holds(place) && across.holds(place_across);
    }
    /// Whether the domain, which must not be empty, has a point that differs from the given
    /// position by at most `reach` along each axis.
    bool is_within(double reach, double place, double place_across) const {
        return along.meets(place - reach, place + reach) &&
               across.meets(place_across - reach, place_across + reach);
    }
};

/// The domains of all ranks, which together cover all positions. Ranks of a group have consecutive
/// numbers, and the groups have the order of the strips.
class Domains {
public:
    /// One domain that covers everything.
    Domains() : Domains(Strips()) {}
    /// Groups of one rank: each rank owns a whole strip.
    explicit Domains(Strips strips);
    /// `groups[k]` has the cuts across strip k; it needs one element for each strip.
    Domains(Strips strips, std::vector<Strips> groups);

    Axis axis() const { return strips_.axis(); }
    int size() const { return first_ranks_.back(); } ///< number of ranks
    int n_strips() const { return strips_.size(); }
    int largest_group() const;
    bool are_cut_across() const { return size() > n_strips(); }
    const Strips& strips() const { return strips_; }
    const Strips& group(int strip) const { return groups_[static_cast<std::size_t>(strip)]; }
    int first_rank(int strip) const { return first_ranks_[static_cast<std::size_t>(strip)]; }
    int strip_of(int rank) const;

    Domain of(int rank) const;
    bool is_empty(int rank) const { return of(rank).is_empty(); }
    /// The disc's coordinates along the strips' axis and across it.
    std::pair<double, double> place_of(const DiscState& disc, double time) const {
        return turned(axis(), disc.x_at(time), disc.y_at(time));
    }
    /// The rank whose domain contains the position.
    int owner(double along, double across) const {
        const int strip = strips_.owner(along);
        return first_rank(strip) + (are_cut_across() ? group(strip).owner(across) : 0);
    }

    /// The other ranks, ascending, whose domain has points within `reach` >= 0 of the domain of
    /// `rank`, along each axis. Discs of two such ranks may meet. The cost is proportional to the
    /// number of ranks in the strips within reach.
    std::vector<int> neighbours_within(int rank, double reach) const;

    /// The domains after the box has been stretched by these positive factors.
    Domains stretched(double along_x, double along_y) const;

    friend bool operator==(const Domains&, const Domains&) = default;

private:
    Strips strips_;
    std::vector<Strips> groups_; ///< the cuts across each strip
    /// First rank of each strip; the last element is the number of ranks
    std::vector<int> first_ranks_;
};

/// The other ranks, ascending, with which `rank` may exchange discs if the domains change. Discs
/// were in the domains `before`, have moved by at most `distance` along each axis, and go to the
/// owners in `after`. The cost is proportional to the number of ranks.
std::vector<int> movers_between(const Domains& before, const Domains& after, int rank,
                                double distance);

/// Input for choose_groups. All lengths have the same unit.
struct GroupNeeds {
    int n_ranks = 1;
    double n_discs = 0;           ///< number of discs on all ranks
    double length = 1, width = 1; ///< edges of the box along the strips' axis, and across it
    double halo = 0;              ///< depth of a rank's halo
    /// Whether the box is periodic along the strips' axis, and across it
    bool is_periodic = false, is_periodic_across = false;
};

/// The number of ranks in each strip; these numbers differ by at most one. Groups are used only if
/// they make the halos sufficiently smaller, because domains have more neighbours than strips.
std::vector<int> choose_groups(const GroupNeeds& needs);
/// Divides the ranks into groups of at most `n_across` ranks, whose sizes differ by at most one.
std::vector<int> groups_of(int n_ranks, int n_across);

/// For each cut, the share of the work below the cut. The work of strips is assumed to be
/// proportional to the sizes of their groups.
std::vector<double> shares_below_cuts(const std::vector<int>& group_sizes);

} // namespace carrom
