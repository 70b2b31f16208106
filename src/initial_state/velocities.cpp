// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/velocities.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/axis.hpp"
#include "core/exact_sum.hpp"
#include "core/random_numbers.hpp"
#include "dynamics/species.hpp"

namespace carrom {

Velocity drawn_velocity(const SceneParameters& scene, DiscId id) {
    DiscRandom random(scene.seed, Purpose::velocity, id);
    const Direction direction = random_direction(random);
    const double speed = scene.velocities == VelocityKind::maxwell
                             ? std::sqrt(random_exponential(random))
                             : std::numbers::sqrt3 * random.uniform();
    // Exchanges x and y if the box is taller than wide, so that the box turned by 90 degrees has
    // the same gas.
    const auto [vx, vy] = turned(longer_axis(scene.box), speed * direction.x, speed * direction.y);
    return {vx, vy};
}

Velocity stream_velocity(const SceneParameters& scene, Point place) {
    Velocity sum;
    for (const Stream& stream : scene.streams) {
        const bool is_inside = place.x >= stream.x_low && place.x <= stream.x_high &&
                               place.y >= stream.y_low && place.y <= stream.y_high;
        if (!is_inside) continue;
        sum.x += stream.vx;
        sum.y += stream.vy;
    }
    return sum;
}

void add_streams(const SceneParameters& scene, std::vector<InputDisc>& discs) {
    if (scene.streams.empty() && !scene.effects.are_sheared()) return;
    for (InputDisc& disc : discs) {
        const Velocity stream = stream_velocity(scene, {disc.x, disc.y});
        disc.vx += stream.x + scene.effects.flow_at(disc.y, scene.box);
        disc.vy += stream.y;
    }
}

namespace {

/// Momentum and energy of discs. Masses are divided by the largest mass, so that sums of any masses
/// stay in the range of doubles.
class Motion {
public:
    Motion(const SceneParameters& scene, const std::vector<InputDisc>& discs,
           const Communicator& ranks, int n_threads)
        : ranks_(ranks), n_threads_(n_threads), n_discs_(static_cast<double>(scene.n_discs)),
          species_(scene.effects.species, scene.radius) {
        double heaviest = 0;
        for (const InputDisc& disc : discs) heaviest = std::max(heaviest, mass_of(disc));
        heaviest_ = ranks.max(heaviest);
        total_ = sum_over(discs, 1, [this](const InputDisc& disc) { return share_of(disc); });
    }

    double heaviest() const { return heaviest_; }
    double share_of(const InputDisc& disc) const { return mass_of(disc) / heaviest_; }

    /// The velocity of the centre of mass. **Collective.**
    Velocity mean_velocity(const std::vector<InputDisc>& discs) const {
        const double largest = largest_component(discs);
        const auto momentum = [&](double InputDisc::* component) {
            return sum_over(discs, largest, [&](const InputDisc& disc) {
                return share_of(disc) * disc.*component;
            });
        };
        const double x = momentum(&InputDisc::vx), y = momentum(&InputDisc::vy);
        return {x / total_, y / total_};
    }

    /// The mean of m v^2 divided by the mean of m. **Collective.**
    double mean_square(const std::vector<InputDisc>& discs) const {
        const double largest = largest_component(discs);
        return sum_over(discs, 2 * largest * largest,
                        [this](const InputDisc& disc) {
                            return share_of(disc) * (disc.vx * disc.vx + disc.vy * disc.vy);
                        }) /
               total_;
    }

    /// The total mass of all discs, divided by the largest mass.
    double total_mass() const { return total_; }

private:
    double mass_of(const InputDisc& disc) const { return species_.of(disc.id).mass; }

    double largest_component(const std::vector<InputDisc>& discs) const {
        double largest = 0;
#pragma omp parallel for num_threads(n_threads_) schedule(static) reduction(max : largest)
        for (std::size_t i = 0; i < discs.size(); ++i)
            largest = std::max({largest, std::fabs(discs[i].vx), std::fabs(discs[i].vy)});
        return ranks_.max(largest);
    }

    /// Sums a term over all discs of all ranks; no |term| may exceed `largest`.
    template <class Term>
    double sum_over(const std::vector<InputDisc>& discs, double largest, const Term& term) const {
        if (largest == 0) return 0;
        ExactSum sum(n_discs_ * largest);
#pragma omp parallel for num_threads(n_threads_) schedule(static) reduction(+ : sum)
        for (std::size_t i = 0; i < discs.size(); ++i) sum.add(term(discs[i]));
        ranks_.sum(sum);
        return sum.value();
    }

    const Communicator& ranks_;
    int n_threads_;
    double n_discs_;
    SpeciesTable species_;
    double heaviest_ = 1, total_ = 0;
};

void subtract_drift(const SceneParameters& scene, std::vector<InputDisc>& discs,
                    const Motion& motion) {
    const Periods periods = scene.effects.periods(scene.box);
    if (!periods.are_any() || scene.n_discs == 1) return;
    Velocity drift = motion.mean_velocity(discs);
    if (periods.x == 0) drift.x = 0;
    if (periods.y == 0) drift.y = 0;
    for (InputDisc& disc : discs) {
        disc.vx -= drift.x;
        disc.vy -= drift.y;
    }
}

/// The factor by which drawn speeds are multiplied. With a temperature, speeds are drawn in
/// proportion to sqrt(heaviest / m), so that all species have the same kT on average.
double scale_of(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                const Motion& motion) {
    const double root = std::sqrt(motion.mean_square(discs));
    if (root == 0) return 0;
    if (!scene.temperature) return scene.speed / root;
    const double per_disc = motion.total_mass() / static_cast<double>(scene.n_discs);
    return std::sqrt(2 * (*scene.temperature / motion.heaviest()) / per_disc) / root;
}

} // namespace

namespace {

/// Draws velocities, and corrects drift and energy of all discs together. **Collective.**
void give_motion(const SceneParameters& scene, std::vector<InputDisc>& discs,
                 const Communicator& communicator, int n_threads) {
    const Motion motion(scene, discs, communicator, n_threads);
#pragma omp parallel for num_threads(n_threads) schedule(static)
    for (std::size_t i = 0; i < discs.size(); ++i) {
        InputDisc& disc = discs[i];
        const Velocity drawn = drawn_velocity(scene, disc.id);
        const double factor = scene.temperature ? std::sqrt(1 / motion.share_of(disc)) : 1;
        disc.vx = factor * drawn.x;
        disc.vy = factor * drawn.y;
    }
    subtract_drift(scene, discs, motion);
    const double scale = scale_of(scene, discs, motion);
    for (InputDisc& disc : discs) {
        disc.vx *= scale;
        disc.vy *= scale;
    }
}

/// Calls give_motion for each group, with the group's temperature or speed. **Collective.**
void give_motion_by_group(const SceneParameters& scene, std::vector<InputDisc>& discs,
                          const Communicator& communicator, int n_threads) {
    std::ranges::sort(discs, {}, &InputDisc::id);
    SceneParameters of_group = scene;
    std::vector<InputDisc> part;
    DiscId end = 0;
    for (const DiscGroup& group : scene.groups) {
        const auto first = std::ranges::lower_bound(discs, end, {}, &InputDisc::id);
        const auto last = std::ranges::lower_bound(discs, end += group.count, {}, &InputDisc::id);
        if (group.count == 0) continue; // all discs of the group are frozen
        of_group.n_discs = group.count;
        of_group.temperature = scene.temperature;
        of_group.speed = group.speed.value_or(scene.speed);
        if (group.temperature) of_group.temperature = group.temperature;
        if (group.speed) of_group.temperature.reset();
        part.assign(first, last);
        give_motion(of_group, part, communicator, n_threads);
        std::ranges::copy(part, first);
    }
}

} // namespace

void give_velocities(const SceneParameters& scene, std::vector<InputDisc>& discs,
                     const Communicator& communicator, int n_threads) {
    if (scene.groups.empty())
        give_motion(scene, discs, communicator, n_threads);
    else
        give_motion_by_group(scene, discs, communicator, n_threads);
    add_streams(scene, discs);
}

} // namespace carrom
