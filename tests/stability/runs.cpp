// SPDX-License-Identifier: BSD-3-Clause
#include "runs.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <tuple>

#include <omp.h>

#include "core/errors.hpp"
#include "gathered.hpp"
#include "quad.hpp"
#include "scene_tools.hpp"

namespace carrom::test {

namespace {} // namespace

std::string name_of(Method method) {
    return method == Method::time_stepped ? "time-stepped" : "event-driven";
}

DiscSystem start(const TestScene& scene, Method method, Tuning tuning, unsigned seed) {
    const Communicator world = Communicator::world();
    SceneParameters checked = scene_of(scene);
    checked.method = method;
    tuning.threads = omp_get_max_threads();
    tuning.discs_per_thread = 1;
    return {checked, share_of(scene, world.rank(), world.size(), seed), world, tuning};
}

void run_to(DiscSystem& system, std::int64_t step) {
    while (system.step() < step) system.advance_towards(step);
}

Outcome outcome_of(const DiscSystem& system) {
    Outcome outcome{gathered(system.discs(), Communicator::world()), system.clock(),
                    system.totals()};
    std::sort(outcome.discs.begin(), outcome.discs.end(),
              [](const DiscState& a, const DiscState& b) { return a.id < b.id; });
    return outcome;
}

Outcome run(const TestScene& scene, Method method, const Tuning& tuning, unsigned seed) {
    DiscSystem system = start(scene, method, tuning, seed);
    run_to(system, scene.steps);
    return outcome_of(system);
}

std::string failure_of(const TestScene& scene, Method method) {
    try {
        run(scene, method);
    } catch (const InputError& error) {
        return error.what();
    } catch (const CollectiveError& error) {
        return error.what();
    }
    return {};
}

std::vector<Collision> collisions_of(const TestScene& scene, Method method) {
    DiscSystem system = start(scene, method);
    std::vector<Collision> mine;
    system.log_to(&mine);
    run_to(system, scene.steps);
    std::vector<Collision> all = gathered(std::span<const Collision>(mine), Communicator::world());
    std::sort(all.begin(), all.end(), [](const Collision& a, const Collision& b) {
        const auto key = [](const Collision& c) {
            return std::make_tuple(c.micro_step, c.time, c.generation, c.p, c.q != Collision::wall,
                                   c.q);
        };
        return key(a) < key(b);
    });
    return all;
}

double ulp_of(double size) {
    return std::nextafter(size, std::numeric_limits<double>::max()) - size;
}

double deepest_overlap(const Outcome& outcome, double sigma) {
    // Only neighbours within a diameter in the order of x are compared.
    std::vector<std::pair<double, double>> places;
    for (const DiscState& disc : outcome.discs)
        places.emplace_back(disc.x_at(outcome.clock), disc.y_at(outcome.clock));
    std::sort(places.begin(), places.end());
    double deepest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (std::size_t j = i + 1;
             j < places.size() && places[j].first - places[i].first < 1.01 * sigma; ++j) {
            const double dx = places[j].first - places[i].first,
                         dy = places[j].second - places[i].second;
            deepest = std::max(deepest, sigma - std::sqrt(dx * dx + dy * dy));
        }
    }
    // Discs with equal local times may have collided with each other at that time, so their overlap
    // at that time is computed.
    std::vector<const DiscState*> by_time;
    for (const DiscState& disc : outcome.discs) by_time.push_back(&disc);
    std::sort(by_time.begin(), by_time.end(),
              [](const DiscState* a, const DiscState* b) { return a->tau < b->tau; });
    for (std::size_t i = 1; i < by_time.size(); ++i) {
        const DiscState &a = *by_time[i - 1], &b = *by_time[i];
        if (a.tau == b.tau)
            deepest = std::max(
                deepest, sigma - std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)));
    }
    return deepest;
}

double farthest_outside(const Outcome& outcome, const reference::Setting& setting) {
    double farthest = -std::numeric_limits<double>::infinity();
    for (const DiscState& disc : outcome.discs) {
        for (const double centre : {disc.x_at(outcome.clock), disc.y_at(outcome.clock)}) {
            farthest = std::max(
                {farthest, setting.radius - centre, centre - (setting.box_size - setting.radius)});
        }
    }
    return farthest;
}

double squared_speeds(const Outcome& outcome) {
    Quad sum = 0;
    for (const DiscState& disc : outcome.discs)
        sum += Quad(disc.vx) * disc.vx + Quad(disc.vy) * disc.vy;
    return static_cast<double>(sum);
}

} // namespace carrom::test
