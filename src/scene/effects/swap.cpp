// SPDX-License-Identifier: BSD-3-Clause
// Swap moves: at a sync, pairs of discs exchange their radii where no overlap follows. Discs keep
// their ids, places, velocities and masses, so that energy and momentum stay as they
// are (A. Ninarello, L. Berthier and D. Coslovich, Phys. Rev. X 7, 021039 (2017); L. Berthier and
// others, Nature Commun. 10, 1508 (2019)).
//
// All radii in ascending order have places, and each disc holds one. In a round
//   1. pairs of places are proposed, by random numbers that depend on seed, sync and round alone.
//      Each place is in one pair at most. Its disc may have the larger radius of the two
//      afterwards: call that its room. A disc without a proposal has its radius as its room.
//   2. A pair is accepted if both discs fit: each is as far from every neighbour, except from each
//      other, as the room of both together.
//   3. The discs of accepted pairs exchange their places, all at once.
// No overlap can follow, because no radius exceeds its disc's room. Detailed balance: the rooms are
// the same before and after, whichever pairs are accepted, because a pair of places has the same
// discs. So the same proposals accept the same pairs again, and lead back. Each set of proposals is
// its own inverse, and its probability does not depend on the state: every two states go over into
// each other equally often, as in the ensemble of hard discs, where all states weigh the same.
//
// Whether a disc fits depends on its neighbours alone. So ranks decide for their own discs and
// gather those that fit, and the result depends neither on ranks nor on threads.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <mutex>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

/// A place in the order of radii.
using Place = std::uint32_t;

/// The proposals of a round.
struct Proposals {
    std::uint64_t seed, sync, round;
    Place n_places = 0, distance = 1, shift = 0;

    /// One disc in four gets a proposal. More would have too many neighbours with one.
    static constexpr double share = 0.25;

    Proposals(std::uint64_t seed_of_all, std::uint64_t n_syncs, std::uint64_t number, Place n)
        : seed(seed_of_all), sync(n_syncs), round(number), n_places(n) {
        const auto words = random_words(seed, Purpose::swap, round, sync);
        distance = Place{1} << words[0] % static_cast<unsigned>(std::bit_width(n - 1U));
        shift = static_cast<Place>(words[1] % (2 * std::uint64_t{distance}));
    }

    /// The place that is paired with this one, if any.
    std::optional<Place> partner_of(Place place) const {
        const bool is_low = ((std::uint64_t{place} + shift) / distance) % 2 == 0;
        if (is_low ? place >= n_places - std::min(distance, n_places) : place < distance)
            return std::nullopt;
        const Place low = is_low ? place : place - distance;
        const auto words = random_words(seed, Purpose::swap, low, sync, 1 + round);
        if (unit_number(words[0]) >= share) return std::nullopt;
        return is_low ? place + distance : low;
    }
};

/// Others within reach of each own disc.
class Neighbours {
public:
    struct One {
        DiscId id = 0;
        double distance = 0;
    };

    explicit Neighbours(const SyncDiscs& at) : first_(at.discs.size() + 1) {
        struct Link {
            std::size_t index;
            One other;
        };
        std::vector<Link> links;
        at.visit_near_pairs([&](std::size_t index, DiscId other, double distance) {
            links.push_back({index, {other, distance}});
            ++first_[index + 1];
        });
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        all_.resize(links.size());
        std::vector<std::size_t> next = first_;
        for (const Link& link : links) all_[next[link.index]++] = link.other;
    }

    std::span<const One> of(std::size_t index) const {
        return std::span(all_).subspan(first_[index], first_[index + 1] - first_[index]);
    }

private:
    std::vector<std::size_t> first_;
    std::vector<One> all_;
};

class SwapMoves final : public SyncEffect {
public:
    explicit SwapMoves(const SceneParameters& scene)
        : swaps_(scene.effects.swap), n_discs_(scene.n_discs),
          steps_between_(steps_between_syncs(scene)) {}

    void learn(const SpeciesTable& species) override {
        table_ = species;
        holders_.resize(n_discs_);
        std::iota(holders_.begin(), holders_.end(), DiscId{0});
        std::ranges::stable_sort(holders_, {}, [&](DiscId id) { return species.of(id).radius; });
        places_.resize(n_discs_);
        for (Place place = 0; place < n_discs_; ++place) {
            radii_.push_back(species.of(holders_[place]).radius);
            places_[holders_[place]] = place;
        }
    }

    double reach(std::int64_t n_syncs) const override {
        return acts_at(n_syncs) ? 2 * radii_.back() * (1 + 0x1p-30) : 0;
    }

    void act(const SyncDiscs& at) override {
        if (!acts_at(at.n_syncs)) return;
        const Neighbours neighbours(at);
        for (std::int64_t round = 0; round < swaps_.rounds; ++round)
            play({swaps_.seed, static_cast<std::uint64_t>(at.n_syncs),
                  static_cast<std::uint64_t>(round), static_cast<Place>(n_discs_)},
                 at, neighbours);
        for (std::size_t i = 0; i < at.discs.size(); ++i)
            at.radii[i] = radii_[places_[at.discs[i].id]];
    }

    std::vector<std::int64_t> kept() const override {
        std::vector<std::int64_t> all{n_accepted_};
        all.insert(all.end(), places_.begin(), places_.end());
        return all;
    }
    void go_on(std::span<const std::int64_t> kept) override {
        if (kept.size() != n_discs_ + 1) return;
        n_accepted_ = kept[0];
        for (DiscId id = 0; id < n_discs_; ++id) give(id, static_cast<Place>(kept[id + 1]));
    }

private:
    bool acts_at(std::int64_t n_syncs) const {
        return swaps_.until_step == 0 || static_cast<double>(n_syncs) * steps_between_ <=
                                             static_cast<double>(swaps_.until_step);
    }

    void give(DiscId id, Place place) {
        places_[id] = place;
        holders_[place] = id;
        table_->set_radius(id, radii_[place]);
    }

    double room_of(DiscId id, const Proposals& proposals) const {
        const Place place = places_[id];
        return radii_[std::max(place, proposals.partner_of(place).value_or(place))];
    }

    bool fits(DiscId partner, double room, std::span<const Neighbours::One> others,
              const Proposals& proposals) const {
        return std::ranges::all_of(others, [&](const Neighbours::One& other) {
            return other.id == partner ||
                   other.distance >= (room + room_of(other.id, proposals)) * (1 + 0x1p-40);
        });
    }

    /// The lower places of own discs that fit, for each of the pair's discs once.
    std::vector<Place> fitting(const Proposals& proposals, const SyncDiscs& at,
                               const Neighbours& neighbours) const {
        std::vector<Place> all;
        std::mutex lock;
        at.in_parts([&](std::size_t begin, std::size_t end) {
            std::vector<Place> mine;
            for (std::size_t i = begin; i < end; ++i) {
                const Place place = places_[at.discs[i].id];
                const std::optional<Place> partner = proposals.partner_of(place);
                if (!partner || radii_[place] == radii_[*partner]) continue;
                const double room = radii_[std::max(place, *partner)];
                if (fits(holders_[*partner], room, neighbours.of(i), proposals))
                    mine.push_back(std::min(place, *partner));
            }
            const std::lock_guard guard(lock);
            all.insert(all.end(), mine.begin(), mine.end());
        });
        return all;
    }

    void play(const Proposals& proposals, const SyncDiscs& at, const Neighbours& neighbours) {
        const std::vector<Place> mine = fitting(proposals, at, neighbours);
        const std::vector<std::byte> bytes = at.gather_over_ranks(std::as_bytes(std::span(mine)));
        std::vector<Place> all(bytes.size() / sizeof(Place));
        if (!all.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
        std::ranges::sort(all);
        for (std::size_t k = 1; k < all.size(); ++k) {
            if (all[k] != all[k - 1]) continue; // only one of the two fits
            const Place low = all[k], high = low + proposals.distance;
            const DiscId smaller = holders_[low], larger = holders_[high];
            give(smaller, high);
            give(larger, low);
            ++n_accepted_;
        }
    }

    Swaps swaps_;
    std::uint64_t n_discs_;
    double steps_between_;
    std::optional<SpeciesTable> table_; ///< the run's own: copies share their memory
    std::vector<double> radii_;         ///< by place
    std::vector<DiscId> holders_;       ///< by place
    std::vector<Place> places_;         ///< by disc
    std::int64_t n_accepted_ = 0;
};

const Need swapping{"without effects.swap.rounds",
                    [](const SceneParameters& s) { return s.effects.swap.is_any(); }};

std::vector<Key> keys_of_swap() {
    return {
        key("effects.swap.rounds", "1",
            "How often pairs of discs are proposed to exchange their radii at each sync; a round "
            "proposes it to a quarter of all discs.",
            [](auto& s) -> auto& { return s.effects.swap.rounds; })
            .within({0, 10000}),
        key("effects.swap.until_step", "steps",
            "The last step at which radii are exchanged; 0: they are at all.",
            [](auto& s) -> auto& { return s.effects.swap.until_step; })
            .within({0, static_cast<double>(largest_steps)})
            .needs(swapping),
        key("effects.swap.seed", "1", "Seed of the proposals.",
            [](auto& s) -> auto& { return s.effects.swap.seed; })
            .within({.low = 0})
            .needs(swapping)
            .seed(),
    };
}

bool swaps(const SceneParameters& s) { return s.effects.swap.is_any(); }

bool have_one_radius(const Effects& effects) {
    return std::ranges::all_of(effects.species, [&](const Species& one) {
        return one.radius == effects.species.front().radius;
    });
}

std::vector<Rule> rules_of_swap() {
    const RuleKeys keys = {"effects.swap.rounds"};
    return {
        rule("swaps", "discs of one radius", "they have nothing to exchange", keys,
             [](const SceneParameters& s) { return swaps(s) && have_one_radius(s.effects); }),
        rule("swaps", "time.method = \"time-stepped\"",
             "discs that overlap there have no free room", keys,
             [](const SceneParameters& s) { return swaps(s) && is_time_stepped(s); }),
        rule("swaps", "sides that are not periodic all round",
             "rooms are those between discs alone", keys,
             [](const SceneParameters& s) { return swaps(s) && !is_periodic_all_round(s); }),
        rule("swaps", "sheared sides", "neighbours there move", keys,
             [](const SceneParameters& s) { return swaps(s) && s.effects.are_sheared(); }),
        rule("swaps", "obstacles", "rooms are those between discs alone", keys,
             [](const SceneParameters& s) { return swaps(s) && has_obstacles(s); }),
        rule("swaps", "rough discs", "their energy of rotation depends on the radius", keys,
             [](const SceneParameters& s) { return swaps(s) && is_rough(s); }),
        rule("swaps", "growing discs", "there is no equilibrium to reach", keys,
             [](const SceneParameters& s) { return swaps(s) && has_growth(s); }),
        rule("swaps", "contacts that last", "they belong to discs of their radii", keys,
             [](const SceneParameters& s) { return swaps(s) && s.effects.lasting_speed > 0; }),
    };
}

} // namespace

namespace effects {

EffectDeclaration swap() {
    return {.tables = {{"effects.swap", "Discs of several sizes that exchange their radii."}},
            .keys = keys_of_swap(),
            .rules = rules_of_swap(),
            .summary =
                [](const Effects& e) {
                    return e.swap.is_any()
                               ? fmt::format("{} rounds of swaps at each sync", e.swap.rounds)
                               : "";
                },
            .at_syncs = [](const SceneParameters& s) -> std::unique_ptr<SyncEffect> {
                if (!s.effects.swap.is_any()) return nullptr;
                return std::make_unique<SwapMoves>(s);
            },
            .at_end =
                [](std::span<const std::int64_t> kept) {
                    return EndNumber{"swaps", "swaps", "pairs of discs have exchanged their radii",
                                     kept.empty() ? 0 : static_cast<std::uint64_t>(kept[0])};
                }};
}

} // namespace effects

} // namespace carrom
