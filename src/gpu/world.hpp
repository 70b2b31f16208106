// SPDX-License-Identifier: BSD-3-Clause
// The data that a window's kernels use: plain pointers into the device's memory, and the
// representation of a disc's next event.
//
// For each disc its first candidate in the window is stored: the contact that comes first by
// micro-step, then by the total order. A micro-step handles only its own candidates, so it accesses
// few discs if few discs collide in it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "core/image.hpp"
#include "gpu/atomics.hpp"
#include "gpu/device_cells.hpp"
#include "gpu/device_sums.hpp"
#include "time_stepped/candidate.hpp"
#include "time_stepped/step_walls.hpp"
#include "time_stepped/window.hpp"

namespace carrom {

/// Value of NextEvent::partner if the disc has no candidate.
inline constexpr LocalIndex no_partner = wall_index - 1;
/// Value of NextEvent::micro, which counts micro-steps from the window's start, if the disc has no
/// candidate.
inline constexpr std::uint8_t no_micro = 255;
static_assert(longest_window < no_micro);

/// A disc's first candidate.
struct NextEvent {
    double time = 0;                       ///< time within its micro-step, 0 to 1
    LocalIndex partner = no_partner;       ///< slot of the other disc, or `wall_index`
    std::int16_t image_x = 0, image_y = 0; ///< added to the other disc's image, in box lengths
    std::uint8_t micro = no_micro;
};

/// Number of rounds that use the whole device; afterwards one block of threads does the rest.
inline constexpr int rounds_of_all = 2;

/// Numbers that kernels change and that the host reads after a window.
struct DeviceCounters {
    std::uint32_t n_active = 0;  ///< discs with a candidate in the present micro-step
    std::uint32_t n_changed = 0; ///< discs whose first candidate must be found again
    std::uint32_t n_waiting[rounds_of_all + 2] = {};
    std::uint32_t is_cut = 0;  ///< whether discs are too fast for the rest of the window, 0 or 1
    std::uint32_t n_micro = 0; ///< completed micro-steps of the window
    /// Numbers of candidates found and carried out since the stepper was made
    std::uint64_t n_candidates = 0, n_kept = 0;
    Largest squared_speed; ///< over all discs at the last sync and all collisions since
};

/// All data of a window's kernels. Arrays before `active` are indexed by slot.
template <class D> struct World {
    explicit World(const D& of_scene) : dynamics(of_scene) {}

    D dynamics;
    DeviceCells cells;
    Window window;
    std::uint32_t n = 0;
    double squared_window_speed = 0; ///< square of the speed for which the reach is enough
    double flown = 0;        ///< micro-steps flown before the last sync that the stress sums lack
    double stress_scale = 0; ///< 0: no stress is summed

    DiscState* discs = nullptr;
    std::uint32_t* cell = nullptr;
    double* time = nullptr; ///< this and the next four arrays store the disc's NextEvent
    LocalIndex* partner = nullptr;
    std::int16_t *image_x = nullptr, *image_y = nullptr;
    std::uint8_t* micro = nullptr;
    std::uint8_t* taken = nullptr;      ///< 1: the disc takes part in an event of this micro-step
    std::uint32_t* is_listed = nullptr; ///< whether the disc is in `changed`
    LocalIndex *active = nullptr, *changed = nullptr;
    LocalIndex* waiting[2] = {};

    DeviceCounters* counters = nullptr;
    StressPieces* stripes = nullptr;
    static constexpr std::uint32_t n_stripes = 1024;

    CARROM_DEVICE NextEvent event(LocalIndex k) const {
        return {time[k], partner[k], image_x[k], image_y[k], micro[k]};
    }
    CARROM_DEVICE void set_event(LocalIndex k, const NextEvent& event) const {
        time[k] = event.time;
        partner[k] = event.partner;
        image_x[k] = event.image_x;
        image_y[k] = event.image_y;
        micro[k] = event.micro;
    }
    CARROM_DEVICE std::uint8_t number_of(int m) const {
        return static_cast<std::uint8_t>(m - window.first_micro);
    }
    CARROM_DEVICE DeviceStress stress(std::uint32_t thread) const {
        return {stripes[thread % n_stripes], stress_scale};
    }
    /// The disc in this slot, with `image` (box lengths along x and y) added to its own image.
    CARROM_DEVICE DiscState displaced(LocalIndex slot, Image image) const {
        DiscState disc = discs[slot];
        if constexpr (D::is_periodic) move_image(disc, image);
        return disc;
    }

    /// Disc k's event in the form that the total order compares.
    CARROM_DEVICE Candidate candidate(LocalIndex k, const NextEvent& event) const {
        Candidate candidate{event.time, k, event.partner};
        if (!candidate.is_wall() && discs[event.partner].id < discs[k].id) {
            candidate.p = event.partner;
            candidate.q = k;
        }
        return candidate;
    }
    /// Whether candidate a of disc k comes before candidate b of disc k. If two images of a disc
    /// touch k at the same time, the images have a fixed order.
    CARROM_DEVICE bool is_before(LocalIndex k, const NextEvent& a, const NextEvent& b) const {
        if (b.partner == no_partner) return a.partner != no_partner;
        if (a.micro != b.micro) return a.micro < b.micro;
        const TotalOrder order({discs, n});
        const Candidate first = candidate(k, a), second = candidate(k, b);
        if (order(first, second)) return true;
        if (order(second, first)) return false;
        const int sign = first.p == k ? 1 : -1;
        if (a.image_x != b.image_x) return sign * a.image_x < sign * b.image_x;
        return sign * a.image_y < sign * b.image_y;
    }

    /// The first candidate, from micro-step `from` on, between a disc in the state `p` and the disc
    /// in slot `other`, to whose own image `image` is added.
    CARROM_DEVICE NextEvent meeting(const DiscState& p, LocalIndex other, Image image,
                                    int from) const {
        const auto contact = D::is_periodic
                                 ? dynamics.contact(p, displaced(other, image),
                                                    dynamics.tolerance())
                                 : dynamics.contact(p, discs[other], dynamics.tolerance());
        if (!contact.exists()) return {};
        const int m = first_micro_step(contact, from, window.end_micro());
        if (m == window.end_micro()) return {};
        return {in_step_time(contact, m), other, static_cast<std::int16_t>(image.x),
                static_cast<std::int16_t>(image.y), number_of(m)};
    }
    /// The disc's first collision with a wall from micro-step `from` on.
    CARROM_DEVICE NextEvent bounce(const DiscState& disc, int from) const {
        if (!dynamics.may_meet_wall(disc, window.end_micro())) return {};
        for (int m = from; m < window.end_micro(); ++m) {
            const double t = StepWalls(dynamics).time(disc, m);
            if (t != never) return {t, wall_index, 0, 0, number_of(m)};
        }
        return {};
    }
    /// Calls visit(event) for each candidate of disc k with another disc.
    template <class Visit>
    CARROM_DEVICE void for_each_meeting(LocalIndex k, int from, const Visit& visit) const {
        if (!dynamics.has_pairs()) return;
        const DiscState p = discs[k];
        cells.for_each_near(cell[k], [&](LocalIndex other, Image image) {
            if (other == k) return; // an image of a disc never approaches the disc itself
            const NextEvent event = meeting(p, other, image, from);
            if (event.partner != no_partner) visit(event);
        });
    }
    /// Disc k's first candidate from micro-step `from` on. If `passes_taken`, partners for which
    /// `taken` is 1 are skipped.
    CARROM_DEVICE NextEvent first_event(LocalIndex k, int from, bool passes_taken) const {
        NextEvent first = bounce(discs[k], from);
        for_each_meeting(k, from, [&](const NextEvent& event) {
            if (passes_taken && taken[event.partner] != 0) return;
            if (is_before(k, event, first)) first = event;
        });
        return first;
    }
};

} // namespace carrom
