// SPDX-License-Identifier: BSD-3-Clause
// Micro-benchmarks of the kernels, one core each: the cost of a pair, a disc or a collision.
//   carrom_benchmarks [--benchmark_filter=...] [--benchmark_format=json] ...
// Gases of packing 0.2 with speeds evenly up to half a radius per step, 1e4 discs (which fit the
// second level of cache) and 1e6. Each benchmark names its items. The counters flops and bytes are
// derived from the source: each operation of the formula (a fused one is two), each number that is
// read or written once. page.py draws the roofline of them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "cell_list/cell_grid.hpp"
#include "core/state_hash.hpp"
#include "dynamics/all_dynamics.hpp"
#include "dynamics/pair_contact.hpp"
#include "event_driven/block_run.hpp"
#include "event_driven/block_window.hpp"
#include "parallel/received.hpp"
#include "parallel/sample_sort.hpp"
#include "time_stepped/contact_filter.hpp"
#include "time_stepped/local_resolution.hpp"
#include "time_stepped/search.hpp"

using namespace carrom;

namespace {

constexpr double pi = 3.14159265358979323846, packing = 0.2, largest_speed = 0.5;

/// Discs of radius 1 on a square lattice, in the order of rows, each moved a little without
/// overlaps.
struct Gas {
    double size;
    std::vector<DiscState> discs;

    explicit Gas(std::int64_t n) : size(std::sqrt(static_cast<double>(n) * pi / packing)) {
        const auto side = static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(n))));
        const double spacing = (size - 2) / static_cast<double>(side);
        std::mt19937_64 random(3210);
        const auto even = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        for (std::int64_t k = 0; k < n; ++k) {
            DiscState& disc = discs.emplace_back();
            disc.id = static_cast<DiscId>(k);
            const double room = spacing / 2 - 1;
            disc.x = 1 + spacing * (static_cast<double>(k % side) + 0.5) + even(-room, room);
            disc.y = 1 + spacing * (static_cast<double>(k / side) + 0.5) + even(-room, room);
            const double speed = even(0, largest_speed), angle = even(0, 2 * pi);
            disc.vx = speed * std::cos(angle);
            disc.vy = speed * std::sin(angle);
        }
    }

    void sort_into(CellGrid& grid, double reach, double duration) {
        grid.sort(discs, geometry(reach), 0, 0, duration, 1);
    }
    GridGeometry geometry(double reach) const {
        return make_geometry({0, size, 0, size}, Axis::x, reach, discs.size(), 0);
    }
    Population population() const { return {discs, discs.size()}; }
};

constexpr int window_steps = 3;
double reach_of_window() { return 2 + 2 * largest_speed * window_steps; }

/// Sets rates from the items of one iteration, and from the flops and bytes that the source has for
/// an item.
void print_message(benchmark::State& state, double items, double flops, double bytes) {
    state.SetItemsProcessed(
        static_cast<std::int64_t>(items * static_cast<double>(state.iterations())));
    state.counters["flops"] = flops;
    state.counters["bytes"] = bytes;
}

/// Item: a pair about to collide, with the whole predicate. It takes 50 operations, where a root or
/// a quotient counts as one, and the memory of two discs.
void contact_predicate(benchmark::State& state) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> even(-1, 1);
    std::vector<DiscState> discs(4096);
    for (std::size_t k = 0; k < discs.size(); k += 2) {
        discs[k + 1].x = 2.5 + 0.4 * even(random);
        discs[k + 1].y = 0.5 * even(random);
        discs[k].vx = 1;
        discs[k + 1].vx = -1 + 0.3 * even(random);
        discs[k + 1].vy = 0.1 * even(random);
    }
    for (auto _ : state) {
        double sum = 0;
        for (std::size_t k = 0; k < discs.size(); k += 2)
            sum += pair_contact(discs[k], discs[k + 1], 2.0, 1e-12).delay;
        benchmark::DoNotOptimize(sum);
    }
    print_message(state, static_cast<double>(discs.size() / 2), 50, 2 * sizeof(DiscState));
}
BENCHMARK(contact_predicate);

/// The number of pairs that filter_column tests, over all columns: those of the half stencil.
double tested_pairs(const CellGrid& grid) {
    double pairs = 0;
    const int reach = grid.geometry().n_reach;
    for (int column = 0; column < grid.geometry().n_columns; ++column) {
        for (int row = 0; row < grid.geometry().n_rows; ++row) {
            const SlotRange cell = grid.run(column, row, row);
            const double n = cell.end - cell.begin,
                         n_own = grid.run(column, row, row + reach).end - cell.begin;
            pairs += n * (n_own - (n + 1) / 2);
            for (int other = column + 1;
                 other <= std::min(column + reach, grid.geometry().n_columns - 1); ++other) {
                const SlotRange run = grid.run(other, row - reach, row + reach);
                pairs += n * static_cast<double>(run.end - run.begin);
            }
        }
    }
    return pairs;
}

/// Item: a pair in the stencil, with 27 operations in single precision, and the four numbers of the
/// second disc.
void vector_filter(benchmark::State& state) {
    Gas gas(state.range(0));
    CellGrid grid;
    gas.sort_into(grid, reach_of_window(), window_steps);
    const float touching = grid.touching_squared(2);
    std::vector<DiscPair> pairs;
    for (auto _ : state) {
        std::size_t n = 0;
        for (int column = 0; column < grid.geometry().n_columns; ++column)
            n += filter_column(grid, column, touching, pairs);
        benchmark::DoNotOptimize(n);
    }
    print_message(state, tested_pairs(grid), 27, 16);
    state.SetLabel(filter_target());
}
BENCHMARK(vector_filter)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

/// Item: a disc. Its cell and flight take 14 operations; its state is read twice and written once,
/// 24 bytes of order and flight are written, and the counts of its cell are changed twice. Discs
/// fly a window forwards and backwards in turns, as far as in a run.
void cell_grid_sort(benchmark::State& state) {
    Gas gas(state.range(0));
    CellGrid grid;
    gas.sort_into(grid, reach_of_window(), window_steps);
    const GridGeometry geometry = gas.geometry(reach_of_window());
    double anchor = 0;
    for (auto _ : state) {
        anchor = window_steps - anchor;
        grid.sort(gas.discs, geometry, anchor, anchor, window_steps, 1);
        benchmark::ClobberMemory();
    }
    print_message(state, static_cast<double>(gas.discs.size()), 14,
                  3 * sizeof(DiscState) + 24 + 16);
}
BENCHMARK(cell_grid_sort)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

/// Item: a candidate, including the copy of the list that the resolution uses up. Only comparisons,
/// no arithmetic.
void local_resolution(benchmark::State& state) {
    Gas gas(state.range(0));
    CellGrid grid;
    gas.sort_into(grid, reach_of_window(), window_steps);
    Search<PlainDynamics> search(PlainDynamics(gas.size, 1), 1, 1);
    Window window;
    window.n_micro = window_steps;
    search.predict_all(gas.population(), grid, window, reach_of_window());
    const std::vector<WindowState> states(gas.discs.size(), 0);
    const Candidates all = search.collect(window, window_steps - 1, states);
    Candidates live;
    LocalResolution resolution(1);
    Verdicts verdicts;
    for (auto _ : state) {
        live = all;
        resolution.resolve(gas.population(), live, verdicts);
        benchmark::DoNotOptimize(verdicts.kept.data());
    }
    print_message(state, static_cast<double>(all.size()), 0, 3 * sizeof(Candidate) + 3 * 8);
}
BENCHMARK(local_resolution)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

/// A contested candidate as the sort gets it.
struct Record {
    double time;
    DiscId p, q;
};

/// Item: a record, sorted alone among those of 8 ranks and then merged, as a rank does before and
/// after records are sent.
void sort_records(benchmark::State& state) {
    constexpr std::size_t n_ranks = 8;
    std::mt19937_64 random(5);
    std::vector<Record> all(static_cast<std::size_t>(state.range(0)));
    for (Record& record : all) record = {static_cast<double>(random() >> 11), random(), random()};
    const auto before = [](const Record& a, const Record& b) { return a.time < b.time; };
    for (auto _ : state) {
        Received<Record> in;
        in.items = all;
        for (std::size_t k = 0; k < n_ranks; ++k) {
            in.offsets.push_back(all.size() * (k + 1) / n_ranks);
            const auto at = [&](std::size_t place) {
                return in.items.begin() + static_cast<std::ptrdiff_t>(place);
            };
            std::stable_sort(at(in.offsets[k]), at(in.offsets[k + 1]), before);
        }
        const std::vector<Record> sorted = detail::merge_groups(std::move(in), before);
        benchmark::DoNotOptimize(sorted.data());
    }
    const double passes = std::log2(static_cast<double>(all.size()));
    print_message(state, static_cast<double>(all.size()), 0, 2 * sizeof(Record) * passes);
}
BENCHMARK(sort_records)->Arg(8'000)->Arg(800'000)->Unit(benchmark::kMillisecond);

/// Item: a collision of the event-driven method, in one block without a halo, with as many discs as
/// a block usually has with its halo.
void block_run(benchmark::State& state) {
    Gas gas(state.range(0));
    const PlainDynamics dynamics(gas.size, 1);
    BlockNeeds needs{
        gas.size, 1, static_cast<double>(gas.discs.size()), 1.08 * largest_speed, 0, 0, 3, true};
    needs.collision_rate = guessed_collision_rate(needs, largest_speed / 2);
    const BlockChoice choice = choose_block_window(needs, 64, {});
    const BlockWindow window{0, choice.duration, true, needs.speed_bound};
    CellGrid grid;
    gas.sort_into(grid, block_reach(window, 2, gas.size), choice.duration);
    const GridGeometry& geometry = grid.geometry();
    std::vector<std::uint64_t> histories(gas.discs.size());
    BlockRun<PlainDynamics> block_run(dynamics);
    BlockOutcome outcome;
    const CellBlock all_cells{0, geometry.n_columns, 0, geometry.n_rows};
    const BlockGround ground{.discs = gas.discs,
                             .n_own = gas.discs.size(),
                             .grid = &grid,
                             .own_cells = all_cells,
                             .window = window};
    for (auto _ : state) {
        block_run.run(ground, all_cells, 0, histories, outcome);
        benchmark::DoNotOptimize(outcome.n_events);
    }
    print_message(state, static_cast<double>(outcome.n_events), 0, 0);
    state.counters["discs_per_event"] = static_cast<double>(gas.discs.size()) /
                                        static_cast<double>(
                                            std::max<std::uint64_t>(1, outcome.n_events));
}
BENCHMARK(block_run)->Arg(3'000)->Arg(10'000)->Unit(benchmark::kMillisecond);

/// Item: a disc, read once; 48 bytes of its state are hashed to 128 bits and added. No floating
/// point.
void state_hash(benchmark::State& state) {
    const Gas gas(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(hash_of(gas.discs));
    print_message(state, static_cast<double>(gas.discs.size()), 0, sizeof(DiscState));
}
BENCHMARK(state_hash)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

/// Item: a disc, converted to the columns of a checkpoint, piece by piece, with ids in random
/// order.
void pack_columns(benchmark::State& state) {
    const Gas gas(state.range(0));
    std::vector<LocalIndex> places(gas.discs.size());
    for (std::size_t k = 0; k < places.size(); ++k) places[k] = static_cast<LocalIndex>(k);
    std::shuffle(places.begin(), places.end(), std::mt19937_64(7));
    std::vector<double> x(1024), y(1024), vx(1024), vy(1024), tau(1024);
    for (auto _ : state) {
        for (std::size_t k = 0; k < places.size(); ++k) {
            if (k + 64 < places.size()) __builtin_prefetch(&gas.discs[places[k + 64]]);
            const DiscState& disc = gas.discs[places[k]];
            const std::size_t row = k % 1024;
            x[row] = disc.x;
            y[row] = disc.y;
            vx[row] = disc.vx;
            vy[row] = disc.vy;
            tau[row] = disc.tau;
        }
        benchmark::ClobberMemory();
    }
    print_message(state, static_cast<double>(gas.discs.size()), 0, sizeof(DiscState) + 4 + 40);
}
BENCHMARK(pack_columns)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
