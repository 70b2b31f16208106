// SPDX-License-Identifier: BSD-3-Clause
#include "measure/block_averages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

/// Samples are at most this many micro-steps apart, or one sync interval if that is longer.
constexpr std::int64_t usual_interval = 64;
/// A run whose last step is this or later begins with a sample at each step. These hundred or so
/// extra samples cost little in a long run, and give error estimates to a user who stops early.
constexpr std::int64_t many_steps = 1'000'000;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

} // namespace

BlockAverages::Block& BlockAverages::Block::operator+=(const Block& other) {
    walls += other.walls;
    pairs += other.pairs;
    speed += other.speed;
    kurtosis += other.kurtosis;
    motion += other.motion;
    return *this;
}

BlockAverages::BlockAverages(MeasuredRun& run)
    : Measurement(run), system_(run.system.averaged_system()) {}

void BlockAverages::begin() {
    first_step_ = block_step_ = sample_step_ = run_.system.step();
    interval_.emplace(run_.system, run_.ranks);
    present_ = {};
    // Few samples are planned, because each costs some nanoseconds a disc and, between syncs, one
    // more window of the event-driven method. A run whose energy changes needs more samples.
    const auto wanted = static_cast<std::int64_t>(system_.keeps_energy ? fewest_blocks
                                                                       : most_blocks / 2);
    steps_per_sample_ = std::clamp<std::int64_t>((system_.last_step - first_step_) / wanted, 1,
                                                 most_steps_per_sample());
    if (does_energy_jump(run_.scene.effects)) steps_per_sample_ = between_syncs(steps_per_sample_);
    if (begins_with_steps()) steps_per_sample_ = 1; // `add` makes samples rarer and blocks longer
    steps_per_block_ = steps_per_sample_;
    blocks_.clear();
}

/// Whether the first samples are taken at each step. This is so in long runs, unless effects make
/// the energy jump at syncs: the time between samples is then chosen to suit the syncs.
bool BlockAverages::begins_with_steps() const {
    return system_.last_step >= many_steps && !does_energy_jump(run_.scene.effects);
}

bool BlockAverages::is_short(const Block& whole, double collisions_per_disc) const {
    return begins_with_steps() &&
           (blocks_.size() < fewest_short_blocks || whole.walls + whole.pairs < fewest_collisions ||
            2 * whole.pairs < collisions_per_disc * system_.n_discs);
}

/// Returns the number of steps between samples, at most `steps`. If possible, it is chosen so that
/// samples fall, one after the other, on all phases of the sync interval that have steps.
std::int64_t BlockAverages::between_syncs(std::int64_t steps) const {
    for (std::int64_t less = steps; less > steps / 2; --less)
        if (std::gcd(less * system_.micro_steps, system_.sync_every) ==
            std::gcd(system_.micro_steps, system_.sync_every))
            return less;
    return steps;
}

std::int64_t BlockAverages::next_due(std::int64_t step) const {
    return std::max(step + 1,
                    has_begun() ? sample_step_ + steps_per_sample_ : run_.scene.averages_from);
}

void BlockAverages::sample_if_due() {
    const std::int64_t step = run_.system.step();
    if (has_begun() && step >= sample_step_ + steps_per_sample_)
        sample({});
    else if (!has_begun() && step >= run_.scene.averages_from)
        begin();
}

/// Does not use `state`, because the simulation's sums contain everything that averages need.
void BlockAverages::sample(const SampledState& /*state*/) {
    const std::int64_t step = run_.system.step();
    const MotionSample now = interval_->now();
    add(step, block_up_to(step, now));
    interval_->begin(now);
}

void BlockAverages::add(std::int64_t step, const Block& block) {
    present_ += block;
    sample_step_ = step;
    if (step < block_step_ + steps_per_block_) return;
    blocks_.push_back(present_);
    present_ = {};
    block_step_ = step;
    if (blocks_.size() < most_blocks) return;
    for (std::size_t k = 0; k < most_blocks / 2; ++k) {
        blocks_[k] = blocks_[2 * k];
        blocks_[k] += blocks_[2 * k + 1];
    }
    blocks_.resize(most_blocks / 2);
    steps_per_block_ *= 2;
    // Samples become rarer in runs that began with one per step or pass their planned end.
    if (2 * steps_per_sample_ <= most_steps_per_sample()) steps_per_sample_ *= 2;
}

/// The largest number of steps between samples: a sync interval, or
/// `usual_interval` micro-steps if syncs are more frequent.
std::int64_t BlockAverages::most_steps_per_sample() const {
    const std::int64_t apart = std::max(system_.sync_every, usual_interval);
    return (apart + system_.micro_steps - 1) / system_.micro_steps;
}

namespace {

void keep_tensor(KeptNumbers& kept, Tensor& tensor) {
    kept(tensor.xx), kept(tensor.xy), kept(tensor.yy);
}

void keep_sample(KeptNumbers& kept, MotionSample& sample) {
    kept(sample.wall_collisions), kept(sample.pair_collisions), kept(sample.speed_unit);
    kept(sample.mean_speed), kept(sample.mean_square), kept(sample.mean_fourth);
    kept(sample.n_discs), kept(sample.mass), kept(sample.momentum_x), kept(sample.momentum_y);
    keep_tensor(kept, sample.motion);
    keep_tensor(kept, sample.stress);
    kept(sample.energy), kept(sample.area);
}

} // namespace

void BlockAverages::Block::keep(KeptNumbers& kept) {
    kept(walls), kept(pairs), kept(speed), kept(kurtosis);
    kept(motion.steps), kept(motion.area), kept(motion.n_discs);
    keep_tensor(kept, motion.kinetic);
    keep_tensor(kept, motion.stress);
}

/// Stores or restores the averages. They begin anew if the scene's `averages_from` has changed.
void BlockAverages::keep(KeptNumbers& kept) {
    kept.same(run_.scene.averages_from);
    MotionInterval::Pending pending;
    MotionSample last;
    if (!kept.is_restored()) {
        pending = interval_->pending();
        last = interval_->last();
    }
    kept(pending.bound), kept(pending.words);
    kept(first_step_), kept(block_step_), kept(sample_step_);
    kept(steps_per_sample_), kept(steps_per_block_);
    keep_sample(kept, last);
    present_.keep(kept);
    keep_blocks(kept);
    if (!kept.is_restored()) return;
    const bool is_valid = pending.bound > 0 && std::isfinite(pending.bound) &&
                          block_step_ >= first_step_ && sample_step_ >= block_step_ &&
                          steps_per_sample_ >= 1 && steps_per_block_ >= steps_per_sample_ &&
                          blocks_.size() < most_blocks;
    if (!is_valid) kept.refuse();
    if (kept.is_right()) interval_.emplace(run_.system, run_.ranks, pending, last);
}

/// Stores or restores the blocks. They are stored last, so that their number need not be stored.
void BlockAverages::keep_blocks(KeptNumbers& kept) {
    if (!kept.is_restored())
        for (Block& block : blocks_) block.keep(kept);
    else
        for (blocks_.clear(); kept.is_right() && !kept.is_at_end();)
            blocks_.emplace_back().keep(kept);
}

/// The counts and integrals from the last sample up to `step`, at which `sample` was taken.
BlockAverages::Block BlockAverages::block_up_to(std::int64_t step,
                                                const MotionSample& sample) const {
    const MotionSample& before = interval_->last();
    const auto kurtosis_of = [](const MotionSample& l) {
        return l.mean_square > 0 ? l.mean_fourth / (l.mean_square * l.mean_square) : 0;
    };
    Block block;
    block.walls = static_cast<double>(sample.wall_collisions - before.wall_collisions);
    block.pairs = static_cast<double>(sample.pair_collisions - before.pair_collisions);
    const auto steps = static_cast<double>(step - sample_step_);
    block.motion = integrals_between(system_, before, sample, steps);
    // Mean speed and kurtosis are assumed to change linearly between two samples.
    for (const MotionSample* one : {&before, &sample}) {
        block.speed += steps / 2 * one->mean_speed * one->speed_unit * system_.velocity_unit;
        block.kurtosis += steps / 2 * kurtosis_of(*one);
    }
    return block;
}

/// Whether discs have left through open sides, which changes averages over the remaining discs.
bool BlockAverages::lost_discs() const {
    if (system_.keeps_discs || blocks_.empty()) return false;
    const auto n_in = [](const Block& block) { return block.motion.n_discs / block.steps(); };
    return n_in(blocks_.back()) < n_in(blocks_.front()) * (1 - 1e-9);
}

template <class Value>
Estimate BlockAverages::estimate(const Block& whole, const Value& value, double collisions) const {
    Estimate result;
    result.value = value(whole);
    if (std::isnan(result.value)) return result; // undefined for this scene
    result.is_short = is_short(whole, collisions);
    if (result.is_short) return result;
    std::vector<double> terms;
    for (const Block& block : blocks_) terms.push_back(value(block));
    const BlockedMean blocked = blocked_mean(terms);
    result.is_conserved = blocked.is_constant;
    result.is_changing = blocked.is_changing || (lost_discs() && !blocked.is_constant);
    if (result.is_changing) result.first = terms.front(), result.last = terms.back();
    if (result.is_conserved || result.is_changing || std::isnan(blocked.error)) return result;
    result.error = blocked.error;
    const double independent = blocked.blocks_per_independent *
                               static_cast<double>(steps_per_block_);
    result.correlation_time = independent / 2;
    result.independent_samples = whole.steps() / independent;
    return result;
}

void BlockAverages::fill_pressures(Averages& result, const Block& whole) const {
    const auto part = [&](double Tensor::* one) {
        return estimate(
            whole, [one](const Block& b) { return b.motion.pressure(one); }, fewest_collisions);
    };
    result.temperature = estimate(whole, [](const Block& b) { return b.motion.temperature(); });
    result.pressure_tensor = {part(&Tensor::xx), part(&Tensor::xy), part(&Tensor::yy)};
    result.pressure = estimate(whole, [](const Block& b) { return b.motion.pressure(); });
    result.compressibility = estimate(whole, [](const Block& b) {
        return b.motion.pressure() * b.motion.area / b.motion.energy();
    });
}

/// Computes the pressures by equations (13c) and (19a) of Li et al. 2022, which give beta P from
/// numbers of collisions in a time. R^2 is the sum of all squared velocities, kT = R^2 / (2 N).
void BlockAverages::fill_counted_pressures(Averages& result, const Block& whole,
                                           const MotionSample& sample) const {
    const double n = system_.n_discs, area = system_.box.area();
    const double square = sample.mean_square *
                          std::pow(sample.speed_unit * system_.velocity_unit, 2);
    const double sqrt_pi_g_over_r = square > 0 ? std::sqrt(std::numbers::pi / (n * square)) *
                                                     gamma_ratio(n)
                                               : 0;
    const double temperature = square / 2;
    result.wall_pressure = estimate(whole, [=, this](const Block& block) {
        return temperature * sqrt_pi_g_over_r * block.walls /
               ((system_.box.x + system_.box.y) * block.steps());
    });
    result.virial_pressure = estimate(whole, [=, this](const Block& block) {
        const double rate = (block.walls + std::numbers::sqrt2 * block.pairs) / block.steps();
        return temperature * (n + system_.radius * sqrt_pi_g_over_r * rate) / area;
    });
}

namespace {

Estimate inverse_of(const Estimate& rate) {
    Estimate time = rate;
    for (double Estimate::* number : {&Estimate::value, &Estimate::first, &Estimate::last})
        time.*number = 1 / (rate.*number);
    time.error = rate.value > 0 ? time.value * time.value * rate.error : unknown;
    return time;
}

} // namespace

Averages BlockAverages::averages() const {
    Averages result;
    if (!has_begun()) return result;
    const std::int64_t step = run_.system.step();
    result.first_step = first_step_;
    result.steps = step - first_step_;
    if (result.steps == 0) return result;
    const MotionSample sample = interval_->now();
    Block whole = block_up_to(step, sample);
    whole += present_;
    for (const Block& block : blocks_) whole += block;
    result.n_blocks = static_cast<std::int64_t>(blocks_.size());

    const double n = system_.n_discs;
    result.collision_frequency = estimate(
        whole, [n](const Block& block) { return 2 * block.pairs / (n * block.steps()); });
    result.mean_free_time = inverse_of(result.collision_frequency);
    if (!system_.keeps_discs) result.collision_frequency = result.mean_free_time = {};
    // A single disc keeps its speed along each axis, so theories of equilibrium do not hold for it.
    if (system_.is_plain && n > 1) fill_counted_pressures(result, whole, sample);
    result.mean_speed = estimate(
        whole, [](const Block& b) { return b.speed / b.steps(); }, fewest_collisions);
    result.speed_kurtosis = estimate(
        whole, [](const Block& b) { return b.kurtosis / b.steps(); }, fewest_collisions);
    fill_pressures(result, whole);
    return result;
}

/// Computes Gamma(n + 1/2) / Gamma(n) by an asymptotic series (Tricomi and Erdelyi 1951), which is
/// used for n >= 64. A smaller n is first raised to 64 or more with Gamma(n + 1) = n Gamma(n).
double gamma_ratio(double n) {
    double factor = 1;
    for (; n < 64; n += 1) factor *= n / (n + 0.5);
    const double u = 1 / n;
    const double series = 1 + u * (-1.0 / 8 +
                                   u * (1.0 / 128 +
                                        u * (5.0 / 1024 +
                                             u * (-21.0 / 32768 +
                                                  u * (-399.0 / 262144 + u * (869.0 / 4194304))))));
    return factor * std::sqrt(n) * series;
}

} // namespace carrom
