// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/block_averages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace carrom {

namespace {

/// Blocks are joined to longer ones while so many are left.
constexpr std::size_t fewest_joined_blocks = 16;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A power of two that is two to four times the largest component of a velocity.
double speed_unit_of(std::span<const Disc> own, int n_threads, const Communicator& communicator) {
    double largest = 0;
    const auto n = static_cast<std::int64_t>(own.size());
#pragma omp parallel for num_threads(n_threads) schedule(static)                                   \
    reduction(max : largest) if (n > 10000)
    for (std::int64_t i = 0; i < n; ++i) {
        const Disc& disc = own[static_cast<std::size_t>(i)];
        largest = std::max({largest, std::fabs(disc.vx), std::fabs(disc.vy)});
    }
    int exponent = 0;
    std::frexp(communicator.max(largest), &exponent);
    return std::ldexp(1.0, std::max(exponent, -1000) + 1);
}

} // namespace

double standard_error(std::vector<double> terms) {
    double error = unknown;
    for (std::size_t fewest = fewest_blocks; terms.size() >= fewest;
         fewest = fewest_joined_blocks) {
        const auto n = static_cast<double>(terms.size());
        double mean = 0, squares = 0;
        for (const double term : terms) mean += term / n;
        for (const double term : terms) squares += (term - mean) * (term - mean);
        error = std::fmax(error, std::sqrt(squares / (n * (n - 1))));
        for (std::size_t k = 0; k < terms.size() / 2; ++k)
            terms[k] = (terms[2 * k] + terms[2 * k + 1]) / 2;
        terms.resize(terms.size() / 2);
    }
    return error;
}

/// No term is above 1: the sum of as many as there are discs stays below 2^63.
double terms_per_unit_of(std::uint64_t n_discs) {
    const double bits = std::ceil(std::log2(static_cast<double>(n_discs)));
    return std::ldexp(1.0, 62 - static_cast<int>(bits));
}

Look look_at(std::span<const Disc> own, const SpeciesTable* species_table, double heaviest,
             std::uint64_t n_discs, int n_threads, const Communicator& communicator) {
    Look look;
    look.speed_unit = speed_unit_of(own, n_threads, communicator);
    const double terms_per_unit = terms_per_unit_of(n_discs);
    const double per_unit = 1 / look.speed_unit;
    std::uint64_t walls = 0, pairs = 0, speeds = 0, squares = 0, fourths = 0, departed = 0;
    std::uint64_t masses = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    const auto n = static_cast<std::int64_t>(own.size());
    const auto fixed = [terms_per_unit](double term) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(term * terms_per_unit));
    };
#pragma omp parallel for num_threads(n_threads) schedule(static)                                   \
    reduction(+ : walls, pairs, speeds, squares, fourths, departed, masses, x, y, xx, xy,          \
                  yy) if (n > 10000)
    for (std::int64_t i = 0; i < n; ++i) {
        const Disc& disc = own[static_cast<std::size_t>(i)];
        walls += disc.wall_collisions;
        pairs += disc.pair_collisions;
        const bool has_departed = disc.has_departed(); // and is at rest
        departed += has_departed;
        const double vx = disc.vx * per_unit, vy = disc.vy * per_unit;
        const double square = vx * vx + vy * vy;
        speeds += fixed(std::sqrt(square));
        fourths += fixed(square * square);
        double px = vx, py = vy;
        if (species_table) {
            const double mass = species_table->of(disc.id).mass / heaviest;
            px = mass * vx;
            py = mass * vy;
            squares += fixed(square);
            masses += has_departed ? 0 : fixed(mass);
        }
        x += fixed(px);
        y += fixed(py);
        xx += fixed(px * vx);
        xy += fixed(px * vy);
        yy += fixed(py * vy);
    }
    if (!species_table) squares = xx + yy;
    std::uint64_t sums[] = {walls,  pairs, speeds, squares, fourths, departed,
                            masses, x,     y,      xx,      xy,      yy};
    communicator.sum(sums);
    const double per_term = 1 / terms_per_unit;
    look.n_discs = static_cast<double>(n_discs - sums[5]);
    const double per_disc = per_term / std::max(1.0, look.n_discs);
    look.wall_collisions = sums[0];
    look.pair_collisions = sums[1] / 2;
    look.mean_speed = static_cast<double>(sums[2]) * per_disc;
    look.mean_square = static_cast<double>(sums[3]) * per_disc;
    look.mean_fourth = static_cast<double>(sums[4]) * per_disc;
    const auto signed_sum = [&](std::size_t k) {
        return static_cast<double>(static_cast<std::int64_t>(sums[k])) * (per_term * heaviest);
    };
    look.mass = species_table ? signed_sum(6) : look.n_discs;
    look.momentum_x = signed_sum(7);
    look.momentum_y = signed_sum(8);
    look.motion = {signed_sum(9), signed_sum(10), signed_sum(11)};
    return look;
}

Tensor sum_of(const PairVirial& virial, const Communicator& communicator) {
    PairVirial all = virial;
    for (ExactSum* sum : {&all.xx, &all.xy, &all.yy}) communicator.sum(*sum);
    return {all.xx.value(), all.xy.value(), all.yy.value()};
}

Tensor& Tensor::operator+=(const Tensor& other) {
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
}

BlockAverages::Block& BlockAverages::Block::operator+=(const Block& other) {
    steps += other.steps;
    walls += other.walls;
    pairs += other.pairs;
    speed += other.speed;
    kurtosis += other.kurtosis;
    area += other.area;
    n_discs += other.n_discs;
    motion += other.motion;
    virial += other.virial;
    return *this;
}

void BlockAverages::begin(std::int64_t step, const Look& look) {
    has_begun_ = true;
    first_step_ = block_step_ = look_step_ = step;
    last_ = look;
    present_ = {};
    constexpr auto fewest = static_cast<std::int64_t>(fewest_blocks); // each costs a look
    const std::int64_t per_sync = (system_.sync_every + system_.micro_steps - 1) /
                                  system_.micro_steps;
    steps_per_block_ = std::clamp<std::int64_t>((system_.last_step - step) / fewest, 1, per_sync);
    blocks_.clear();
}

bool BlockAverages::is_due(std::int64_t step) const {
    return step >= block_end() || syncs_before(step) > syncs_before(look_step_);
}

void BlockAverages::add(std::int64_t step, const Look& look) {
    present_ += block_between(look_step_, last_, step, look);
    last_ = look;
    look_step_ = step;
    if (step < block_end()) return;
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
}

namespace {

/// A record of numbers of 8 bytes, one behind the other.
template <class Record> constexpr std::size_t n_words_of = sizeof(Record) / sizeof(std::int64_t);

template <class Record> void append_words(std::vector<std::int64_t>& words, const Record& record) {
    const auto mine = std::bit_cast<std::array<std::int64_t, n_words_of<Record>>>(record);
    words.insert(words.end(), mine.begin(), mine.end());
}

template <class Record> Record take_words(std::span<const std::int64_t>& words) {
    std::array<std::int64_t, n_words_of<Record>> mine;
    std::copy_n(words.begin(), mine.size(), mine.begin());
    words = words.subspan(mine.size());
    return std::bit_cast<Record>(mine);
}

} // namespace

std::vector<std::int64_t> BlockAverages::words() const {
    std::vector<std::int64_t> words = {first_step_, block_step_, look_step_, steps_per_block_};
    append_words(words, last_);
    append_words(words, present_);
    for (const Block& block : blocks_) append_words(words, block);
    return words;
}

bool BlockAverages::set_words(std::span<const std::int64_t> words) {
    constexpr std::size_t n_fixed = 4 + n_words_of<Look> + n_words_of<Block>;
    if (words.size() < n_fixed || (words.size() - n_fixed) % n_words_of<Block> != 0) return false;
    const std::size_t n_blocks = (words.size() - n_fixed) / n_words_of<Block>;
    if (n_blocks >= most_blocks || words[3] < 1 || words[1] < words[0] || words[2] < words[1])
        return false;
    first_step_ = words[0], block_step_ = words[1], look_step_ = words[2];
    steps_per_block_ = words[3];
    words = words.subspan(4);
    last_ = take_words<Look>(words);
    present_ = take_words<Block>(words);
    blocks_.clear();
    for (std::size_t k = 0; k < n_blocks; ++k) blocks_.push_back(take_words<Block>(words));
    has_begun_ = true;
    return true;
}

Tensor BlockAverages::motion_of(const Look& look) const {
    const double drift_x = system_.is_periodic_x && look.mass > 0 ? look.momentum_x / look.mass : 0,
                 drift_y = system_.is_periodic_y && look.mass > 0 ? look.momentum_y / look.mass : 0;
    const double n = look.n_discs, all = n > 1 ? n / (n - 1) : 1;
    const double x_factor = system_.is_periodic_x ? all : 1,
                 y_factor = system_.is_periodic_y ? all : 1;
    const Tensor left = {
        look.motion.xx - 2 * drift_x * look.momentum_x + look.mass * drift_x * drift_x,
        look.motion.xy - drift_x * look.momentum_y - drift_y * look.momentum_x +
            look.mass * drift_x * drift_y,
        look.motion.yy - 2 * drift_y * look.momentum_y + look.mass * drift_y * drift_y};
    const double unit = look.speed_unit * system_.velocity_unit;
    return {x_factor * unit * unit * left.xx,
            std::sqrt(x_factor * y_factor) * unit * unit * left.xy,
            y_factor * unit * unit * left.yy};
}

BlockAverages::Block BlockAverages::block_between(std::int64_t step, const Look& before,
                                                  std::int64_t now, const Look& look) const {
    const auto kurtosis_of = [](const Look& l) {
        return l.mean_square > 0 ? l.mean_fourth / (l.mean_square * l.mean_square) : 0;
    };
    Block block;
    block.steps = static_cast<double>(now - step);
    block.walls = static_cast<double>(look.wall_collisions - before.wall_collisions);
    block.pairs = static_cast<double>(look.pair_collisions - before.pair_collisions);
    block.virial = {look.virial.xx - before.virial.xx, look.virial.xy - before.virial.xy,
                    look.virial.yy - before.virial.yy};
    block.virial = system_.velocity_unit * block.virial;
    for (const Look* one : {&before, &look}) { // what changes evenly
        const double half = block.steps / 2;
        block.speed += half * one->mean_speed * one->speed_unit * system_.velocity_unit;
        block.kurtosis += half * kurtosis_of(*one);
        block.area += half * one->area;
        block.n_discs += half * one->n_discs;
        block.motion += half * motion_of(*one);
    }
    return block;
}

template <class Value>
Estimate BlockAverages::estimate(const Block& whole, const Value& value) const {
    std::vector<double> terms;
    for (const Block& block : blocks_) terms.push_back(value(block));
    return {value(whole), standard_error(std::move(terms))};
}

void BlockAverages::fill_pressures(Averages& result, const Block& whole) const {
    const auto both = [](const Block& b, double Tensor::* part) {
        return (b.motion.*part + b.virial.*part) / b.area;
    };
    const auto pressure = [&both](const Block& b) {
        return (both(b, &Tensor::xx) + both(b, &Tensor::yy)) / 2;
    };
    const auto energy = [](const Block& b) { return (b.motion.xx + b.motion.yy) / 2; }; // N kT
    result.temperature = estimate(whole, [&](const Block& b) { return energy(b) / b.n_discs; });
    result.pressure_tensor = {
        estimate(whole, [&](const Block& b) { return both(b, &Tensor::xx); }),
        estimate(whole, [&](const Block& b) { return both(b, &Tensor::xy); }),
        estimate(whole, [&](const Block& b) { return both(b, &Tensor::yy); })};
    result.pressure = estimate(whole, pressure);
    result.compressibility = estimate(
        whole, [&](const Block& b) { return pressure(b) * b.area / energy(b); });
}

/// Equations (13c) and (19a) of Li et al. 2022: beta P per collision and time; R^2 = sum of the
/// squares of all velocities, kT = R^2 / (2 N).
void BlockAverages::fill_counted_pressures(Averages& result, const Block& whole,
                                           const Look& look) const {
    const double n = system_.n_discs, area = system_.box.area();
    const double square = look.mean_square * std::pow(look.speed_unit * system_.velocity_unit, 2);
    const double sqrt_pi_g_over_r = square > 0 ? std::sqrt(std::numbers::pi / (n * square)) *
                                                     gamma_ratio(n)
                                               : 0;
    const double temperature = square / 2;
    result.wall_pressure = estimate(whole, [=, this](const Block& block) {
        return temperature * sqrt_pi_g_over_r * block.walls /
               ((system_.box.x + system_.box.y) * block.steps);
    });
    result.virial_pressure = estimate(whole, [=, this](const Block& block) {
        const double rate = (block.walls + std::numbers::sqrt2 * block.pairs) / block.steps;
        return temperature * (n + system_.radius * sqrt_pi_g_over_r * rate) / area;
    });
}

Averages BlockAverages::averages(std::int64_t step, const Look& look) const {
    Averages result;
    result.first_step = first_step_;
    result.steps = step - first_step_;
    if (result.steps == 0) return result;
    Block whole = block_between(look_step_, last_, step, look);
    whole += present_;
    for (const Block& block : blocks_) whole += block;
    result.n_blocks = static_cast<std::int64_t>(blocks_.size());

    const double n = system_.n_discs;
    result.collision_frequency = estimate(
        whole, [n](const Block& block) { return 2 * block.pairs / (n * block.steps); });
    const double time = 1 / result.collision_frequency.value;
    result.mean_free_time = {time, whole.pairs > 0 ? time * time * result.collision_frequency.error
                                                   : unknown};
    result.wall_pressure = result.virial_pressure = {unknown, unknown};
    if (!system_.keeps_discs)
        result.collision_frequency = result.mean_free_time = {unknown, unknown};
    if (system_.is_plain) fill_counted_pressures(result, whole, look);
    result.mean_speed = estimate(whole, [](const Block& b) { return b.speed / b.steps; });
    result.speed_kurtosis = estimate(whole, [](const Block& b) { return b.kurtosis / b.steps; });
    fill_pressures(result, whole);
    return result;
}

/// Asymptotic series from 64 on (Tricomi and Erdelyi 1951), below that by Gamma(n + 1) = n
/// Gamma(n).
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
