// SPDX-License-Identifier: BSD-3-Clause
#include "grading/runs.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "machine/machine.hpp"
#include "parallel/exchange.hpp"
#include "run/pilot/trial.hpp"

namespace carrom {

namespace {

constexpr std::size_t discs_at_a_time = 1 << 16;

std::vector<InputDisc> moved_by_a_bit(std::vector<InputDisc> discs, const SceneParameters& scene,
                                      std::uint64_t seed) {
    const double low = scene.radius;
    for (InputDisc& disc : discs) {
        disc.x = std::clamp(nudged(disc.x, disc.id, seed), low, scene.box.x - low);
        disc.y = std::clamp(nudged(disc.y, disc.id, seed + 1), low, scene.box.y - low);
        disc.vx = nudged(disc.vx, disc.id, seed + 2);
        disc.vy = nudged(disc.vy, disc.id, seed + 3);
    }
    return discs;
}

} // namespace

double drawn(std::uint64_t id, std::uint64_t seed) {
    std::uint64_t bits = id * 0x9e3779b97f4a7c15u + seed * 0xd1b54a32d192ed03u;
    bits = (bits ^ (bits >> 31)) * 0xbf58476d1ce4e5b9u;
    bits ^= bits >> 29;
    return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

double nudged(double place, std::uint64_t id, std::uint64_t seed) {
    return place * (1 + 0x1p-50 * drawn(id, seed));
}

double difference(const DiscState& a, double clock_a, const DiscState& b, double clock_b,
                  double unit) {
    return std::max({std::fabs(a.x_at(clock_a) - b.x_at(clock_b)),
                     std::fabs(a.y_at(clock_a) - b.y_at(clock_b)), std::fabs(a.vx - b.vx) * unit,
                     std::fabs(a.vy - b.vy) * unit});
}

ComparedRuns::ComparedRuns(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                           const Communicator& ranks)
    : ranks_(ranks), n_discs_(scene.n_discs) {
    Tuning tuning;
    tuning.threads = default_threads(ranks);
    check_threads(tuning.threads, ranks);
    SceneParameters with_other_formulas = scene;
    with_other_formulas.arithmetic = Arithmetic::naive;
    const auto add = [&](const SceneParameters& of, std::vector<InputDisc> from) {
        runs_.push_back(std::make_unique<DiscSystem>(of, std::move(from), ranks, tuning));
    };
    add(scene, discs);
    add(scene, moved_by_a_bit(discs, scene, 1));
    add(with_other_formulas, moved_by_a_bit(discs, scene, 5));
}

std::vector<DiscState> ComparedRuns::gather(const DiscSystem& system) const {
    std::vector<DiscState> discs(ranks_.is_root() ? n_discs_ : 0);
    const auto place = [&discs](std::span<const DiscState> some) {
        for (const DiscState& disc : some) discs[disc.id] = disc;
    };
    stream_to_root(ranks_, system.discs(), place, discs_at_a_time);
    return discs;
}

ExpectedDiscs ComparedRuns::at(std::int64_t step) {
    for (const auto& run : runs_) advance_to(*run, step);
    const DiscSystem& right = *runs_.front();
    ExpectedDiscs expected{gather(right), right.clock(), {}};
    expected.spread.assign(expected.discs.size(), 0);
    for (std::size_t i = 1; i < runs_.size(); ++i) {
        const std::vector<DiscState> others = gather(*runs_[i]);
        for (std::size_t id = 0; id < others.size(); ++id)
            expected.spread[id] = std::max(
                expected.spread[id], difference(expected.discs[id], expected.clock, others[id],
                                                runs_[i]->clock(), right.velocity_unit()));
    }
    return expected;
}

} // namespace carrom
