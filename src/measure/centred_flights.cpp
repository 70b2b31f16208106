// SPDX-License-Identifier: BSD-3-Clause
#include "measure/centred_flights.hpp"

#include <algorithm>

#include "core/exact_sum.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

/// Sums `term` over the flights of all ranks, `n` in all. No term may be larger than `largest`.
template <class Term>
double sum_over(std::span<const Flight> flights, double n, double largest,
                const Communicator& ranks, const Term& term) {
    if (largest == 0) return 0;
    ExactSum sum(n * largest);
    for (const Flight& flight : flights) sum.add(term(flight));
    ranks.sum(sum);
    return sum.value();
}

/// Subtracts from the component `axis` of a vector its mean over all discs, weighted by mass.
void subtract_mean(std::vector<Flight>& flights, std::array<double, 2> Flight::* vector,
                   std::size_t axis, double n, double largest, double heaviest,
                   const Communicator& ranks) {
    const double mass = sum_over(flights, n, heaviest, ranks,
                                 [](const Flight& flight) { return flight.mass; });
    const double sum = sum_over(flights, n, heaviest * largest, ranks, [&](const Flight& flight) {
        return flight.mass * (flight.*vector)[axis];
    });
    for (Flight& flight : flights) (flight.*vector)[axis] -= sum / mass;
}

} // namespace

std::array<bool, 2> is_centred(const SceneParameters& scene, double n_discs) {
    const auto is_apart = [&](Axis axis) {
        return n_discs > 1 && drift_along(axis, scene.effects) != Drift::is_heat;
    };
    return {is_apart(Axis::x), is_apart(Axis::y)};
}

std::array<double, 3> mean_flights(std::vector<Flight>& flights, const FlightBounds& bounds,
                                   const SceneParameters& scene, const Communicator& ranks) {
    const double n = static_cast<double>(ranks.sum(std::uint64_t{flights.size()}));
    double heaviest = 0;
    for (const Flight& flight : flights) heaviest = std::max(heaviest, flight.mass);
    heaviest = ranks.max(heaviest);
    const std::array<bool, 2> is_apart = is_centred(scene, n);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        if (!is_apart[axis]) continue;
        subtract_mean(flights, &Flight::way, axis, n, bounds.way, heaviest, ranks);
        subtract_mean(flights, &Flight::first_velocity, axis, n, bounds.velocity, heaviest, ranks);
        subtract_mean(flights, &Flight::velocity, axis, n, bounds.velocity, heaviest, ranks);
    }
    // A component minus its mean may be twice as large as the bound of the component.
    const auto square = [&](std::size_t axis) {
        return sum_over(flights, n, 4 * bounds.way * bounds.way, ranks,
                        [&](const Flight& flight) { return flight.way[axis] * flight.way[axis]; });
    };
    const double x = square(0), y = square(1),
                 products = sum_over(flights, n, 8 * bounds.velocity * bounds.velocity, ranks,
                                     [](const Flight& flight) {
                                         return flight.first_velocity[0] * flight.velocity[0] +
                                                flight.first_velocity[1] * flight.velocity[1];
                                     });
    return {x / n, y / n, products / n};
}

} // namespace carrom
