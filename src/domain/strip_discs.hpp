// SPDX-License-Identifier: BSD-3-Clause
// The discs of one rank: its own discs, in the order of their cells, followed by the halo that
// neighbours have sent. The rank owns a strip or a part of a strip (domains.hpp). This class
// migrates discs between ranks, sorts them, and fetches the halo.
//
// Cuts and bounds that are equal on all ranks determine which ranks exchange discs, so `farthest`
// and `reach` must be equal on all ranks. Cost of a migration with a new halo: two passes over the
// own discs, and two messages to each neighbour.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"
#include "core/disc_state.hpp"
#include "core/side_columns.hpp"
#include "domain/domains.hpp"
#include "domain/transfer.hpp"
#include "dynamics/effects.hpp"
#include "parallel/communicator.hpp"
#include "parallel/neighbour_exchange.hpp"

namespace carrom {

/// Settings for the number of ranks that share a strip. They only affect the speed of a run.
struct GroupChoice {
    double halo_spacings = 0; ///< usual depth of halos, in mean distances between discs
    /// If unset, it is chosen from the halo's depth, the box and the number of ranks
    std::optional<int> ranks_across;
};

/// The work of a rank, in a unit that is the same on all ranks. Work for pairs of close discs, such
/// as collisions, is counted separately, because it increases with the local density.
struct RankWork {
    std::uint64_t of_discs = 0, of_pairs = 0;

    std::uint64_t all() const { return of_discs + of_pairs; }
};

/// A disc that returns into the box, with its numbers in the side columns.
struct ReturningDisc {
    DiscState state;
    double numbers[n_side_columns] = {};
};

class StripDiscs {
public:
    /// `discs` may be in any distribution over the ranks. Sends each disc to the owner of its
    /// domain. Domains have equal areas, or equal numbers of discs if discs are clustered. In a
    /// periodic box, migration gives own discs their images in the box, and the halo may contain
    /// images of own discs. `columns` have the order of the discs; missing numbers are 0.
    /// **Collective.**
    StripDiscs(const Communicator& communicator, const Box& box, DiscStates discs,
               const Periods& periods, SideColumns columns, int n_threads,
               const GroupChoice& choice);

    /// Drops the halo and sends each own disc to the rank whose domain contains it at `time`. No
    /// disc may have moved by more than `farthest` since the last migration. `companion` holds a
    /// second state of each own disc, in the same order, or is null. **Collective.**
    void migrate(double time, double farthest, DiscStates* companion);

    /// Sorts the own discs, and all arrays with one element per disc, by the discs' cells at the
    /// time `anchor` (CellGrid::sort); the grid then has no halo. `companion`: see migrate.
    void sort(const GridGeometry& geometry, double anchor, double time, double duration,
              DiscStates* companion);
    /// Sorts the own discs into cells by their positions at `time`, for searches at that time only.
    void sort_cells(const GridGeometry& geometry, double time);

    /// Appends the discs within `reach` of the own domain at `time` to the own discs: discs of
    /// other ranks and, in periodic boxes, images of own discs. Sorts them into cells. The own
    /// discs must have been migrated and sorted for the same time. **Collective.**
    void fetch_halo(double time, double reach, DiscStates* companion);

    /// Adds discs up to the distance `reach` to the halos of ranks with `wants` true. These halos
    /// already hold all discs within `beyond`, which keep their indices. No updates can be sent
    /// until discs are sorted again. **Collective.**
    void fetch_more_halo(double time, double beyond, double reach, bool wants);

    /// Sends new states of own discs in `changed` to the ranks that have these discs in their halo.
    /// Receives new states for the own halo, and appends the indices of the updated halo discs to
    /// `updates`. **Collective.**
    void send_updates(std::span<const LocalIndex> changed, std::vector<LocalIndex>& updates);

    /// Sends the elements of `values`, one for each own disc, that other ranks need for their
    /// halos, and appends the elements for this rank's halo. **Collective.**
    template <class Values> void show(Values& values) {
        values.resize(n_own_);
        if (has_no_halo()) return;
        transfer(exchange_, halo_plan_, values, values, n_threads_);
        for (const HaloPart& part : more_halo_)
            transfer(exchange_, part.plan, values, values, n_threads_);
    }

    /// Reports each halo disc in `of_halo` to the rank that owns it. Appends to `reported` those
    /// own discs that other ranks report in the same call. **Collective.**
    void report_to_owners(std::span<const LocalIndex> of_halo, std::vector<LocalIndex>& reported);

    /// Moves the cuts so that all domains have equal work, if the largest `work` of a rank exceeds
    /// `above` times the mean. The cuts are computed from positions at `time`; the next migration
    /// sends them to their new owners. **Collective.**
    void rebalance(double time, double above, const RankWork& work);

    Population population() const { return {discs_, n_own_}; }
    const CellGrid& grid() const { return grid_; }
    CellGrid& grid() { return grid_; }
    /// Frees the memory of the cells.
    void drop_grid();
    DiscStates& all() { return discs_; }
    std::span<const DiscState> own() const { return std::span(discs_).first(n_own_); }
    std::span<DiscState> own() { return std::span(discs_).first(n_own_); }
    /// Side columns of all discs: first the own discs, then the halo.
    SideColumns& columns() { return columns_; }
    const SideColumns& columns() const { return columns_; }
    SideSpans own_columns() const {
        SideSpans own = columns_.spans();
        columns_.for_each([&](SideColumn column) { own[column] = own[column].first(n_own_); });
        return own;
    }
    std::size_t n_own() const { return n_own_; }
    std::uint64_t n_total() const { return n_total_; } ///< number of discs on all ranks
    const Domains& domains() const { return domains_; }
    /// The other ranks whose present halos may contain own discs of this rank.
    std::span<const int> neighbours() const {
        return periods_.are_any() ? other_partners_ : halo_plan_.partners;
    }

    const Periods& periods() const { return periods_; }
    /// Must be called after each sync, because the sync is the new time 0 of moving images.
    void set_periods(const Periods& periods) { periods_ = periods; }
    /// Changes the side lengths of a periodic box, and stretches domains and positions of own discs
    /// in proportion, each axis by its own factor. There must be no halo. Because of rounding, a
    /// stretched position may lie on the upper side of the box.
    void reshape(const Box& box);
    /// Whether no rank has a halo, because there is one rank and no periodic side.
    bool has_no_halo() const { return communicator_.size() == 1 && !periods_.are_any(); }
    /// Sets the images of own discs to (0, 0) until the next migration. If `are_in_box`, as after a
    /// sync, that migration tests only discs that were near the sides of the box when they were
    /// sorted.
    void forget_images(bool are_in_box = false);

    /// Like forget_images, but restore_images can restore the images until the next migration.
    /// Repeated calls cost little, because the discs with images are listed only once.
    void set_images_aside();
    void restore_images();

    /// The region of positions that a rank with a halo of `reach` uses, for a box of this extent.
    /// The box limits the region only along axes that are not periodic.
    Extent extent_seen(const Extent& box, double reach) const;

    /// Moves departed discs from the own discs to `departed()`, where they stay until take_back,
    /// and drops the halo. **Collective.**
    void set_departed_aside();
    /// Puts returning discs into the box, and drops the halo. All ranks must pass the same list;
    /// the rank whose domain contains a disc's position becomes its owner.
    void take_back(std::span<const ReturningDisc> discs);
    std::span<const DiscState> departed() const { return departed_; }
    /// Side columns of the departed discs, in the order of `departed()`
    const SideColumns& departed_columns() const { return departed_columns_; }
    /// Number of discs on all ranks, departed ones included.
    std::uint64_t n_with_departed() const { return n_with_departed_; }

    /// Removes the halo.
    void forget_halo() {
        more_halo_.clear();
        discs_.resize(n_own_);
        columns_.resize(n_own_);
    }

    /// Whether each own disc lies in this rank's domain at `time`, and all ranks together have each
    /// disc 0 .. n-1 once, including departed discs. **Collective.**
    bool is_valid(double time) const;

private:
    /// Halo discs that fetch_more_halo has added.
    struct HaloPart {
        TransferPlan plan;
        /// Index in `discs_` of each partner's first disc; the last element is the end of the last
        /// partner's discs
        std::vector<std::size_t> offsets;
    };

    template <class Values> void move_along(const TransferPlan& plan, Values& values);
    void set_home_images(double time, double farthest, DiscStates* companion);
    TransferPlan migration_plan(double time, double farthest) const;
    template <class Visit> void weigh(const RankWork& work, double unit, const Visit& visit) const;
    std::vector<PlaceRange> places_outside(const Inside& inner) const;
    std::pair<double, double> place_in_box(const DiscState& disc, double time) const;
    TransferPlan plan_of_halo(double time, const HaloDepth& depth) const;
    void report_part(const TransferPlan& plan, std::span<const std::size_t> offsets,
                     std::span<const LocalIndex> of_halo, std::vector<LocalIndex>& reported);
    Companions companions(DiscStates* states);

    /// The new state of a disc, and its index among the discs that this rank has sent to the halo
    /// of the partner.
    struct Update {
        DiscState disc;
        std::uint64_t place;
    };
    TransferPlan plan_updates(std::span<const LocalIndex> changed) const;
    void take_updates(std::span<const Update> items, std::size_t offset,
                      std::span<LocalIndex> updated);

    Communicator communicator_;
    int n_threads_;
    Box box_;
    Periods periods_;
    DiscStates discs_;    ///< own discs, then the halo
    SideColumns columns_; ///< side columns of the discs in `discs_`
    std::size_t n_own_ = 0;
    std::uint64_t n_total_, n_with_departed_;
    DiscStates departed_;          ///< departed discs, at the positions where they left
    SideColumns departed_columns_; ///< side columns of the departed discs
    std::vector<int> group_sizes_; ///< number of ranks in each strip
    Domains domains_,
        redistributed_domains_; ///< the present cuts, and the cuts at the last migration
    NeighbourExchange exchange_;
    CellGrid grid_;
    bool is_sorted_ = false; ///< whether own discs are still in the order of the grid
    /// Own discs with an image other than (0, 0), and this image
    std::vector<std::pair<LocalIndex, Image>> displaced_;
    /// Whether `displaced_` has been filled since the last migration
    bool are_displaced_listed_ = false;
    bool has_images_ = false; ///< if false, the next migration tests the images of all own discs
    TransferPlan halo_plan_;
    /// Neighbours except this rank itself, which is its own neighbour in a periodic box
    std::vector<int> other_partners_;
    std::vector<std::size_t> halo_offsets_; ///< where each partner's discs begin in `discs_`
    std::vector<HaloPart> more_halo_;
    std::vector<std::uint8_t> is_shown_; ///< whether a neighbour has the own disc in its halo
};

} // namespace carrom
