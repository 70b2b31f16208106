// SPDX-License-Identifier: BSD-3-Clause
#include "measure/motion_interval.hpp"
#include "simulation/disc_statistics.hpp"

namespace carrom {

namespace {

/// Restarts the simulation's sums of stress with the unit of a checkpoint's sums.
DiscSystem& in_unit(DiscSystem& system, double bound) {
    system.begin_stress_sums(bound);
    return system;
}

} // namespace

MotionInterval::MotionInterval(DiscSystem& system, const Communicator& ranks)
    : system_(&system), ranks_(&ranks), last_sums_(system.stress_sums()) {
    begin(motion_sample(system));
}

MotionInterval::MotionInterval(DiscSystem& system, const Communicator& ranks,
                               const Pending& pending, const MotionSample& last)
    : system_(&system), ranks_(&ranks), last_sums_(in_unit(system, pending.bound).stress_sums()),
      last_(last) {
    // The restored sums are sums over all ranks, so only one rank, the root, includes them.
    if (!ranks.is_root()) return;
    StressSums sums(pending.bound);
    std::size_t next = 0;
    for (ExactSum* part : sums.parts()) {
        part->add_words(pending.words[next], pending.words[next + 1]);
        next += 2;
    }
    last_sums_ -= sums;
}

/// This rank's sums of stress since the last sample.
StressSums MotionInterval::since_last() const {
    StressSums since = system_->stress_sums();
    since -= last_sums_;
    return since;
}

MotionSample MotionInterval::now() const {
    MotionSample now = motion_sample(*system_);
    integrate(*system_, since_last(), now);
    return now;
}

void MotionInterval::begin(const MotionSample& now) {
    last_sums_ = system_->stress_sums();
    last_ = now;
    last_.stress = {};
    last_.energy = 0;
    integrate_flights(*system_, last_);
}

MotionInterval::Pending MotionInterval::pending() const {
    Pending pending{system_->stress_bound(), {}};
    StressSums since = since_last();
    std::size_t next = 0;
    for (ExactSum* part : since.parts()) {
        ranks_->sum(*part);
        pending.words[next++] = part->low_word();
        pending.words[next++] = part->high_word();
    }
    return pending;
}

} // namespace carrom
