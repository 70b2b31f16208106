// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/block_averages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace carrom {

namespace {

/// Errors are taken from no fewer blocks; blocks are joined to longer ones while so many are left.
constexpr std::size_t fewest_blocks = 4, fewest_joined_blocks = 16;

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
    double error = std::numeric_limits<double>::quiet_NaN();
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

Look look_at(std::span<const Disc> own, std::uint64_t n_discs, int n_threads,
             const Communicator& communicator) {
    Look look;
    look.speed_unit = speed_unit_of(own, n_threads, communicator);
    // No term is above 1: their sum stays below 2^63.
    const double terms_per_unit = std::ldexp(
        1.0, 62 - static_cast<int>(std::ceil(std::log2(static_cast<double>(n_discs)))));
    const double per_unit = 1 / look.speed_unit;
    std::uint64_t walls = 0, pairs = 0, speeds = 0, squares = 0, fourths = 0, departed = 0;
    const auto n = static_cast<std::int64_t>(own.size());
    const auto fixed = [terms_per_unit](double term) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(term * terms_per_unit));
    };
#pragma omp parallel for num_threads(n_threads) schedule(static)                                   \
    reduction(+ : walls, pairs, speeds, squares, fourths, departed) if (n > 10000)
    for (std::int64_t i = 0; i < n; ++i) {
        const Disc& disc = own[static_cast<std::size_t>(i)];
        walls += disc.wall_collisions;
        pairs += disc.pair_collisions;
        departed += disc.has_departed(); // at rest
        const double vx = disc.vx * per_unit, vy = disc.vy * per_unit;
        const double square = vx * vx + vy * vy;
        speeds += fixed(std::sqrt(square));
        squares += fixed(square);
        fourths += fixed(square * square);
    }
    std::uint64_t sums[] = {walls, pairs, speeds, squares, fourths, departed};
    communicator.sum(sums);
    const double per_disc = 1 / (terms_per_unit * static_cast<double>(std::max<std::uint64_t>(
                                                      1, n_discs - sums[5])));
    look.wall_collisions = sums[0];
    look.pair_collisions = sums[1] / 2;
    look.mean_speed = static_cast<double>(sums[2]) * per_disc;
    look.mean_square = static_cast<double>(sums[3]) * per_disc;
    look.mean_fourth = static_cast<double>(sums[4]) * per_disc;
    return look;
}

BlockAverages::Block& BlockAverages::Block::operator+=(const Block& other) {
    steps += other.steps;
    walls += other.walls;
    pairs += other.pairs;
    n_looks += other.n_looks;
    speed += other.speed;
    kurtosis += other.kurtosis;
    return *this;
}

void BlockAverages::begin(std::int64_t step, const Look& look) {
    has_begun_ = true;
    first_step_ = block_step_ = step;
    first_ = block_ = look;
    syncs_per_block_ = 1;
    blocks_.clear();
}

bool BlockAverages::ends_block(std::int64_t step) const {
    const bool sync_has_ended = syncs_before(step) > syncs_before(step - 1);
    return sync_has_ended && syncs_before(step) - syncs_before(block_step_) >= syncs_per_block_;
}

void BlockAverages::end_block(std::int64_t step, const Look& look) {
    blocks_.push_back(block_since(block_step_, block_, step, look));
    block_step_ = step;
    block_ = look;
    if (blocks_.size() < most_blocks) return;
    for (std::size_t k = 0; k < most_blocks / 2; ++k) {
        blocks_[k] = blocks_[2 * k];
        blocks_[k] += blocks_[2 * k + 1];
    }
    blocks_.resize(most_blocks / 2);
    syncs_per_block_ *= 2;
}

double BlockAverages::speed_of(const Look& look) const {
    return look.mean_speed * look.speed_unit * system_.velocity_unit;
}

double BlockAverages::kurtosis_of(const Look& look) {
    return look.mean_square > 0 ? look.mean_fourth / (look.mean_square * look.mean_square) : 0;
}

BlockAverages::Block BlockAverages::block_since(std::int64_t step, const Look& before,
                                                std::int64_t now, const Look& look) const {
    Block block;
    block.steps = static_cast<double>(now - step);
    block.walls = static_cast<double>(look.wall_collisions - before.wall_collisions);
    block.pairs = static_cast<double>(look.pair_collisions - before.pair_collisions);
    block.n_looks = 1;
    block.speed = speed_of(look);
    block.kurtosis = kurtosis_of(look);
    if (system_.is_plain) return block;
    // Where speeds drift those at the ends of blocks alone would be too late: half of the one
    // before, half of the one after.
    block.speed = (speed_of(before) + block.speed) / 2;
    block.kurtosis = (kurtosis_of(before) + block.kurtosis) / 2;
    return block;
}

Averages BlockAverages::averages(std::int64_t step, const Look& look) const {
    Averages result;
    result.first_step = first_step_;
    result.steps = step - first_step_;
    if (result.steps == 0) return result;
    const Block whole = block_since(first_step_, first_, step, look);
    Block looks = blocks_.empty() ? whole : Block{};
    for (const Block& block : blocks_) looks += block;
    result.n_blocks = static_cast<std::int64_t>(blocks_.size());
    const auto error_of = [this](const auto& value) {
        std::vector<double> terms;
        for (const Block& block : blocks_) terms.push_back(value(block));
        return standard_error(std::move(terms));
    };

    const double n = system_.n_discs, area = system_.box_size * system_.box_size;
    const auto frequency = [n](const Block& block) { return 2 * block.pairs / (n * block.steps); };
    // beta P per collision and time; R^2 = sum of the squares of all velocities, kT = R^2 / (2 N).
    const double square = look.mean_square * std::pow(look.speed_unit * system_.velocity_unit, 2);
    const double sqrt_pi_g_over_r = square > 0 ? std::sqrt(std::numbers::pi / (n * square)) *
                                                     gamma_ratio(n)
                                               : 0;
    const double temperature = square / 2;
    const auto wall_pressure = [=, this](const Block& block) {
        return temperature * sqrt_pi_g_over_r * block.walls / (2 * system_.box_size * block.steps);
    };
    const auto virial_pressure = [=, this](const Block& block) {
        const double rate = (block.walls + std::numbers::sqrt2 * block.pairs) / block.steps;
        return temperature * (n + system_.radius * sqrt_pi_g_over_r * rate) / area;
    };
    const auto speed = [](const Block& block) { return block.speed / block.n_looks; };
    const auto kurtosis = [](const Block& block) { return block.kurtosis / block.n_looks; };

    result.collision_frequency = {frequency(whole), error_of(frequency)};
    const double time = 1 / result.collision_frequency.value;
    result.mean_free_time = {time, whole.pairs > 0 ? time * time * result.collision_frequency.error
                                                   : std::numeric_limits<double>::quiet_NaN()};
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    result.wall_pressure = result.virial_pressure = {unknown, unknown};
    if (!system_.keeps_discs)
        result.collision_frequency = result.mean_free_time = {unknown, unknown};
    if (system_.is_plain) {
        result.wall_pressure = {wall_pressure(whole), error_of(wall_pressure)};
        result.virial_pressure = {virial_pressure(whole), error_of(virial_pressure)};
    }
    result.mean_speed = {speed(looks), error_of(speed)};
    result.speed_kurtosis = {kurtosis(looks), error_of(kurtosis)};
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
