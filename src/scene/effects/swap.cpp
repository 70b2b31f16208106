// SPDX-License-Identifier: BSD-3-Clause
// Swap moves: at a sync, pairs of discs exchange their radii if no overlap follows. Discs keep
// their ids, positions, velocities and masses, so energy and momentum do not change (A. Ninarello,
// L. Berthier and D. Coslovich, Phys. Rev. X 7, 021039 (2017); L. Berthier and others, Nature
// Commun. 10, 1508 (2019)).
//
// All radii are numbered in ascending order, and each disc has one number. In a round
//   1. pairs of numbers are proposed by random bits, which depend on seed, sync, round and number.
//      Each number is in one pair at most. A disc's bound is the largest radius that it can have
//      after the round: the larger radius of its pair, or its own radius if it is in no pair.
//   2. A pair is accepted if both discs fit: each disc's distance to every other neighbour is at
//      least the sum of the two bounds, and to walls and fixed bodies it is at least its own bound.
//   3. The discs of all accepted pairs exchange their numbers, and so their radii, at once.
// No overlap can follow, because no radius exceeds its disc's bound. Detailed balance holds: the
// bounds are the same before and after, whichever pairs are accepted, because the two discs of a
// pair only exchange their numbers. So if the same pairs are proposed again, the same ones are
// accepted, which restores the first state. Each set of proposals is its own inverse, and its
// probability does not depend on the state. So the transitions between any two states are equally
// probable in both directions, as all states of the ensemble of hard discs have the same weight.
//
// Whether a disc fits depends on its neighbours alone. So each rank tests its own discs, and ranks
// exchange lists of discs that fit. The result depends neither on ranks nor on threads. Cost: a
// halo as deep as the largest diameter at each sync, and an exchange between all ranks per round.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <mutex>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "dynamics/fixed_bodies.hpp"
#include "scene/boundaries/boundary.hpp"
#include "scene/effects/effect.hpp"
#include "scene/effects/sync_times.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

/// The number of a radius; radii are numbered in ascending order.
using SizeNumber = std::uint32_t;

/// The proposals of a round. In a round the numbers of all partners differ by the same distance, a
/// random power of two, and each power is equally probable. So pairs of similar radii, which
/// usually fit, are proposed as often as pairs of very different radii, which change a state more.
struct Proposals {
    std::uint64_t seed, sync, round;
    SizeNumber n_sizes = 0, distance = 1, shift = 0;

    /// The probability that a possible pair is proposed. With more proposals, more neighbours would
    /// count with the larger radius of their own pair, so that fewer pairs would fit.
    static constexpr double share = 0.25;

    Proposals(std::uint64_t seed_of_all, std::uint64_t n_syncs, std::uint64_t number, SizeNumber n)
        : seed(seed_of_all), sync(n_syncs), round(number), n_sizes(n) {
        const auto words = random_words(seed, Purpose::swap, round, sync);
        distance = SizeNumber{1} << words[0] % static_cast<unsigned>(std::bit_width(n - 1U));
        shift = static_cast<SizeNumber>(words[1] % (2 * std::uint64_t{distance}));
    }

    /// The number with which `number` is paired in this round, if any.
    std::optional<SizeNumber> partner_of(SizeNumber number) const {
        const bool is_low = ((std::uint64_t{number} + shift) / distance) % 2 == 0;
        if (is_low ? number >= n_sizes - std::min(distance, n_sizes) : number < distance)
            return std::nullopt;
        const SizeNumber low = is_low ? number : number - distance;
        const auto words = random_words(seed, Purpose::swap, low, sync, 1 + round);
        if (unit_number(words[0]) >= share) return std::nullopt;
        return is_low ? number + distance : low;
    }
};

/// For each disc of this rank, the other discs within the distance SwapMoves::reach.
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

/// Required distances are larger by this factor, so that discs that would touch never fit.
constexpr double with_rounding = 1 + 0x1p-40;

/// Walls and fixed bodies at rest, with a test of whether a disc has room beside them.
class BodiesAtRest {
public:
    explicit BodiesAtRest(const SceneParameters& scene)
        : box_(scene.box), has_walls_x_(!scene.effects.is_periodic_x()),
          has_walls_y_(!scene.effects.is_periodic_y()),
          fixed_bodies_(scene.box, scene.radius, scene.effects) {}

    bool leave_room(const DiscState& disc, double room) const {
        room *= with_rounding;
        if (has_walls_x_ && !(disc.x >= room && box_.x - disc.x >= room)) return false;
        if (has_walls_y_ && !(disc.y >= room && box_.y - disc.y >= room)) return false;
        return !fixed_bodies_.do_overlap(disc.x, disc.y, room);
    }

private:
    Box box_;
    bool has_walls_x_, has_walls_y_;
    FixedBodies fixed_bodies_;
};

class SwapMoves final : public SyncEffect {
public:
    explicit SwapMoves(const SceneParameters& scene)
        : swaps_(scene.effects.swap), n_discs_(scene.n_discs),
          steps_between_(steps_between_syncs(scene)), at_rest_(scene) {}

    void learn(const SpeciesTable& species) override {
        table_ = species;
        holders_.resize(n_discs_);
        std::iota(holders_.begin(), holders_.end(), DiscId{0});
        std::ranges::stable_sort(holders_, {}, [&](DiscId id) { return species.of(id).radius; });
        numbers_.resize(n_discs_);
        for (SizeNumber number = 0; number < n_discs_; ++number) {
            radii_.push_back(species.of(holders_[number]).radius);
            numbers_[holders_[number]] = number;
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
                  static_cast<std::uint64_t>(round), static_cast<SizeNumber>(n_discs_)},
                 at, neighbours);
        for (std::size_t i = 0; i < at.discs.size(); ++i)
            at.radii[i] = radii_[numbers_[at.discs[i].id]];
    }

    std::vector<std::int64_t> kept() const override {
        std::vector<std::int64_t> all{n_accepted_};
        all.insert(all.end(), numbers_.begin(), numbers_.end());
        return all;
    }
    void go_on(std::span<const std::int64_t> kept) override {
        if (!are_numbers(kept))
            throw CollectiveError("the state has no radii of discs that exchange them");
        n_accepted_ = kept[0];
        for (DiscId id = 0; id < n_discs_; ++id) give(id, static_cast<SizeNumber>(kept[id + 1]));
    }

private:
    bool acts_at(std::int64_t n_syncs) const {
        return swaps_.until_step == 0 || static_cast<double>(n_syncs) * steps_between_ <=
                                             static_cast<double>(swaps_.until_step);
    }

    /// Whether `kept` gives each disc a different number.
    bool are_numbers(std::span<const std::int64_t> kept) const {
        if (kept.size() != n_discs_ + 1) return false;
        std::vector<bool> is_held(n_discs_);
        return std::ranges::all_of(kept.subspan(1), [&](std::int64_t number) {
            const auto k = static_cast<std::uint64_t>(number);
            if (k >= n_discs_ || is_held[k]) return false;
            return bool(is_held[k] = true);
        });
    }

    void give(DiscId id, SizeNumber number) {
        numbers_[id] = number;
        holders_[number] = id;
        table_->set_radius(id, radii_[number]);
    }

    double room_of(DiscId id, const Proposals& proposals) const {
        const SizeNumber number = numbers_[id];
        return radii_[std::max(number, proposals.partner_of(number).value_or(number))];
    }

    bool fits(DiscId partner, double room, std::span<const Neighbours::One> others,
              const Proposals& proposals) const {
        return std::ranges::all_of(others, [&](const Neighbours::One& other) {
            return other.id == partner ||
                   other.distance >= (room + room_of(other.id, proposals)) * with_rounding;
        });
    }

    /// The lower number of its pair, for each disc of this rank that fits. In all ranks' lists
    /// together, a number occurs twice if both discs of the pair fit.
    std::vector<SizeNumber> fitting(const Proposals& proposals, const SyncDiscs& at,
                                    const Neighbours& neighbours) const {
        std::vector<SizeNumber> all;
        std::mutex lock;
        at.in_parts([&](std::size_t begin, std::size_t end) {
            std::vector<SizeNumber> mine;
            for (std::size_t i = begin; i < end; ++i) {
                const SizeNumber number = numbers_[at.discs[i].id];
                const std::optional<SizeNumber> partner = proposals.partner_of(number);
                if (!partner || radii_[number] == radii_[*partner]) continue;
                const double room = radii_[std::max(number, *partner)];
                if (fits(holders_[*partner], room, neighbours.of(i), proposals) &&
                    at_rest_.leave_room(at.discs[i], room))
                    mine.push_back(std::min(number, *partner));
            }
            const std::lock_guard guard(lock);
            all.insert(all.end(), mine.begin(), mine.end());
        });
        return all;
    }

    void play(const Proposals& proposals, const SyncDiscs& at, const Neighbours& neighbours) {
        const std::vector<SizeNumber> mine = fitting(proposals, at, neighbours);
        const std::vector<std::byte> bytes = at.gather_over_ranks(std::as_bytes(std::span(mine)));
        std::vector<SizeNumber> all(bytes.size() / sizeof(SizeNumber));
        if (!all.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
        std::ranges::sort(all);
        for (std::size_t k = 1; k < all.size(); ++k) {
            if (all[k] != all[k - 1]) continue; // a number occurs twice if both discs fit
            const SizeNumber low = all[k], high = low + proposals.distance;
            const DiscId smaller = holders_[low], larger = holders_[high];
            give(smaller, high);
            give(larger, low);
            ++n_accepted_;
        }
    }

    Swaps swaps_;
    std::uint64_t n_discs_;
    double steps_between_;
    BodiesAtRest at_rest_;
    std::optional<SpeciesTable> table_; ///< shares its memory with the run's table
    std::vector<double> radii_;         ///< radii in ascending order, by number
    std::vector<DiscId> holders_;       ///< id of the disc with the radius, by number of the radius
    std::vector<SizeNumber> numbers_;   ///< number of the radius, by id of the disc
    std::int64_t n_accepted_ = 0;
};

const Need swapping{"without effects.swap.rounds",
                    [](const SceneParameters& s) { return s.effects.swap.is_on(); }};

std::vector<Key> keys_of_swap() {
    return {
        key("effects.swap.rounds", "1",
            "How often at each sync pairs of discs are proposed to exchange their radii; a round "
            "proposes it to a quarter of all discs. 0: never.",
            [](auto& s) -> auto& { return s.effects.swap.rounds; })
            .within({0, 10000}),
        key("effects.swap.until_step", "steps",
            "The last step at which radii are exchanged. 0: the end of the run.",
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

bool swaps(const SceneParameters& s) { return s.effects.swap.is_on(); }

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
             "discs overlap a little there, so that none fits; take time.method = \"event-driven\"",
             keys, [](const SceneParameters& s) { return swaps(s) && is_time_stepped(s); }),
        rule("swaps", "sides that move, are open or sheared",
             "a disc must find the same room on the way back", keys,
             [](const SceneParameters& s) {
                 return swaps(s) &&
                        (!are_walls_at_rest(s.effects) || has_open(s) || s.effects.are_sheared());
             }),
        rule("swaps", "rough discs", "their energy of rotation depends on the radius", keys,
             [](const SceneParameters& s) { return swaps(s) && is_rough(s); }),
        rule("swaps", "growing discs", "there is no equilibrium to reach", keys,
             [](const SceneParameters& s) { return swaps(s) && has_growing_discs(s); }),
        rule("swaps", "contacts that last", "they belong to discs of their radii", keys,
             [](const SceneParameters& s) { return swaps(s) && s.effects.lasting_speed > 0; }),
    };
}

/// Lists the initial radii of all discs on each rank. Limits the number of discs, because numbers
/// of radii have 32 bits.
void check_and_list_radii(const SceneDraft& draft) {
    constexpr std::uint64_t most = std::uint64_t{1} << 31;
    if (!swaps(draft.scene)) return;
    DiscId end = 0;
    for (const Species& one : draft.scene.effects.species)
        draft.scene.first_numbers[SideColumn::swapped_radius].push_back(
            {end += one.count, one.radius});
    if (draft.scene.n_discs > most)
        draft.refuse({"effects.swap.rounds"},
                     fmt::format("at most {} discs exchange their radii, because each rank knows "
                                 "the radii of all",
                                 most));
}

} // namespace

namespace effects {

EffectDeclaration swap() {
    return {.tables = {{"effects.swap", "Discs of several sizes that exchange their radii."}},
            .keys = keys_of_swap(),
            .rules = rules_of_swap(),
            .derive =
                [](const SceneDraft& draft) {
                    if (swaps(draft.scene)) sync_in_each_step(draft);
                },
            .check_times =
                [](const SceneDraft& draft) {
                    if (swaps(draft.scene))
                        warn_of_no_sync(draft, "discs never exchange their radii: they would");
                },
            .check_room = check_and_list_radii,
            .summary =
                [](const Effects& e) {
                    if (!e.swap.is_on()) return std::string();
                    return fmt::format("{} rounds of swaps at each sync{}", e.swap.rounds,
                                       e.swap.until_step == 0
                                           ? ""
                                           : fmt::format(" up to step {}", e.swap.until_step));
                },
            .at_syncs = [](const SceneParameters& s) -> std::unique_ptr<SyncEffect> {
                if (!s.effects.swap.is_on()) return nullptr;
                return std::make_unique<SwapMoves>(s);
            },
            .at_end =
                [](std::span<const std::int64_t> kept) {
                    return std::vector<EndNumber>{
                        {"swaps", "swaps", "pairs of discs have exchanged their radii",
                         kept.empty() ? 0 : static_cast<std::uint64_t>(kept[0])}};
                }};
}

} // namespace effects

} // namespace carrom
