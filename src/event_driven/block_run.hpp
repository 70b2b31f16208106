// SPDX-License-Identifier: BSD-3-Clause
// A speculative run of a window of time in one block of cells, alone. It carries out every
// collision of its own discs and of those around them, in the total order of the event-driven
// method (docs/understanding/method.md, sections 3.3 and 8).
//
// A run does not see what happens beyond its halo, and may be wrong without noticing. So it also
// reports the event histories of the ring, the discs within one reach of its own cells. It is right
// if their owners have found the same, and if own discs have met no others. Block-local copies in
// the order of cells, a line of 64 bytes and four floats a disc, stay in the L2 cache. Whole runs
// of cells are rejected in single precision; the double predicate decides on the rest.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "core/disc.hpp"
#include "core/side_columns.hpp"
#include "dynamics/all_dynamics.hpp"
#include "engine/stress_sums.hpp"
#include "event_driven/box_layout.hpp"
#include "event_driven/size_levels.hpp"

namespace carrom {

/// Times since the last sync. An event belongs to the window if begin < time <= end; the first
/// window after a sync also holds its begin. What happened at `begin` is done: contacts of that
/// time are those of pairs that have just collided.
struct BlockWindow {
    double begin = 0, end = 1;
    bool holds_begin = true;
    double speed_bound = 0; ///< no disc is faster at the start, none gets further than this takes
                            ///< it, or the run is void

    double duration() const { return end - begin; }
};

/// How far apart two discs can be at a window's start that meet in it. Cells n_reach wide must
/// cover it.
double block_reach(const BlockWindow& window, double diameter, const Box& box);

/// Cells [first, end) of a grid's frame.
struct CellBlock {
    int first_column = 0, end_column = 0;
    int first_row = 0, end_row = 0;
};

/// What all blocks of a rank share: its discs, own ones first, and the grid built for the window's
/// start.
struct BlockGround {
    std::span<const Disc> discs;
    std::size_t n_own = 0;
    const CellGrid* grid = nullptr;
    CellBlock own_cells; ///< own discs that rounding puts outside belong to the nearest of them
    BlockWindow window;
    bool is_logged = false;
    const SideColumns* columns = nullptr; ///< by disc
    StressSums no_stress{0x1p900};        ///< where sums begin
    BoxCells box_cells{};                 ///< for runs of the whole box
    bool is_alone = false; ///< there is one run, of the whole box: nobody compares histories, and
                           ///< the grid says nothing
    std::span<const SizeLevel> levels{}; ///< of discs of several sizes
    Extent extent{};                     ///< the box, for runs of all of it
};

/// The event history of a disc of a block's ring: 0 for no event, else a hash of times, partners
/// and results.
struct HaloRecord {
    LocalIndex index = 0;
    std::uint64_t history = 0;
};

/// A collision as the log has it; times since the last sync, impulse per micro-step.
struct LoggedEvent {
    double time = 0;
    std::uint32_t generation = 0;
    bool is_wall = false;
    DiscId p = 0, q = 0; ///< q of a wall: 0 along x, 1 along y, else an obstacle
    double impulse = 0;
    double normal_impulse = 0; ///< of a wall: along x or y, with its sign
};

/// What has become of a disc in a window: three quarters of a state, since many are kept until a
/// window is validated.
class NewState {
public:
    NewState() = default;
    explicit NewState(const Disc& disc)
        : x_(disc.x), y_(disc.y), vx_(disc.vx), vy_(disc.vy), tau_(disc.tau),
          wall_collisions_(disc.wall_collisions & wall_bits), is_departed_(disc.is_departed),
          pair_collisions_(static_cast<std::uint32_t>(disc.pair_collisions)) {}

    /// `disc` is as it was at the window's start; its counters grow by less than 2^31.
    void overwrite(Disc& disc) const {
        disc.x = x_;
        disc.y = y_;
        disc.vx = vx_;
        disc.vy = vy_;
        disc.tau = tau_;
        disc.wall_collisions += (wall_collisions_ - disc.wall_collisions) & wall_bits;
        disc.pair_collisions += pair_collisions_ - static_cast<std::uint32_t>(disc.pair_collisions);
        disc.is_departed = is_departed_;
    }

private:
    static constexpr std::uint64_t wall_bits = 0x7fffffff;

    double x_, y_, vx_, vy_, tau_;
    std::uint32_t wall_collisions_ : 31; ///< the counters' low parts
    std::uint32_t is_departed_ : 1;
    std::uint32_t pair_collisions_;
};
static_assert(sizeof(NewState) == 48);

struct BlockOutcome {
    std::vector<LocalIndex> hit;  ///< own discs that have collided
    std::vector<NewState> states; ///< what has become of them
    SideColumns columns;          ///< likewise
    std::vector<HaloRecord> ring;
    std::vector<LoggedEvent> log;
    std::uint64_t n_events = 0; ///< whose first disc is own
    StressSums stress{1};       ///< of these
    double work = 0;            ///< that moving images have done in them, if they are logged
    double too_fast = 0;        ///< the largest speed of an own disc that got too far, else 0
    double far_partner = 0; ///< the largest speed of a disc from beyond the ring that an own disc
                            ///< has met, else 0
    double largest_speed_at_end = 0;
    bool is_cascade = false; ///< the run was given up in a collision cascade of this disc
    DiscId cascade_disc = 0, cascade_partner = 0; ///< equal if it is a wall that it meets
    double cascade_time = 0;
};

/// Scratch space of one thread; it keeps its memory from block to block.
template <class Dynamics> class BlockRun {
public:
    explicit BlockRun(const Dynamics& dynamics);
    ~BlockRun();
    BlockRun(BlockRun&&) noexcept;

    /// Runs the own discs in `block` and what lies `halo` cells around it. Writes the history of
    /// each own disc of the block to its place in `histories`. **Not collective**: many threads may
    /// run blocks at once.
    void run(const BlockGround& ground, const CellBlock& block, int halo,
             std::span<std::uint64_t> histories, BlockOutcome& outcome);

    /// The same for all discs of the box, which the rank has: each is there once, and periodic
    /// sides are looked through. Such a run is right.
    void run_whole(const BlockGround& ground, const CellBlock& block,
                   std::span<std::uint64_t> histories, BlockOutcome& outcome);

    /// Another one of the same kind from now on: walls that move are elsewhere after a sync.
    void change_dynamics(const Dynamics& dynamics);

    std::size_t bytes() const;

private:
    struct Scratch;

    void run_gathered(std::span<std::uint64_t> histories);

    std::unique_ptr<Scratch> scratch_;
};

#define CARROM_DECLARE(Dynamics) extern template class BlockRun<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DECLARE)
#undef CARROM_DECLARE

} // namespace carrom
