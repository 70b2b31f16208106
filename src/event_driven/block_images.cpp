// SPDX-License-Identifier: BSD-3-Clause
// A block run that sees all of a periodic box: images are linked, so that what happens to one
// happens to all.
#include <bit>
#include <utility>

#include "event_driven/block_scratch.hpp"

namespace carrom {

/// Makes rings of the images of each disc.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::link_images() {
    constexpr std::uint32_t none = 0xffffffff;
    const std::size_t n = discs.size(), size = std::bit_ceil(2 * n + 1);
    next_image.resize(n);
    image_table.assign(size, none);
    for (std::uint32_t slot = 0; slot < n; ++slot) {
        std::size_t place = ((discs[slot].id * 0x9e3779b97f4a7c15u) >> 20) & (size - 1);
        while (image_table[place] != none && discs[image_table[place]].id != discs[slot].id)
            place = (place + 1) & (size - 1);
        next_image[slot] = slot;
        if (image_table[place] == none)
            image_table[place] = slot;
        else
            std::swap(next_image[slot], next_image[image_table[place]]);
    }
}

/// What has happened to a disc has happened to all of its images.
template <class Dynamics>
void BlockRun<Dynamics>::Scratch::mirror(std::uint32_t slot, double time) {
    for (std::uint32_t other = next_image[slot]; other != slot; other = next_image[other]) {
        const Image image = image_of(discs[other]);
        discs[other] = discs[slot];
        set_image(discs[other], image);
        past_events_of[other] = past_events_of[slot];
        if constexpr (Dynamics::has_spin) spins[other] = spins[slot];
        const double speed_squared = discs[other].vx * discs[other].vx +
                                     discs[other].vy * discs[other].vy;
        const float before = vx[other] * vx[other] + vy[other] * vy[other];
        if (is_own[other] != 0 && (speed_squared > bound_squared || before > bound_lane_squared))
            hold_to_schedule(other, time);
        place(other, ground.window.begin);
    }
}

/// A pair's contact is found several times then: the first one that is carried out makes the others
/// stale.
template <class Dynamics> void BlockRun<Dynamics>::Scratch::predict_images(std::uint32_t slot) {
    for (std::uint32_t other = next_image[slot]; other != slot; other = next_image[other]) {
        if (dynamics.has_walls()) predict_walls(other);
        predict_pairs(other);
    }
}

#define CARROM_DEFINE(Dynamics)                                                                    \
    template void BlockRun<Dynamics>::Scratch::link_images();                                      \
    template void BlockRun<Dynamics>::Scratch::mirror(std::uint32_t, double);                      \
    template void BlockRun<Dynamics>::Scratch::predict_images(std::uint32_t);
CARROM_FOR_EACH_PERIODIC_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
