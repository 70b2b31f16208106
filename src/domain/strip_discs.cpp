// SPDX-License-Identifier: BSD-3-Clause
#include "domain/strip_discs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/errors.hpp"
#include "domain/domain_cuts.hpp"
#include "domain/hand_to_owners.hpp"
#include "domain/transfer_in_parts.hpp"

namespace carrom {

namespace {

/// The axis along which strips follow each other. Under shear, rows of boxes slide along x; strips
/// then follow each other along y, so that only the first and the last strip have moving images.
Axis cut_axis(const Box& box, const Periods& periods) {
    return periods.are_moving() ? Axis::y : longer_axis(box);
}

/// The sizes of the groups of ranks. The halo's depth is converted from disc spacings to a length.
std::vector<int> group_sizes(const Box& box, const Periods& periods, int n_ranks,
                             std::uint64_t n_discs, const GroupChoice& choice) {
    if (choice.ranks_across) return groups_of(n_ranks, std::min(*choice.ranks_across, n_ranks));
    const Axis axis = cut_axis(box, periods);
    GroupNeeds needs;
    needs.n_ranks = n_ranks;
    needs.n_discs = static_cast<double>(n_discs);
    needs.length = along(axis, box);
    needs.width = along(other_axis(axis), box);
    needs.halo = choice.halo_spacings * std::sqrt(needs.length / static_cast<double>(n_discs + 1)) *
                 std::sqrt(needs.width);
    needs.is_periodic = periods.along(axis) != 0;
    needs.is_periodic_across = periods.along(other_axis(axis)) != 0;
    return choose_groups(needs);
}

/// The first domains. They have equal areas, unless discs are so clustered that one rank would have
/// to store far more discs than the mean before the first cuts by work. `owner_in(domains, disc)`
/// and `place_of(disc)` use the position at the disc's own time. **Collective.**
template <class OwnerIn, class PlaceOf>
Domains first_domains(const Communicator& communicator, const Box& box, const Domains& equal,
                      const std::vector<int>& group_sizes, std::span<const DiscState> discs,
                      const OwnerIn& owner_in, const PlaceOf& place_of) {
    // Largest allowed number of discs in a domain, divided by the mean
    constexpr double most_crowded = 1.5;
    std::vector<std::uint64_t> counts(static_cast<std::size_t>(communicator.size()), 0);
    for (const DiscState& disc : discs) ++counts[owner_in(equal, disc)];
    communicator.sum(counts);
    std::uint64_t most = 0, all = 0;
    for (const std::uint64_t count : counts) {
        most = std::max(most, count);
        all += count;
    }
    if (static_cast<double>(most) * communicator.size() <= most_crowded * static_cast<double>(all))
        return equal;
    return domains_of_equal_weights(communicator, box, equal.axis(), group_sizes,
                                    [&](const auto& visit) {
                                        for (const DiscState& disc : discs) {
                                            const auto [along, across] = place_of(disc);
                                            visit(along, across, 1);
                                        }
                                    });
}

} // namespace

StripDiscs::StripDiscs(const Communicator& communicator, const Box& box, DiscStates discs,
                       const Periods& periods, SideColumns columns, int n_threads,
                       const GroupChoice& choice)
    : communicator_(communicator), n_threads_(n_threads), box_(box), periods_(periods),
      n_total_(communicator.sum(std::uint64_t{discs.size()})), n_with_departed_(n_total_),
      group_sizes_(group_sizes(box, periods, communicator.size(), n_total_, choice)),
      domains_(equal_domains(box, cut_axis(box, periods), group_sizes_)),
      redistributed_domains_(domains_), exchange_(communicator) {
    columns_ = std::move(columns);
    columns_.resize(discs.size());
    columns_.for_each([&](SideColumn column) { departed_columns_.add(column); });
    if (communicator.size() > 1) {
        const auto place_of = [&](const DiscState& disc) { return place_in_box(disc, disc.tau); };
        const auto owner_in = [&](const Domains& domains, const DiscState& disc) {
            const auto [along, across] = place_of(disc);
            return static_cast<std::size_t>(domains.owner(along, across));
        };
        domains_ = first_domains(communicator_, box, domains_, group_sizes_, discs, owner_in,
                                 place_of);
        redistributed_domains_ = domains_;
        const auto owner_of = [&](const DiscState& disc) { return owner_in(domains_, disc); };
        columns_.for_each([&](SideColumn column) {
            hand_to_owners(communicator, columns_[column],
                           [&](std::size_t i) { return owner_of(discs[i]); });
        });
        hand_to_owners(communicator, discs, [&](std::size_t i) { return owner_of(discs[i]); });
    }
    discs_ = std::move(discs);
    n_own_ = discs_.size();
}

void StripDiscs::reshape(const Box& box) {
    const double along_x = box.x / box_.x, along_y = box.y / box_.y;
#pragma omp parallel for num_threads(n_threads_) schedule(static)
    for (std::size_t i = 0; i < n_own_; ++i) {
        discs_[i].x *= along_x;
        discs_[i].y *= along_y;
    }
    domains_ = domains_.stretched(along_x, along_y);
    redistributed_domains_ = redistributed_domains_.stretched(along_x, along_y);
    box_ = box;
    periods_.x = box.x;
    periods_.y = box.y;
}

/// The position of the disc's image in the box at `time`, along the strips' axis and across it.
std::pair<double, double> StripDiscs::place_in_box(const DiscState& disc, double time) const {
    DiscState in_box = disc;
    in_box.x = disc.x_at(time);
    in_box.y = disc.y_at(time);
    periods_.wrap(in_box, time);
    return domains_.place_of(in_box, in_box.tau);
}

void StripDiscs::set_departed_aside() {
    forget_halo();
    // Copies and then erases, because std::stable_partition would allocate a buffer whose alignment
    // is too small for discs.
    const auto has_departed = [](const DiscState& disc) { return disc.has_departed(); };
    std::copy_if(discs_.begin(), discs_.end(), std::back_inserter(departed_), has_departed);
    columns_.for_each([&](SideColumn column) {
        std::vector<double>&values = columns_[column], &departed = departed_columns_[column];
        std::size_t n_left = 0;
        for (std::size_t i = 0; i < discs_.size(); ++i)
            if (has_departed(discs_[i]))
                departed.push_back(values[i]);
            else
                values[n_left++] = values[i];
        values.resize(n_left);
    });
    if (std::erase_if(discs_, has_departed) > 0) is_sorted_ = false;
    n_own_ = discs_.size();
    n_total_ = communicator_.sum(std::uint64_t{n_own_});
}

/// The domains of the last migration determine the owner, because the next migration starts from
/// them.
void StripDiscs::take_back(std::span<const ReturningDisc> discs) {
    if (discs.empty()) return;
    forget_halo();
    for (const ReturningDisc& disc : discs) {
        const auto waiting = std::ranges::find(departed_, disc.state.id, &DiscState::id);
        if (waiting != departed_.end()) {
            const auto place = waiting - departed_.begin();
            departed_.erase(waiting);
            departed_columns_.for_each([&](SideColumn column) {
                departed_columns_[column].erase(departed_columns_[column].begin() + place);
            });
        }
        const auto [along, across] = redistributed_domains_.place_of(disc.state, disc.state.tau);
        if (redistributed_domains_.owner(along, across) != communicator_.rank()) continue;
        discs_.push_back(disc.state);
        columns_.for_each([&](SideColumn column) {
            columns_[column].push_back(disc.numbers[static_cast<std::size_t>(column)]);
        });
    }
    is_sorted_ = false;
    n_own_ = discs_.size();
    n_total_ += discs.size();
}

void StripDiscs::migrate(double time, double farthest, DiscStates* companion) {
    forget_halo();
    are_displaced_listed_ = false;
    if (companion) companion->resize(n_own_);
    if (periods_.are_any()) set_home_images(time, farthest, companion);
    if (communicator_.size() > 1) {
        const TransferPlan plan = migration_plan(time, farthest);
        move_along(plan, discs_);
        if (companion) move_along(plan, *companion);
        columns_.for_each([&](SideColumn column) { move_along(plan, columns_[column]); });
        n_own_ = discs_.size();
    }
    is_sorted_ = false;
    redistributed_domains_ = domains_;
}

/// Sends the values of leaving discs to their new ranks, and appends the values of arriving discs.
template <class Values> void StripDiscs::move_along(const TransferPlan& plan, Values& values) {
    Values arrived;
    transfer(exchange_, plan, values, arrived, n_threads_);
    remove_leaving(plan, values);
    values.insert(values.end(), arrived.begin(), arrived.end());
}

/// Plans the migration. Without periodic sides it skips discs that were deep inside the domain when
/// they were sorted.
TransferPlan StripDiscs::migration_plan(double time, double farthest) const {
    const int rank = communicator_.rank();
    if (periods_.are_any())
        return plan_periodic_migration(redistributed_domains_, domains_, rank, own(), time,
                                       farthest, periods_, n_threads_);
    const std::vector<PlaceRange> searched = places_outside(
        interior(domains_, rank, farthest, periods_));
    return plan_migration(redistributed_domains_, domains_, rank, own(), searched, time, farthest,
                          n_threads_);
}

/// Ascending ranges that contain every own disc outside of `inner` at the time of sorting.
std::vector<PlaceRange> StripDiscs::places_outside(const Inside& inner) const {
    if (!is_sorted_) return {{0, n_own_}};
    std::vector<PlaceRange> places;
    for (const SlotRange range : grid_.outside(inner)) places.push_back({range.begin, range.end});
    return places;
}

Companions StripDiscs::companions(DiscStates* states) {
    forget_halo();
    Companions with;
    if (states) with.states = std::span(*states).first(n_own_);
    with.columns = &columns_;
    return with;
}

void StripDiscs::sort(const GridGeometry& geometry, double anchor, double time, double duration,
                      DiscStates* companion) {
    const Companions with = companions(companion);
    grid_.sort(own(), geometry, anchor, time, duration, n_threads_, periods_, with);
    is_sorted_ = true;
}

void StripDiscs::sort_cells(const GridGeometry& geometry, double time) {
    const Companions with = companions(nullptr);
    grid_.sort_cells(own(), geometry, time, n_threads_, periods_, with);
    is_sorted_ = true;
}

void StripDiscs::drop_grid() {
    grid_ = {};
    is_sorted_ = false;
}

Extent StripDiscs::extent_seen(const Extent& box, double reach) const {
    const auto part_of = [reach](const Strip& mine, double low, double high, double period) {
        if (period != 0)
            return std::pair(std::max(0.0, mine.low) - reach, std::min(period, mine.high) + reach);
        return std::pair(std::max(low, mine.low - reach), std::min(high, mine.high + reach));
    };
    const Domain mine = domains_.of(communicator_.rank());
    const auto [along_x, along_y] = turned(domains_.axis(), mine.along, mine.across);
    const auto [x_low, x_high] = part_of(along_x, box.x_low, box.x_high, periods_.x);
    const auto [y_low, y_high] = part_of(along_y, box.y_low, box.y_high, periods_.y);
    return {x_low, x_high, y_low, y_high};
}

void StripDiscs::fetch_halo(double time, double reach, DiscStates* companion) {
    if (has_no_halo()) return;
    for (const std::vector<LocalIndex>& shown : halo_plan_.leaving) {
        for (const LocalIndex index : shown) is_shown_[index] = 0;
    }
    more_halo_.clear();
    halo_plan_ = plan_of_halo(time, {reach});
    other_partners_ = halo_plan_.partners;
    std::erase(other_partners_, communicator_.rank());
    for (DiscStates* values : {&discs_, companion}) {
        if (!values) continue;
        if (communicator_.size() == 1) {
            append_images(halo_plan_, *values, n_threads_);
            halo_offsets_ = {0, values->size() - n_own_};
        } else if (periods_.are_any()) {
            halo_offsets_ = transfer_images(exchange_, halo_plan_, *values, *values, n_threads_);
        } else {
            halo_offsets_ = transfer(exchange_, halo_plan_, *values, *values, n_threads_);
        }
    }
    columns_.for_each([&](SideColumn column) { show(columns_[column]); });
    for (std::size_t& offset : halo_offsets_) offset += n_own_;
    // Reserved like `discs_`, so that both lists are reallocated equally rarely
    is_shown_.reserve(discs_.capacity());
    is_shown_.resize(n_own_, 0);
    for (const std::vector<LocalIndex>& shown : halo_plan_.leaving) {
        for (const LocalIndex index : shown) is_shown_[index] = 1;
    }
    grid_.add_halo(std::span<const DiscState>(discs_).subspan(n_own_), n_threads_);
}

void StripDiscs::send_updates(std::span<const LocalIndex> changed,
                              std::vector<LocalIndex>& updates) {
    if (has_no_halo()) return;
    ensure(more_halo_.empty(), "a halo that has grown gets no updates");
    const TransferPlan plan = plan_updates(changed);
    const std::size_t n_partners = plan.partners.size();
    std::vector<RawVector<Update>> out(n_partners);
    for (std::size_t k = 0; k < n_partners; ++k) {
        const std::vector<LocalIndex>& places = plan.leaving[k];
        out[k].resize(places.size());
#pragma omp parallel for num_threads(n_threads_)                                                   \
    schedule(static) if (places.size() >= least_for_threads)
        for (std::size_t i = 0; i < places.size(); ++i)
            out[k][i] = {discs_[halo_plan_.leaving[k][places[i]]], places[i]};
    }
    const std::size_t n_before = updates.size();
    RawVector<Update> in;
    const std::vector<std::size_t> offsets = exchange_.append(std::span<const int>(plan.partners),
                                                              out, in);
    updates.resize(n_before + in.size());
    for (std::size_t k = 0; k < n_partners; ++k)
        take_updates(std::span<const Update>(in).subspan(offsets[k], offsets[k + 1] - offsets[k]),
                     halo_offsets_[k], std::span(updates).subspan(n_before + offsets[k]));
    columns_.for_each([&](SideColumn column) {
        std::vector<double>& values = columns_[column];
        std::vector<std::vector<double>> values_out(n_partners);
        for (std::size_t k = 0; k < n_partners; ++k)
            for (const LocalIndex place : plan.leaving[k])
                values_out[k].push_back(values[halo_plan_.leaving[k][place]]);
        Received<double> values_in;
        exchange_.exchange(std::span<const int>(plan.partners), values_out, values_in);
        for (std::size_t i = 0; i < values_in.items.size(); ++i)
            values[updates[n_before + i]] = values_in.items[i];
    });
}

/// For each partner, finds the own discs in `changed` that the partner has in its halo, and lists
/// their places in the list of the halo plan.
TransferPlan StripDiscs::plan_updates(std::span<const LocalIndex> changed) const {
    TransferPlan plan;
    plan.partners = halo_plan_.partners;
    plan.leaving.resize(plan.partners.size());
    const PlaceRange all[] = {{0, changed.size()}};
    plan_in_parts(plan, all, n_threads_, [&](LocalIndex k, LeavingDiscs& part) {
        const LocalIndex index = changed[k];
        if (index >= n_own_ || is_shown_[index] == 0) return;
        for (std::size_t partner = 0; partner < part.leaving.size(); ++partner) {
            const std::vector<LocalIndex>& shown = halo_plan_.leaving[partner];
            for (auto place = std::lower_bound(shown.begin(), shown.end(), index);
                 place != shown.end() && *place == index; ++place)
                part.leaving[partner].push_back(static_cast<LocalIndex>(place - shown.begin()));
        }
    });
    return plan;
}

/// Copies states that a partner has sent; the partner's discs begin at the index `offset` in
/// `discs_`. Writes the indices of these discs to `updated`.
void StripDiscs::take_updates(std::span<const Update> items, std::size_t offset,
                              std::span<LocalIndex> updated) {
#pragma omp parallel for num_threads(n_threads_)                                                   \
    schedule(static) if (items.size() >= least_for_threads)
    for (std::size_t i = 0; i < items.size(); ++i) {
        const auto index = static_cast<LocalIndex>(offset + items[i].place);
        ensure(discs_[index].id == items[i].disc.id,
               "a neighbour's update is of another disc than the halo has there");
        const Image image = periods_.are_any() ? image_of(discs_[index]) : Image{};
        discs_[index] = items[i].disc;
        if (periods_.are_any()) set_image(discs_[index], image);
        updated[i] = index;
    }
}

bool StripDiscs::is_valid(double time) const {
    std::uint64_t sums[] = {n_own_ + departed_.size(), 0, 0};
    bool in_domain = true;
    for (const DiscState& disc : departed_) {
        sums[1] += disc.id;
        sums[2] += disc.id * disc.id;
    }
    for (const DiscState& disc : own()) {
        sums[1] += disc.id;
        sums[2] += disc.id * disc.id;
        const auto [along, across] = place_in_box(disc, time);
        in_domain = in_domain &&
                    redistributed_domains_.owner(along, across) == communicator_.rank();
    }
    communicator_.sum(sums);
    std::uint64_t id_sum = 0, square_sum = 0; // modulo 2^64, like `sums`
    for (std::uint64_t id = 0; id < n_with_departed_; ++id) {
        id_sum += id;
        square_sum += id * id;
    }
    return communicator_.all(in_domain) && sums[0] == n_with_departed_ && sums[1] == id_sum &&
           sums[2] == square_sum;
}

} // namespace carrom
