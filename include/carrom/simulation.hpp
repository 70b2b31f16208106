// SPDX-License-Identifier: BSD-3-Clause
// Simulates a scene step by step, and writes and reads checkpoints.
//
// The state depends only on the scene and the step: it has the same bits for any number of ranks
// and threads, and for any division of the steps into calls. A disc is stored on the rank that owns
// the part of the box in which the disc lies.
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

/// Options that change the time that a run takes, but never its results.
struct Options {
    /// Threads of each rank; 0: OMP_NUM_THREADS, or if unset the rank's share of the node's cores
    int threads = 0;
    /// Receives on rank 0 each line that `carrom run` prints when it starts, such as warnings and
    /// the method that a pilot run has chosen. If empty, these lines are dropped.
    std::function<void(const std::string& line)> messages{};
    /// Whether to count crossings of periodic sides, for `read_images`; costs 16 bytes a disc
    bool counts_images = false;
};

/// When `advance_to` writes checkpoints, and how many it keeps.
struct CheckpointSchedule {
    std::string folder{};         ///< made if it is missing; no other run may write to it
    std::int64_t every_steps = 0; ///< steps between checkpoints; 0: not triggered by steps
    double every_minutes = 0;     ///< wall time between checkpoints; 0: not triggered by time
    std::int64_t keep = 2; ///< number of checkpoints to keep; this run's older ones are removed
    bool at_end = true;    ///< whether to write a checkpoint also at the last step, `time.steps`
};

class Simulation {
public:
    /// Makes the scene at step 0. Throws InputError with all problems of the scene and its discs.
    /// With `time.accuracy` a pilot run first chooses method and micro-steps, which `scene()` then
    /// contains. Only `output.measurements` of the tables under `output` is used, and no file is
    /// written. Memory of all ranks together: at least 94 bytes a disc (event-driven method: 120).
    /// The session must outlive the simulation. **Collective.**
    Simulation(const Session& session, const Scene& scene, const Options& options = {});

    /// Continues from a checkpoint of this library or of `carrom run`, with the same bits as the
    /// uninterrupted run. If `path` is a folder, its newest complete checkpoint is used. The
    /// checkpoint contains the scene. `settings` (such as "time.steps=200") override its keys and
    /// may change the last step and the measurements. Throws CollectiveError (code 2) if the file
    /// is damaged, InputError if a setting would change the simulated states. **Collective.**
    static Simulation from_checkpoint(const Session& session, const std::string& path,
                                      const std::vector<std::string>& settings = {},
                                      const Options& options = {});

    /// After a move the old object can only be assigned to or destroyed; calls throw InputError.
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    ~Simulation();

    const SceneFacts& scene() const; ///< facts of the scene; not collective
    std::int64_t step() const;       ///< steps since the scene's start; not collective
    /// The present lengths of the box's sides. They are those of the scene unless
    /// `effects.barostat.axes` changes them. Not collective.
    Box box() const;

    /// Simulates to the end of `step`. Throws InputError if `step` is before the present step or
    /// after `time.steps`. **Collective.**
    void advance_to(std::int64_t step);
    void advance(std::int64_t n_steps);                  ///< **Collective.**
    void advance_to_end() { advance_to(scene().steps); } ///< **Collective.**

    /// This rank's discs at the present step, in order of id. Each disc is on exactly one rank.
    /// Discs that have left through an open side are included: they rest one radius outside of that
    /// side. Costs a copy and a sort. Not collective.
    std::vector<Disc> discs() const;

    /// All discs in order of id on rank 0, and an empty list on other ranks. Rank 0 needs 64 bytes
    /// a disc. **Collective.**
    std::vector<Disc> gathered_discs() const;

    /// These functions write data of this rank's discs into arrays indexed by id, and leave the
    /// elements of other discs unchanged. x and y of disc `id` go to elements 2 id and 2 id + 1,
    /// its spin or direction goes to element `id`, its counts of collisions with walls and with
    /// discs go to elements 2 id and 2 id + 1. Throws InputError if an array is too short for all
    /// discs of the scene. Cost: one pass over the discs by all threads. Not collective.
    void read_positions(std::span<double> xy) const;
    void read_velocities(std::span<double> xy) const; ///< velocities, length per step
    void read_spins(std::span<double> spins) const;   ///< angular velocities, radians per step
    /// Angles from the x axis, counterclockwise; 0 unless discs are active.
    void read_directions(std::span<double> angles) const;
    void read_collisions(std::span<std::int64_t> counts) const;

    /// Writes how many box lengths disc `id` has moved across periodic sides along x and y to
    /// elements 2 id and 2 id + 1; a position plus these lengths has no jumps. Each rank writes its
    /// share of the ids. Crossings are counted from the scene's start, or from the checkpoint if it
    /// has no such counts. Writes nothing unless `Options::counts_images` was set and a side is
    /// periodic. Throws InputError for sheared sides, because their images move. **Collective.**
    void read_images(std::span<std::int32_t> lengths) const;

    /// Radius, mass and species of all discs of the scene, by id. If discs exchange their radii
    /// (`effects.swap`), `radius` is the present one. Not collective.
    std::vector<DiscKind> kinds() const;

    /// Replaces positions, velocities or spins of this rank's discs between two steps. `discs` are
    /// the discs that `discs()` returns, in any order; their counts of collisions are ignored. A
    /// disc whose numbers are unchanged keeps all of its bits. Averages restart, and measurements
    /// restart if positions have changed. Throws InputError, and changes nothing, for numbers that
    /// are not finite, for discs outside of the box or in obstacles, and if more pairs than before
    /// would overlap. Costs about as much as making the simulation from a list of discs.
    /// **Collective.**
    void change_discs(std::span<const Disc> discs);

    /// Makes an independent simulation of the same state, averages and measurements, which
    /// continues with the same bits. It writes no checkpoints until its `keep_checkpoints` is
    /// called. **Collective.**
    Simulation copy() const;

    /// Sums over all discs; every rank gets the result. Costs a pass over the discs and one search
    /// for pairs that touch, together about as much as a step. **Collective.**
    Totals totals() const;

    /// Averages since `output.averages_from_step`, `restart_averages` or `change_discs`;
    /// checkpoints and copies continue them. Costs a pass over the discs. **Collective.**
    Averages averages() const;
    void restart_averages(); ///< restarts the averages; **Collective.**

    /// The tables of `output.measurements` with all samples so far, equal on all ranks; an empty
    /// list before the first sample. `advance_to` takes the samples. Not collective.
    std::vector<MeasuredTable> measurements() const;

    /// Writes the state to a file, completely or not at all. The folder must exist. Throws
    /// CollectiveError (code 4) if writing fails; an older file of that name is then unchanged.
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
