// SPDX-License-Identifier: BSD-3-Clause
#include "run/checkpoints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/stop_request.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "run/start/restart.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

constexpr double seconds_between_looks = 0.5;
/// A rank with more discs keeps no copy of them.
constexpr double most_copied = 1e6;
/// Between copies: each takes some 20 ns a disc, and what measurements keep as much again.
constexpr double seconds_between_copies = 0.02, seconds_per_copied_disc = 4e-6;
/// After a request to stop. A step without a copy of its beginning gets the time that it seems to
/// need, up to what batch systems allow.
constexpr double patience = 1, most_patience = 20;
constexpr double longest_stretch = 1e15; // steps

} // namespace

Checkpoints::Checkpoints(const Scene& scene, std::int64_t first_step, bool is_restart,
                         std::function<bool()> must_stop, const Communicator& ranks, int n_threads)
    : ranks_(ranks), scene_(scene), must_stop_(std::move(must_stop)), n_threads_(n_threads),
      last_looked_(first_step) {
    if (!scene_.checkpoint || !is_restart) return;
    last_written_ = first_step;
    kept_ = earlier_checkpoints(scene_, first_step, ranks_);
    kept_.push_back(checkpoint_path(scene_.checkpoint->folder, first_step));
    if (!ranks_.is_root()) return;
    remove_unfinished(scene_.checkpoint->folder); // by the run that was killed
}

std::int64_t Checkpoints::next_look(std::int64_t step) const {
    std::int64_t next = step + stretch_;
    if (!scene_.checkpoint) return next;
    if (const auto every = scene_.checkpoint->every_steps)
        next = std::min(next, (step / *every + 1) * *every);
    return next;
}

bool Checkpoints::look_up(const Simulation& simulation, Recordings& recordings) {
    const std::int64_t step = simulation.step();
    const Updates now = updates(step);
    const bool is_end = step >= scene_.steps;
    if (!scene_.checkpoint) return now.must_stop && !is_end;
    const CheckpointOutput& wanted = *scene_.checkpoint;
    const bool is_due = now.must_stop || now.is_time ||
                        (wanted.every_steps && step > 0 && step % *wanted.every_steps == 0) ||
                        (is_end && wanted.at_end);
    if (is_due && step != last_written_) write(simulation, recordings);
    if (!now.must_stop && now.is_copy_due && step != last_written_) copy(simulation, recordings);
    return now.must_stop && !is_end;
}

/// What all ranks agree on: whether any has a signal, and what rank 0's clock says. **Collective.**
Checkpoints::Updates Checkpoints::updates(std::int64_t step) {
    std::array<std::uint64_t, 5> sums = {must_stop_() ? 1u : 0u, 0, 0, 0, 0};
    const double discs_per_rank = static_cast<double>(scene_.n_discs) / ranks_.size();
    if (ranks_.is_root()) {
        const double seconds = stretch_watch_.lap();
        const double steps = static_cast<double>(step - last_looked_) * seconds_between_looks /
                             std::max(seconds, 1e-6);
        seconds_since_written_ += seconds;
        seconds_since_copied_ += seconds;
        const double pause = std::max(seconds_between_copies,
                                      seconds_per_copied_disc * discs_per_rank);
        sums[3] = step == last_looked_ || seconds_since_copied_ > pause ? 1 : 0;
        sums[4] = static_cast<std::uint64_t>(std::min(2e3 * seconds, 1e6));
        sums[1] = scene_.checkpoint && scene_.checkpoint->every_minutes &&
                          seconds_since_written_ >= *scene_.checkpoint->every_minutes * 60
                      ? 1
                      : 0;
        sums[2] = static_cast<std::uint64_t>(std::clamp(steps, 1.0, longest_stretch));
    }
    ranks_.sum(sums);
    last_looked_ = step;
    stretch_ = static_cast<std::int64_t>(sums[2]);
    const bool is_copied = !scene_.checkpoint || discs_per_rank <= most_copied;
    const double as_long_again = static_cast<double>(sums[4]) / 1e3;
    set_stop_patience(is_copied ? patience : std::clamp(as_long_again, patience, most_patience));
    return {sums[0] > 0, sums[1] > 0, scene_.checkpoint && is_copied && sums[3] > 0};
}

StoredSamples Checkpoints::samples_now(const Simulation& simulation, Recordings& recordings) const {
    StoredSamples samples = recordings.samples();
    samples.averages = simulation.stored_averages();
    return samples;
}

void Checkpoints::copy(const Simulation& simulation, Recordings& recordings) {
    if (!copy_) copy_.emplace();
    const std::span<const Disc> discs = simulation.discs();
    copy_->header = header_now(scene_, simulation);
    copy_->discs.assign(discs.begin(), discs.end());
    copy_->columns = SideColumns(simulation.side_columns());
    copy_->samples = samples_now(simulation, recordings);
    stretch_watch_.lap();
    seconds_since_copied_ = 0;
}

std::string Checkpoints::write_copy(Recordings& recordings) {
    recordings.commit();
    if (copy_) {
        const std::string path = checkpoint_path(scene_.checkpoint->folder, copy_->header.step);
        write_checkpoint(path, copy_->header, copy_->discs, ranks_,
                         {n_threads_, scene_.checkpoint->transfers == Transfers::collective},
                         copy_->samples, copy_->columns.spans());
        note_written(path, copy_->header.step);
    }
    return last_written_ < 0
               ? "nothing is kept to go on from"
               : fmt::format("the last state that is kept is of step {}", last_written_);
}

void Checkpoints::write(const Simulation& simulation, Recordings& recordings) {
    if (removal_.valid()) removal_.get(); // its room may be needed
    recordings
        .commit(); // a restart cuts them back to its step, but cannot make up for what is missing
    const CheckpointHeader header = header_now(scene_, simulation);
    const std::string path = checkpoint_path(scene_.checkpoint->folder, header.step);
    write_checkpoint(path, header, simulation.discs(), ranks_,
                     {n_threads_, scene_.checkpoint->transfers == Transfers::collective},
                     samples_now(simulation, recordings), simulation.side_columns());
    note_written(path, header.step);
}

void Checkpoints::note_written(const std::string& path, std::int64_t step) {
    last_written_ = step;
    copy_.reset();
    std::erase(kept_, path);
    kept_.push_back(path);
    remove_oldest();
    stretch_watch_.lap(); // writing is no part of a stretch
    seconds_since_written_ = 0;
}

/// Giving back the blocks of a large file takes a fifth of the time of writing it: beside the
/// steps.
void Checkpoints::remove_oldest() {
    const auto n_removed = std::max<std::ptrdiff_t>(
        0, std::ssize(kept_) - static_cast<std::ptrdiff_t>(scene_.checkpoint->keep));
    std::vector<std::string> removed(kept_.begin(), kept_.begin() + n_removed);
    kept_.erase(kept_.begin(), kept_.begin() + n_removed);
    if (removed.empty() || !ranks_.is_root()) return;
    removal_ = std::async(std::launch::async | std::launch::deferred,
                          [removed = std::move(removed)] {
                              std::error_code ignored;
                              for (const std::string& path : removed)
                                  std::filesystem::remove(path, ignored);
                          });
}

} // namespace carrom
