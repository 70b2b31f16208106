// SPDX-License-Identifier: BSD-3-Clause
// Obstacles said plainly: bodies one by one, their formulas written a second time, from docs/method.md.
#pragma once

#include <cstddef>
#include <vector>

#include "one_rule.hpp"

namespace carrom::reference {

/// A fixed disc, or the line of a segment from (x, y) in the direction (ux, uy); its ends are fixed discs of radius 0.
struct Body {
    double x = 0, y = 0, reach = 0;
    double ux = 0, uy = 0, length = 0;
};

struct BodyMeeting {
    double time = 0;
    std::size_t body = 0;
};

class FixedBodies {
public:
    explicit FixedBodies(const Setting& setting);

    bool are_none() const { return bodies_.empty(); }
    /// The first meeting from `from` on, that with `left` at the disc's own time left out. Infinite if there is none.
    BodyMeeting first_meeting(const Disc& disc, double from, std::size_t left) const;
    /// Turns the velocity of a disc round that is at the body at `time`.
    void reflect(Disc& disc, std::size_t body, double time, bool is_touched) const;

    static constexpr std::size_t none = ~std::size_t{0};

private:
    double meeting_time(const Disc& disc, const Body& body) const;

    Setting setting_;
    double gx_, gy_;
    std::vector<Body> bodies_;
};

} // namespace carrom::reference
