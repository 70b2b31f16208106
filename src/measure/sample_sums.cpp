// SPDX-License-Identifier: BSD-3-Clause
#include "measure/sample_sums.hpp"

#include <bit>
#include <type_traits>

namespace carrom {

namespace {

constexpr std::int64_t format = 2;

/// Everything that is kept, in one order for writing and reading.
template <class Sums, class Visit> void visit_all(Sums& s, const Visit& visit) {
    visit(s.quantities), visit(s.every_steps), visit(s.wanted_from), visit(s.largest_distance),
        visit(s.largest_velocity);
    visit(s.first_step), visit(s.last_step), visit(s.speed_scale), visit(s.n_samples),
        visit(s.n_discs), visit(s.area);
    for (auto* counts : {&s.pairs, &s.vx, &s.vy, &s.speeds, &s.x, &s.y, &s.pending}) visit(*counts);
    for (auto& count : s.wall_collisions) visit(count);
    for (auto* numbers :
         {&s.ideal_pairs, &s.impulses, &s.displacements, &s.pressures, &s.last_motion})
        visit(*numbers);
    visit(s.virial_bound), visit(s.pending_virial);
    if (s.quantities & thermo_bit) visit(s.thermo);
    if (s.quantities & psi6_bit)
        visit(s.psi6), visit(s.neighbours), visit(s.moduli), visit(s.psi6_pairs),
            visit(s.psi6_products);
    if (s.quantities & structure_factor_bit) visit(s.largest_wavenumber), visit(s.structure_factor);
    if (s.quantities & diffusion_bit) visit(s.correlation_steps), visit(s.flights);
}

} // namespace

std::vector<std::int64_t> packed(const SampleSums& sums) {
    std::vector<std::int64_t> words = {format};
    visit_all(sums, [&words](const auto& value) {
        if constexpr (requires { value.size(); }) {
            words.push_back(static_cast<std::int64_t>(value.size()));
            for (const auto& item : value) words.push_back(std::bit_cast<std::int64_t>(item));
        } else {
            words.push_back(std::bit_cast<std::int64_t>(value));
        }
    });
    return words;
}

std::optional<SampleSums> unpacked(std::span<const std::int64_t> words) {
    SampleSums sums;
    std::size_t next = 0;
    bool is_right = true;
    const auto take = [&]() -> std::int64_t {
        is_right = is_right && next < words.size();
        return is_right ? words[next++] : 0;
    };
    if (take() != format) return std::nullopt;
    visit_all(sums, [&](auto& value) {
        if constexpr (requires { value.size(); }) {
            const std::int64_t size = take();
            is_right = is_right && size >= 0 &&
                       static_cast<std::size_t>(size) <= words.size() - next;
            value.resize(is_right ? static_cast<std::size_t>(size) : 0);
            for (auto& item : value)
                item = std::bit_cast<std::remove_reference_t<decltype(item)>>(take());
        } else {
            value = std::bit_cast<std::remove_reference_t<decltype(value)>>(take());
        }
    });
    if (!is_right || next != words.size()) return std::nullopt;
    return sums;
}

} // namespace carrom
