// SPDX-License-Identifier: BSD-3-Clause
// Copies simulations in memory, and changes discs between steps for the calling program.
//
// Both continue from the stored state like a restart from a checkpoint, so they also have the same
// bits on any number of ranks and threads. A changed disc starts anew at the present time. All
// others keep their stored bits, so setting a disc to its present values changes nothing. Cost:
// about the time to set up a run of these discs, and meanwhile the memory of a second run.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "dynamics/fixed_bodies.hpp"
#include "engine/engine.hpp"
#include "library/live_part.hpp"
#include "library/simulation_state.hpp"
#include "parallel/agreement.hpp"
#include "parallel/meeting.hpp"
#include "run/pilot/setting_choice.hpp"

namespace carrom {

namespace {

constexpr const char* call_name = "change_discs";
constexpr std::size_t most_named = 5; ///< most discs per rank whose problems a message lists

/// The region in which discs' centres may be at the present step.
class Room {
public:
    explicit Room(const Run& run)
        : scene_(run.scene()), species_(run.system().species_table()),
          extent_(extent_at(scene_.effects, run.system().engine().box(),
                            static_cast<double>(run.step()))),
          size_(run.system().engine().size() *
                scene_.effects.size_at(static_cast<double>(run.step()))),
          rounding_(32 * 0x1p-53 * scene_.box.longest()),
          fixed_bodies_(scene_.box, scene_.radius * size_, scene_.effects) {}

    /// The reason why a disc cannot be at its position; empty if it can be there.
    std::string problem(const Disc& disc) const {
        const double radius = species_.of(disc.id).radius * size_;
        const Origin& origin = scene_.origin;
        const double x = disc.x + origin.x, y = disc.y + origin.y;
        const bool is_inside = is_between(x, extent_.x_low, extent_.x_high, radius,
                                          scene_.effects.is_periodic_x()) &&
                               is_between(y, extent_.y_low, extent_.y_high, radius,
                                          scene_.effects.is_periodic_y());
        if (!is_inside)
            return fmt::format("lies outside of the box, [{}, {}{} x [{}, {}{}, or in a wall",
                               extent_.x_low - origin.x, extent_.x_high - origin.x,
                               scene_.effects.is_periodic_x() ? ')' : ']', extent_.y_low - origin.y,
                               extent_.y_high - origin.y,
                               scene_.effects.is_periodic_y() ? ')' : ']');
        const auto overlap = fixed_bodies_.deepest_overlap(x, y, radius,
                                                           2 * std::max(2e-12 * radius, rounding_));
        if (overlap.body == BodyContact::no_body) return {};
        return fmt::format("overlaps {} by {:.3g}", fixed_bodies_.name_of(overlap.body),
                           overlap.depth);
    }

private:
    bool is_between(double place, double low, double high, double radius, bool is_periodic) const {
        if (is_periodic) return place >= low && place < high;
        return place >= low + radius - rounding_ && place <= high - radius + rounding_;
    }

    const SceneParameters& scene_;
    SpeciesTable species_;
    Extent extent_;
    double size_, rounding_;
    FixedBodies fixed_bodies_;
};

struct Change {
    bool of_place = false, of_velocity = false, of_spin = false;
    bool is_on() const { return of_place || of_velocity || of_spin; }
};

/// The disc with coordinates relative to the box's lower left corner; unchanged ones keep all bits.
Disc counted_from_corner(Disc disc, const DiscState& shown, const Origin& origin) {
    disc.x = disc.x == shown.x - origin.x ? shown.x : disc.x + origin.x;
    disc.y = disc.y == shown.y - origin.y ? shown.y : disc.y + origin.y;
    return disc;
}

/// Compares a given disc with `shown`, its state in the box's frame with velocities per micro-step.
Change change_of(const Disc& disc, const DiscState& shown, double unit, double spin) {
    return {disc.x != shown.x || disc.y != shown.y,
            disc.vx != shown.vx * unit || disc.vy != shown.vy * unit, disc.spin != spin};
}

/// Writes the changed disc to `stored`, with the present time. `shown` is its old state in the
/// frame of the box.
void apply(const Disc& disc, const Change& change, const DiscState& shown, const Frame& frame,
           double time, double unit, DiscState& stored) {
    const double x = stored.x_at(time), y = stored.y_at(time);
    stored.x = change.of_place ? disc.x - frame.x : x;
    stored.y = change.of_place ? disc.y - frame.y : y;
    stored.tau = time;
    if (!change.of_velocity) return;
    if (frame.periods.are_moving()) { // the image in the box may have another velocity
        stored.vx += (disc.vx / unit - shown.vx) / frame.slowing;
        stored.vy += (disc.vy / unit - shown.vy) / frame.slowing;
    } else {
        stored.vx = (disc.vx / unit - frame.vx) / frame.slowing;
        stored.vy = (disc.vy / unit - frame.vy) / frame.slowing;
    }
}

/// Throws a single problem if smooth discs are given spins, because the reason is the same for all
/// of them. **Collective.**
void refuse_spins_of_smooth(const std::vector<Disc>& discs, const Run& run) {
    const bool have_spins = !run.system().spins().empty();
    const bool are_given = std::ranges::any_of(discs, [](const Disc& d) { return d.spin != 0; });
    if (run.ranks().any(are_given && !have_spins))
        throw InputError({{call_name, 0,
                           "discs are smooth, and only rough discs turn; leave out their spins, or "
                           "set effects.contact.kind = \"rough\" in the scene"}});
}

/// The problems of the given discs. Both lists must be in order of id.
std::vector<Problem> problems_of(const std::vector<Disc>& discs, const std::vector<Disc>& present,
                                 const Run& run) {
    const auto has_same_id = [](const Disc& a, const Disc& b) { return a.id == b.id; };
    if (!std::ranges::equal(discs, present, has_same_id))
        return {{call_name, 0,
                 fmt::format("wants each of this rank's {} discs once, as discs() has them",
                             present.size())}};
    std::vector<Problem> problems;
    const Room room(run);
    for (std::size_t i = 0; i < discs.size() && problems.size() < most_named; ++i) {
        const Disc& disc = discs[i];
        const auto refuse = [&](const std::string& text) {
            problems.push_back({fmt::format("disc {}", disc.id), 0, text});
        };
        const bool is_moved = disc.x != present[i].x || disc.y != present[i].y;
        if (!std::isfinite(disc.x) || !std::isfinite(disc.y) || !std::isfinite(disc.vx) ||
            !std::isfinite(disc.vy) || !std::isfinite(disc.spin))
            refuse("has a number that is not finite");
        else if (const std::string text = is_moved ? room.problem(disc) : ""; !text.empty())
            refuse(fmt::format("at ({}, {}) {}", disc.x, disc.y, text));
    }
    return problems;
}

/// The changes that a call makes on this rank.
struct Changed {
    bool places = false, any = false;
    /// Box lengths between the stored positions of moved discs and their positions in a periodic
    /// box. The new stored positions are in the box, so no sync records these lengths.
    std::vector<Crossing> crossings{};
};

/// Changes the discs of a stored state. Departed discs stay as they are.
Changed change_stored(const std::vector<Disc>& discs, const Run& run, StoredState& state) {
    const DiscSystem& system = run.system();
    const Frame frame = system.frame();
    const Periods& box = frame.periods;
    const auto lengths = [](double flown, double shown, double period) {
        return period == 0 ? 0 : std::round((flown - shown) / period);
    };
    const double unit = system.velocity_unit(), time = system.clock();
    std::vector<double> no_spins;
    std::vector<double>& spins = state.columns.has(SideColumn::spin)
                                     ? state.columns[SideColumn::spin]
                                     : no_spins;
    Changed changed;
    for (std::size_t i = 0; i < state.discs.size(); ++i) {
        DiscState& stored = state.discs[i];
        if (stored.has_departed()) continue;
        const DiscState shown = frame.in_box(stored, time);
        const Disc disc = counted_from_corner(
            *std::ranges::lower_bound(discs, stored.id, {}, &Disc::id), shown, run.scene().origin);
        const Change change = change_of(disc, shown, unit, spins.empty() ? 0 : spins[i] * unit);
        if (!change.is_on()) continue;
        changed.any = true;
        if (change.of_place) {
            changed.places = true;
            changed.crossings.push_back({stored.id,
                                         lengths(stored.x_at(time) + frame.x, shown.x, box.x),
                                         lengths(stored.y_at(time) + frame.y, shown.y, box.y)});
        }
        apply(disc, change, shown, frame, time, unit, stored);
        if (change.of_spin) spins[i] = disc.spin / unit;
    }
    return changed;
}

} // namespace

RunStart stored_start(Run& run) {
    RunStart start;
    start.samples = run.stored_samples();
    start.counts_images = run.images() != nullptr;
    const std::span<const DiscState> discs = run.system().discs();
    StoredState& state = start.stored.emplace();
    state.discs.assign(discs.begin(), discs.end());
    state.columns = SideColumns(run.system().side_columns());
    state.micro_steps_done = run.system().micro_steps_done();
    state.kept_by_effects = start.samples.effects;
    return start;
}

SceneParameters scene_to_go_on(const Run& run) {
    SceneParameters scene = run.scene();
    if (scene.accuracy) decide_on(scene, {scene.method, scene.micro_steps});
    return scene;
}

Simulation Simulation::copy() const {
    Run& run = live().run();
    meet(run.ranks(), "Simulation::copy");
    return Simulation(std::make_unique<State>(scene_to_go_on(run), stored_start(run), run.ranks(),
                                              live().tuning, Messages()));
}

void Simulation::change_discs(std::span<const Disc> changed) {
    Run& run = live().run();
    meet(run.ranks(), "Simulation::change_discs");
    std::vector<Disc> sorted(changed.begin(), changed.end());
    std::ranges::sort(sorted, {}, &Disc::id);
    agree_on_problems(run.ranks(), problems_of(sorted, discs(), run));
    refuse_spins_of_smooth(sorted, run);
    RunStart start = stored_start(run);
    const Changed mine = change_stored(sorted, run, *start.stored);
    if (!run.ranks().any(mine.any)) return;
    const bool are_moved = run.ranks().any(mine.places);
    const std::uint64_t overlaps = are_moved ? run.system().totals().overlapping_pairs : 0;
    if (are_moved) {
        StoredSamples kept;
        kept.effects = std::move(start.samples.effects);
        kept.have_images = start.samples.have_images;
        if (kept.have_images) kept.first_places = std::move(start.samples.first_places);
        start.samples = std::move(kept);
    }
    start.samples.averages.clear();
    live().replace(std::move(start), are_moved ? std::optional(overlaps) : std::nullopt);
    if (ImageCounts* images = live().run().images()) images->add(mine.crossings);
}

} // namespace carrom
