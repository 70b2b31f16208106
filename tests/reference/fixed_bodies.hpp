// SPDX-License-Identifier: BSD-3-Clause
// A plain implementation of obstacles: one body after another, with formulas written a second time
// from docs/understanding/effects.md, section 10.
#pragma once

#include <cstddef>
#include <vector>

#include "time_stepped.hpp"

namespace carrom::reference {

/// A fixed disc, or the line of a segment from (x, y) in the direction (ux, uy); its ends are fixed
/// discs of radius 0.
struct Body {
    double x = 0, y = 0, radius = 0;
    double ux = 0, uy = 0, length = 0;
};

struct BodyMeeting {
    double time = 0;
    std::size_t body = 0;
    Copy copy{}; ///< the body's image in a box with periodic sides
};

class FixedBodies {
public:
    explicit FixedBodies(const Setting& setting);

    bool are_none() const { return species_.empty(); }
    /// The first meeting from `from` on, except that with `left` at the disc's own time; infinite
    /// if there is none. Searches images of bodies as far as the disc flies until `until`.
    BodyMeeting first_meeting(const DiscState& disc, double from, double until,
                              const BodyMeeting& left) const;
    /// Reverses the normal velocity of a disc that is at the body at `time`.
    void reflect(DiscState& disc, const BodyMeeting& at, double time, double since) const;

    static constexpr std::size_t none = ~std::size_t{0};

    static constexpr BodyMeeting nowhere() { return {0, none}; }

private:
    double meeting_time(const DiscState& disc, const Body& body, Copy copy) const;
    std::vector<Copy> copies(const DiscState& disc, const Body& body, double until) const;

    Setting setting_;
    double gx_, gy_;
    std::vector<Body> species_;
};

} // namespace carrom::reference
