// SPDX-License-Identifier: BSD-3-Clause
#include "domain/strip_discs.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "core/errors.hpp"
#include "domain/hand_to_owners.hpp"
#include "domain/transfer_in_parts.hpp"

namespace carrom {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// Moving rows of boxes slide along x. Strips are rows then, so that only the first
/// and the last one have images that move.
Axis cut_axis(const Box& box, const Periods& periods) {
    return periods.are_moving() ? Axis::y : longer_axis(box);
}

Strips equal_strips(const Box& box, const Periods& periods, int n_ranks) {
    const Axis axis = cut_axis(box, periods);
    std::vector<double> cuts;
    for (int k = 1; k < n_ranks; ++k) cuts.push_back(along(axis, box) * k / n_ranks);
    return Strips(cuts, axis);
}

/// The places further than `reach` from both ends of the strip.
Inside inner_part(const Strips& strips, int rank, double reach) {
    const double low = strips.low(rank) + reach, high = strips.high(rank) - reach;
    return strips.axis() == Axis::x ? Inside{low, high, -unbounded, unbounded}
                                    : Inside{-unbounded, unbounded, low, high};
}

/// The disc's place in the box along the strips' axis.
double place_in_box(const Strips& strips, const Periods& periods, const DiscState& disc,
                    double time) {
    DiscState in_box = disc;
    in_box.x = disc.x_at(time);
    in_box.y = disc.y_at(time);
    periods.wrap(in_box, time);
    return strips.place_of(in_box, in_box.tau);
}

} // namespace

StripDiscs::StripDiscs(const Communicator& communicator, const Box& box,
                       std::vector<DiscState> discs, const Periods& periods, SideColumns columns,
                       int n_threads)
    : communicator_(communicator), n_threads_(n_threads),
      length_(along(cut_axis(box, periods), box)), periods_(periods),
      strips_(equal_strips(box, periods, communicator.size())), redistributed_strips_(strips_),
      exchange_(communicator) {
    columns_ = std::move(columns);
    columns_.resize(discs.size());
    columns_.for_each([&](SideColumn column) { departed_columns_.add(column); });
    if (communicator.size() > 1) {
        const auto owner_of = [&](const DiscState& disc) {
            return static_cast<std::size_t>(
                strips_.owner(place_in_box(strips_, periods, disc, disc.tau)));
        };
        columns_.for_each([&](SideColumn column) {
            hand_to_owners(communicator, columns_[column],
                           [&](std::size_t i) { return owner_of(discs[i]); });
        });
        hand_to_owners(communicator, discs, [&](std::size_t i) { return owner_of(discs[i]); });
    }
    discs_ = std::move(discs);
    n_own_ = discs_.size();
    n_total_ = n_with_departed_ = communicator.sum(std::uint64_t{n_own_});
}

void StripDiscs::set_departed_aside() {
    forget_halo();
    // Not std::stable_partition: its buffer is aligned for less than a disc.
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

void StripDiscs::migrate(double time, double farthest, std::vector<DiscState>* companion) {
    forget_halo();
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
    redistributed_strips_ = strips_;
}

/// Sends the values of the discs that leave, and appends those of the discs that come.
template <Message T> void StripDiscs::move_along(const TransferPlan& plan, std::vector<T>& values) {
    std::vector<T> arrived;
    transfer(exchange_, plan, values, arrived, n_threads_);
    remove_leaving(plan, values);
    values.insert(values.end(), arrived.begin(), arrived.end());
}

/// Discs far from both ends of the strip when they were sorted cannot have left it.
TransferPlan StripDiscs::migration_plan(double time, double farthest) const {
    const int rank = communicator_.rank();
    if (periods_.are_any())
        return plan_periodic_migration(redistributed_strips_, strips_, rank, own(), time, farthest,
                                       periods_, n_threads_);
    const std::vector<PlaceRange> searched = places_outside(inner_part(strips_, rank, farthest));
    return plan_migration(redistributed_strips_, strips_, rank, own(), searched, time, farthest,
                          n_threads_);
}

/// Ascending ranges that hold all own discs outside of `inner` at the time of sorting.
std::vector<PlaceRange> StripDiscs::places_outside(const Inside& inner) const {
    if (!is_sorted_) return {{0, n_own_}};
    std::vector<PlaceRange> places;
    for (const SlotRange range : grid_.outside(inner)) places.push_back({range.begin, range.end});
    return places;
}

Companions StripDiscs::companions(std::vector<DiscState>* states) {
    forget_halo();
    Companions with;
    if (states) with.states = std::span(*states).first(n_own_);
    with.columns = &columns_;
    return with;
}

void StripDiscs::sort(const GridGeometry& geometry, double anchor, double time, double duration,
                      std::vector<DiscState>* companion) {
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

/// A disc's companion stands for the same image, wherever the disc's own state takes
/// it. Discs far from all sides at the time of sorting still have the right image.
/// This holds because no frame may jump along a periodic axis (scene/rules.cpp).
void StripDiscs::set_home_images(double time, double farthest, std::vector<DiscState>* companion) {
    const Inside inside = periods_.inside();
    const Inside inner{inside.x_low + farthest, inside.x_high - farthest, inside.y_low + farthest,
                       inside.y_high - farthest};
    const bool are_all = companion || !has_images_;
    for (const PlaceRange range :
         are_all ? std::vector<PlaceRange>{{0, n_own_}} : places_outside(inner)) {
#pragma omp parallel for num_threads(n_threads_)                                                   \
    schedule(static) if (range.end - range.begin >= least_for_threads)
        for (std::size_t i = range.begin; i < range.end; ++i) {
            DiscState& disc = discs_[i];
            const Image image = image_of(disc);
            const bool is_at_home = inside.holds(periods_.x_of(disc, time),
                                                 periods_.y_of(disc, time)); // for nearly all discs
            if (is_at_home && !companion) continue;
            const Image home = is_at_home ? image : periods_.home(disc, time);
            if (!is_at_home) set_image(disc, home);
            if (companion) set_image((*companion)[i], home);
        }
    }
    has_images_ = true;
}

Extent StripDiscs::extent_seen(const Extent& box, double reach) const {
    const auto all_of = [reach](double box_low, double box_high, double period) {
        return period == 0 ? std::pair(box_low, box_high) : std::pair(-reach, period + reach);
    };
    const auto part_of = [&](double box_low, double box_high, double period) {
        const double low = strips_.low(communicator_.rank()),
                     high = strips_.high(communicator_.rank());
        if (period == 0)
            return std::pair(std::max(box_low, low - reach), std::min(box_high, high + reach));
        return std::pair(std::max(0.0, low) - reach, std::min(period, high) + reach);
    };
    const bool cut_x = strips_.axis() == Axis::x;
    const auto [x_low, x_high] = cut_x ? part_of(box.x_low, box.x_high, periods_.x)
                                       : all_of(box.x_low, box.x_high, periods_.x);
    const auto [y_low, y_high] = cut_x ? all_of(box.y_low, box.y_high, periods_.y)
                                       : part_of(box.y_low, box.y_high, periods_.y);
    return {x_low, x_high, y_low, y_high};
}

void StripDiscs::forget_images() {
    if (!periods_.are_any()) return;
#pragma omp parallel for num_threads(n_threads_) schedule(static) if (n_own_ >= least_for_threads)
    for (std::size_t i = 0; i < n_own_; ++i) set_image(discs_[i], {});
    has_images_ = false;
}

void StripDiscs::fetch_halo(double time, double reach, std::vector<DiscState>* companion) {
    if (has_no_halo()) return;
    for (const std::vector<LocalIndex>& shown : halo_plan_.leaving) {
        for (const LocalIndex index : shown) is_shown_[index] = 0;
    }
    if (periods_.are_any()) {
        const std::vector<PlaceRange> searched = places_outside(
            interior(strips_, communicator_.rank(), reach, periods_));
        halo_plan_ = plan_periodic_halo(strips_, communicator_.rank(), own(), searched, time, reach,
                                        periods_, n_threads_);
        other_partners_ = halo_plan_.partners;
        std::erase(other_partners_, communicator_.rank());
    } else {
        const int rank = communicator_.rank();
        const std::vector<PlaceRange> searched = places_outside(inner_part(strips_, rank, reach));
        halo_plan_ = plan_halo(strips_, rank, own(), searched, time, reach, n_threads_);
    }
    for (std::vector<DiscState>* values : {&discs_, companion}) {
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
    is_shown_.resize(n_own_, 0);
    for (const std::vector<LocalIndex>& shown : halo_plan_.leaving) {
        for (const LocalIndex index : shown) is_shown_[index] = 1;
    }
    grid_.add_halo(std::span<const DiscState>(discs_).subspan(n_own_), n_threads_);
}

void StripDiscs::send_updates(std::span<const LocalIndex> changed,
                              std::vector<LocalIndex>& updates) {
    if (has_no_halo()) return;
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
    Received<Update> in;
    in.offsets = exchange_.append(std::span<const int>(plan.partners), out, in.items);
    updates.resize(n_before + in.items.size());
    for (std::size_t k = 0; k < in.n_senders(); ++k)
        take_updates(in.from(k), halo_offsets_[k],
                     std::span(updates).subspan(n_before + in.offsets[k]));
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

/// Lists by partner where in its halo the own discs among `changed` are.
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

/// Takes over the states that a partner has sent, whose discs begin at `offset` in the halo. Writes
/// their places to `updated`.
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

void StripDiscs::report_to_owners(std::span<const LocalIndex> of_halo,
                                  std::vector<LocalIndex>& reported) {
    if (has_no_halo()) return;
    std::vector<std::vector<std::uint64_t>> out(halo_plan_.partners.size());
    for (const LocalIndex index : of_halo) {
        const auto behind = std::upper_bound(halo_offsets_.begin(), halo_offsets_.end(),
                                             std::size_t{index});
        const auto k = static_cast<std::size_t>(behind - halo_offsets_.begin()) - 1;
        out[k].push_back(index - halo_offsets_[k]);
    }
    Received<std::uint64_t> in;
    exchange_.exchange(std::span<const int>(halo_plan_.partners), out, in);
    for (std::size_t k = 0; k < in.n_senders(); ++k) {
        for (const std::uint64_t place : in.from(k))
            reported.push_back(halo_plan_.leaving[k][place]);
    }
}

void StripDiscs::rebalance(double time, double above) {
    const auto n_ranks = static_cast<std::uint64_t>(communicator_.size());
    if (n_ranks == 1) return;
    const auto largest_share = static_cast<double>(communicator_.max(std::uint64_t{n_own_}) *
                                                   n_ranks);
    if (largest_share <= above * static_cast<double>(n_total_)) return;
    std::vector<std::uint64_t> weights(std::clamp<std::size_t>(256 * n_ranks, 4096, 65536), 0);
    const auto n_bins = static_cast<double>(weights.size());
    for (const DiscState& disc : own()) {
        const double bin = place_in_box(strips_, periods_, disc, time) / length_ * n_bins;
        weights[static_cast<std::size_t>(std::clamp(bin, 0.0, n_bins - 1))] += 1;
    }
    communicator_.sum(weights);
    strips_ = Strips(balanced_cuts(weights, length_, communicator_.size()), strips_.axis());
}

bool StripDiscs::is_valid(double time) const {
    std::uint64_t sums[] = {n_own_ + departed_.size(), 0, 0};
    bool in_strip = true;
    for (const DiscState& disc : departed_) {
        sums[1] += disc.id;
        sums[2] += disc.id * disc.id;
    }
    for (const DiscState& disc : own()) {
        sums[1] += disc.id;
        sums[2] += disc.id * disc.id;
        in_strip = in_strip &&
                   redistributed_strips_.owner(place_in_box(strips_, periods_, disc, time)) ==
                       communicator_.rank();
    }
    communicator_.sum(sums);
    std::uint64_t id_sum = 0, square_sum = 0; // modulo 2^64, like the expected sums
    for (std::uint64_t id = 0; id < n_with_departed_; ++id) {
        id_sum += id;
        square_sum += id * id;
    }
    return communicator_.all(in_strip) && sums[0] == n_with_departed_ && sums[1] == id_sum &&
           sums[2] == square_sum;
}

} // namespace carrom
