// SPDX-License-Identifier: BSD-3-Clause
// Cells of the whole box and the ghosts beyond its sides, compared with all pairs of discs and
// images.
#include "event_driven/box_layout.hpp"

#include <cmath>
#include <random>
#include <set>

#include "catch.hpp"

using namespace carrom;

namespace {

struct Case {
    double x, y; // sides of the box
    bool round_x, round_y;
    double reach;
    std::size_t n_discs;
    std::size_t n_own;
};

Periods periods_of(const Case& of) { return {of.round_x ? of.x : 0, of.round_y ? of.y : 0}; }

/// Own discs, some of which have flown out of the box since they were stored, with the images that
/// are in the box. Then two copies of each other disc, as other ranks send them.
std::vector<DiscState> discs_of(const Case& of, double time) {
    std::mt19937 random(7);
    const auto below = [&](double limit) {
        return limit * static_cast<double>(random()) / 4294967296.0;
    };
    const Periods periods = periods_of(of);
    std::vector<DiscState> discs;
    for (std::size_t id = 0; id < of.n_discs; ++id) {
        DiscState disc;
        disc.id = id;
        disc.vx = of.round_x ? below(of.x) : 0;
        disc.vy = of.round_y ? -below(of.y) : 0;
        disc.x = below(of.x) - (of.round_x ? 0.5 * disc.vx : 0);
        disc.y = below(of.y) - (of.round_y ? 0.5 * disc.vy : 0);
        set_image(disc, periods.home(disc, time));
        discs.push_back(disc);
        if (id < of.n_own) continue;
        const Image home = image_of(disc);
        set_image(discs.back(), {home.x + (of.round_x ? 1 : 0), home.y});
        set_image(disc, {home.x, home.y - (of.round_y ? 2 : 0)});
        discs.push_back(disc);
    }
    return discs;
}

double at_home(double place, double period) {
    return period > 0 ? place - period * std::floor(place / period) : place;
}

/// A disc in a slot, and its cell.
struct Seen {
    DiscId id;
    Image image;
    int column, row;
};

std::vector<Seen> all_seen(const BoxLayout& layout, std::span<const DiscState> discs,
                           const BoxCells& cells) {
    std::vector<Seen> seen;
    const int n_rows = cells.n_rows + 2 * cells.n_above,
              n_columns = cells.n_columns + 2 * cells.n_beside;
    for (int column = 0; column < n_columns; ++column) {
        for (int row = 0; row < n_rows; ++row) {
            const auto cell = static_cast<std::size_t>(column * (n_rows + 1) + row);
            for (std::uint32_t slot = layout.cell_starts()[cell];
                 slot < layout.cell_starts()[cell + 1]; ++slot) {
                const Ghost* const ghost = discs.empty() ? nullptr : layout.ghost_at(slot);
                seen.push_back({discs[layout.indices()[slot]].id, ghost ? ghost->image : Image{},
                                column, row});
            }
        }
    }
    return seen;
}

} // namespace

TEST_CASE("whole box: each disc is there once, and all that are within reach of it around it") {
    const double time = 0.5;
    for (const Case& of :
         {Case{10, 10, true, true, 1.5, 60, 60}, Case{10, 7, true, false, 2, 50, 50},
          Case{6, 11, false, true, 1, 80, 30}, Case{3, 2.5, true, true, 3.9, 5, 5},
          Case{3, 40, true, true, 2.9, 40, 11}}) {
        CAPTURE(of.x, of.y, of.reach);
        const Periods periods = periods_of(of);
        const std::vector<DiscState> discs = discs_of(of, time);
        const BoxCells cells = cells_of_box({0, of.x, 0, of.y}, periods, of.reach, 0.7);
        BoxLayout layout;
        layout.lay(discs, of.n_own, cells, periods, time);
        const std::vector<Seen> seen = all_seen(layout, discs, cells);
        std::multiset<DiscId> real;
        for (const Seen& one : seen)
            if (one.image == Image{}) real.insert(one.id);
        CHECK(real.size() == of.n_discs);
        for (DiscId id = 0; id < of.n_discs; ++id) CHECK(real.count(id) == 1);

        std::vector<double> x(of.n_discs), y(of.n_discs);
        for (const DiscState& disc : discs) {
            x[disc.id] = at_home(disc.x_at(time), periods.x);
            y[disc.id] = at_home(disc.y_at(time), periods.y);
        }
        const int far_x = of.round_x ? 3 : 0, far_y = of.round_y ? 3 : 0;
        for (const Seen& p : seen) {
            if (p.image != Image{}) continue;
            for (DiscId q = 0; q < of.n_discs; ++q) {
                for (int i = -far_x; i <= far_x; ++i) {
                    for (int j = -far_y; j <= far_y; ++j) {
                        const double dx = x[q] + i * of.x - x[p.id], dy = y[q] + j * of.y - y[p.id];
                        if (std::hypot(dx, dy) >= of.reach) continue;
                        const auto n = std::count_if(seen.begin(), seen.end(), [&](const Seen& s) {
                            return s.id == q && s.image == Image{i, j} &&
                                   std::abs(s.column - p.column) <= cells.n_reach_columns &&
                                   std::abs(s.row - p.row) <= cells.n_reach_rows;
                        });
                        REQUIRE(n == 1);
                    }
                }
            }
        }
        for (const Ghost& ghost : layout.ghosts()) {
            CHECK(layout.indices()[ghost.slot] == layout.indices()[ghost.disc]);
            CHECK(ghost.x_shift * cells.width == Approx(ghost.image.x * of.x));
            CHECK(ghost.y_shift * cells.width == Approx(ghost.image.y * of.y));
            int n_listed = 0;
            layout.for_ghosts_of(ghost.disc,
                                 [&](const Ghost& one) { n_listed += one.slot == ghost.slot; });
            CHECK(n_listed == 1);
        }
    }
}

TEST_CASE("whole box: levels with cells of other widths have ghosts one period away in one unit") {
    const Case of{12, 9, true, true, 1, 40, 40};
    const Periods periods = periods_of(of);
    const std::vector<DiscState> discs = discs_of(of, 0.5);
    BoxLayout layout;
    layout.clear();
    std::vector<LocalIndex> small, large;
    for (const LocalIndex index : layout.list_once(discs, of.n_own))
        (index % 4 == 0 ? large : small).push_back(index);
    const double unit = 0.8;
    for (const auto& [listed, reach] : {std::pair(small, 1.0), std::pair(large, 4.1)}) {
        const std::size_t before = layout.indices().size();
        const BoxCells cells = cells_of_box({0, of.x, 0, of.y}, periods, reach, reach);
        layout.add_level(discs, listed, of.n_own, cells, periods, 0.5, unit);
        CHECK(layout.indices().size() > before + listed.size());
    }
    for (const Ghost& ghost : layout.ghosts()) {
        CHECK(layout.indices()[ghost.slot] == layout.indices()[ghost.disc]);
        CHECK(ghost.x_shift * unit == Approx(ghost.image.x * of.x));
        CHECK(ghost.y_shift * unit == Approx(ghost.image.y * of.y));
    }
}
