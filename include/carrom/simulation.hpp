// SPDX-License-Identifier: BSD-3-Clause
// A scene that moves forward in time, and its checkpoints.
//
// The state depends only on the scene and the step. It has the same bits for any number of ranks
// and threads, and for any division of the steps into calls. A disc is stored on the rank whose
// part of the box it is in.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <carrom/averages.hpp>
#include <carrom/disc.hpp>
#include <carrom/measured_table.hpp>
#include <carrom/scene.hpp>
#include <carrom/session.hpp>
#include <carrom/totals.hpp>

namespace carrom {

/// Choices that change how long a run takes, and never its result.
struct Options {
    /// Threads of each rank; 0: OMP_NUM_THREADS, or else its share of the node's cores
    int threads = 0;
    /// Receives on rank 0 each line that `carrom run` prints when it starts, such as warnings and
    /// the choice of a pilot. If empty, these lines are dropped.
    std::function<void(const std::string& line)> messages{};
    /// Needed for `read_images`; takes 16 bytes a disc in periodic boxes
    bool counts_images = false;
};

/// When `advance_to` writes checkpoints, and how many it keeps.
struct CheckpointSchedule {
    std::string folder{};         ///< made if it is missing; no other run may write to it
    std::int64_t every_steps = 0; ///< steps between checkpoints; 0: none by steps
    double every_minutes = 0;     ///< wall time between checkpoints; 0: none by time
    std::int64_t keep = 2; ///< number of checkpoints to keep; older ones of this run are removed
    bool at_end = true;    ///< whether to write one at the step `time.steps`, too
};

class Simulation {
public:
    /// Makes the scene at step 0. Throws InputError with all problems of the scene and of its
    /// discs. With `time.accuracy` a pilot first chooses method and micro-steps; `scene()` has its
    /// choice. Of the tables under `output` only `output.measurements` has an effect, and no file
    /// is written. Memory: 94 bytes a disc and more (120 in the event-driven method), shared by the
    /// ranks. The session must outlive it. **Collective.**
    Simulation(const Session& session, const Scene& scene, const Options& options = {});

    /// Continues from a checkpoint of this library or of `carrom run`, with the same bits as the
    /// uninterrupted run. If the place is a folder, the newest complete checkpoint there is used.
    /// The scene is in the file. `settings` (such as "time.steps=200") override its keys and may
    /// change the last step and the measurements. Throws CollectiveError (code 2) if the file is
    /// damaged, InputError if a setting would make it another run. **Collective.**
    static Simulation from_checkpoint(const Session& session, const std::string& path,
                                      const std::vector<std::string>& settings = {},
                                      const Options& options = {});

    /// After a move, every call of the old object throws InputError, except assignment.
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    ~Simulation();

    const SceneFacts& scene() const; ///< facts of the scene; not collective
    std::int64_t step() const;       ///< steps since the scene's start; not collective

    /// Moves forward to the end of that step. Throws InputError if the step is before the present
    /// one, or after `time.steps`. **Collective.**
    void advance_to(std::int64_t step);
    void advance(std::int64_t n_steps);                  ///< **Collective.**
    void advance_to_end() { advance_to(scene().steps); } ///< **Collective.**

    /// This rank's discs at the present step, in the order of their ids. All ranks together have
    /// each disc once. Discs that have left through an open side are included: they rest one radius
    /// outside. Costs a copy and a sort. Not collective.
    std::vector<Disc> discs() const;

    /// All discs, in the order of their ids, on rank 0; nothing on the others. Takes 64 bytes a
    /// disc there. **Collective.**
    std::vector<Disc> gathered_discs() const;

    /// These functions write numbers of this rank's discs to the places of their ids, and leave the
    /// places of other discs unchanged. x and y of disc `id` go to places 2 id and 2 id + 1, its
    /// spin and its direction to place `id`, its collisions with walls and with discs to places 2
    /// id and 2 id + 1. If the arrays have no room for all discs of the scene, InputError is
    /// thrown. Cost: one pass by all threads. Not collective.
    void read_positions(std::span<double> xy) const;
    void read_velocities(std::span<double> xy) const; ///< length per step
    void read_spins(std::span<double> spins) const;   ///< angle per step
    /// Angles from the x axis, counterclockwise; 0 unless discs are active.
    void read_directions(std::span<double> angles) const;
    void read_collisions(std::span<std::int64_t> counts) const;

    /// Writes by how many box lengths discs have crossed periodic sides, along x and along y, to
    /// places 2 id and 2 id + 1. Each rank writes its share of the ids. Adding these lengths to a
    /// position gives a path without jumps. They count from the scene's start, or from a checkpoint
    /// that has none. Writes nothing unless `Options::counts_images` was set and a side is
    /// periodic. Throws InputError between sheared sides, because their images move.
    /// **Collective.**
    void read_images(std::span<std::int32_t> lengths) const;

    /// Radius, mass and species of all discs of the scene, by id. If discs exchange their radii
    /// (`effects.swap`), the radii are those of the present step. Not collective.
    std::vector<DiscKind> kinds() const;

    /// Gives this rank's discs other positions, velocities or spins between two steps. `discs` are
    /// those that `discs()` returns, in any order; their counts of collisions are ignored. Discs
    /// whose numbers do not change keep all of their bits. Averages begin anew. If positions have
    /// changed, measurements begin anew, too. Throws InputError for numbers that are not finite,
    /// for discs outside of the box or in obstacles, and if more pairs than before would overlap;
    /// nothing is changed then. Costs about as much as making the simulation from a list of discs.
    /// **Collective.**
    void change_discs(std::span<const Disc> discs);

    /// Makes an independent simulation of the same state, averages and measurements, which
    /// continues with the same bits. It writes no checkpoints until its `keep_checkpoints` is
    /// called. **Collective.**
    Simulation copy() const;

    /// Sums over all discs; every rank gets them. Costs a pass over the discs and one search for
    /// pairs that touch, about as much as a step. **Collective.**
    Totals totals() const;

    /// Averages since stepping began here, or since `restart_averages`. Costs a pass over the
    /// discs. **Collective.**
    Averages averages() const;
    void restart_averages(); ///< starts the averages anew; **Collective.**

    /// The tables of the scene's `output.measurements`, as sampled so far; none before the first
    /// sample. Samples are taken inside `advance_to`. The same on every rank. Not collective.
    std::vector<MeasuredTable> measurements() const;

    /// Writes the state as a whole file or not at all. Its folder must exist. Throws
    /// CollectiveError (code 4) if it fails; an older file of that name then stays unchanged.
    /// Writes 80 bytes a disc to disk. **Collective.**
    void write_checkpoint(const std::string& path) const;

    /// From now on `advance_to` writes checkpoints at the times of the schedule, as
    /// `write_checkpoint` does. Call it once. Throws InputError for a wrong schedule,
    /// CollectiveError (code 4) if the folder cannot be made. **Collective.**
    void keep_checkpoints(const CheckpointSchedule& schedule);

    struct State; ///< used by the library only
    const State& state() const { return live(); }

private:
    State& live() const;
    explicit Simulation(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

} // namespace carrom
