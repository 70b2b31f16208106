// SPDX-License-Identifier: BSD-3-Clause
#include "run/recordings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "machine/machine.hpp"
#include "parallel/sample_sort.hpp"
#include "scene/frame_times.hpp"
#include "simulation/disc_order.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

constexpr double seconds_between_commits = 0.8; ///< short enough for programs that follow a run
constexpr double largest_share = 0.02;          ///< largest share of time that commits may take

/// Whether `a` is before `b` in the total order. Walls come before discs: q + 1 is 0 for a wall.
bool comes_before(const Collision& a, const Collision& b) {
    const auto key = [](const Collision& c) {
        return std::tuple(c.micro_step, c.time, c.generation, c.p, c.q + 1);
    };
    return key(a) < key(b);
}

} // namespace

LoggedCollision logged(const Collision& collision, std::int64_t micro_steps) {
    // A collision exactly at the end of a step belongs to it; one at the run's start, to step 1.
    const auto n_micro = std::max<std::int64_t>(
        1, static_cast<std::int64_t>(std::ceil(collision.time)));
    LoggedCollision entry;
    entry.step = (collision.micro_step + n_micro - 1) / micro_steps + 1;
    entry.time = (static_cast<double>(collision.micro_step) + collision.time) /
                 static_cast<double>(micro_steps);
    entry.p = static_cast<std::int64_t>(collision.p);
    entry.q = collision.q == Collision::wall ? -1 : static_cast<std::int64_t>(collision.q);
    entry.impulse = collision.impulse;
    return entry;
}

Recordings::Recordings(Run& run, const Messages& messages)
    : run_(run), scene_(run.scene()), ranks_(run.ranks()), messages_(messages),
      growing_(run.scene(), run.ranks()) {
    if (scene_.trajectory) open_trajectory();
    if (scene_.collisions) open_log();
    if (run_.images() && run_.is_restart() && !run_.has_earlier_images() && run_.step() > 0)
        messages_.warn("{}: image counts from step {}; the checkpoint has no counts\n",
                       scene_.trajectory->file, run_.step());
}

void Recordings::begin() {
    if (run_.is_restart()) {
        if (trajectory_) trajectory_->commit();
        if (log_) log_->commit();
        return add_rows();
    }
    if (trajectory_) trajectory_->begin();
    if (log_) log_->begin();
    act();
}

void Recordings::open_trajectory() {
    trajectory_.emplace(scene_.trajectory->file, layout_of(scene_, *scene_.trajectory), ranks_);
    if (!run_.is_restart()) return;
    report_missing_frames(trajectory_->go_on(run_.step()), run_.step());
    report_loss(scene_.trajectory->file, trajectory_->recorded_before());
}

void Recordings::open_log() {
    const std::int64_t step = run_.step();
    log_.emplace(scene_.collisions->file, system_of(scene_), ranks_);
    run_.system().log_to(&collisions_);
    if (!run_.is_restart()) return;
    if (!log_->go_on(step) && step > 0)
        messages_.warn("{}: begins with step {}; of the steps before there is no log\n",
                       scene_.collisions->file, step + 1);
    else if (const auto& gaps = log_->gaps(); !gaps.empty() && gaps.back() == step)
        messages_.warn("{}: has no collisions of steps {} to {}, and goes on with step {}\n",
                       scene_.collisions->file, gaps[gaps.size() - 2], step, step + 1);
    report_loss(scene_.collisions->file, log_->recorded_before());
}

/// Warns of recorded steps after the end of this run, which are lost.
void Recordings::report_loss(const std::string& file, std::int64_t recorded) const {
    if (recorded > scene_.steps)
        messages_.warn("{}: had steps up to {}, and loses those after step {}, where this run "
                       "ends\n",
                       file, recorded, scene_.steps);
}

/// Warns of frames that are missing in the trajectory of a restart.
void Recordings::report_missing_frames(std::int64_t last, std::int64_t step) const {
    const TrajectoryOutput& output = *scene_.trajectory;
    const std::int64_t last_due = last_frame(output, step);
    if (last >= last_due) return;
    const std::int64_t first_missing = last < 0 ? 0 : next_frame(output, last);
    messages_.warn("{}: has no frames of steps {} to {}, and goes on with step {}\n", output.file,
                   first_missing, last_due, next_frame(output, step));
}

std::int64_t Recordings::next_due(std::int64_t step) const {
    if (!scene_.trajectory) return std::numeric_limits<std::int64_t>::max();
    return next_frame(*scene_.trajectory, step);
}

bool Recordings::act() {
    DiscSystem& system = run_.system();
    const std::int64_t step = system.step();
    if (log_) record_collisions(step);
    add_rows();
    ImageCounts* const counts = run_.images();
    // Crossings are counted at each step, because uncounted ones take memory
    if (counts) static_cast<void>(counts->counts());
    if (trajectory_ && step == last_frame(*scene_.trajectory, step)) {
        std::vector<ComputedNumbers> computed; // computed first, because this moves discs in memory
        if (scene_.trajectory->computed != ComputedFieldSet{}) computed = computed_numbers(system);
        const std::vector<DiscImage> images = counts ? counts->now() : std::vector<DiscImage>{};
        const Box box = system.engine().box();
        trajectory_->append(step, system.shown(), system.clock(), system.side_columns(), computed,
                            images, box == scene_.box ? nullptr : &box);
    }
    commit_now_and_then();
    return true;
}

void Recordings::add_rows() { growing_.add_rows_of(run_.sampler()); }

void Recordings::commit_now_and_then() {
    if (!trajectory_ && !log_ && !scene_.measurements) return;
    seconds_uncommitted_ += since_asked_.lap();
    const double wait = std::max(seconds_between_commits, commit_seconds_ / largest_share);
    if (!ranks_.any(ranks_.is_root() && seconds_uncommitted_ > wait)) return;
    seconds_uncommitted_ = 0;
    run_.commit();
    commit_seconds_ = since_asked_.lap();
}

void Recordings::record_collisions(std::int64_t step) {
    const std::vector<Collision> sorted = sample_sort(ranks_, std::exchange(collisions_, {}),
                                                      comes_before, ranks_.size());
    std::vector<LoggedCollision> entries;
    entries.reserve(sorted.size());
    for (const Collision& collision : sorted)
        entries.push_back(logged(collision, scene_.micro_steps));
    log_->append(entries, step);
}

void Recordings::commit() {
    if (trajectory_) trajectory_->commit();
    if (log_) log_->commit();
    if (scene_.measurements) write_tables(scene_, run_.sampler().tables(), ranks_);
}

void Recordings::finish() {
    run_.commit();
    if (trajectory_) trajectory_->describe();
}

} // namespace carrom
