// SPDX-License-Identifier: BSD-3-Clause
#include "measure/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "engine/state_sums.hpp"
#include "measure/order_tables.hpp"
#include "statistics/hexatic_order.hpp"

namespace carrom {

namespace {

std::uint64_t quantities_of(const MeasurementOutput& output) {
    return (output.wall_pressure ? 1u : 0u) | (output.radial_distribution ? 2u : 0u) |
           (output.velocities ? 4u : 0u) | (output.density ? 8u : 0u) |
           (output.displacement ? 16u : 0u) | (output.pressure ? 32u : 0u) |
           (output.thermo ? thermo_bit : 0u) | (output.psi6 ? psi6_bit : 0u) |
           (output.structure_factor ? structure_factor_bit : 0u) |
           (output.diffusion ? diffusion_bit : 0u);
}

/// A component's root mean square, as the discs and the thermal walls have it; 0 where all is at
/// rest.
double thermal_speed(const Scene& scene, const Totals& totals) {
    double temperature = totals.kinetic_energy / static_cast<double>(totals.n_discs);
    for (const Boundary& side : scene.effects.boundaries)
        temperature = std::max(temperature, side.temperature);
    double lightest = 1;
    for (const Species& each : scene.effects.species) lightest = std::min(lightest, each.mass);
    return std::sqrt(temperature / lightest);
}

/// How fast discs may become by falling or by being pushed.
double driven_speed(const Scene& scene) {
    double speed = std::sqrt(
        2 * (std::fabs(scene.effects.gravity.x) + std::fabs(scene.effects.gravity.y)) *
        scene.box.longest());
    for (const Boundary& side : scene.effects.boundaries)
        speed = std::max(speed, std::fabs(side.speed));
    speed = std::max(speed, 2 * largest_wall_speed(scene.effects));
    return speed;
}

void count(std::vector<std::uint64_t>& counts, double place) {
    if (place >= 0 && place < static_cast<double>(counts.size()))
        ++counts[static_cast<std::size_t>(place)];
}

/// Adds what all ranks have counted.
void add_over(const Communicator& ranks, std::vector<std::uint64_t>&& mine,
              std::vector<std::uint64_t>& sums) {
    ranks.sum(std::span(mine));
    for (std::size_t k = 0; k < mine.size(); ++k) sums[k] += mine[k];
}

} // namespace

std::vector<Species> species_apart(const Scene& scene) {
    constexpr std::size_t most = 8;
    const std::vector<Species>& species = scene.effects.species;
    if (species.empty() || species.size() > most) return {{scene.n_discs, scene.radius, 1}};
    return species;
}

Sampler::Sampler(const Scene& scene, Simulation& simulation, const Communicator& ranks)
    : scene_(scene), output_(*scene.measurements), simulation_(simulation), ranks_(ranks) {}

Sampler::~Sampler() { simulation_.add_impulses_to(nullptr); }

/// Sums of nothing with the scene's keys. A largest velocity that is not given is what sampling
/// begins with.
SampleSums Sampler::wanted() const {
    SampleSums sums;
    sums.quantities = quantities_of(output_);
    sums.every_steps = output_.every_steps;
    sums.wanted_from = output_.from_step;
    sums.largest_distance = output_.largest_distance;
    sums.largest_velocity = output_.largest_velocity.value_or(0);
    if (output_.radial_distribution)
        sums.pairs.assign(output_.bins * n_pair_kinds(species_apart(scene_).size()), 0);
    sums.ideal_pairs.assign(sums.pairs.size(), 0);
    for (auto* counts : {&sums.vx, &sums.vy, &sums.speeds})
        if (output_.velocities) counts->assign(output_.bins, 0);
    for (auto* counts : {&sums.x, &sums.y})
        if (output_.density) counts->assign(output_.bins, 0);
    if (output_.psi6) {
        sums.neighbours.assign(HexaticSums::most_neighbours + 1, 0);
        for (auto* counts : {&sums.moduli, &sums.psi6_pairs}) counts->assign(output_.bins, 0);
        sums.psi6_products.assign(output_.bins, 0);
    }
    if (output_.diffusion) sums.correlation_steps = output_.correlation_steps;
    if (output_.structure_factor) {
        sums.largest_wavenumber = output_.largest_wavenumber;
        sums.structure_factor.assign(wave_vectors_of(scene_).size(), 0);
    }
    return sums;
}

void Sampler::begin() {
    sums_ = wanted();
    sums_.first_step = simulation_.step();
    const Totals totals = simulation_.totals();
    const double thermal = thermal_speed(scene_, totals), driven = driven_speed(scene_);
    const double usual = thermal > 0 ? thermal : driven > 0 ? driven : 1;
    if (!output_.largest_velocity) sums_.largest_velocity = 5 * usual;
    sums_.speed_scale = std::max(usual, driven);
    has_begun_ = true;
    follow_walls();
    follow_crossings();
    if (output_.pressure || output_.thermo) pressure_.emplace(simulation_, ranks_, sums_);
}

void Sampler::follow_walls() {
    if (!output_.wall_pressure) return;
    impulses_.emplace(sums_.speed_scale *
                      0x1p62); // more than a run comes to, and 2^-63 of a speed is seen
    simulation_.add_impulses_to(&*impulses_);
}

void Sampler::go_on(StoredSamples stored) {
    const std::int64_t step = simulation_.step();
    if (stored.sums.empty() || step <= output_.from_step) return;
    const std::optional<SampleSums> found = unpacked(stored.sums);
    SampleSums asked = wanted();
    if (found && output_.is_distance_default && found->largest_distance != asked.largest_distance) {
        // Another last step: walls come in less far, or further.
        if (found->largest_distance > asked.largest_distance)
            throw InputError(
                {{"[output.measurements]", 0,
                  fmt::format("the checkpoint's radial distribution reaches {:g}, and walls that "
                              "come in until the last step leave room for {:g}: "
                              "run to an earlier step, or begin anew with "
                              "output.measurements.from_step = {}",
                              found->largest_distance, asked.largest_distance, step)}});
        asked.largest_distance = found->largest_distance;
    }
    const bool is_same = found && found->quantities == asked.quantities &&
                         found->every_steps == asked.every_steps &&
                         found->wanted_from == asked.wanted_from &&
                         found->largest_distance == asked.largest_distance &&
                         (!output_.largest_velocity ||
                          found->largest_velocity == asked.largest_velocity) &&
                         found->pairs.size() == asked.pairs.size() &&
                         found->vx.size() == asked.vx.size() && found->x.size() == asked.x.size() &&
                         found->moduli.size() == asked.moduli.size() &&
                         found->largest_wavenumber == asked.largest_wavenumber &&
                         found->structure_factor.size() == asked.structure_factor.size() &&
                         stored.have_first_places == follows_flights() &&
                         stored.have_lengths == follows_lengths() &&
                         stored.have_velocities == output_.diffusion &&
                         found->correlation_steps == asked.correlation_steps;
    if (!is_same)
        throw InputError(
            {{"[output.measurements]", 0,
              fmt::format("the checkpoint's measurements are of other keys: keep those, or begin "
                          "anew with output.measurements.from_step = {}",
                          step)}});
    sums_ = *found;
    has_begun_ = true;
    follow_walls();
    follow_crossings();
    if (impulses_ && sums_.pending.size() == 12 && ranks_.is_root()) {
        for (std::size_t side = 0; side < 4; ++side) {
            impulses_->normal[side].add_words(sums_.pending[3 * side], sums_.pending[3 * side + 1]);
            impulses_->counts[side] = sums_.pending[3 * side + 2];
        }
    }
    sums_.pending.clear();
    if (output_.pressure || output_.thermo)
        pressure_ = PressureSampler::going_on(simulation_, ranks_, sums_);
    if (follows_flights()) place_first(stored.first_places);
    if (lengths_)
        lengths_->go_on(stored.first_places, &FirstPlace::lengths_x, &FirstPlace::lengths_y);
}

std::int64_t Sampler::next_due(std::int64_t step) const {
    if (!has_begun_) return std::max(step + 1, output_.from_step);
    return sums_.first_step +
           ((step - sums_.first_step) / output_.every_steps + 1) * output_.every_steps;
}

void Sampler::look() {
    const std::int64_t step = simulation_.step();
    if (!has_begun_ && step >= output_.from_step) begin();
    if (!has_begun_ || step == sums_.last_step ||
        (step - sums_.first_step) % output_.every_steps != 0)
        return;
    sample(step);
}

void Sampler::sample(std::int64_t step) {
    const std::span<const Disc> discs = simulation_.shown();
    const std::uint64_t n_discs = ranks_.sum(std::uint64_t{discs.size()});
    const Extent box = extent_at(scene_.effects, scene_.box, static_cast<double>(step));
    const bool is_first = sums_.n_samples == 0;
    std::vector<Disc> kept;
    const std::span<const Disc> inside = discs_in_box(discs, scene_.effects, box,
                                                      simulation_.clock(), kept);
    sums_.n_discs += ranks_.sum(std::uint64_t{inside.size()});
    sums_.area += (box.x_high - box.x_low) * (box.y_high - box.y_low);
    if (output_.velocities) sample_velocities(inside);
    if (output_.density) sample_density(inside, box);
    if (follows_flights()) sample_displacement(discs, n_discs, is_first);
    if (output_.wall_pressure && !is_first) sample_impulses(step);
    if (pressure_ && !is_first) pressure_->sample(sums_, static_cast<double>(output_.every_steps));
    if (output_.thermo) sample_thermo();
    if (output_.structure_factor) sample_structure_factor(discs, box);
    if (output_.radial_distribution) sample_distances(box); // moves discs in memory: last
    if (output_.psi6) sample_psi6();                        // likewise
    ++sums_.n_samples;
    sums_.last_step = step;
}

void Sampler::sample_velocities(std::span<const Disc> discs) {
    const std::size_t n = output_.bins;
    const double unit = simulation_.velocity_unit(), largest = sums_.largest_velocity;
    const double per_component = static_cast<double>(n) / (2 * largest),
                 per_speed = static_cast<double>(n) / largest;
    std::vector<std::uint64_t> vx(n, 0), vy(n, 0), speeds(n, 0);
    for (const Disc& disc : discs) {
        const double u = disc.vx * unit, v = disc.vy * unit;
        count(vx, (u + largest) * per_component);
        count(vy, (v + largest) * per_component);
        count(speeds, std::sqrt(u * u + v * v) * per_speed);
    }
    add_over(ranks_, std::move(vx), sums_.vx);
    add_over(ranks_, std::move(vy), sums_.vy);
    add_over(ranks_, std::move(speeds), sums_.speeds);
}

void Sampler::sample_density(std::span<const Disc> discs, const Extent& box) {
    const std::size_t n = output_.bins;
    const double time = simulation_.clock(), last = static_cast<double>(n - 1);
    const double per_x = static_cast<double>(n) / (box.x_high - box.x_low),
                 per_y = static_cast<double>(n) / (box.y_high - box.y_low);
    std::vector<std::uint64_t> x(n, 0), y(n, 0);
    for (const Disc& disc : discs) { // the box's own edge belongs to its last bin
        count(x, std::clamp((disc.x_at(time) - box.x_low) * per_x, 0.0, last));
        count(y, std::clamp((disc.y_at(time) - box.y_low) * per_y, 0.0, last));
    }
    add_over(ranks_, std::move(x), sums_.x);
    add_over(ranks_, std::move(y), sums_.y);
}

void Sampler::sample_distances(const Extent& box) {
    const std::size_t n = output_.bins;
    const double width = sums_.largest_distance / static_cast<double>(n);
    std::vector<std::uint64_t> pairs(sums_.pairs.size(), 0);
    const std::vector<Species> species = species_apart(scene_);
    std::vector<DiscId> species_ends;
    for (const Species& one : species)
        species_ends.push_back((species_ends.empty() ? 0 : species_ends.back()) + one.count);
    simulation_.count_pair_distances(width, species_ends, pairs);
    add_over(ranks_, std::move(pairs), sums_.pairs);
    const double a = box.x_high - box.x_low - 2 * scene_.radius,
                 b = box.y_high - box.y_low - 2 * scene_.radius;
    const bool goes_round_x = scene_.effects.is_periodic_x(),
               goes_round_y = scene_.effects.is_periodic_y();
    const auto share = [&](double distance) {
        if (goes_round_x && goes_round_y)
            return share_of_ideal_pairs_around(scene_.box.area(), distance);
        if (goes_round_x || goes_round_y)
            return share_of_ideal_pairs_around_x(goes_round_x ? scene_.box.x : scene_.box.y,
                                                 goes_round_x ? b : a, distance);
        return share_of_ideal_pairs(a, b, distance);
    };
    for (std::size_t second = 0; second < species.size(); ++second) {
        for (std::size_t first = 0; first <= second; ++first) {
            const auto n_first = static_cast<double>(species[first].count),
                       n_second = static_cast<double>(species[second].count);
            const double all = first == second ? 0.5 * n_first * (n_first - 1) : n_first * n_second;
            for (std::size_t k = 0; k < n; ++k) {
                const double inner = static_cast<double>(k) * width,
                             outer = static_cast<double>(k + 1) * width;
                sums_.ideal_pairs[pair_kind(first, second) * n + k] += all * (share(outer) -
                                                                              share(inner));
            }
        }
    }
}

void Sampler::sample_impulses(std::int64_t /*step*/) {
    std::array<std::uint64_t, 4> counts = impulses_->counts;
    ranks_.sum(std::span<std::uint64_t>(counts));
    for (std::size_t side = 0; side < 4; ++side) {
        ExactSum sum = impulses_->normal[side];
        ranks_.sum(sum);
        sums_.impulses.push_back(sum.value());
        sums_.wall_collisions[side] += counts[side];
    }
    *impulses_ = WallImpulses(sums_.speed_scale * 0x1p62);
}

void Sampler::sample_thermo() {
    const Totals totals = simulation_.energies();
    const Look& now = pressure_->last();
    sums_.thermo.insert(sums_.thermo.end(),
                        {totals.kinetic_energy + totals.rotational_energy + totals.potential_energy,
                         pressure_->temperature(), now.n_discs,
                         static_cast<double>(now.pair_collisions)});
}

StoredSamples Sampler::stored() const {
    StoredSamples stored;
    if (!has_begun_) return stored;
    SampleSums sums = sums_;
    if (impulses_) {
        std::array<std::uint64_t, 4> counts = impulses_->counts;
        ranks_.sum(std::span<std::uint64_t>(counts));
        for (std::size_t side = 0; side < 4; ++side) {
            ExactSum sum = impulses_->normal[side];
            ranks_.sum(sum);
            for (const std::uint64_t word : {sum.low_word(), sum.high_word(), counts[side]})
                sums.pending.push_back(word);
        }
    }
    if (pressure_) pressure_->store(sums);
    stored.sums = packed(sums);
    stored.have_first_places = follows_flights();
    stored.have_lengths = lengths_.has_value();
    stored.have_velocities = output_.diffusion;
    for (std::size_t i = 0; i < first_places_.size(); ++i) {
        FirstPlace& place = stored.first_places.emplace_back(
            FirstPlace{first_id_ + i, first_places_[i][0], first_places_[i][1]});
        if (stored.have_velocities)
            place.vx = first_velocities_[i][0], place.vy = first_velocities_[i][1];
    }
    if (lengths_)
        lengths_->store(stored.first_places, &FirstPlace::lengths_x, &FirstPlace::lengths_y);
    return stored;
}

std::vector<MeasuredTable> Sampler::tables() const {
    return has_begun_ && sums_.n_samples > 0 ? tables_of(sums_, scene_)
                                             : std::vector<MeasuredTable>{};
}

std::optional<MeasuredTable> Sampler::thermo_from(std::size_t first) const {
    if (!output_.thermo || sums_.n_samples <= first) return std::nullopt;
    return thermo(sums_, first);
}

} // namespace carrom
