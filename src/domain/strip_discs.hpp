// SPDX-License-Identifier: BSD-3-Clause
// The discs of one rank: its own, in the order of their cells, and behind them the halo that its
// neighbours have sent. Moves them between ranks: migrate, sort, fetch the halo.
//
// Who may send to whom follows from the cuts and from bounds that all ranks share; so `farthest`
// and `reach` must be the same on all ranks. Price: two passes over the own
// discs, and two messages to each neighbour.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"
#include "core/disc.hpp"
#include "core/side_columns.hpp"
#include "domain/strips.hpp"
#include "domain/transfer.hpp"
#include "dynamics/effects.hpp"
#include "parallel/communicator.hpp"
#include "parallel/neighbour_exchange.hpp"

namespace carrom {

class StripDiscs {
public:
    /// Takes discs that lie anywhere on any rank and gives them to the owners of equal strips.
    /// **Collective.** Where there are periods, own discs get the images in the box when they
    /// migrate, and the halo has images of own discs, too. `columns` run along the discs; what
    /// they leave out is 0.
    StripDiscs(const Communicator& communicator, const Box& box, std::vector<Disc> discs,
               const Periods& periods = {}, SideColumns columns = {});

    /// Forgets the halo and sends each own disc to the rank whose strip holds it at `time`. No disc
    /// has moved by more than `farthest` since the last migration. `companion` runs along the own
    /// discs, or is null. **Collective.**
    void migrate(double time, double farthest, std::vector<Disc>* companion);

    /// Brings the own discs, and what runs along them, into the order of their cells at `anchor`
    /// (CellGrid::sort), without a halo. `companion` as above.
    void sort(const GridGeometry& geometry, double anchor, double time, double duration,
              int n_threads, std::vector<Disc>* companion);
    /// The same without flights.
    void sort_cells(const GridGeometry& geometry, double time, int n_threads);

    /// Appends to the own discs those of other ranks within `reach` of the own strip at `time`, and
    /// puts them into cells. The own discs have migrated and been sorted for the same time.
    /// **Collective.**
    void fetch_halo(double time, double reach, std::vector<Disc>* companion);

    /// Sends the new states of the own discs among `changed` to the ranks that have them in their
    /// halo. Takes over those of the own halo, and appends their places to `updates`.
    /// **Collective.**
    void send_updates(std::span<const LocalIndex> changed, std::vector<LocalIndex>& updates);

    /// Of values that run along the own discs, sends those of discs in other ranks' halos; puts
    /// those of the own halo's discs behind the own ones. **Collective.**
    template <Message T> void show(std::vector<T>& values) {
        values.resize(n_own_);
        if (has_no_halo()) return;
        Received<T> in;
        transfer(exchange_, halo_plan_, std::span<const T>(values), in);
        values.insert(values.end(), in.items.begin(), in.items.end());
    }

    /// Reports discs of the halo to their owners. Appends to `reported` the own discs that others
    /// have reported. **Collective.**
    void report_to_owners(std::span<const LocalIndex> of_halo, std::vector<LocalIndex>& reported);

    /// Moves the cuts to equal shares by the discs' places at `time`, if the largest share exceeds
    /// the mean by a factor of more than `above`. The discs follow when they migrate next.
    /// **Collective.**
    void rebalance(double time, double above);

    Population population() const { return {discs_, n_own_}; }
    const CellGrid& grid() const { return grid_; }
    CellGrid& grid() { return grid_; }
    /// Gives back what the cells take.
    void drop_grid();
    std::vector<Disc>& all() { return discs_; }
    std::span<const Disc> own() const { return std::span(discs_).first(n_own_); }
    std::span<Disc> own() { return std::span(discs_).first(n_own_); }
    /// By disc, own and halo.
    SideColumns& columns() { return columns_; }
    const SideColumns& columns() const { return columns_; }
    SideSpans own_columns() const {
        SideSpans own = columns_.spans();
        columns_.for_each([&](SideColumn column) { own[column] = own[column].first(n_own_); });
        return own;
    }
    std::size_t n_own() const { return n_own_; }
    std::uint64_t n_total() const { return n_total_; } ///< over all ranks
    const Strips& strips() const { return strips_; }
    /// Other ranks in whose halo own discs are, since it was fetched.
    std::span<const int> neighbours() const {
        return periods_.are_any() ? other_partners_ : halo_plan_.partners;
    }

    const Periods& periods() const { return periods_; }
    /// After a sync: boxes that move are elsewhere.
    void set_periods(const Periods& periods) { periods_ = periods; }
    /// Whether no rank has a halo, for want of neighbours.
    bool has_no_halo() const { return communicator_.size() == 1 && !periods_.are_any(); }
    /// Takes the images of own discs away.
    void forget_images();

    /// What a rank looks at that has a halo of `reach`, in a box of this extent where it is not
    /// periodic.
    Extent extent_seen(const Extent& box, double reach) const;

    /// Takes discs that have left the box out of the own ones, for good, and forgets the halo.
    /// **Collective.**
    void set_departed_aside();
    std::span<const Disc> departed() const { return departed_; }
    const SideColumns& departed_columns() const { return departed_columns_; } ///< along them
    std::uint64_t n_with_departed() const { return n_with_departed_; }        ///< over all ranks

    /// Drops the halo's discs.
    void forget_halo() {
        discs_.resize(n_own_);
        columns_.resize(n_own_);
    }

    /// Each own disc lies in its strip at `time`, and all ranks together own each of 0 .. n-1 once,
    /// departed ones too. **Collective.**
    bool is_valid(double time) const;

private:
    template <Message T> void move_along(const TransferPlan& plan, std::vector<T>& values);
    void set_home_images(double time, double farthest, std::vector<Disc>* companion);
    TransferPlan migration_plan(double time, double farthest) const;
    std::vector<PlaceRange> places_outside(const Inside& inner) const;
    Companions companions(std::vector<Disc>* states);

    Communicator communicator_;
    double length_; ///< of the box along the strips' axis
    Periods periods_;
    std::vector<Disc> discs_; ///< own, then halo
    SideColumns columns_;     ///< likewise
    std::size_t n_own_ = 0;
    std::uint64_t n_total_ = 0, n_with_departed_ = 0;
    std::vector<Disc> departed_;   ///< where they have left
    SideColumns departed_columns_; ///< along them
    Strips strips_,
        redistributed_strips_; ///< wanted, and those of the last migration
    NeighbourExchange exchange_;
    CellGrid grid_;
    bool is_sorted_ = false;  ///< whether the grid has the own discs' places
    bool has_images_ = false; ///< whether own discs had the images at home when they were sorted
    TransferPlan halo_plan_;
    std::vector<int> other_partners_;       ///< of a periodic box, where a rank is its own partner
    std::vector<std::size_t> halo_offsets_; ///< of each partner's discs behind the own ones
    std::vector<std::uint8_t> is_shown_;    ///< by own disc: whether a partner has it in its halo
};

} // namespace carrom
