// SPDX-License-Identifier: BSD-3-Clause
// The discs of one rank: its own, in the order of their cells, and behind them the halo that its
// neighbours have sent. The rank owns a strip, or a part of one (domains.hpp). This class moves
// discs between ranks: it migrates and sorts them, and fetches the halo.
//
// Which ranks exchange discs follows from cuts and bounds that all ranks know, so `farthest` and
// `reach` must be the same on all ranks. Price: two passes over the own discs, and two messages to
// each neighbour.
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

/// How many ranks share a strip. It affects the cost only.
struct GroupChoice {
    double halo_spacings = 0; ///< usual depth of halos, in mean distances between discs
    /// If unset, it is chosen from the halo's depth, the box and the number of ranks
    std::optional<int> ranks_across;
};

/// The work of a rank, in any unit that is the same on all ranks. Work for pairs of near discs,
/// such as collisions, is counted separately, because it grows with the density around a disc.
struct RankWork {
    std::uint64_t of_discs = 0, of_pairs = 0;

    std::uint64_t all() const { return of_discs + of_pairs; }
};

/// A disc that comes back into the box, with its numbers in the columns that discs have.
struct ReturningDisc {
    DiscState state;
    double numbers[n_side_columns] = {};
};

class StripDiscs {
public:
    /// Takes discs in any distribution and gives them to the owners of equal domains.
    /// In a periodic box own discs get the images in the box when they migrate, and
    /// the halo has images of own discs, too. `columns` run along the discs; missing
    /// numbers are 0. **Collective.**
    StripDiscs(const Communicator& communicator, const Box& box, DiscStates discs,
               const Periods& periods, SideColumns columns, int n_threads,
               const GroupChoice& choice);

    /// Forgets the halo and sends each own disc to the rank whose domain holds it at `time`. No
    /// disc has moved by more than `farthest` since the last migration. `companion` runs along the
    /// own discs, or is null. **Collective.**
    void migrate(double time, double farthest, DiscStates* companion);

    /// Brings the own discs, and all arrays along them, into the order of their cells
    /// at `anchor` (CellGrid::sort), without a halo. `companion`: see migrate.
    void sort(const GridGeometry& geometry, double anchor, double time, double duration,
              DiscStates* companion);
    /// Sorts into cells without flights.
    void sort_cells(const GridGeometry& geometry, double time);

    /// Appends to the own discs those of other ranks within `reach` of the own domain at `time`,
    /// and puts them into cells. The own discs have migrated and been sorted for the same time.
    /// **Collective.**
    void fetch_halo(double time, double reach, DiscStates* companion);

    /// Adds the discs within `reach` to the halos of those ranks that `want` it. Their halos hold
    /// the discs within `beyond` already, which keep their places. Until discs are sorted again,
    /// there are no updates. **Collective.**
    void fetch_more_halo(double time, double beyond, double reach, bool wants);

    /// Sends the new states of the own discs among `changed` to the ranks that have them in their
    /// halo. Updates the own halo in the same way, and appends the places of its updated discs to
    /// `updates`. **Collective.**
    void send_updates(std::span<const LocalIndex> changed, std::vector<LocalIndex>& updates);

    /// `values` has one element for each own disc. Sends the values of discs in other ranks' halos,
    /// and appends the values of this halo's discs. **Collective.**
    template <class Values> void show(Values& values) {
        values.resize(n_own_);
        if (has_no_halo()) return;
        transfer(exchange_, halo_plan_, values, values, n_threads_);
        for (const HaloPart& part : more_halo_)
            transfer(exchange_, part.plan, values, values, n_threads_);
    }

    /// Sends discs of the halo to their owners. Appends the own discs that other ranks have sent to
    /// `reported`. **Collective.**
    void report_to_owners(std::span<const LocalIndex> of_halo, std::vector<LocalIndex>& reported);

    /// Moves the cuts so that all domains have equal shares of the `work` that ranks have done
    /// lately, if the largest share exceeds the mean by more than the factor `above`. Discs count
    /// where they are at `time`; the next migration moves them. **Collective.**
    void rebalance(double time, double above, const RankWork& work);

    Population population() const { return {discs_, n_own_}; }
    const CellGrid& grid() const { return grid_; }
    CellGrid& grid() { return grid_; }
    /// Frees the memory of the cells.
    void drop_grid();
    DiscStates& all() { return discs_; }
    std::span<const DiscState> own() const { return std::span(discs_).first(n_own_); }
    std::span<DiscState> own() { return std::span(discs_).first(n_own_); }
    /// Numbers of all discs, own and halo.
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
    /// The other ranks that had own discs in their halo when it was fetched.
    std::span<const int> neighbours() const {
        return periods_.are_any() ? other_partners_ : halo_plan_.partners;
    }

    const Periods& periods() const { return periods_; }
    /// Call it after a sync, because moving images are then elsewhere.
    void set_periods(const Periods& periods) { periods_ = periods; }
    /// Whether no rank has a halo, because there are no neighbours.
    bool has_no_halo() const { return communicator_.size() == 1 && !periods_.are_any(); }
    /// Own discs have no images until the next migration. If all of them are in the box, as after a
    /// sync, only discs that were near its sides when they were sorted can need an image then.
    void forget_images(bool are_in_box = false);

    /// As forget_images, but the images can be restored until the next migration. Each costs little
    /// after the first one, because no image changes until then.
    void set_images_aside();
    void restore_images();

    /// The positions that a rank with a halo of `reach` uses, in a box of this extent. The box
    /// limits them only along axes that are not periodic.
    Extent extent_seen(const Extent& box, double reach) const;

    /// Removes discs that have left the box from the own ones for good, and drops the halo.
    /// **Collective.**
    void set_departed_aside();
    /// Takes departed discs, the same ones on all ranks, into the box, and drops the halo. The rank
    /// whose domain contains a disc's state owns the disc.
    void take_back(std::span<const ReturningDisc> discs);
    std::span<const DiscState> departed() const { return departed_; }
    /// Numbers of the departed discs, in the order of `departed()`
    const SideColumns& departed_columns() const { return departed_columns_; }
    /// Number of discs on all ranks, departed ones included.
    std::uint64_t n_with_departed() const { return n_with_departed_; }

    /// Drops the discs of the halo.
    void forget_halo() {
        more_halo_.clear();
        discs_.resize(n_own_);
        columns_.resize(n_own_);
    }

    /// Whether each own disc lies in its domain at `time`, and all ranks together have
    /// each of 0 .. n-1 once, departed ones included. **Collective.**
    bool is_valid(double time) const;

private:
    /// Discs that were added to the halo later.
    struct HaloPart {
        TransferPlan plan;
        std::vector<std::size_t> offsets; ///< where each partner's discs begin, and the end
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

    /// New state of a disc, and its place in the neighbour's halo.
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
    SideColumns columns_; ///< numbers of these discs
    std::size_t n_own_ = 0;
    std::uint64_t n_total_, n_with_departed_;
    DiscStates departed_;          ///< departed discs, at the positions where they left
    SideColumns departed_columns_; ///< numbers of the departed discs
    std::vector<int> group_sizes_; ///< number of ranks in each strip
    Domains domains_,
        redistributed_domains_; ///< the present cuts, and the cuts at the last migration
    NeighbourExchange exchange_;
    CellGrid grid_;
    bool is_sorted_ = false; ///< the grid has the own discs' places
    /// own discs with an image, and the image
    std::vector<std::pair<LocalIndex, Image>> displaced_;
    bool are_displaced_listed_ = false; ///< whether they have been listed since the last migration
    bool has_images_ = false; ///< own discs had their images in the box when they were sorted
    TransferPlan halo_plan_;
    /// Neighbours without this rank; in a periodic box a rank is also a neighbour of itself
    std::vector<int> other_partners_;
    std::vector<std::size_t> halo_offsets_; ///< where each partner's discs begin
    std::vector<HaloPart> more_halo_;
    std::vector<std::uint8_t> is_shown_; ///< whether a neighbour has the own disc in its halo
};

} // namespace carrom
