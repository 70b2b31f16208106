// SPDX-License-Identifier: BSD-3-Clause
// How a finding becomes the same failure on every rank.
#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "check/state_check.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

constexpr std::size_t most_around = 12;
constexpr std::size_t most_struck = 6; ///< partners in collisions that a rank names

struct Neighbour {
    InputDisc disc;
    double spin = 0;                                        ///< per step
    double order = std::numeric_limits<double>::infinity(); ///< squared distance; negative for
                                                            ///< discs that must be there
};
using Neighbours = std::array<Neighbour, most_around>;
using Struck = std::array<DiscId, most_struck>;

constexpr DiscId nobody = ~DiscId{0};

/// Discs that have collided with one of the two, as far as this rank's log knows.
Struck struck_by(DiscId disc, DiscId partner, std::span<const Collision> log) {
    Struck struck;
    struck.fill(nobody);
    std::size_t n = 0;
    for (const Collision& c : log) {
        if (c.q == Collision::wall || n == struck.size()) continue;
        if (c.p == disc || c.p == partner)
            struck[n++] = c.q;
        else if (c.q == disc || c.q == partner)
            struck[n++] = c.p;
    }
    return struck;
}

void keep_first(std::vector<Neighbour>& neighbours) {
    std::sort(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
        return std::tuple(a.order, a.disc.id) < std::tuple(b.order, b.disc.id);
    });
    neighbours.resize(std::min(neighbours.size(), most_around));
}

} // namespace

void StateCheck::fail_if_found(const Finding& mine, Log log) {
    Finding first;
    for (const Finding& finding : communicator_.all_gather(mine)) {
        if (finding.is_found == 0) continue;
        const auto key = [](const Finding& f) {
            return std::tuple(f.invariant, f.disc, f.partner);
        };
        if (first.is_found == 0 || key(finding) < key(first)) first = finding;
    }
    if (first.is_found == 0) return;
    if (first.rank < 0) {
        const int keeper = slab_of_disc(first.disc);
        if (keeper == communicator_.rank()) first.rank = known_[first.disc - first_id_].owner;
        communicator_.broadcast(first.rank, keeper);
    }
    auto [discs, spins] = around(first, log);
    throw CheckFailure(text_of(first), first.invariant, micro_steps_done_ / scene_.micro_steps,
                       first.disc, first.rank, std::move(discs), std::move(spins));
}

std::string StateCheck::text_of(const Finding& f) const {
    const std::string who = fmt::format("check failed at step {}: disc {} on rank {} ",
                                        micro_steps_done_ / scene_.micro_steps, f.disc, f.rank);
    switch (f.invariant) {
    case Invariant::finite: return who + "has a number in its state that is not finite";
    case Invariant::owned_once:
        if (f.disc >= scene_.n_discs)
            return who + fmt::format("does not exist: ids end at {}", scene_.n_discs - 1);
        return who + (f.value == 0 ? "is owned by no rank any more"
                                   : fmt::format("is owned {} times", f.value));
    case Invariant::in_box:
        return who +
               fmt::format("is {:.3g} outside the box; rounding explains {:.3g}", f.value, f.bound);
    case Invariant::in_strip: return who + fmt::format("is in the strip of rank {}", f.value);
    case Invariant::in_cell: return who + "is not in the cell that it is filed under";
    case Invariant::clear:
        return who + fmt::format("overlaps {} by {:.3g}; rounding explains {:.3g}",
                                 obstacles_->name_of(static_cast<std::uint32_t>(f.partner)),
                                 f.value, f.bound);
    case Invariant::counters:
        return who + fmt::format("has counted {} collisions with {} in this step, but had {}",
                                 f.value, f.partner == 0 ? "walls" : "discs", f.bound);
    case Invariant::motion:
        return who + fmt::format("has changed its {} by {:.3g} a micro-step without a collision",
                                 f.partner == 0 ? "velocity" : "spin", f.value);
    case Invariant::overlap:
        return who + fmt::format("overlaps disc {} by {:.3g}{}; rounding explains {:.3g}",
                                 f.partner, f.value,
                                 scene_.method == Method::time_stepped
                                     ? ", though both were free to collide"
                                     : "",
                                 f.bound);
    case Invariant::energy:
        return who + fmt::format("is the first of some whose energy together has changed by a "
                                 "share of {:.3g}; rounding explains {:.3g}",
                                 f.value, f.bound);
    }
    return who;
}

/// As they were at the last look.
StateCheck::Around StateCheck::around(const Finding& finding, Log log) const {
    if (finding.disc >= scene_.n_discs) return {};
    const auto clock = static_cast<double>(micro_steps_before_ % scene_.sync_every);
    const auto unit = static_cast<double>(scene_.micro_steps);
    const Periods periods = scene_.effects.periods(scene_.box_size);
    const auto inside = [&](double x, double period, double radius) {
        return period != 0 ? wrapped(x, period) : std::clamp(x, radius, scene_.box_size - radius);
    };
    const auto then = [&](const Disc& disc) {
        const double radius = species_.of(disc.id).radius;
        return InputDisc{disc.id, inside(disc.x_at(clock), periods.x, radius),
                         inside(disc.y_at(clock), periods.y, radius), disc.vx * unit,
                         disc.vy * unit};
    };
    const auto to_nearest_image = [](double d, double period) {
        return period != 0 ? d - period * std::round(d / period) : d;
    };
    const int keeper = slab_of_disc(finding.disc);
    InputDisc centre;
    if (keeper == communicator_.rank()) centre = then(before_[finding.disc - first_id_].disc);
    communicator_.broadcast(centre, keeper);

    const bool has_partner = finding.invariant == Invariant::overlap;
    std::vector<DiscId> wanted = {finding.disc};
    if (has_partner) wanted.push_back(finding.partner);
    for (const Struck& struck : communicator_.all_gather(
             struck_by(finding.disc, has_partner ? finding.partner : finding.disc, log)))
        wanted.insert(wanted.end(), struck.begin(), struck.end());

    std::vector<Neighbour> mine;
    for (const Known& known : before_) {
        const InputDisc disc = then(known.disc);
        const double dx = to_nearest_image(disc.x - centre.x, periods.x),
                     dy = to_nearest_image(disc.y - centre.y, periods.y);
        const auto place = std::find(wanted.begin(), wanted.end(), disc.id);
        const bool is_wanted = place != wanted.end();
        mine.push_back({disc, known.spin * unit,
                        is_wanted ? static_cast<double>(place - wanted.end()) : dx * dx + dy * dy});
    }
    keep_first(mine);
    Neighbours padded;
    std::copy(mine.begin(), mine.end(), padded.begin());
    std::vector<Neighbour> all;
    for (const Neighbours& part : communicator_.all_gather(padded))
        all.insert(all.end(), part.begin(), part.end());
    keep_first(all);
    std::erase_if(
        all, [](const Neighbour& n) { return n.order == std::numeric_limits<double>::infinity(); });
    std::sort(all.begin(), all.end(),
              [](const Neighbour& a, const Neighbour& b) { return a.disc.id < b.disc.id; });
    Around found;
    for (const Neighbour& neighbour : all) {
        found.discs.push_back(neighbour.disc);
        if (effects_.contact.kind == ContactKind::rough) found.spins.push_back(neighbour.spin);
    }
    return found;
}

} // namespace carrom
