// SPDX-License-Identifier: BSD-3-Clause
// Images of discs in boxes that repeat themselves, at rest or under shear.
#include <cmath>
#include <utility>

#include "time_stepped.hpp"

namespace carrom::reference {

std::vector<Copy> copies_near(const Setting& setting, const DiscState& p, const DiscState& q,
                              double begin, double end, const Tiles& tiles) {
    // Growing discs are searched up to twice their radius.
    const double sigma = (setting.effects.growth == 0 ? 2 : 4) * setting.radius;
    const bool is_x = setting.effects.is_periodic_x(), is_y = setting.effects.is_periodic_y();
    const double away = (std::fabs(p.vx) + std::fabs(q.vx) + std::fabs(p.vy) + std::fabs(q.vy)) *
                            (end - begin) +
                        1.01 * sigma;
    const auto range = [](bool is_periodic, double length, double distance,
                          double reach) { // the range of n with |distance + n L| within reach
        if (!is_periodic) return std::pair(0, 0);
        return std::pair(static_cast<int>(std::floor((-reach - distance) / length)),
                         static_cast<int>(std::ceil((reach - distance) / length)));
    };
    const auto place = [begin](double x, double v, double tau) { return x + v * (begin - tau); };
    const double dx = place(q.x, q.vx, q.tau) - place(p.x, p.vx, p.tau),
                 dy = place(q.y, q.vy, q.tau) - place(p.y, p.vy, p.tau);
    const auto [y_low, y_high] = range(is_y, setting.box().y, dy, away);
    std::vector<Copy> copies;
    for (int y = y_low; y <= y_high; ++y) {
        const Copy row{0, y};
        const auto [x_low, x_high] = range(is_x, setting.box().x, dx + tiles.x_to(row, begin),
                                           away + std::fabs(tiles.vx_of(row)) * (end - begin));
        for (int x = x_low; x <= x_high; ++x) copies.push_back({x, y});
    }
    return copies;
}

namespace {

/// Moves `place` by `up` lengths, so that it is in [0, length). The result is exact except for one
/// rounding.
double inside_of(double place, double length, double& up) {
    if (place >= 0 && place < length) return place;
    const double lengths = std::floor(place / length);
    double rest = std::fma(-lengths, length, place);
    up = -lengths;
    if (rest < 0) {
        rest = rest + length;
        up = up + 1;
    }
    if (rest >= length) {
        rest = rest - length;
        up = up - 1;
    }
    return rest;
}

} // namespace

/// The row above has moved by speed * sync, including the product's rounding error.
Tiles Setting::tiles(std::int64_t sync) const {
    Tiles tiles{box()};
    if (!effects.are_sheared()) return tiles;
    tiles.speed = effects.shear / static_cast<double>(micro_steps) * box().y;
    const double product = tiles.speed * static_cast<double>(sync);
    const double error = std::fma(tiles.speed, static_cast<double>(sync), -product);
    double unused = 0;
    tiles.slid = inside_of(inside_of(product, box().x, unused) + error, box().x, unused);
    return tiles;
}

void bring_inside(const Setting& setting, DiscState& disc, const Tiles& tiles) {
    double up = 0, unused = 0;
    if (setting.effects.is_periodic_y()) disc.y = inside_of(disc.y, setting.box().y, up);
    if (setting.effects.are_sheared() && up != 0) { // the image is now in a row so many rows up
        disc.x = disc.x + up * (tiles.slid + tiles.speed * disc.tau);
        disc.vx = disc.vx + up * tiles.speed;
    }
    if (setting.effects.is_periodic_x()) disc.x = inside_of(disc.x, setting.box().x, unused);
}

} // namespace carrom::reference
