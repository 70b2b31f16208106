// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/freeze_discs.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "dynamics/species.hpp"
#include "parallel/exchange.hpp"
#include "scene/frozen_discs.hpp"

namespace carrom {

namespace {

bool is_in_frozen_group(const SceneParameters& scene, DiscId id) {
    DiscId end = 0;
    for (const DiscGroup& group : scene.groups)
        if (id < (end += group.count)) return group.is_frozen;
    return false;
}

bool is_frozen(const SceneParameters& scene, const InputDisc& disc) {
    const auto holds = [&disc](const StartRegion& r) {
        return r.x_low <= disc.x && disc.x <= r.x_high && r.y_low <= disc.y && disc.y <= r.y_high;
    };
    return std::ranges::any_of(scene.freeze, holds) || is_in_frozen_group(scene, disc.id);
}

/// Returns the items of all ranks on every rank. **Collective.**
template <class Item>
std::vector<Item> of_all_ranks(const std::vector<Item>& mine, const Communicator& ranks) {
    return send_to_owners(
               ranks, std::vector<std::vector<Item>>(static_cast<std::size_t>(ranks.size()), mine))
        .items;
}

} // namespace

void freeze_discs(SceneParameters& scene, std::vector<InputDisc>& discs,
                  const Communicator& ranks) {
    const SpeciesTable species(scene.effects.species, scene.radius);
    std::vector<FrozenDisc> frozen;
    for (const InputDisc& disc : discs)
        if (is_frozen(scene, disc))
            frozen.push_back(
                {static_cast<double>(disc.id), disc.x, disc.y, species.of(disc.id).radius});
    frozen = of_all_ranks(frozen, ranks);
    std::ranges::sort(frozen, {}, &FrozenDisc::id);
    const std::string text = problem_of_frozen(scene, frozen);
    if (!text.empty()) throw InputError({{scene.name, 0, text}});
    std::erase_if(discs, [&scene](const InputDisc& disc) { return is_frozen(scene, disc); });
    for (InputDisc& disc : discs)
        disc.id -= static_cast<DiscId>(
            std::ranges::lower_bound(frozen, static_cast<double>(disc.id), {}, &FrozenDisc::id) -
            frozen.begin());
    set_frozen(scene, std::move(frozen));
}

} // namespace carrom
