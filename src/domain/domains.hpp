// SPDX-License-Identifier: BSD-3-Clause
// Assigns rectangles of the box to ranks. Strips cut the box along the strips' axis. Each strip
// belongs to a group of ranks that cut it again, across the axis. A group of one rank owns its
// whole strip. Pure arithmetic, no MPI.
//
// With few ranks groups have one rank, because a whole strip has the fewest neighbours. With many
// ranks whole strips would be so narrow that most discs of a rank would be halo. A rectangle that
// is about as wide as high has the smallest halo. Each strip has its own cuts, so that all domains
// can have equal work in any distribution of discs.
//
// As in strips.hpp, all lists follow from numbers that every rank knows. They are symmetric, and
// complete to the last bit.
#pragma once

#include <utility>
#include <vector>

#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "domain/strips.hpp"

namespace carrom {

/// A rectangle that a rank owns, along the strips' axis and across it.
struct Domain {
    Strip along, across;

    bool is_empty() const { return along.is_empty() || across.is_empty(); }
    bool holds(double place, double place_across) const {
        return along.holds(place) && across.holds(place_across);
    }
    /// Whether the domain is not empty and contains a position within `reach` of this one along
    /// each axis.
    bool is_within(double reach, double place, double place_across) const {
        return along.meets(place - reach, place + reach) &&
               across.meets(place_across - reach, place_across + reach);
    }
};

/// The domains cover all positions. The ranks of a group have consecutive numbers, and groups are
/// in the order of strips.
class Domains {
public:
    /// One domain that covers everything.
    Domains() : Domains(Strips()) {}
    /// Groups of one rank: each rank owns a whole strip.
    explicit Domains(Strips strips);
    /// `groups[k]` cuts strip k across. There is one for each strip.
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
    /// The disc's place along the strips' axis, and across it.
    std::pair<double, double> place_of(const DiscState& disc, double time) const {
        return turned(axis(), disc.x_at(time), disc.y_at(time));
    }
    /// The rank whose domain holds the place.
    int owner(double along, double across) const {
        const int strip = strips_.owner(along);
        return first_rank(strip) + (are_cut_across() ? group(strip).owner(across) : 0);
    }

    /// The other ranks r, ascending, such that a disc in one of the domains r and `rank` can lie
    /// within `reach` >= 0 of the other, along each axis. Cost: the number of ranks in the strips
    /// within reach.
    std::vector<int> neighbours_within(int rank, double reach) const;

    friend bool operator==(const Domains&, const Domains&) = default;

private:
    Strips strips_;
    std::vector<Strips> groups_; ///< the cuts across each strip
    /// The first rank of each strip, and the number of ranks at the end
    std::vector<int> first_ranks_;
};

/// The other ranks, ascending, that `rank` may have to send discs to or receive discs from. Discs
/// were in their owners' domains `before`, have moved by at most `distance` along each axis, and go
/// to their owners in `after`. Cost: the number of ranks.
std::vector<int> movers_between(const Domains& before, const Domains& after, int rank,
                                double distance);

/// The arguments for the choice of groups. Lengths are in any unit.
struct GroupNeeds {
    int n_ranks = 1;
    double n_discs = 0;           ///< number of discs on all ranks
    double length = 1, width = 1; ///< edges of the box along the strips' axis, and across it
    double halo = 0;              ///< depth of a rank's halo
    /// Whether the box is periodic in these directions
    bool is_periodic = false, is_periodic_across = false;
};

/// How many ranks share each strip. They differ by at most one. Strips stay whole unless groups
/// save enough of the halo, because domains have more neighbours than strips.
std::vector<int> choose_groups(const GroupNeeds& needs);
/// Sizes of groups that have `n_across` ranks, or one less.
std::vector<int> groups_of(int n_ranks, int n_across);

/// For each cut the share of the work below it, if the work of strips is proportional to their
/// groups' sizes.
std::vector<double> shares_below_cuts(const std::vector<int>& group_sizes);

} // namespace carrom
