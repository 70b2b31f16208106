// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/block_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "event_driven/block_run.hpp"

namespace carrom {

namespace {

// Times in nanoseconds, measured on one core.
constexpr double cost_per_disc = 40; ///< sorting, copying and returning a disc, once in each window
constexpr double cost_per_copy = 40; ///< copying one disc of a block or of its halo
constexpr double cost_per_event = 160;
constexpr double cost_per_partner = 1.0; ///< testing one disc in a prediction
/// Predicting a collision with one partner that the disc would meet in the window if no other disc
/// stopped it. In a long window of a dilute gas this can be any disc of the box. Where discs are
/// clustered, the costs above already include this cost.
constexpr double cost_per_candidate = 6;
constexpr double usual_speed = 0.3; ///< typical speed of a disc, relative to the speed bound
/// Largest number of discs in a block with its halo. They need not all stay in the cache, because
/// most of them are compared only once.
constexpr double discs_in_cache = 24000;
constexpr double cost_per_choice = 5000; ///< a fixed cost of each window
/// Estimated time for which a thread waits for other threads and for messages in each window
constexpr double cost_per_window = 50000;
constexpr int most_blocks_per_thread = 8;
/// The slowest of many blocks takes longer than its cells and discs suggest, by the share
/// `unforeseen`. A run that is repeated with twice the halo takes `repeated_run` times as long.
constexpr double unforeseen = 0.1, repeated_run = 1.6;
constexpr double densest_gas = 0.7; ///< largest packing fraction for which a rate is estimated
/// If the diameter is less than this share of the reach, a halo of two reaches is enough: discs fly
/// far compared with their size, so few chains of collisions lead beyond it in a window.
constexpr double thin_gas = 0.2;

// A repeated run with twice the halo costs, with its consequences, as much as 2.5 first runs.
// Windows become shorter if more than the share `mostly_repeated` of the block runs was repeated.
constexpr double runs_to_repeat = 2.5, mostly_repeated = 0.5;
constexpr double memory = 0.9; ///< weight of older windows in a running mean
/// Weight of older windows in the mean of waits. It is larger, because a single wait is long and
/// shows little about how often waits occur.
constexpr double memory_of_waits = 0.98;
constexpr int most_more = 2;   ///< largest addition to the halo, in reaches
constexpr int long_calm = 200; ///< windows without a repeated run before a smaller halo is tried
constexpr double shorter = 0.7, longer = 1.03, least_hits = 0.1;

/// The mean distance between neighbouring discs
double spacing_of(const BlockNeeds& needs) {
    const double n = needs.n_discs * needs.crowding + 1;
    return needs.box.is_square() ? needs.box.x / std::sqrt(n)
                                 : std::sqrt(needs.box.x / n) * std::sqrt(needs.box.y);
}

BlockWindow window_of(const BlockNeeds& needs, double duration) {
    return {needs.time, needs.time + duration, false, needs.speed_bound};
}

/// The number of discs of a block with its halo, divided by its number of own discs.
double share_seen(const BlockNeeds& needs, const BlockChoice& choice) {
    if (needs.is_one_block) return 1;
    const double halo = choice.halo * choice.reach;
    const auto along = [&](double length, bool goes_round) {
        const double own = std::min(choice.block_side, length), seen = own + 2 * halo;
        return (goes_round ? seen : std::min(seen, length)) / own;
    };
    return along(needs.box.x, needs.goes_round_x) * along(needs.box.y, needs.goes_round_y);
}

/// The time until the last thread has finished, divided by the mean time that threads work
double share_waited(const BlockNeeds& needs, const BlockChoice& choice) {
    if (needs.n_threads == 0 || needs.is_one_block) return 1;
    const double blocks_per_thread = std::max(1.0,
                                              needs.n_discs / (needs.n_threads * choice.own_discs));
    return 1 + (unforeseen + repeated_run * needs.rounds) / blocks_per_thread;
}

/// Chooses blocks of `own_discs` own discs each, for the mean density around discs.
void take_blocks_of(double own_discs, const BlockNeeds& needs, BlockChoice& choice) {
    const double area = own_discs * spacing_of(needs) * spacing_of(needs);
    choice.own_discs = own_discs;
    choice.block_side = std::max(std::sqrt(area), area / needs.box.shortest());
}

/// Chooses blocks so small that each thread gets at least one. Small blocks have more halo in
/// total; with few large blocks, threads wait longer for the slowest block.
void share_out(const BlockNeeds& needs, BlockChoice& choice) {
    const double largest = choice.own_discs;
    BlockChoice best = choice;
    double least = std::numeric_limits<double>::infinity();
    for (int per_thread = 1; per_thread <= most_blocks_per_thread; ++per_thread) {
        take_blocks_of(std::min(largest, needs.n_discs / (per_thread * needs.n_threads) + 1), needs,
                       choice);
        const double cost = share_seen(needs, choice) * share_waited(needs, choice);
        if (cost >= least) continue;
        least = cost;
        best = choice;
    }
    choice = best;
}

BlockChoice choice_of(const BlockNeeds& needs, double duration) {
    BlockChoice choice;
    choice.duration = duration;
    choice.reach = block_reach(window_of(needs, duration), 2 * needs.radius, needs.box);
    const double spacing = spacing_of(needs);
    choice.halo = needs.halo.value_or((2 * needs.radius < thin_gas * choice.reach ? 2 : 3) +
                                      needs.more_halo);
    const double margin = choice.halo * choice.reach;
    double side = std::sqrt(discs_in_cache) * spacing - 2 * margin;
    if (side > needs.box.shortest()) // a block cannot be higher than the box, so it can be longer
        side = discs_in_cache * spacing * (spacing / needs.box.shortest()) - 2 * margin;
    const double longest = needs.box.longest();
    choice.block_side = needs.is_one_block ? longest
                                           : std::min(std::max(side, 1.5 * margin), longest);
    const double height = std::min(choice.block_side, needs.box.shortest());
    choice.own_discs = std::max(1.0, choice.block_side / spacing * (height / spacing));
    if (needs.n_threads > 0 && !needs.is_one_block) share_out(needs, choice);
    return choice;
}

/// Bounces off walls per disc and micro-step. Each needs a prediction, as a collision does.
double bounce_rate(const BlockNeeds& needs) {
    const double speed = 2 / std::numbers::pi * usual_speed * needs.speed_bound;
    return (needs.goes_round_x ? 0 : speed / needs.box.x) +
           (needs.goes_round_y ? 0 : speed / needs.box.y);
}

/// The share of all discs that a disc would meet in a window if no other disc stopped it
double share_met(const BlockNeeds& needs, double duration) {
    const double edge = 2 * needs.radius + 2 * usual_speed * needs.speed_bound * duration;
    return std::min(edge / needs.box.x, 1.0) * std::min(edge / needs.box.y, 1.0);
}

double cost_per_time(const BlockNeeds& needs, const BlockChoice& choice) {
    const double share = share_seen(needs, choice) * share_waited(needs, choice);
    const double around = 1.6 * (choice.reach - 2 * (needs.radius - needs.equivalent_radius));
    const double partners = needs.n_discs * needs.crowding *
                            (std::min(around, needs.box.x) / needs.box.x) *
                            (std::min(around, needs.box.y) / needs.box.y);
    const double collisions = needs.collision_rate * choice.duration,
                 bounces = bounce_rate(needs) * choice.duration;
    const double tries = partners * (cost_per_partner +
                                     cost_per_candidate * share_met(needs, choice.duration));
    const double run_blocks = cost_per_copy + tries / 2 +
                              collisions * (cost_per_event + 2 * tries) +
                              bounces * (cost_per_event + tries);
    const double wait = (cost_per_choice + cost_per_window * needs.n_threads) / (needs.n_discs + 1);
    return (cost_per_disc + wait + share * run_blocks) / choice.duration;
}

} // namespace

BlockChoice choose_block_window(const BlockNeeds& needs, double longest,
                                std::optional<double> wanted) {
    if (wanted) return choice_of(needs, std::min(*wanted, longest));
    BlockChoice best = choice_of(needs, longest);
    if (!(needs.speed_bound > 0)) return best;
    const double spacing = spacing_of(needs);
    double least = cost_per_time(needs, best);
    for (double duration = std::min(longest, 0.02 * spacing / needs.speed_bound);
         duration < longest; duration *= 1.1) {
        const BlockChoice choice = choice_of(needs, duration);
        const double cost = cost_per_time(needs, choice);
        if (cost >= least) continue;
        least = cost;
        best = choice;
    }
    return best;
}

void Caution::learn(const Passed& window) {
    lately_ += (1 - memory) * (runs_to_repeat * window.repeated - lately_);
    waited_lately_ += (1 - memory_of_waits) * (window.waited - waited_lately_);
    const bool is_mostly = window.repeated > mostly_repeated && more_halo_ == most_more;
    most_hits_ = is_mostly ? std::max(least_hits, shorter * window.hits) : longer * most_hits_;
    n_calm_ = window.repeated > 0 ? 0 : n_calm_ + 1;
    if (std::max(lately_, waited_lately_) > window.price_of_reach && more_halo_ < most_more) {
        ++more_halo_;
        lately_ = waited_lately_ = 0;
    } else if (n_calm_ >= long_calm && more_halo_ > 0) {
        --more_halo_;
        n_calm_ = 0;
    }
}

double guessed_collision_rate(const BlockNeeds& needs, double mean_speed) {
    const double number_density = needs.n_discs * needs.crowding / needs.box.area();
    const double packing = std::min(densest_gas, number_density * std::numbers::pi *
                                                     needs.equivalent_radius *
                                                     needs.equivalent_radius);
    const double contact_value = (1 - 7 * packing / 16) / ((1 - packing) * (1 - packing));
    const double relative_speed = std::numbers::sqrt2 * mean_speed;
    return number_density * 2 * needs.equivalent_radius * relative_speed * contact_value;
}

} // namespace carrom
