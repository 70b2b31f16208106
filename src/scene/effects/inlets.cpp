// SPDX-License-Identifier: BSD-3-Clause
// Inlets: discs that come in through open sides, as from a gas outside.
//
// The gas outside is ideal, with temperature kT and density n. Discs come in where other
// discs depart: with their centre one radius outside the side. In a time t and on a length l the
// mean number of arrivals is n sqrt(kT / (2 pi m)) t l. Arrivals are independent, so their number
// has a Poisson distribution. The inward velocity has the density v exp(-m v^2 / 2 kT), and
// the velocity along the side has a Maxwell distribution, as for discs that leave a thermal wall.
// At the next sync an arrival is left out if another disc or an obstacle blocks its entry.
// Otherwise the disc is put where it would have flown by then, or where it entered if its path is
// blocked. Arrival is the reverse of departure, so a gas in equilibrium has the activity n.
//
// Only discs that have departed before can come in. Random numbers depend on the seed, the side and
// the count of syncs.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/boundaries/boundary.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

constexpr double most_arrivals = 1e5; ///< at one side between two syncs

bool has_inlets(const Effects& effects) {
    return std::ranges::any_of(effects.boundaries,
                               [](const Boundary& side) { return side.inlet.is_on(); });
}

class Inlets final : public SyncEffect, public DiscSource {
public:
    explicit Inlets(const SceneParameters& scene)
        : sides_(per_micro_step(scene).boundaries), rows_(scene.effects.contact.rows),
          n_discs_(scene.n_discs), seed_(scene.effects.inlet_seed),
          interval_(static_cast<double>(scene.sync_every)) {}

    void act(const SyncDiscs& /*at*/) override {}
    DiscSource* source() override { return this; }

    std::vector<Arrival> arrivals(std::int64_t n_syncs) const override {
        std::vector<Arrival> all;
        for (std::size_t side = 0; side < sides_.size(); ++side)
            if (sides_[side].inlet.is_on()) add_arrivals(side, n_syncs, all);
        return all;
    }
    void count(const ArrivalCounts& these) override {
        counts_.in += these.in;
        counts_.without_place += these.without_place;
        counts_.without_disc += these.without_disc;
    }

    std::vector<std::int64_t> kept() const override {
        return {static_cast<std::int64_t>(counts_.in),
                static_cast<std::int64_t>(counts_.without_place),
                static_cast<std::int64_t>(counts_.without_disc)};
    }
    void go_on(std::span<const std::int64_t> kept) override {
        if (kept.size() != 3) return;
        counts_ = {static_cast<std::uint64_t>(kept[0]), static_cast<std::uint64_t>(kept[1]),
                   static_cast<std::uint64_t>(kept[2])};
    }

private:
    void add_arrivals(std::size_t side, std::int64_t n_syncs, std::vector<Arrival>& all) const {
        const Inlet& inlet = sides_[side].inlet;
        const std::size_t low = side < 2 ? 2 : 0; // this side ends at the sides low and low + 1
        DiscRandom random(seed_, Purpose::inlet, side, static_cast<std::uint64_t>(n_syncs));
        const auto is_wall = [&](std::size_t other) {
            return sides_[other].kind != BoundaryKind::open;
        };
        for (double time = random_exponential(random) / inlet.rate; time < interval_;
             time += random_exponential(random) / inlet.rate) {
            Arrival one;
            one.side = side;
            set_ids(one, inlet);
            one.flown = interval_ - time;
            one.across = random.uniform();
            one.has_low_wall = is_wall(low);
            one.has_high_wall = is_wall(low + 1);
            one.inwards = std::sqrt(2 * inlet.temperature * random_exponential(random));
            const double speed = std::sqrt(2 * inlet.temperature * random_exponential(random));
            one.along = speed * random_direction(random).x;
            all.push_back(one);
        }
    }
    /// Sets the range of ids that the disc may have: all, or those of one row of `discs.species`.
    void set_ids(Arrival& one, const Inlet& inlet) const {
        one.end = n_discs_;
        if (inlet.species == 0) return;
        DiscId begin = 0;
        one.end = 0;
        for (const SpeciesRow& row : rows_) {
            if (row.row + 1 == static_cast<std::size_t>(inlet.species))
                one.first = begin, one.end = row.end;
            begin = row.end;
        }
    }

    std::array<Boundary, 4> sides_;
    std::vector<SpeciesRow> rows_;
    DiscId n_discs_;
    std::uint64_t seed_;
    double interval_;
    ArrivalCounts counts_;
};

Need inlet_of(std::size_t side) {
    return {fmt::format("without {}", side_key(side, "inlet.rate")),
            [side](const SceneParameters& s) { return s.effects.boundaries[side].inlet.is_on(); }};
}

std::vector<Key> keys_of_inlets() {
    std::vector<Key> all;
    for (std::size_t side = 0; side < boundary_names.size(); ++side) {
        all.push_back(
            key(side_key(side, "inlet.rate"), "1/step",
                "Discs that come in through the open side in a step, on average. They are discs "
                "that have departed, those of the lowest ids first.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].inlet.rate; })
                .by_default("none")
                .within({.low = 0, .excludes_low = true})
                .needs(side_needs(side, BoundaryKind::open)));
        all.push_back(
            key(side_key(side, "inlet.temperature"), "length^2/step^2",
                "kT of the gas that they come from, for discs of mass 1.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].inlet.temperature; })
                .within({1e-60, 1e60})
                .needs(inlet_of(side))
                .required());
        all.push_back(
            key(side_key(side, "inlet.species"), "1",
                "The row of 'discs.species' that they are of, counted from 1.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].inlet.species; })
                .by_default("any")
                .within({.low = 1})
                .needs(inlet_of(side)));
    }
    all.push_back(key("effects.inlets.seed", "1", "Seed of the random numbers of inlets.",
                      [](auto& s) -> auto& { return s.effects.inlet_seed; })
                      .within({.low = 0})
                      .needs({"without a side that has an inlet",
                              [](const SceneParameters& s) { return has_inlets(s.effects); }})
                      .seed());
    return all;
}

std::vector<Table> tables_of_inlets() {
    std::vector<Table> all;
    for (std::size_t side = 0; side < boundary_names.size(); ++side)
        all.push_back({.name = side_key(side, "inlet"),
                       .help = "Discs that come in through an open side, as from a gas outside.",
                       .is_like_another = side > 0});
    all.push_back({"effects.inlets", "All inlets of the scene."});
    return all;
}

/// Makes the default time between syncs at most a step, because discs come in at syncs, and outputs
/// should contain the discs that have arrived before them.
void sync_in_each_step_of_inlets(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (has_inlets(scene.effects) && !draft.settings.has("time.sync_every"))
        scene.sync_every = std::min(scene.sync_every, scene.micro_steps);
}

void check_inlet(const SceneDraft& draft, std::size_t side) {
    const SceneParameters& scene = draft.scene;
    const Inlet& inlet = scene.effects.boundaries[side].inlet;
    const std::string rate = side_key(side, "inlet.rate"),
                      temperature = side_key(side, "inlet.temperature"),
                      species = side_key(side, "inlet.species");
    if (inlet.rate * steps_between_syncs(scene) > most_arrivals)
        draft.refuse({rate}, fmt::format("'{}' = {:g} lets more than {:g} discs in between two "
                                         "syncs; take a smaller rate, or time.sync_every",
                                         rate, inlet.rate, most_arrivals));
    if (const std::string text = speed_problem(std::sqrt(inlet.temperature), scene); !text.empty())
        draft.refuse({temperature}, fmt::format("'{}': {}", temperature, text));
    const std::vector<SpeciesRow>& rows = scene.effects.contact.rows;
    if (inlet.species == 0) return;
    const auto is_it = [&](const SpeciesRow& row) {
        return row.row + 1 == static_cast<std::size_t>(inlet.species);
    };
    if (!std::ranges::any_of(rows, is_it))
        draft.refuse({species}, fmt::format("'{}' = {} is no row of 'discs.species', which has {}",
                                            species, inlet.species, rows.size()));
}

void check_inlets(const SceneDraft& draft) {
    for (std::size_t side = 0; side < boundary_names.size(); ++side)
        if (draft.scene.effects.boundaries[side].inlet.is_on()) check_inlet(draft, side);
}

std::vector<Rule> rules_of_inlets() {
    return {
        rule("inlets", "time.stop.departed", "departed discs come back; take another condition",
             {"time.stop.departed"},
             [](const SceneParameters& s) { return has_inlets(s.effects) && s.stop.departed; }),
    };
}

std::string summary_of_inlets(const Effects& effects) {
    std::string all;
    for (std::size_t side = 0; side < boundary_names.size(); ++side)
        if (const Inlet& inlet = effects.boundaries[side].inlet; inlet.is_on())
            all += fmt::format("{}{} inlet of {:g} discs a step, temperature {:g}",
                               all.empty() ? "" : "; ", boundary_names[side], inlet.rate,
                               inlet.temperature);
    return all;
}

double usual_speed_of_inlets(const SceneParameters& scene) {
    double largest = 0;
    for (const Boundary& side : scene.effects.boundaries)
        if (side.inlet.is_on()) largest = std::max(largest, side.inlet.temperature);
    return std::sqrt(largest);
}

std::vector<EndNumber> numbers_of_inlets(std::span<const std::int64_t> kept) {
    const auto number = [&](std::size_t k) {
        return k < kept.size() ? static_cast<std::uint64_t>(kept[k]) : 0;
    };
    return {
        {"inlet_discs", "inlets", "discs have come in", number(0)},
        {"inlet_without_place", "no place", "were left out because a disc or an obstacle was there",
         number(1)},
        {"inlet_without_disc", "no disc", "were left out because no disc had departed", number(2)}};
}

} // namespace

namespace effects {

EffectDeclaration inlets() {
    return {.tables = tables_of_inlets(),
            .keys = keys_of_inlets(),
            .rules = rules_of_inlets(),
            .derive = sync_in_each_step_of_inlets,
            .check_room = check_inlets,
            .summary = summary_of_inlets,
            .usual_speed = usual_speed_of_inlets,
            .at_syncs = [](const SceneParameters& s) -> std::unique_ptr<SyncEffect> {
                if (!has_inlets(s.effects)) return nullptr;
                return std::make_unique<Inlets>(s);
            },
            .at_end = numbers_of_inlets};
}

} // namespace effects

} // namespace carrom
