// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carrom {

namespace {

/// A power of two that is two to four times the largest component of a velocity.
double speed_unit_of(std::span<const DiscState> own, int n_threads,
                     const Communicator& communicator) {
    double largest = 0;
    const auto n = static_cast<std::int64_t>(own.size());
#pragma omp parallel for num_threads(n_threads) schedule(static)                                   \
    reduction(max : largest) if (n > 10000)
    for (std::int64_t i = 0; i < n; ++i) {
        const DiscState& disc = own[static_cast<std::size_t>(i)];
        largest = std::max({largest, std::fabs(disc.vx), std::fabs(disc.vy)});
    }
    int exponent = 0;
    std::frexp(communicator.max(largest), &exponent);
    return std::ldexp(1.0, std::max(exponent, -1000) + 1);
}

} // namespace

/// No term exceeds 1, so the sum of one term for each disc stays below 2^63.
double terms_per_unit_of(std::uint64_t n_discs) {
    const double bits = std::ceil(std::log2(static_cast<double>(n_discs)));
    return std::ldexp(1.0, 62 - static_cast<int>(bits));
}

MotionSample sample_motion(std::span<const DiscState> own, const SpeciesTable* species_table,
                           double heaviest, std::uint64_t n_discs, int n_threads,
                           const Communicator& communicator) {
    MotionSample sample;
    sample.speed_unit = speed_unit_of(own, n_threads, communicator);
    const double terms_per_unit = terms_per_unit_of(n_discs);
    const double per_unit = 1 / sample.speed_unit;
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
        const DiscState& disc = own[static_cast<std::size_t>(i)];
        walls += disc.wall_collisions;
        pairs += disc.pair_collisions;
        departed += disc.has_departed(); // departed discs are at rest
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
            masses += disc.has_departed() ? 0 : fixed(mass);
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
    sample.n_discs = static_cast<double>(n_discs - sums[5]);
    const double per_disc = per_term / std::max(1.0, sample.n_discs);
    sample.wall_collisions = sums[0];
    sample.pair_collisions = sums[1] / 2;
    sample.mean_speed = static_cast<double>(sums[2]) * per_disc;
    sample.mean_square = static_cast<double>(sums[3]) * per_disc;
    sample.mean_fourth = static_cast<double>(sums[4]) * per_disc;
    const auto signed_sum = [&](std::size_t k) {
        return static_cast<double>(static_cast<std::int64_t>(sums[k])) * (per_term * heaviest);
    };
    sample.mass = species_table ? signed_sum(6) : sample.n_discs;
    sample.momentum_x = signed_sum(7);
    sample.momentum_y = signed_sum(8);
    sample.motion = {signed_sum(9), signed_sum(10), signed_sum(11)};
    return sample;
}

namespace {

/// The sum of m (v + a)(v + a), given the sum of m v v, the momenta, the mass and a = (ax, ay).
Tensor shifted(const Tensor& squares, double px, double py, double mass, double ax, double ay) {
    return {squares.xx + 2 * px * ax + mass * ax * ax,
            squares.xy + px * ay + py * ax + mass * ax * ay,
            squares.yy + 2 * py * ay + mass * ay * ay};
}

} // namespace

void add_integrals(const StressSums& mine, const Communicator& communicator, MotionSample& sample) {
    StressSums all = mine;
    for (ExactSum* sum : all.parts()) communicator.sum(*sum);
    sample.stress += Tensor{all.xx.value(), all.xy.value(), all.yy.value()};
    sample.energy += all.energy.value();
}

void add_flights(const FlightIntegral& flights, const Frame& frame, MotionSample& sample) {
    if (flights.weight == 0) return; // the weight is 0 immediately after a sync
    // A stored velocity is (velocity in the box - velocity of the frame) / slowing.
    const double unit = sample.speed_unit, slowing = frame.slowing;
    const double ax = flights.shift_x * slowing - frame.vx,
                 ay = flights.shift_y * slowing - frame.vy;
    const double px = unit * sample.momentum_x, py = unit * sample.momentum_y;
    const Tensor squares = shifted((unit * unit) * sample.motion, px, py, sample.mass, ax, ay);
    Tensor flown = (flights.weight / (slowing * slowing)) * squares;
    const double rx = flights.rest_x, ry = flights.rest_y, more = flights.more_y;
    flown += sample.mass * Tensor{rx * rx, rx * ry, ry * ry + more * more};
    sample.stress += flown;
    sample.energy += flown.xx + flown.yy;
}

Tensor& Tensor::operator+=(const Tensor& other) {
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
}

MotionIntegrals& MotionIntegrals::operator+=(const MotionIntegrals& other) {
    steps += other.steps;
    area += other.area;
    n_discs += other.n_discs;
    kinetic += other.kinetic;
    stress += other.stress;
    return *this;
}

namespace {

/// The drift velocity along one axis at both ends of an interval.
struct DriftOfInterval {
    Drift kind;
    double before, after;
};

DriftOfInterval drift_of(Drift kind, const AveragedSystem& system, const MotionSample& before,
                         const MotionSample& after, double MotionSample::* momentum) {
    if (kind == Drift::is_heat) return {kind, 0, 0};
    const auto velocity = [&](const MotionSample& sample) {
        if (!(sample.mass > 0)) return 0.0;
        return sample.*momentum / sample.mass * sample.speed_unit * system.velocity_unit;
    };
    return {kind, velocity(before), velocity(after)};
}

/// The mean of the product a b over an interval. Where nothing stops a drift, it is constant or
/// linear in time. For a fluctuating drift, the mean square at the two samples equals the mean
/// square over time; linear interpolation between the samples would give up to a third less.
double mean_product(const DriftOfInterval& a, const DriftOfInterval& b) {
    const double at_ends = (a.before * b.before + a.after * b.after) / 2;
    if (a.kind == Drift::is_driven || b.kind == Drift::is_driven) return at_ends;
    return at_ends - (a.after - a.before) * (b.after - b.before) / 6;
}

/// N divided by the number of degrees of freedom that are left along an axis.
double per_freedom(Drift kind, double n_discs, const AveragedSystem& system) {
    if (kind == Drift::is_heat) return 1;
    if (system.n_discs == 1) return std::numeric_limits<double>::quiet_NaN();
    return n_discs > 1 ? n_discs / (n_discs - 1) : 1;
}

} // namespace

/// Two numbers in integrals_between are approximate: how the kinetic energy is divided between the
/// axes, and a drift that changes between samples. Both errors enter the result only with the
/// weight 1 / N, and only along axes where the drift is not part of the temperature.
namespace {

/// A sum of squares along one axis, minus `taken`; `all` is the sum along both axes. If all discs
/// have equal velocities, only a rounding error remains, which is set to 0.
double rest(double sum, double taken, double all) {
    const double left = sum - taken;
    return std::fabs(left) <= 0x1p-44 * all ? 0 : left;
}

} // namespace

MotionIntegrals integrals_between(const AveragedSystem& system, const MotionSample& before,
                                  const MotionSample& after, double steps) {
    MotionIntegrals result;
    result.steps = steps;
    result.area = steps * (before.area + after.area) / 2;
    result.n_discs = steps * (before.n_discs + after.n_discs) / 2;
    const double unit = system.velocity_unit, energy = unit * (after.energy - before.energy);
    Tensor sampled;
    for (const MotionSample* one : {&before, &after})
        sampled += (steps / 2 * unit * unit * one->speed_unit * one->speed_unit) * one->motion;
    const double difference = (sampled.xx - sampled.yy) / 2;
    const Tensor all = system.has_flow
                           ? sampled
                           : Tensor{energy / 2 + difference, sampled.xy, energy / 2 - difference};

    const DriftOfInterval x = drift_of(system.drift_x, system, before, after,
                                       &MotionSample::momentum_x),
                          y = drift_of(system.drift_y, system, before, after,
                                       &MotionSample::momentum_y);
    const double n = result.n_discs / steps, mass = steps * (before.mass + after.mass) / 2,
                 x_factor = per_freedom(x.kind, n, system),
                 y_factor = per_freedom(y.kind, n, system);
    result.kinetic = {x_factor * rest(all.xx, mass * mean_product(x, x), all.xx + all.yy),
                      std::sqrt(x_factor * y_factor) * (all.xy - mass * mean_product(x, y)),
                      y_factor * rest(all.yy, mass * mean_product(y, y), all.xx + all.yy)};
    result.stress = unit * Tensor{after.stress.xx - before.stress.xx,
                                  after.stress.xy - before.stress.xy,
                                  after.stress.yy - before.stress.yy};
    result.stress += result.kinetic;
    if (!system.has_flow) result.stress += -1.0 * all; // in a flow the sums contain no flights
    return result;
}

double temperature_at(const AveragedSystem& system, const MotionSample& sample) {
    MotionSample before = sample, after = sample; // two equal samples, one step apart
    before.energy = 0;
    after.energy = system.velocity_unit * sample.speed_unit * sample.speed_unit *
                   (sample.motion.xx + sample.motion.yy);
    return integrals_between(system, before, after, 1).temperature();
}

} // namespace carrom
