// SPDX-License-Identifier: BSD-3-Clause
// Resolution across strips, compared with the rule itself: walk through all candidates in order,
// and keep one if both discs are free.
#include "time_stepped/boundary_resolution.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "catch.hpp"

#include "time_stepped/local_resolution.hpp"

using namespace carrom;

namespace {

constexpr DiscId no_disc = ~DiscId{0};

/// A candidate with global numbers: ids; a wall has no second disc.
struct Meeting {
    double time;
    DiscId p, q;

    auto key() const { return std::tuple(time, p, q == no_disc ? 0 : q + 1); }
    friend bool operator<(const Meeting& a, const Meeting& b) { return a.key() < b.key(); }
};

using Meetings = std::set<Meeting>;

Meetings walked(const Meetings& all) {
    Meetings kept;
    std::set<DiscId> taken;
    for (const Meeting& meeting : all) {
        if (taken.contains(meeting.p) || (meeting.q != no_disc && taken.contains(meeting.q)))
            continue;
        taken.insert({meeting.p, meeting.q});
        taken.erase(no_disc);
        kept.insert(meeting);
    }
    return kept;
}

/// Discs in a row, each with a few candidates with later discs and some with walls. There are only
/// a few times, so many are equal.
Meetings random_meetings(std::uint32_t seed, DiscId n_discs, int per_disc, std::uint32_t n_times) {
    std::mt19937 random(seed);
    Meetings all;
    for (DiscId p = 0; p < n_discs; ++p) {
        for (int k = 0; k < per_disc; ++k) {
            const double time = static_cast<double>(random() % n_times) / n_times;
            const DiscId q = p + 1 + random() % 5;
            if (random() % 8 == 0)
                all.insert({time, p, no_disc});
            else if (q < n_discs)
                all.insert({time, p, q});
        }
    }
    // A pair has only one contact in a micro-step, the first one.
    std::set<std::pair<DiscId, DiscId>> pairs;
    std::erase_if(all, [&](const Meeting& m) { return !pairs.insert({m.p, m.q}).second; });
    return all;
}

/// Each disc with the next one, so the verdict on the last pair depends on the first.
Meetings chain(DiscId n_discs, bool is_tied) {
    Meetings all;
    for (DiscId p = 0; p + 1 < n_discs; ++p)
        all.insert(
            {is_tied ? 0.5 : static_cast<double>(p) / static_cast<double>(n_discs), p, p + 1});
    return all;
}

struct Setting {
    int owner_stride; ///< number of successive discs with one owner; at 1 every pair
                      ///< has discs of two ranks
    int rounds;
    std::uint64_t per_slice;
};

/// All ranks together decide the candidates that each of them knows; returned as sets of ids.
Meetings decided(const Communicator& world, const Meetings& all, const Setting& setting) {
    const auto owner = [&](DiscId id) {
        return static_cast<int>(id / static_cast<DiscId>(setting.owner_stride) %
                                static_cast<DiscId>(world.size()));
    };
    const auto is_ours = [&](const Meeting& m) {
        return owner(m.p) == world.rank() || (m.q != no_disc && owner(m.q) == world.rank());
    };
    std::set<DiscId> own, halo;
    for (const Meeting& m : all) {
        if (!is_ours(m)) continue;
        for (const DiscId id : {m.p, m.q})
            if (id != no_disc) (owner(id) == world.rank() ? own : halo).insert(id);
    }
    std::vector<DiscState> discs;
    std::map<DiscId, LocalIndex> place;
    for (const std::set<DiscId>* ids : {&own, &halo}) {
        for (const DiscId id : *ids) {
            place[id] = static_cast<LocalIndex>(discs.size());
            discs.emplace_back().id = id;
        }
    }
    Candidates live;
    for (const Meeting& m : all)
        if (is_ours(m))
            live.push_back({m.time, place.at(m.p), m.q == no_disc ? wall_index : place.at(m.q)});
    std::shuffle(live.begin(), live.end(), std::mt19937(static_cast<unsigned>(world.rank())));

    const Population population{discs, own.size()};
    std::vector<int> others;
    for (int rank = 0; rank < world.size(); ++rank)
        if (rank != world.rank()) others.push_back(rank);
    Verdicts verdicts;
    LocalResolution(1).resolve(population, live, verdicts);
    BoundaryResolution across(world);
    across.rounds_before_sort = setting.rounds;
    across.candidates_per_slice = setting.per_slice;
    across.decide(population, others, verdicts.undecided,
                  world.sum(std::uint64_t{verdicts.undecided.size()}), verdicts.kept);
    CHECK(verdicts.undecided.empty());
    Meetings kept;
    for (const Candidate& c : verdicts.kept)
        kept.insert({c.time, discs[c.p].id, c.is_wall() ? no_disc : discs[c.q].id});
    CHECK(kept.size() == verdicts.kept.size());
    Meetings expected = walked(all);
    std::erase_if(expected, [&](const Meeting& m) { return !is_ours(m); });
    CHECK(std::equal(kept.begin(), kept.end(), expected.begin(), expected.end(),
                     [](const Meeting& a, const Meeting& b) { return a.key() == b.key(); }));
    return kept;
}

const std::vector<Setting> settings = {{1, 6, 8192}, {7, 6, 8192}, {40, 6, 8192},   {7, 0, 8192},
                                       {7, 0, 16},   {3, 1, 16},   {1, 1000, 8192}, {3, 2, 64}};

} // namespace

TEST_CASE("resolution across strips is the sorted walk, by talk, by sort and by both") {
    const Communicator world = Communicator::world();
    for (const Setting& setting : settings) {
        for (std::uint32_t seed = 1; seed <= 12; ++seed) {
            CAPTURE(setting.owner_stride, setting.rounds, seed);
            decided(world,
                    random_meetings(seed, 300, seed % 3 == 0 ? 4 : 1, seed % 2 == 0 ? 4 : 1000000),
                    setting);
        }
    }
}

TEST_CASE("chains across strips are resolved, however often they cross") {
    const Communicator world = Communicator::world();
    for (const Setting& setting : settings) {
        for (const bool is_tied : {false, true}) {
            CAPTURE(setting.owner_stride, setting.rounds, is_tied);
            decided(world, chain(90, is_tied), setting);
        }
    }
}

TEST_CASE("where discs of two ranks meet at all, one round of talk decides what is first for both "
          "and what depends on it alone") {
    const Communicator world = Communicator::world();
    // Ranks 0 and 1 own discs 0, 1 and 2, 3: the pair of 1 and 2 comes first, so 0 with 1 and 2
    // with 3 do not happen.
    const std::vector<std::vector<DiscId>> ids = {{0, 1, 2}, {2, 3, 1}};
    std::vector<DiscState> discs(3);
    Candidates undecided, kept;
    std::vector<int> other;
    if (world.rank() < 2) {
        const auto rank = static_cast<std::size_t>(world.rank());
        for (std::size_t k = 0; k < 3; ++k) discs[k].id = ids[rank][k];
        other = {1 - world.rank()};
        if (rank == 0)
            undecided = {{0.5, 0, 1}, {0.25, 1, 2}};
        else
            undecided = {{0.5, 0, 1}, {0.25, 2, 0}};
    }
    const Population population{discs, 2};
    const std::uint64_t messages = world.traffic().messages;
    BoundaryResolution across(world);
    across.resolve_boundary(population, other, undecided, kept);
    CHECK(undecided.empty());
    CHECK(kept.size() == (world.rank() < 2 ? 1 : 0));
    for (const Candidate& c : kept) CHECK(c.time == 0.25);
    CHECK(world.traffic().messages - messages == other.size());
}
