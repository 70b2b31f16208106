// SPDX-License-Identifier: BSD-3-Clause
// A speculative run of one block of cells over a window of time, without the other blocks. It
// carries out every collision of the block's own discs and of the discs in its halo, in the total
// order of the event-driven method (docs/understanding/method.md, sections 3.3 and 8).
//
//   cells of a rank          the run of block B, whose halo is two reaches deep
//   +-----+-----+-----+      +-----------------------------+
//   |     |     |     |      |   .      halo        .      |   . is run, and then discarded
//   |  A  |  B  |  C  |      |      +---------------+  .   |
//   |     |     |     |      | .    | r   ring    r |      |   r is run; its history goes to
//   +-----+-----+-----+      |      |   +-------+   |      |     BlockOutcome::ring
//   |     |     |     |      |   .  | r | o   o | r |  .   |
//   |  D  |  E  |  F  |      |      |   |   o   |   |      |   o is an own disc: its new state
//   |     |     |     |      |      |   +-------+   |      |     is kept, its history goes to
//   +-----+-----+-----+      |  .   | r       r     |  .   |     `histories`, which all blocks read
//                            |      +---------------+      |
//                            |       .        .       .    |
//                            +-----------------------------+
//
// A run ignores everything beyond its halo, so its result may be wrong. Therefore histories
// are compared. Disc 7 is an own disc of A and lies in the ring of B:
//
//   run of A: history h of disc 7 ---+
//                                    +--- h = h': B was right about disc 7
//   run of B: history h' of disc 7 --+--- h != h': if disc 7 can have met an own disc of B, A and B
//                                         run again with twice the halo (rollback)
//
// The result of a run is right if h = h' for all discs of its ring, and if its own discs have not
// collided with a disc from beyond the ring.
//
// The run uses copies of the discs, sorted by cell. Each copy has 64 bytes and four floats, so that
// all copies fit into the L2 cache. Most pairs are rejected in single precision, many at a time. A
// test in double precision decides about the rest.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "core/disc_state.hpp"
#include "core/raw_vector.hpp"
#include "core/side_columns.hpp"
#include "dynamics/all_dynamics.hpp"
#include "engine/loss_sums.hpp"
#include "engine/pair_event.hpp"
#include "engine/stress_sums.hpp"
#include "event_driven/block_cuts.hpp"
#include "event_driven/box_layout.hpp"
#include "event_driven/size_levels.hpp"

namespace carrom {

/// A window; its times are since the last sync. An event belongs to the window if begin < time <=
/// end. Only the first window after a sync also includes events at `begin`. In a later window, a
/// contact at `begin` is one that the previous window has already carried out.
struct BlockWindow {
    double begin = 0, end = 1;
    bool holds_begin = true;
    /// No disc is faster than this at `begin`. The run is invalid if a disc moves further from its
    /// position at `begin` than this speed allows.
    double speed_bound = 0;

    double duration() const { return end - begin; }
    BlockWindow with_bound(double speed) const { return {begin, end, holds_begin, speed}; }
};

/// The largest distance at the start of a window between two discs that can meet in it.
/// GridGeometry::n_reach is the number of cells that cover this distance.
double block_reach(const BlockWindow& window, double diameter, const Box& box);

/// The empty sums from which each part of a block run starts, and a time that the stress lacks.
struct BlockSums {
    StressSums no_stress{0x1p900}; ///< empty; terms are rounded to the unit of the engine's sums
    LossSums no_losses{0x1p900};   ///< empty; terms are rounded to the unit of the engine's sums
    double flown_before = 0; ///< time of flights before the last sync, not yet added to the stress
};

/// Which collisions of own discs are recorded, and how.
struct BlockNotes {
    bool log = false;           ///< whether collisions with walls go to BlockOutcome::log
    bool pairs_in_log = true;   ///< if `log`, whether collisions of pairs go there, too
    bool pairs = false;         ///< whether collisions of pairs go to BlockOutcome::pairs
    std::int64_t last_sync = 0; ///< micro-step of the last sync, for BlockOutcome::pairs
    double velocity_unit = 1;   ///< factor from stored velocities to those in BlockOutcome::pairs

    friend bool operator==(const BlockNotes&, const BlockNotes&) = default;
};

/// The data that all blocks of a rank share.
struct BlockGround {
    std::span<const DiscState> discs; ///< the rank's own discs, then the halo
    std::size_t n_own = 0;
    const SideColumns* columns = nullptr; ///< side columns of `discs`, in the same order
    const CellGrid* grid = nullptr;       ///< discs sorted by positions at the window's start
    CellBlock own_cells; ///< cells of own discs; by rounding, a disc may lie just outside of them
    BlockWindow window;
    std::span<const double> stops{}; ///< times inside the window at which parts of it end
    /// Whether a single run covers the whole box. If so, no histories are compared, and no grid is
    /// built.
    bool is_alone = false;
    BoxCells box_cells{};                ///< cells for runs of the whole box
    Extent extent{};                     ///< the box, for runs of the whole box
    std::span<const SizeLevel> levels{}; ///< levels of sizes, smallest discs first
    BlockSums sums{};
    BlockNotes notes{};
};

/// The event history of a disc in a block's ring (within one reach of the block). It is 0 if the
/// disc had no event, otherwise a hash of the times, partners and results of its events. The last
/// byte of the hash is a SpeedClass.
struct HaloRecord {
    LocalIndex index = 0;
    std::uint64_t history = 0;
};

/// The last byte c of a history: after each event the disc's speed was at most sqrt(c / 200) times
/// the window's speed bound. If c is 255, the disc may have any speed.
using SpeedClass = std::uint8_t;
inline constexpr std::uint64_t largest_speed_class = 255;
inline constexpr double speed_classes_to_bound = 200;

inline SpeedClass speed_class_of(std::uint64_t history) {
    return static_cast<SpeedClass>(history & largest_speed_class);
}

/// A collision for the log. `time` is since the last sync; `impulse` is the length of the vector
/// (gained_x, gained_y).
struct LoggedEvent {
    double time = 0;
    std::uint32_t generation = 0;
    bool is_wall = false;
    DiscId p = 0, q = 0; ///< if `is_wall`, q is 0 for a wall across x, 1 for one across y, and
                         ///< larger for a fixed body
    double impulse = 0;
    double gained_x = 0, gained_y = 0; ///< change of the velocity of p, in lengths per micro-step
    double vx = 0, vy = 0;             ///< velocity of p after the collision
    BodyTouch touch{};                 ///< place and normal of the contact with a fixed body
};

/// The state of a disc at the end of a part. Members that a window does not change are left out.
/// This saves a quarter of the memory of a DiscState, which matters because many new states are
/// kept until the window is validated.
class NewState {
public:
    NewState() = default;
    explicit NewState(const DiscState& disc)
        : x_(disc.x), y_(disc.y), vx_(disc.vx), vy_(disc.vy), tau_(disc.tau),
          wall_collisions_(disc.wall_collisions & low_bits), is_departed_(disc.is_departed),
          pair_collisions_(disc.pair_collisions & low_bits), has_collided_(disc.has_collided) {}

    /// Writes this state to `disc`, which must have the state of the same disc at an earlier time
    /// of the window. Since then its counters must have increased by less than 2^31.
    void overwrite(DiscState& disc) const {
        disc.x = x_;
        disc.y = y_;
        disc.vx = vx_;
        disc.vy = vy_;
        disc.tau = tau_;
        disc.wall_collisions += (wall_collisions_ - disc.wall_collisions) & low_bits;
        disc.pair_collisions += (pair_collisions_ - disc.pair_collisions) & low_bits;
        disc.is_departed = is_departed_;
        disc.has_collided = has_collided_;
    }

private:
    static constexpr std::uint64_t low_bits = 0x7fffffff; ///< the bits of a counter that are kept

    double x_, y_, vx_, vy_, tau_;
    std::uint32_t wall_collisions_ : 31;
    std::uint32_t is_departed_ : 1;
    std::uint32_t pair_collisions_ : 31;
    std::uint32_t has_collided_ : 1;
};
static_assert(sizeof(NewState) == 48);

/// The events of own discs in one part of a window, which ends at a stop or at the window's end.
struct BlockPart {
    /// Sizes of `hit`, `log` and `pairs` of BlockOutcome at the end of this part.
    std::size_t n_hit = 0, n_logged = 0, n_pairs = 0;
    std::uint64_t n_simultaneous = 0; ///< collisions at equal times; see RollbackCounts
    StressSums stress{1};             ///< sums over the events of this part
    LossSums losses{1};               ///< sums over the events of this part
    double work = 0;                  ///< work that moving images do on discs in these events
};

/// The results of a run. Lists have the entries of the first part, then of the second, and so on.
struct BlockOutcome {
    std::vector<BlockPart> parts; ///< one part for each stop, and one for the window's end
    std::vector<LocalIndex> hit;  ///< own discs that collided, part by part; each once per part
    RawVector<NewState> states;   ///< the new states of the discs in `hit`, in the same order
    SideColumns columns;          ///< side columns of the discs in `hit`, in the same order
    std::vector<HaloRecord> ring;
    std::vector<LoggedEvent> log;
    NotedEvents<PairEvent> pairs;
    std::uint64_t n_events = 0;  ///< number of events whose first disc is an own disc
    std::uint64_t n_carried = 0; ///< number of all events of the run, including events of the halo
    std::uint64_t n_seen = 0;    ///< number of discs in the run, including halo discs and ghosts
    double too_fast = 0;         ///< largest speed of discs that were too fast for the window, or 0
    /// Upper bound of the speeds of discs from beyond the ring that met own discs; 0 if none did
    double far_partner = 0;
    double largest_speed_at_end = 0;
    double largest_speed = 0; ///< upper bound of the speeds of own discs during the run
    bool is_cascade = false;  ///< whether the run ended in a collision cascade
    DiscId cascade_disc = 0, cascade_partner = 0; ///< equal if the partner is a wall
    double cascade_time = 0;

    /// The range of a list's entries that belong to the parts `first` to `end` - 1. `number` is the
    /// member of BlockPart for this list, such as &BlockPart::n_hit.
    std::pair<std::size_t, std::size_t> entries(std::size_t BlockPart::* number, std::size_t first,
                                                std::size_t end) const {
        const auto up_to = [&](std::size_t part) { return part > 0 ? parts[part - 1].*number : 0; };
        return {up_to(first), up_to(end)};
    }
};

/// Runs blocks on one thread, one after the other, and uses the same memory for all of them.
template <class Dynamics> class BlockRun {
public:
    explicit BlockRun(const Dynamics& dynamics);
    ~BlockRun();
    BlockRun(BlockRun&&) noexcept;

    /// Runs the own discs in `block`, together with all discs up to `halo` cells away from it.
    /// Writes the history of each own disc of the block to `histories`, at the disc's index. **Not
    /// collective**: threads may run different blocks at the same time.
    void run(const BlockGround& ground, const CellBlock& block, int halo,
             std::span<std::uint64_t> histories, BlockOutcome& outcome);

    /// Runs all discs of the box, which must be own discs or in the halo. Each disc occurs once,
    /// and its images are ghosts (box_layout.hpp). No other block can change the result.
    void run_whole(const BlockGround& ground, const CellBlock& block,
                   std::span<std::uint64_t> histories, BlockOutcome& outcome);

    /// Replaces the dynamics after a sync, because walls and moving images depend on the time.
    void change_dynamics(const Dynamics& dynamics);

    std::size_t bytes() const;

private:
    struct Scratch;

    void run_gathered(std::span<std::uint64_t> histories);
    void run_events(double end);

    std::unique_ptr<Scratch> scratch_;
};

#define CARROM_DECLARE(Dynamics) extern template class BlockRun<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DECLARE)
#undef CARROM_DECLARE

} // namespace carrom
