// SPDX-License-Identifier: BSD-3-Clause
#include "check/surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace carrom {

namespace {

constexpr std::size_t most_around = 12;
/// The largest number of collision partners that each rank reports
constexpr std::size_t most_struck = 6;
constexpr DiscId nobody = ~DiscId{0};
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Neighbour {
    SceneDisc of;
    double order = infinity; ///< squared distance from the finding's disc; negative: always listed
};
using Neighbours = std::array<Neighbour, most_around>;
using Struck = std::array<DiscId, most_struck>;

/// The discs that collided with `disc` or `partner`, according to this rank's log.
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

/// The discs of the finding, then the discs that collided with them. **Collective.**
std::vector<DiscId> wanted_discs(const Finding& finding, std::span<const Collision> log,
                                 const Communicator& communicator) {
    const bool has_partner = finding.invariant == Invariant::overlap;
    std::vector<DiscId> wanted = {finding.disc};
    if (has_partner) wanted.push_back(finding.partner);
    const Struck mine = struck_by(finding.disc, has_partner ? finding.partner : finding.disc, log);
    for (const Struck& struck : communicator.all_gather(mine))
        wanted.insert(wanted.end(), struck.begin(), struck.end());
    return wanted;
}

void keep_first(std::vector<Neighbour>& neighbours) {
    std::sort(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
        return std::tuple(a.order, a.of.disc.id) < std::tuple(b.order, b.of.disc.id);
    });
    neighbours.resize(std::min(neighbours.size(), most_around));
}

} // namespace

std::vector<SceneDisc> discs_around(const Finding& finding, std::span<const SceneDisc> discs,
                                    int keeper, std::span<const Collision> log,
                                    const Periods& periods, const Communicator& communicator) {
    InputDisc centre;
    for (const SceneDisc& each : discs)
        if (each.disc.id == finding.disc) centre = each.disc;
    communicator.broadcast(centre, keeper);
    const std::vector<DiscId> wanted = wanted_discs(finding, log, communicator);
    std::vector<Neighbour> mine;
    for (const SceneDisc& each : discs) {
        const Shift to = periods.nearest(each.disc.x - centre.x, each.disc.y - centre.y, 0);
        const auto place = std::find(wanted.begin(), wanted.end(), each.disc.id);
        mine.push_back({each, place != wanted.end() ? static_cast<double>(place - wanted.end())
                                                    : to.x * to.x + to.y * to.y});
    }
    keep_first(mine);
    Neighbours padded;
    std::copy(mine.begin(), mine.end(), padded.begin());
    std::vector<Neighbour> all;
    for (const Neighbours& part : communicator.all_gather(padded))
        all.insert(all.end(), part.begin(), part.end());
    keep_first(all);
    std::vector<SceneDisc> around;
    for (const Neighbour& neighbour : all)
        if (neighbour.order != infinity) around.push_back(neighbour.of);
    std::sort(around.begin(), around.end(),
              [](const SceneDisc& a, const SceneDisc& b) { return a.disc.id < b.disc.id; });
    return around;
}

} // namespace carrom
