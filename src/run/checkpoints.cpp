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

constexpr double seconds_between_agreements = 0.5;
/// A run makes no copies if its ranks have more discs than this on average.
constexpr double most_copied = 1e6;
/// Seconds between copies are at least the larger of a constant and a time per disc of a rank. A
/// copy takes about 20 ns a disc, and copying the data of measurements about as long again.
constexpr double seconds_between_copies = 0.02, seconds_per_copied_disc = 4e-6;
/// Seconds that a step may take after a request to stop. If no copies are made, it may take twice
/// the last stretch's time, up to `most_patience`, because batch systems soon end the job.
constexpr double patience = 1, most_patience = 20;
constexpr double longest_stretch = 1e15; // in steps

} // namespace

Checkpoints::Checkpoints(Run& run, std::optional<CheckpointOutput> wanted)
    : run_(run), ranks_(run.ranks()), wanted_(std::move(wanted)), last_agreed_(run.step()) {
    if (!wanted_ || !run.is_restart()) return;
    kept_ = earlier_checkpoints(wanted_->folder, run.scene(), run.step(), ranks_);
    const std::string first = checkpoint_path(wanted_->folder, run.step());
    std::error_code ignored;
    // A run that continues in its own folder already has a checkpoint of its first step.
    if (ranks_.any(ranks_.is_root() && std::filesystem::exists(first, ignored))) {
        last_written_ = run.step();
        kept_.push_back(first);
    }
    if (!ranks_.is_root()) return;
    remove_unfinished(wanted_->folder); // files that a killed run left unfinished
}

std::int64_t Checkpoints::next_due(std::int64_t step) const {
    const std::int64_t next = step + stretch_;
    if (!wanted_ || !wanted_->every_steps) return next;
    return std::min(next, (step / *wanted_->every_steps + 1) * *wanted_->every_steps);
}

bool Checkpoints::act() {
    const std::int64_t step = run_.step();
    const Updates now = updates(step);
    const bool is_end = step >= run_.last_step(), goes_on = !now.must_stop || is_end;
    if (!wanted_) return goes_on;
    const bool is_due = now.must_stop || now.is_time ||
                        (wanted_->every_steps && step > 0 && step % *wanted_->every_steps == 0) ||
                        (is_end && wanted_->at_end);
    if (is_due && step != last_written_) write();
    if (!now.must_stop && now.is_copy_due && step != last_written_) copy();
    return goes_on;
}

/// Returns, with the same result on all ranks, whether any rank has a request to stop, and whether
/// a checkpoint or a copy is due by rank 0's clock. **Collective.**
Checkpoints::Updates Checkpoints::updates(std::int64_t step) {
    std::array<std::uint64_t, 5> sums = {is_stop_requested() ? 1u : 0u, 0, 0, 0, 0};
    const double discs_per_rank = static_cast<double>(run_.scene().n_discs) / ranks_.size();
    if (ranks_.is_root()) {
        const double seconds = stretch_watch_.lap();
        const double steps = static_cast<double>(step - last_agreed_) * seconds_between_agreements /
                             std::max(seconds, 1e-6);
        seconds_since_written_ += seconds;
        seconds_since_copied_ += seconds;
        const double pause = std::max(seconds_between_copies,
                                      seconds_per_copied_disc * discs_per_rank);
        sums[3] = step == last_agreed_ || seconds_since_copied_ > pause ? 1 : 0;
        sums[4] = static_cast<std::uint64_t>(std::min(2e3 * seconds, 1e6));
        sums[1] = wanted_ && wanted_->every_minutes &&
                          seconds_since_written_ >= *wanted_->every_minutes * 60
                      ? 1
                      : 0;
        sums[2] = static_cast<std::uint64_t>(std::clamp(steps, 1.0, longest_stretch));
    }
    ranks_.sum(sums);
    last_agreed_ = step;
    stretch_ = static_cast<std::int64_t>(sums[2]);
    const bool is_copied = !wanted_ || discs_per_rank <= most_copied;
    const double as_long_again = static_cast<double>(sums[4]) / 1e3;
    set_stop_patience(is_copied ? patience : std::clamp(as_long_again, patience, most_patience));
    return {sums[0] > 0, sums[1] > 0, wanted_ && is_copied && sums[3] > 0};
}

void Checkpoints::copy() {
    if (!copy_) copy_.emplace();
    const DiscSystem& system = run_.system();
    const std::span<const DiscState> discs = system.discs();
    copy_->header = header_now(run_.scene(), system);
    copy_->discs.assign(discs.begin(), discs.end());
    copy_->columns = SideColumns(system.side_columns());
    copy_->samples = run_.stored_samples();
    stretch_watch_.lap();
    seconds_since_copied_ = 0;
}

std::string Checkpoints::write_copy() {
    run_.commit();
    if (copy_) {
        const std::string path = checkpoint_path(wanted_->folder, copy_->header.step);
        write_checkpoint(path, copy_->header, copy_->discs, ranks_,
                         {run_.n_threads(), wanted_->transfers == Transfers::collective},
                         copy_->samples, copy_->columns.spans());
        record_written(path, copy_->header.step);
    }
    return last_written_ < 0
               ? "nothing is kept to go on from"
               : fmt::format("the last state that is kept is of step {}", last_written_);
}

std::string Checkpoints::keep(std::int64_t step) {
    if (!wanted_) return "nothing is kept, because the run has no output.folder; -o sets it";
    write_copy();
    if (last_written_ < step) go_over_to(step);
    if (last_written_ < 0) return "nothing is kept to go on from";
    const double size = run_.scene().effects.size_at(static_cast<double>(last_written_));
    return fmt::format("{} keeps step {}, which discs.from takes, with radii {:.10g} times those "
                       "of the scene (discs.packing = {:.10g})",
                       checkpoint_path(wanted_->folder, last_written_), last_written_, size,
                       run_.scene().packing() * size * size);
}

/// Runs again from the last stored state to `step`, and stores the state there. **Collective.**
void Checkpoints::go_over_to(std::int64_t step) {
    if (last_written_ < 0) return;
    SceneParameters scene = run_.scene();
    scene.accuracy.reset(); // a pilot has already chosen method and micro-steps
    Tuning tuning;
    tuning.threads = run_.n_threads();
    tuning.ends_jams = false;
    const std::string last = checkpoint_path(wanted_->folder, last_written_);
    Run again(std::move(scene), start_of(read_checkpoint(last, ranks_)), ranks_, tuning);
    if (!again.advance_to(step)) return;
    const std::string path = checkpoint_path(wanted_->folder, step);
    again.write_checkpoint(path, wanted_->transfers);
    record_written(path, step);
}

void Checkpoints::write() {
    if (removal_.valid()) removal_.get(); // waits, because the space on the disk may be needed
    const std::string path = checkpoint_path(wanted_->folder, run_.step());
    run_.write_checkpoint(path, wanted_->transfers);
    record_written(path, run_.step());
}

void Checkpoints::record_written(const std::string& path, std::int64_t step) {
    last_written_ = step;
    copy_.reset();
    std::erase(kept_, path);
    kept_.push_back(path);
    remove_oldest();
    stretch_watch_.lap(); // so that the time of writing does not count as time of steps
    seconds_since_written_ = 0;
}

/// Removes the oldest checkpoints if there are too many. Freeing the blocks of a large file takes
/// about a fifth of the time that writing it takes, so another thread does it during the steps.
void Checkpoints::remove_oldest() {
    const auto n_removed = std::max<std::ptrdiff_t>(
        0, std::ssize(kept_) - static_cast<std::ptrdiff_t>(wanted_->keep));
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
