// SPDX-License-Identifier: BSD-3-Clause
#include "time_stepped/large_discs.hpp"

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"

namespace carrom {

namespace {

// Times in nanoseconds, as in engine/window_choice.cpp.
constexpr double partner = 1.3;          ///< time for each partner in a square of one reach
constexpr double large_disc = 200;       ///< time for each large disc in a window
constexpr double partner_of_large = 0.5; ///< time for each disc in the cells around a large disc
constexpr double pair_of_large = 0.1;    ///< time for each tested pair of a disc and a large disc
constexpr double hits = 0.3;             ///< estimated collisions of a disc in a window
constexpr double flight = 0.3; ///< length of a flight in a window, divided by the mean spacing

} // namespace

double usual_radius_of(std::span<const Species> species, double radius, double area) {
    if (species.empty()) return radius;
    std::vector<Species> by_size(species.begin(), species.end());
    std::ranges::sort(by_size, {}, &Species::radius);
    double n_discs = 0;
    for (const Species& one : by_size) n_discs += static_cast<double>(one.count);
    const double largest = by_size.back().radius, density = n_discs / area,
                 travel = flight / std::sqrt(density);
    double best = largest, least = 0, n_large = 0;
    for (std::size_t k = by_size.size(); k-- > 0;) {
        const double usual = by_size[k].radius, reach = 2 * (usual + travel),
                     around = 2 * (largest + usual + 2 * travel) + reach;
        const double cost = n_discs * (partner * density * reach * reach +
                                       hits * pair_of_large * n_large) +
                            n_large * (large_disc + partner_of_large * density * around * around +
                                       pair_of_large * n_large);
        if (k + 1 == by_size.size() || cost < least) {
            least = cost;
            best = usual;
        }
        n_large += static_cast<double>(by_size[k].count);
    }
    return best;
}

void LargeDiscs::assign(std::vector<LocalIndex> indices, const CellGrid& grid) {
    indices_ = std::move(indices);
    std::ranges::sort(indices_);
    length_ = indices_.size() + filter_padding;
    lanes_.assign(4 * length_, 0.0f);
    for (std::uint32_t k = 0; k < size(); ++k) copy_flight(k, grid);
}

void LargeDiscs::update(LocalIndex index, const CellGrid& grid) { copy_flight(place(index), grid); }

std::uint32_t LargeDiscs::place(LocalIndex index) const {
    const auto found = std::ranges::lower_bound(indices_, index);
    ensure(found != indices_.end() && *found == index, "a large disc is listed");
    return static_cast<std::uint32_t>(found - indices_.begin());
}

void LargeDiscs::copy_flight(std::uint32_t place, const CellGrid& grid) {
    const LocalIndex index = indices_[place];
    const bool is_own = index < grid.n_own();
    const FlightLanes from = is_own ? grid.lanes() : grid.halo_lanes();
    const std::uint32_t slot = is_own ? index : grid.halo_slot(index);
    lanes_[place] = from.x[slot];
    lanes_[length_ + place] = from.y[slot];
    lanes_[2 * length_ + place] = from.vx[slot];
    lanes_[3 * length_ + place] = from.vy[slot];
}

} // namespace carrom
