// SPDX-License-Identifier: BSD-3-Clause
#include "scene_tools.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "core/random_numbers.hpp"
#include "dynamics/oscillation.hpp"
#include "scene/key.hpp"

namespace carrom::test {

namespace {

constexpr double pi = 3.14159265358979323846;

bool is_free(const TestScene& scene, double x, double y) {
    const double sigma = 2 * scene.setting.radius;
    return std::none_of(scene.discs.begin(), scene.discs.end(), [&](const InputDisc& disc) {
        const double dx = disc.x - x, dy = disc.y - y;
        return dx * dx + dy * dy < sigma * sigma * (1 + 1e-9);
    });
}

} // namespace

std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", value);
    return text.data();
}

SceneParameters scene_of(const TestScene& test_scene) {
    SceneParameters scene;
    scene.name = test_scene.name;
    scene.box = test_scene.setting.box();
    scene.radius = test_scene.setting.radius;
    scene.n_discs = test_scene.discs.size();
    scene.generator = Generator::file;
    scene.listed_discs = test_scene.discs;
    scene.steps = test_scene.steps;
    scene.method = Method::time_stepped; // tests may change it
    scene.micro_steps = test_scene.setting.micro_steps;
    scene.sync_every = test_scene.setting.sync_every;
    scene.effects = test_scene.setting.effects;
    std::vector<NumberRun>& spins = scene.first_numbers[SideColumn::spin];
    for (const double spin : test_scene.setting.first_spins)
        spins.push_back({spins.size() + 1, spin});
    if (scene.effects.swap.is_on()) {
        DiscId end = 0;
        for (const Species& one : scene.effects.species)
            scene.first_numbers[SideColumn::swapped_radius].push_back(
                {end += one.count, one.radius});
    }
    return scene;
}

TestScene transposed(const TestScene& scene) {
    TestScene result = scene;
    result.name += ", transposed";
    for (InputDisc& disc : result.discs) {
        std::swap(disc.x, disc.y);
        std::swap(disc.vx, disc.vy);
    }
    reference::Setting& setting = result.setting;
    const Box box = setting.box();
    if (!box.is_square()) setting.box_size = box.y, setting.box_height = box.x;
    Effects& effects = setting.effects;
    std::swap(effects.boundaries[0], effects.boundaries[2]);
    std::swap(effects.boundaries[1], effects.boundaries[3]);
    std::swap(effects.gravity.x, effects.gravity.y);
    for (FixedDisc& body : effects.fixed_bodies.discs) std::swap(body.x, body.y);
    for (Segment& body : effects.fixed_bodies.segments) {
        std::swap(body.x0, body.y0);
        std::swap(body.x1, body.y1);
    }
    for (double& spin : setting.first_spins) spin = -spin;
    // A tall box draws the same random numbers at its walls as the box turned on its side.
    if (const auto draw = setting.thermal_draw; draw && !box.is_square())
        setting.thermal_draw = [draw](const Boundary& side, DiscId id, std::uint64_t count,
                                      std::size_t number) {
            return draw(side, id, count, (number + 2) % 4);
        };
    return result;
}

TestScene scaled(const TestScene& scene, int exponent) {
    TestScene result = scene;
    result.name += ", times 2^" + std::to_string(exponent);
    const auto scale = [exponent](double& value) { value = std::ldexp(value, exponent); };
    scale(result.setting.box_size);
    scale(result.setting.box_height);
    scale(result.setting.radius);
    for (InputDisc& disc : result.discs) {
        scale(disc.x);
        scale(disc.y);
        scale(disc.vx);
        scale(disc.vy);
    }
    return result;
}

TestScene shuffled(TestScene scene, std::uint64_t seed) {
    Random random(seed);
    scene.name += ", shuffled";
    std::vector<DiscId> ids(scene.discs.size());
    std::iota(ids.begin(), ids.end(), DiscId{0});
    random.shuffle(ids);
    for (std::size_t i = 0; i < ids.size(); ++i) scene.discs[i].id = ids[i];
    random.shuffle(scene.discs);
    return scene;
}

TestScene empty_scene(std::string name, double box_size, double radius, std::int64_t steps) {
    TestScene scene;
    scene.name = std::move(name);
    scene.setting.box_size = box_size;
    scene.setting.radius = radius;
    scene.steps = steps;
    return scene;
}

void add_disc(TestScene& scene, double x, double y, double vx, double vy) {
    scene.discs.push_back({scene.discs.size(), x, y, vx, vy});
}

void add_gas(TestScene& scene, std::size_t n, Random& random) {
    const double size = scene.setting.box_size, radius = scene.setting.radius;
    const double packing_of_centres = static_cast<double>(n) * pi * radius * radius /
                                      ((size - radius) * (size - radius));
    if (packing_of_centres < 0.4) {
        for (std::size_t tries = 0; scene.discs.size() < n; ++tries) {
            if (tries > 1000 * n + 100000)
                throw std::logic_error("no room for the gas of " + scene.name);
            const double x = random.uniform(radius, size - radius),
                         y = random.uniform(radius, size - radius);
            if (is_free(scene, x, y)) add_disc(scene, x, y);
        }
        return;
    }
    const std::size_t k = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(n))));
    const double spacing = size / static_cast<double>(k);
    const double shake = 0.499 * (spacing - 2 * radius);
    for (std::size_t i = 0; i < k * k; ++i) {
        const double x = (static_cast<double>(i % k) + 0.5) * spacing +
                         random.uniform(-shake, shake);
        const double y = (static_cast<double>(i / k) + 0.5) * spacing +
                         random.uniform(-shake, shake);
        add_disc(scene, x, y);
    }
}

void add_species(TestScene& scene, bool round_x, bool round_y, Random& random) {
    const Box box = scene.setting.box();
    const auto nearest = [](double distance, double length, bool is_round) {
        return is_round ? distance - length * std::round(distance / length) : distance;
    };
    for (const Species& one : scene.setting.effects.species) {
        const double x_low = round_x ? 0 : one.radius, y_low = round_y ? 0 : one.radius;
        const std::size_t end = scene.discs.size() + one.count;
        while (scene.discs.size() < end) {
            const double x = random.uniform(x_low, box.x - x_low),
                         y = random.uniform(y_low, box.y - y_low);
            const bool is_clear = std::ranges::all_of(scene.discs, [&](const InputDisc& disc) {
                return std::hypot(nearest(disc.x - x, box.x, round_x),
                                  nearest(disc.y - y, box.y, round_y)) >
                       1.0001 * (one.radius + scene.setting.radius_of(disc.id));
            });
            if (is_clear) add_disc(scene, x, y);
        }
    }
}

std::vector<InputDisc> share_of(const TestScene& scene, int rank, int n_ranks, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<InputDisc> mine;
    for (const InputDisc& disc : scene.discs)
        if (static_cast<int>(random() % static_cast<unsigned>(n_ranks)) == rank)
            mine.push_back(disc);
    std::shuffle(mine.begin(), mine.end(), random);
    return mine;
}

void set_speeds(TestScene& scene, double speed, Random& random) {
    const double largest = speed * std::sqrt(1.5);
    for (InputDisc& disc : scene.discs) {
        disc.vx = random.uniform(-largest, largest);
        disc.vy = random.uniform(-largest, largest);
    }
}

TestScene gas(std::size_t n, double packing, double speed, std::uint64_t seed) {
    Random random(seed);
    const double box_size = std::max(2.5, std::sqrt(static_cast<double>(n) * pi / packing));
    TestScene scene = empty_scene("gas of " + std::to_string(n) + ", packing " + number(packing) +
                                      ", speed " + number(speed),
                                  box_size, 1, 40);
    add_gas(scene, n, random);
    set_speeds(scene, 2 * speed, random);
    return scene;
}

TestScene chain(std::size_t n, const std::string& times_kind, std::uint64_t seed) {
    Random random(seed);
    // Every pair approaches at two units a step, so a gap of g closes at g/2; all gaps are below 2.
    const double count = static_cast<double>(n);
    TestScene scene = empty_scene("chain of " + std::to_string(n) + ", times " + times_kind,
                                  4 * count, 0.5, 12);
    double x = count / 2;
    for (std::size_t i = 0; i < n; ++i) {
        const double place = static_cast<double>(i);
        add_disc(scene, x, 2 * count, count - 2 * place, 0);
        const double rank = std::floor(1024 * (place + 1) / (count + 1)) / 1024;
        double t = 0.5;
        if (times_kind == "rising") t = rank;
        if (times_kind == "falling") t = 1 - rank;
        if (times_kind == "mixed") t = random.uniform(0.01, 0.99);
        x += 1 + 2 * t;
    }
    return scene;
}

TestScene zigzag(std::size_t n, const std::string& times_kind, std::uint64_t seed) {
    Random random(seed);
    const double count = static_cast<double>(n);
    const double box_size = 2 + count;
    TestScene scene = empty_scene("zigzag of " + std::to_string(n) + ", times " + times_kind,
                                  box_size, 0.5, 12);
    double x = 1;
    for (std::size_t i = 0; i < n; ++i) {
        const double side = i % 2 == 0 ? -1 : 1;
        add_disc(scene, x, std::floor(box_size / 2) + 0.625 * side, 0, -0.625 * side);
        // The farther the discs of a pair are apart in x, the later their rows are close enough.
        const double rank = std::floor(1024 * static_cast<double>(i) / count) / 1024;
        double width = 0.75;
        if (times_kind == "rising") width = 0.5625 + 0.375 * rank;
        if (times_kind == "falling") width = 0.9375 - 0.375 * rank;
        if (times_kind == "mixed") width = random.uniform(0.5625, 0.9375);
        x += width;
    }
    return scene;
}

TestScene cradle(std::size_t n, double radius, double gap, double speed) {
    const double pitch = 2 * radius + gap;
    const double box_size = static_cast<double>(n) * pitch + gap;
    TestScene scene = empty_scene("cradle of " + std::to_string(n) + ", radius " + number(radius) +
                                      ", gap " + number(gap) + ", speed " + number(speed),
                                  box_size, radius, 30);
    for (std::size_t i = 0; i < n; ++i) {
        add_disc(scene, (gap + radius) + static_cast<double>(i) * pitch, box_size / 2,
                 i == 0 ? speed : 0, 0);
    }
    return scene;
}

TestScene lattice(std::size_t k, double spacing) {
    TestScene scene = empty_scene("lattice of " + std::to_string(k * k) + ", spacing " +
                                      number(spacing),
                                  spacing * static_cast<double>(k), 0.5, 24);
    for (std::size_t i = 0; i < k * k; ++i) {
        add_disc(scene, (static_cast<double>(i % k) + 0.5) * spacing,
                 (static_cast<double>(i / k) + 0.5) * spacing);
    }
    return scene;
}

TestScene break_shot(std::size_t rows, double radius, double speed, double aim) {
    const double width = 2 * radius * static_cast<double>(rows);
    const double box_size = 4 * width;
    TestScene scene = empty_scene("break of " + std::to_string(rows) + " rows, radius " +
                                      number(radius) + ", speed " + number(speed) + ", aim " +
                                      number(aim),
                                  box_size, radius, 40);
    add_disc(scene, width, box_size / 2 + aim * radius, speed * radius, 0);
    for (std::size_t row = 0; row < rows; ++row) {
        const double x = 2 * width + static_cast<double>(row) * radius * std::sqrt(3.0);
        for (std::size_t place = 0; place <= row; ++place) {
            const double offset = 2 * static_cast<double>(place) - static_cast<double>(row);
            add_disc(scene, x, box_size / 2 + offset * radius);
        }
    }
    return scene;
}

TestScene legacy_like(std::size_t n, double box_size, double radius, std::uint64_t seed) {
    Random random(seed);
    TestScene scene = empty_scene("legacy's speeds, " + std::to_string(n) + " discs, L " +
                                      number(box_size) + ", r " + number(radius),
                                  box_size, radius, 50);
    add_gas(scene, n, random);
    for (InputDisc& disc : scene.discs) {
        const auto [ex, ey] = random.direction();
        const double speed = random.uniform(box_size / (8 * radius), box_size / 4);
        disc.vx = speed * ex;
        disc.vy = speed * ey;
    }
    return scene;
}

void set_oscillation(reference::Setting& setting) {
    setting.oscillation = {};
    setting.oscillating_delay = {};
    if (!(largest_wall_speed(setting.effects) > 0)) return;
    SceneParameters scene;
    scene.effects = setting.effects;
    scene.micro_steps = setting.micro_steps;
    const Effects effects = per_micro_step(scene);
    std::array<double, 4> rest_times{};
    for (std::size_t side = 0; side < 4; ++side) {
        const Boundary& wall = effects.boundaries[side];
        const double rate = 2 * std::numbers::pi / wall.period;
        const double pull = std::fabs(side < 2 ? effects.gravity.x : effects.gravity.y) +
                            wall.amplitude * (rate * rate);
        rest_times[side] = std::min(setting.contact_time() > 0
                                        ? setting.contact_time()
                                        : 2 * setting.least_departure(pull, setting.radius) / pull,
                                    wall.period / 8);
    }
    std::array<Oscillation, 4> walls;
    for (std::size_t side = 0; side < walls.size(); ++side)
        walls[side] = Oscillation(effects.boundaries[side], side % 2 == 0 ? 1 : -1,
                                  side < 2 ? effects.gravity.x : effects.gravity.y,
                                  8 * 0x1p-52 * setting.longest());
    const auto wall_after = [=](std::size_t side, std::int64_t sync) {
        Oscillation wall = walls[side];
        wall.begin_interval(static_cast<double>(sync));
        return wall;
    };
    setting.oscillation = [=](std::size_t side, std::int64_t sync, double time) {
        const Oscillation wall = wall_after(side, sync);
        const WallMotion now = wall.at(time);
        return std::array{now.place, now.velocity, wall.pressure_at(time, time + rest_times[side])};
    };
    setting.oscillating_delay = [=](std::size_t side, std::int64_t sync, double distance,
                                    double rate, double from_wall, double time) {
        return wall_after(side, sync).contact_delay(distance, rate, from_wall, time);
    };
}

void set_thermal_seed(reference::Setting& setting, std::uint64_t seed) {
    setting.effects.thermal_seed = seed;
    setting.thermal_draw = [seed](const Boundary& side, DiscId id, std::uint64_t count,
                                  std::size_t number) {
        DiscRandom random(seed, Purpose::thermal_wall, id, 4 * count + number);
        const double away = std::sqrt(2 * side.temperature * random_exponential(random));
        const double speed = std::sqrt(2 * side.temperature * random_exponential(random));
        return std::array{away, speed * random_direction(random).x};
    };
}

} // namespace carrom::test
