// SPDX-License-Identifier: BSD-3-Clause
// The discs that random insertion has placed in a rank's strip, or within the margin around it.
#pragma once

#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "initial_state/insertion_box.hpp"
#include "initial_state/point_grid.hpp"
#include "initial_state/refused_places.hpp"

namespace carrom {

class PlacedDiscs {
public:
    PlacedDiscs(const InsertionBox& box, int n_threads)
        : box_(box), n_threads_(n_threads), grid_(box.grid(box.share())) {
        discs_.reserve(static_cast<std::size_t>(1.1 * box.share()) + 100);
    }

    void add(std::span<const Notice> found) {
        const std::size_t first = discs_.size();
        discs_.resize(first + found.size());
#pragma omp parallel for num_threads(n_threads_) schedule(static) if (found.size() > 1000)
        for (std::size_t k = 0; k < found.size(); ++k) discs_[first + k] = found[k];
        grid_->add_rest(discs_, n_threads_);
        if (refused_places_) map(first);
    }

    /// Makes a bit map that rejects most proposals, of discs of at least this radius, by one read
    /// of memory.
    void map_refused(double smallest_radius) {
        refused_places_.emplace(box_.strip_low(), box_.strip_high(), box_.box().y, smallest_radius,
                                box_.share());
        map(0);
    }

    /// Deletes the map. Call this before smaller discs are placed, which fit in places that it
    /// rejects.
    void forget_map() { refused_places_.reset(); }

    /// Whether a proposal's disc would overlap a placed disc or a fixed body.
    bool overlaps(const Notice& notice) const {
        if (refused_places_ && refused_places_->holds({notice.x, notice.y})) return true;
        if (box_.overlaps_fixed_body(notice)) return true;
        return box_.for_images(notice, [&](Point at) {
            return grid_->any_near(
                at, [&](std::uint32_t k) { return box_.overlaps(notice.id, at, discs_[k]); });
        });
    }

    [[gnu::always_inline]] void prefetch(const Notice& notice) const {
        if (refused_places_) refused_places_->prefetch({notice.x, notice.y});
    }

    /// Returns the discs of this rank's strip and deletes all others. No disc can be added
    /// afterwards.
    std::vector<InputDisc> take_own() {
        refused_places_.reset();
        grid_.reset();
        std::vector<InputDisc> own;
        own.reserve(discs_.size());
        for (const Notice& disc : discs_) {
            if (!box_.is_mine(disc)) continue;
            const auto [x, y] = turned(box_.axis(), disc.x, disc.y);
            own.push_back({disc.id, x, y, 0, 0});
        }
        RawVector<Notice>().swap(discs_);
        return own;
    }

private:
    void map(std::size_t first) {
#pragma omp parallel for num_threads(n_threads_) schedule(static)
        for (std::size_t k = first; k < discs_.size(); ++k)
            refused_places_->add({discs_[k].x, discs_[k].y}, box_.radius_of(discs_[k].id));
    }

    const InsertionBox& box_;
    int n_threads_;
    RawVector<Notice> discs_;
    std::optional<PointGrid> grid_;               ///< the placed discs; empty after `take_own`
    std::optional<RefusedPlaces> refused_places_; ///< made when most proposals are rejected
};

} // namespace carrom
