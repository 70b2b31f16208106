// SPDX-License-Identifier: BSD-3-Clause
// The working data of a block run: copies of the discs of a block and its halo, their events so
// far, and their predicted events.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "event_driven/block_run.hpp"
#include "event_driven/cascade_watch.hpp"
#include "event_driven/event_queue.hpp"
#include "event_driven/flight_filter.hpp"

namespace carrom {

/// A summary of a disc's events in this window.
struct EventHistory {
    static constexpr std::uint32_t nobody = 0xfffffffd;

    /// Hash of the disc's events (HaloRecord). If BlockGround::is_alone, it is 1 after any event.
    std::uint64_t history = 0;
    std::uint32_t generation = 0;   ///< generation of the last collision
    std::uint32_t partner = nobody; ///< partner in the last collision

    /// Adds a collision to the hash: its time, the partner's id, and the disc's velocity and spin
    /// after it. The position follows from all these, so the hash need not contain it.
    void add(double time, const DiscState& disc, std::uint64_t partner_id, const double* spin,
             SpeedClass speed) {
        const auto mixed = [](double value, std::uint64_t factor) {
            return std::rotl(std::bit_cast<std::uint64_t>(value) * factor, 31);
        };
        const std::uint64_t sum = mixed(time, 0x9e3779b97f4a7c15u) +
                                  mixed(disc.vx, 0xbf58476d1ce4e5b9u) +
                                  mixed(disc.vy, 0x94d049bb133111ebu) + partner_id;
        std::uint64_t hash = (std::rotl(history, 17) ^ sum) * 0xff51afd7ed558ccdu;
        if (spin)
            hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint64_t>(*spin)) *
                   0xc4ceb9fe1a85ec53u;
        const std::uint64_t fastest = std::max<std::uint64_t>(speed, speed_class_of(history));
        history = ((hash ^ (hash >> 32)) & ~largest_speed_class) | fastest;
    }
};
static_assert(sizeof(EventHistory) == 16);

/// A rectangle that contains the positions of all possible partners of a flight at the window's
/// start. Its coordinates are in units of Scratch::cell_width.
struct FlightBox {
    float left = 0, right = 0, bottom = 0, top = 0;
};

/// The cells that a flight box covers, `left` to `right` and `bottom` to `top`, both included.
struct CellsOfBox {
    int left = 0, right = 0, bottom = 0, top = 0;
};

/// The cells of one level of disc sizes (size_levels.hpp).
struct LevelCells {
    BoxCells cells;
    double smallest_radius = 0, largest_radius = 0; ///< radii at the window's end
    std::size_t first_start = 0;                    ///< index in `cell_starts` of the first cell
    std::uint32_t end_slot = 0;
    float columns_per_unit = 1, rows_per_unit = 1; ///< cells per unit of the lanes
    float left = 0, bottom = 0;                    ///< lower left corner, in units of the lanes
    float farthest = 0; ///< margin of flight boxes besides a disc's radius, in units of the lanes

    int n_columns() const { return cells.n_columns + 2 * cells.n_beside; }
    int n_rows() const { return cells.n_rows + 2 * cells.n_above; }
};

template <class Dynamics> struct BlockRun<Dynamics>::Scratch {
    /// Whether discs lie in levels of cells by their size; this is not done if rows of images move.
    static constexpr bool has_sizes = Dynamics::has_species && !Dynamics::has_moving_images;

    explicit Scratch(const Dynamics& of_scene) : dynamics(of_scene) {}

    void begin(const BlockGround& of_rank, BlockOutcome& of_run);
    void list_discs(const CellBlock& own, int halo);
    void list_all_discs();
    void gather();
    void set_scales();
    void mark_own(const CellBlock& own);
    void mark_own_of_all(const CellBlock& own);
    /// Stores a disc's velocity in cells per window, and its position at `start` in cells.
    [[gnu::always_inline]] void place(std::uint32_t slot, double start) {
        const DiscState& disc = discs[slot];
        const auto [along, across] = turned(axis, x_of(disc, start), y_of(disc, start));
        const auto [v_along, v_across] = turned(axis, vx_of(disc), disc.vy);
        x[slot] = static_cast<float>((along - x_corner) * cells_per_length);
        y[slot] = static_cast<float>((across - y_corner) * cells_per_length);
        vx[slot] = static_cast<float>(v_along * cells_per_speed);
        vy[slot] = static_cast<float>(v_across * cells_per_speed);
    }
    /// Stores the flight of a ghost, which is a displaced image of a disc.
    void place_ghost(const Ghost& ghost) {
        x[ghost.slot] = x[ghost.disc] + ghost.x_shift;
        y[ghost.slot] = y[ghost.disc] + ghost.y_shift;
        vx[ghost.slot] = vx[ghost.disc];
        vy[ghost.slot] = vy[ghost.disc];
        if constexpr (Dynamics::has_moving_images)
            vx[ghost.slot] += static_cast<float>(ghost.image.y * periods().speed * cells_per_speed);
    }
    /// The square of the speed (in cells per window) of the disc's fastest nearby image.
    float lane_speed_squared(std::uint32_t slot) const {
        if constexpr (Dynamics::has_moving_images) {
            const auto [along, across] = turned(axis, vx[slot], vy[slot]);
            const float fastest = std::abs(along) +
                                  static_cast<float>(std::abs(periods().speed) * cells_per_speed);
            return fastest * fastest + across * across;
        } else {
            return vx[slot] * vx[slot] + vy[slot] * vy[slot];
        }
    }
    void predict_all();
    void happen(const Event& event);
    void carry_out(const Event& event);
    Loss collide(const Event& event);
    void check_partner(std::uint32_t slot);
    void note(std::uint32_t slot, std::uint32_t partner, const Event& event);
    void hold_to_schedule(std::uint32_t slot, double time);
    /// The flight of a disc from its last collision on.
    Flight flight_of(std::uint32_t slot) const {
        const auto now = static_cast<float>((discs[slot].tau - ground.window.begin) *
                                            windows_per_time);
        return {x[slot] + vx[slot] * now, y[slot] + vy[slot] * now, vx[slot], vy[slot], now, slot};
    }
    /// The box around the rest of a flight. It is computed without branches on the signs of
    /// velocities, because the processor cannot predict these branches.
    FlightBox box_of(const Flight& flight, float half_side) const {
        const float half = (1 - flight.now) / 2;
        const float dx = flight.vx * half, dy = flight.vy * half;
        const float x_middle = flight.x + dx, y_middle = flight.y + dy;
        const float wide = std::abs(dx) + half_side, high = std::abs(dy) + half_side;
        return {x_middle - wide, x_middle + wide, y_middle - high, y_middle + high};
    }
    /// Fills `runs` with the ranges of slots in the cells that the flight box covers.
    void find_runs(const FlightBox& box);
    /// Fills `runs` with the slots of the covered cells, and resizes the lists of partners so that
    /// all of these slots fit. `starts` has the first slots of all cells, column after column.
    [[gnu::always_inline]] void list_runs(const std::uint32_t* starts, std::size_t column_length,
                                          const CellsOfBox& covered) {
        starts += static_cast<std::size_t>(covered.left) * column_length;
        SlotRange* run = runs.data();
        std::uint32_t n_slots = 0;
        for (int k = covered.left; k <= covered.right; ++k, starts += column_length) {
            *run = {starts[covered.bottom], starts[covered.top + 1]};
            n_slots += run->end - run->begin;
            run += run->begin < run->end;
        }
        n_runs = static_cast<std::size_t>(run - runs.data());
        if (partners.size() < n_slots + filter_padding) {
            partners.resize(2 * n_slots + filter_padding);
            others_partners.resize(partners.size());
        }
    }
    void predict_pairs(std::uint32_t slot) {
        if (!dynamics.has_pairs()) return;
        if constexpr (has_sizes)
            predict_sized(slot);
        else
            predict_pairs(flight_of(slot));
    }
    void predict_pairs(const Flight& flight);
    /// Finds the partners of every disc, so a pair may be found twice. This is needed if rows of
    /// images slide: the ghosts of a pair across a sheared side need not lie in opposite cells, so
    /// the order of cells may make neither disc the first of the pair.
    void predict_pairs_of_all() {
        for (std::uint32_t slot = 0; slot < discs.size(); ++slot)
            if (!ghost_at(slot)) predict_pairs({x[slot], y[slot], vx[slot], vy[slot], 0, slot});
    }
    void predict_pairs_of(std::uint32_t p, std::uint32_t q);
    void predict_pair(std::uint32_t a, std::uint32_t b);
    void predict_walls(std::uint32_t slot);
    void predict_fixed_body(std::uint32_t slot, double until);
    void predict_shifted(std::uint32_t a, std::uint32_t b, const Image* image);
    void predict_image(std::uint32_t a, std::uint32_t b, const Image& image);
    void push(double time, std::uint32_t a, std::uint32_t b, const Image* image = nullptr);
    void report(std::span<std::uint64_t> histories);
    void report_by_cells(std::span<std::uint64_t> histories, double& end_squared);
    void report_hits();
    void report_hit(std::uint32_t slot, std::size_t place);
    void report_disc(std::uint32_t slot, std::span<std::uint64_t> histories, std::size_t& next,
                     double& end_squared);
    std::size_t make_room_for_hits();
    void begin_part();
    void end_part();

    // These functions are for discs of several sizes (block_levels.cpp).
    void list_levels(const CellBlock& own, int halo);
    void list_levels_of_all();
    void lay_levels(const Extent& extent, const Periods& across, std::size_t n_at_home);
    void set_scales_of_levels();
    void measure_radii();
    void predict_levels();
    void find_runs_of(const LevelCells& level, const FlightBox& box, bool with_ghosts);
    void predict_in_level(const Flight& flight, std::size_t own, std::size_t other);
    void predict_seen(const Flight& flight, float radius, const Image* image);
    void predict_sized(std::uint32_t slot);
    void predict_two_sized(std::uint32_t p, std::uint32_t q);
    std::size_t level_of_slot(std::uint32_t slot) const {
        std::size_t level = 0;
        while (slot >= levels[level].end_slot) ++level;
        return level;
    }
    /// The radius at the scene's start.
    double first_radius_of(const DiscState& disc) const {
        if constexpr (has_sizes)
            return dynamics.species_table().of(disc.id).radius;
        else
            return dynamics.radius();
    }
    SizedLanes sized_lanes() const { return {lanes, radii.data()}; }
    float margin_of(std::size_t own, std::size_t other) const {
        return margins[own * levels.size() + other];
    }

    SpeedClass speed_class(double squared_speed) const {
        constexpr auto largest = static_cast<double>(largest_speed_class);
        return static_cast<SpeedClass>(std::min(1 + squared_speed * classes_per_squared, largest));
    }
    /// The disc's angular velocity, or null if discs do not rotate.
    double* spin_of(std::uint32_t slot) {
        return dynamics.has_spin() ? &columns[SideColumn::spin][slot] : nullptr;
    }
    std::uint32_t versions_of(const Event& event) const {
        return discs[event.p].version() + (is_wall(event.q) ? 0 : discs[event.q].version());
    }
    Periods periods() const {
        if constexpr (Dynamics::is_periodic) return dynamics.periods();
        return {};
    }
    const Ghost* ghost_at(std::uint32_t slot) const {
        return Dynamics::is_periodic && is_whole ? layout.ghost_at(slot) : nullptr;
    }
    /// Whether the two discs collided with each other at this time and with no other disc since. In
    /// a periodic box this is also true if other images of the two discs collided.
    bool have_just_collided(std::uint32_t a, std::uint32_t b, double time) const {
        if constexpr (Dynamics::is_periodic) {
            const auto was = [this](std::uint32_t partner, std::uint32_t disc) {
                return partner < discs.size() && discs[partner].id == discs[disc].id;
            };
            return was(past_events_of[a].partner, b) && was(past_events_of[b].partner, a) &&
                   time == discs[a].tau;
        } else {
            return past_events_of[a].partner == b && past_events_of[b].partner == a &&
                   time == discs[a].tau;
        }
    }
    [[gnu::always_inline]] double x_of(const DiscState& disc, double time) const {
        if constexpr (Dynamics::is_periodic)
            return dynamics.periods().x_of(disc, time);
        else
            return disc.x_at(time);
    }
    [[gnu::always_inline]] double y_of(const DiscState& disc, double time) const {
        if constexpr (Dynamics::is_periodic)
            return dynamics.periods().y_of(disc, time);
        else
            return disc.y_at(time);
    }
    [[gnu::always_inline]] double vx_of(const DiscState& disc) const {
        if constexpr (Dynamics::has_moving_images)
            return dynamics.periods().vx_of(disc);
        else
            return disc.vx;
    }
    int owning_column(int column) const {
        return std::clamp(column, ground.own_cells.first_column, ground.own_cells.end_column - 1);
    }
    /// Slots in rows `first_row` to `last_row` of a column, counted from the corner of `cells`.
    SlotRange cell_run(int column, int first_row, int last_row) const {
        const std::uint32_t* const starts = cell_starts.data() +
                                            static_cast<std::size_t>(column) * cell_rows;
        return {starts[first_row], starts[last_row + 1]};
    }
    /// Slots in rows `first_row` to `last_row` of a column, numbered as in the rank's grid.
    SlotRange grid_run(int column, int first_row, int last_row) const {
        return cell_run(column - cells.first_column, first_row - cells.first_row,
                        last_row - cells.first_row);
    }

    /// Whether the disc is in a cell of `ring`. Histories of such discs are compared by validation.
    bool is_compared(std::uint32_t slot) const {
        if (has_sizes) return is_of_ring[slot] != 0;
        const auto behind = std::upper_bound(cell_starts.begin(), cell_starts.end(), slot);
        const auto cell = static_cast<std::size_t>(behind - cell_starts.begin()) - 1;
        const int column = cells.first_column + static_cast<int>(cell / cell_rows),
                  row = cells.first_row + static_cast<int>(cell % cell_rows);
        return column >= ring.first_column && column < ring.end_column && row >= ring.first_row &&
               row < ring.end_row;
    }

    [[gnu::noinline]] void give_up(const Event& event) {
        outcome->is_cascade = true;
        outcome->cascade_disc = discs[event.p].id;
        outcome->cascade_partner = is_wall(event.q) ? discs[event.p].id : discs[event.q].id;
        outcome->cascade_time = event.time;
    }

    [[gnu::noinline]] void end_void_run(double squared_speed) {
        too_fast = std::max(too_fast, std::sqrt(squared_speed));
        is_void = true;
    }

    /// Records a finished collision, before the second disc is moved back from its image.
    [[gnu::noinline]] void record_pair(const Event& event, const PairStress<Dynamics>& before,
                                       const Separation& to) {
        if (!outcome->pairs.has_room()) [[unlikely]] // this rare case has a function of its own, so
                                                     // that the event loop saves no register for it
            return record_pair_in_more_room(event, before, to);
        const DiscState &p = discs[event.p], &q = discs[event.q];
        record_in(outcome->pairs.add(), dynamics, p, to, p, q, before.vx(), before.vy(), event.time,
                  ground.notes.velocity_unit, ground.notes.last_sync);
    }

    [[gnu::noinline]] void record_pair_in_more_room(const Event& event,
                                                    const PairStress<Dynamics>& before,
                                                    const Separation& to) {
        outcome->pairs.grow();
        record_pair(event, before, to);
    }

    [[gnu::noinline]] void log_event(const Event& event, double wx, double wy) {
        const bool at_wall = is_wall(event.q);
        if (!ground.notes.pairs_in_log && !at_wall) return;
        outcome->log.push_back({event.time, event.generation, at_wall, discs[event.p].id,
                                at_wall ? event.q - x_wall : discs[event.q].id,
                                std::sqrt(wx * wx + wy * wy), wx, wy, discs[event.p].vx,
                                discs[event.p].vy});
        if constexpr (Dynamics::may_have_fixed_bodies)
            if (is_fixed_body(event.q))
                outcome->log.back().touch = dynamics.touch(discs[event.p],
                                                           event.q - first_fixed_body, event.time);
    }

    Dynamics dynamics;
    BlockGround ground;
    bool is_whole = false; ///< whether the run covers the whole box; then every disc occurs once
    CellBlock cells;       ///< own cells and the halo
    CellBlock ring;        ///< own cells and all cells within one reach of them
    CellBlock firsts; ///< cells of the first discs of pairs, counted from the corner of `cells`
    int n_reach_columns = 1, n_reach_rows = 1;
    Axis axis = Axis::x; ///< the box's axis that cells, lanes and bounds of this struct call x
    double x_corner = 0, y_corner = 0, cell_width = 1, cells_per_length = 1, cells_per_speed = 1,
           windows_per_time = 1;
    float column_limit = 0, row_limit = 0;
    float rows_per_cell = 1; ///< cell width divided by cell height; cells may be higher than wide
    float touching_squared = 0,
          /// `farthest`: distance in cells by which a flight box extends beyond its flight
        farthest = 0;
    float x_inner_low = 0, x_inner_high = 0, y_inner_low = 0,
          y_inner_high = 0;    ///< a disc whose flight ends between these, in cells, meets no wall
    std::size_t cell_rows = 0; ///< number of entries of `cell_starts` for each column
    std::vector<std::uint32_t> cell_starts; ///< first slot of each cell, and each column's end
    std::vector<LocalIndex> indices;        ///< for each slot, the disc's index in `ground.discs`
    DiscStates discs;
    SideColumns columns = side_columns_of(dynamics);
    std::vector<EventHistory> past_events_of;
    std::vector<std::uint8_t> is_own;
    std::vector<std::uint8_t> is_hit;     ///< whether a slot's disc has collided in this part
    std::vector<std::uint32_t> hit_slots; ///< slots of the discs that have collided
    /// Slots and cells for runs of the whole box, and for all runs with levels of disc sizes
    BoxLayout layout;
    std::vector<float> x, y, vx, vy;
    FlightLanes lanes;
    EventQueue queue;
    std::vector<SlotRange> runs; ///< slots to search, by column; only the first n_runs are valid
    std::size_t n_runs = 0;
    std::vector<std::uint32_t> partners,
        others_partners; ///< partners of one disc, and of the disc that it collided with
    std::vector<std::uint32_t> later,
        /// `later`: for each disc of a column in turn, its possible partners later in the column or
        /// in columns to the right; `later_ends`: for each disc, where its partners end in `later`
        later_ends;
    CascadeWatch cascade_watch;
    BlockOutcome* outcome = nullptr;
    BlockPart part;                 ///< the part of the window that is being run
    StressTerms stress_terms;       ///< terms that have not been added to the part's sums yet
    double bound_squared = 0;       ///< square of the speed bound
    float bound_lane_squared = 0;   ///< the square of a slightly smaller bound, in cells per window
    double void_squared = 0;        ///< a disc whose squared speed exceeds this ends the run
    double too_fast = 0;            ///< largest speed that was too fast for the window, or 0
    bool is_void = false;           ///< whether a disc's speed requires a far shorter window
    double largest_squared = 0;     ///< square of BlockOutcome::largest_speed
    double classes_per_squared = 1; ///< number of speed classes per unit of squared speed
    // Members for discs of several sizes.
    std::vector<LevelCells> levels;                 ///< smallest discs first
    std::vector<std::vector<LocalIndex>> in_levels; ///< indices of the discs of each level
    /// For each slot of a level, the disc's position in the level's list in `in_levels`
    std::vector<std::vector<std::uint32_t>> orders;
    std::vector<float> radii; ///< radius of the disc in each slot, in units of the lanes
    /// Margins added to sums of radii, for each pair of levels (margin_of), in units of the lanes
    std::vector<float> margins;
    /// For each slot, whether its disc is within one reach of the own cells (is_compared)
    std::vector<std::uint8_t> is_of_ring;
};

} // namespace carrom
