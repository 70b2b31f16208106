// SPDX-License-Identifier: BSD-3-Clause
#include "run/recordings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "machine/machine.hpp"
#include "parallel/sample_sort.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

constexpr double seconds_between_commits = 5; ///< so that readers see a run that goes on
constexpr double largest_share = 0.02;        ///< of the time, for commits

/// The total order; q + 1 puts the wall, the largest number there is, before every disc.
bool comes_before(const Collision& a, const Collision& b) {
    const auto key = [](const Collision& c) {
        return std::tuple(c.micro_step, c.time, c.generation, c.p, c.q + 1);
    };
    return key(a) < key(b);
}

} // namespace

LoggedCollision logged(const Collision& collision, std::int64_t micro_steps) {
    // A collision at the end of a step belongs to it; one at the very start of the run to step 1.
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

Recordings::Recordings(const Scene& scene, Simulation& simulation, bool is_restart,
                       StoredSamples samples, const Communicator& ranks, const Messages& messages)
    : scene_(scene), ranks_(ranks), messages_(messages), growing_(scene, ranks) {
    const std::int64_t step = simulation.step();
    if (scene_.trajectory) {
        trajectory_.emplace(scene_.trajectory->file, layout_of(scene_, *scene_.trajectory), ranks_);
        if (is_restart)
            report_missing_frames(trajectory_->go_on(step), step);
        else
            trajectory_->begin();
    }
    if (scene_.collisions) {
        log_.emplace(scene_.collisions->file, system_of(scene_), ranks_);
        if (!is_restart)
            log_->begin();
        else if (!log_->go_on(step) && step > 0)
            messages_.warn("{}: begins with step {}; of the steps before there is no log\n",
                           scene_.collisions->file, step + 1);
        simulation.log_to(&collisions_);
    }
    if (scene_.trajectory && scene_.trajectory->has_image) {
        images_.emplace(scene_.box, simulation, ranks_);
        if (samples.have_images)
            images_->go_on(samples.first_places, &FirstPlace::image_x, &FirstPlace::image_y);
        else if (is_restart && step > 0)
            messages_.warn("{}: image counts from step {}; the checkpoint has no counts\n",
                           scene_.trajectory->file, step);
    }
    if (scene_.measurements) {
        sampler_.emplace(scene_, simulation, ranks_);
        if (is_restart) sampler_->go_on(samples);
        sample();
    }
    if (!is_restart) record(simulation);
}

/// What the restart of a run finds of its trajectory.
void Recordings::report_missing_frames(std::int64_t last, std::int64_t step) const {
    const std::int64_t every = scene_.trajectory->every_steps, last_due = step / every * every;
    if (last >= last_due) return;
    const std::int64_t first_missing = last < 0 ? 0 : (last / every + 1) * every;
    messages_.warn("{}: has no frames of steps {} to {}, and goes on with step {}\n",
                   scene_.trajectory->file, first_missing, last_due, last_due + every);
}

std::int64_t Recordings::next_due(std::int64_t step) const {
    std::int64_t next = std::numeric_limits<std::int64_t>::max();
    if (scene_.trajectory)
        next = (step / scene_.trajectory->every_steps + 1) * scene_.trajectory->every_steps;
    if (sampler_) next = std::min(next, sampler_->next_due(step));
    return next;
}

void Recordings::record(const Simulation& simulation) {
    const std::int64_t step = simulation.step();
    if (log_) record_collisions();
    if (sampler_) sample();
    if (images_) static_cast<void>(images_->counts()); // so that they need little memory
    if (trajectory_ && step % scene_.trajectory->every_steps == 0) {
        std::vector<BondOrder> orders; // first: finding them moves discs in memory
        if (scene_.trajectory->has_psi6 || scene_.trajectory->has_neighbours)
            orders = simulation.bond_orders();
        const std::vector<DiscImage> images = images_ ? images_->now() : std::vector<DiscImage>{};
        trajectory_->append(step, simulation.shown(), simulation.clock(), simulation.side_columns(),
                            orders, images);
    }
    commit_now_and_then();
}

void Recordings::sample() {
    sampler_->look();
    growing_.add_rows_of(*sampler_);
}

void Recordings::commit_now_and_then() {
    if (!trajectory_ && !log_ && !sampler_) return;
    seconds_uncommitted_ += since_look_.lap();
    const double wait = std::max(seconds_between_commits, commit_seconds_ / largest_share);
    if (!ranks_.any(ranks_.is_root() && seconds_uncommitted_ > wait)) return;
    seconds_uncommitted_ = 0;
    commit();
    commit_seconds_ = since_look_.lap();
}

void Recordings::record_collisions() {
    const std::vector<Collision> sorted = sample_sort(ranks_, std::exchange(collisions_, {}),
                                                      comes_before, ranks_.size());
    std::vector<LoggedCollision> entries;
    entries.reserve(sorted.size());
    for (const Collision& collision : sorted)
        entries.push_back(logged(collision, scene_.micro_steps));
    log_->append(entries);
}

void Recordings::commit() {
    if (trajectory_) trajectory_->commit();
    if (log_) log_->commit();
    if (sampler_) write_tables(scene_, sampler_->tables(), ranks_);
}

StoredSamples Recordings::samples() {
    StoredSamples samples = sampler_ ? sampler_->stored() : StoredSamples{};
    samples.have_images = images_.has_value();
    if (images_) images_->store(samples.first_places, &FirstPlace::image_x, &FirstPlace::image_y);
    return samples;
}

void Recordings::finish() {
    commit();
    if (trajectory_) trajectory_->describe();
}

} // namespace carrom
