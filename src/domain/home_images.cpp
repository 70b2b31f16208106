// SPDX-License-Identifier: BSD-3-Clause
// Selects, for each own disc of a rank in a periodic box, the image that lies in the box.
#include "domain/strip_discs.hpp"
#include "domain/transfer_in_parts.hpp"

namespace carrom {

/// Gives each own disc the image that is in the box. The disc's state in `companion` gets the same
/// image, although its position may differ. Without a companion, discs that were sorted far from
/// all sides can be skipped: they are still in the box, or a sync has moved them into it.
void StripDiscs::set_home_images(double time, double farthest, DiscStates* companion) {
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
                                                 // True for nearly all discs
                                                 periods_.y_of(disc, time));
            if (is_at_home && !companion) continue;
            const Image home = is_at_home ? image : periods_.home(disc, time);
            if (!is_at_home) set_image(disc, home);
            if (companion) set_image((*companion)[i], home);
        }
    }
    has_images_ = true;
}

void StripDiscs::forget_images(bool are_in_box) {
    if (!periods_.are_any()) return;
#pragma omp parallel for num_threads(n_threads_)                                                   \
    schedule(static) if (n_own_ >= least_for_threads && has_images_)
    for (std::size_t i = 0; i < (has_images_ ? n_own_ : 0); ++i) set_image(discs_[i], {});
    has_images_ = are_in_box;
}

void StripDiscs::set_images_aside() {
    if (!periods_.are_any()) return;
    if (!are_displaced_listed_) {
        displaced_.clear();
        for (std::size_t i = 0; i < n_own_; ++i)
            if (!is_unshifted(discs_[i]))
                displaced_.emplace_back(static_cast<LocalIndex>(i), image_of(discs_[i]));
        are_displaced_listed_ = true;
    }
    for (const auto& [index, image] : displaced_) set_image(discs_[index], {});
    has_images_ = false;
}

void StripDiscs::restore_images() {
    for (const auto& [index, image] : displaced_) set_image(discs_[index], image);
    has_images_ = periods_.are_any();
}

} // namespace carrom
