// SPDX-License-Identifier: BSD-3-Clause
#include "time_stepped/local_resolution.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include <omp.h>

namespace carrom {

namespace {

// Marks that differ from all numbers of candidates. A blocked disc has an undecided candidate.
constexpr std::uint32_t free_disc = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t taken_disc = free_disc - 1;
constexpr std::uint32_t blocked_disc = free_disc - 2;

bool has_halo_disc(const Candidate& candidate, std::size_t n_own) {
    return candidate.p >= n_own || (!candidate.is_wall() && candidate.q >= n_own);
}

std::uint32_t read(std::uint32_t& mark) {
    return std::atomic_ref<std::uint32_t>(mark).load(std::memory_order_relaxed);
}
void write(std::uint32_t& mark, std::uint32_t value) {
    std::atomic_ref<std::uint32_t>(mark).store(value, std::memory_order_relaxed);
}

/// Writes `number` to `mark` if its candidate comes before the one whose number is in `mark`. If
/// several threads write at the same time, one number may be lost.
void offer(std::uint32_t& mark, std::uint32_t number, std::span<const Candidate> live,
           const TotalOrder& before) {
    const std::uint32_t seen = read(mark);
    if (seen == free_disc || before(live[number], live[seen])) write(mark, number);
}

/// Repeats `offer` with an atomic exchange, because a few numbers may have been lost. All threads
/// must have finished `offer` before.
void insist(std::uint32_t& mark, std::uint32_t number, std::span<const Candidate> live,
            const TotalOrder& before) {
    std::atomic_ref<std::uint32_t> place(mark);
    std::uint32_t seen = place.load(std::memory_order_relaxed);
    while (seen != number && (seen == free_disc || before(live[number], live[seen]))) {
        if (place.compare_exchange_weak(seen, number, std::memory_order_relaxed)) return;
    }
}

} // namespace

/// Makes room for the marks of `n_discs` discs. All discs are free before and after a call of
/// `resolve`, so old marks need not be copied.
void LocalResolution::make_room_for(std::size_t n_discs) {
    if (first_.size() >= n_discs) return;
    first_.clear();
    first_.resize(n_discs);
#pragma omp parallel for num_threads(n_threads_) schedule(static)
    for (std::size_t i = 0; i < n_discs; ++i) first_[i] = free_disc;
}

void LocalResolution::resolve(const Population& population, Candidates& live, Verdicts& verdicts) {
    verdicts.kept.clear();
    verdicts.undecided.clear();
    verdicts.n_rounds = 0;
    make_room_for(population.discs.size());
    kept_by_thread_.resize(static_cast<std::size_t>(n_threads_));
    live_by_thread_.resize(static_cast<std::size_t>(n_threads_));
    places_.resize(static_cast<std::size_t>(n_threads_));
    verdicts.kept.reserve(live.size());
    while (!live.empty()) {
        if (verdicts.n_rounds >= rounds_before_walk) return walk(population, live, verdicts);
        ++verdicts.n_rounds;
        const bool concurrent = n_threads_ > 1 && live.size() > 512;
        const std::size_t n_kept = concurrent ? round_together(population, live, verdicts)
                                              : round_alone(population, live, verdicts);
        if (n_kept == 0) {
            std::swap(verdicts.undecided, live);
            return;
        }
    }
}

std::size_t LocalResolution::round_alone(const Population& population, Candidates& live,
                                         Verdicts& verdicts) {
    const TotalOrder before(population.discs);
    const std::size_t old_kept = verdicts.kept.size();
    for (std::size_t k = 0; k < live.size(); ++k) {
        for (const LocalIndex index : {live[k].p, live[k].q})
            if (index != wall_index &&
                (first_[index] == free_disc || before(live[k], live[first_[index]])))
                first_[index] = static_cast<std::uint32_t>(k);
    }
    for (std::size_t k = 0; k < live.size(); ++k) {
        const Candidate& candidate = live[k];
        if (first_[candidate.p] != k || (!candidate.is_wall() && first_[candidate.q] != k) ||
            has_halo_disc(candidate, population.n_own))
            continue;
        verdicts.kept.push_back(candidate);
        first_[candidate.p] = taken_disc;
        if (!candidate.is_wall()) first_[candidate.q] = taken_disc;
    }
    // Removes all other candidates of discs that have a kept one, and resets all marks except
    // `taken_disc`.
    const auto is_struck = [&](const Candidate& candidate) {
        const bool p_taken = first_[candidate.p] == taken_disc,
                   q_taken = !candidate.is_wall() && first_[candidate.q] == taken_disc;
        if (!p_taken) first_[candidate.p] = free_disc;
        if (!candidate.is_wall() && !q_taken) first_[candidate.q] = free_disc;
        return p_taken || q_taken;
    };
    std::erase_if(live, is_struck);
    for (std::size_t k = old_kept; k < verdicts.kept.size(); ++k) {
        for (const LocalIndex index : {verdicts.kept[k].p, verdicts.kept[k].q})
            if (index != wall_index) first_[index] = free_disc;
    }
    return verdicts.kept.size() - old_kept;
}

/// Makes room for all kept and live candidates, and gives each thread its part of the lists.
void LocalResolution::join_lists(Candidates& live, Verdicts& verdicts) {
    std::size_t kept_end = verdicts.kept.size(), live_end = 0;
    for (std::size_t thread = 0; thread < kept_by_thread_.size(); ++thread) {
        places_[thread] = {kept_end, live_end};
        kept_end += kept_by_thread_[thread].size();
        live_end += live_by_thread_[thread].size();
    }
    verdicts.kept.resize(kept_end);
    live.resize(live_end);
}

std::size_t LocalResolution::round_together(const Population& population, Candidates& live,
                                            Verdicts& verdicts) {
    const TotalOrder before(population.discs);
    const std::size_t old_kept = verdicts.kept.size();
    const auto n_live = static_cast<std::int64_t>(live.size());
#pragma omp parallel num_threads(n_threads_)
    {
        const auto thread = static_cast<std::size_t>(omp_get_thread_num());
        Candidates &kept = kept_by_thread_[thread], &rest = live_by_thread_[thread];
        kept.clear();
        rest.clear();
#pragma omp for schedule(static)
        for (std::int64_t k = 0; k < n_live; ++k) {
            const Candidate& candidate = live[static_cast<std::size_t>(k)];
            const auto number = static_cast<std::uint32_t>(k);
            offer(first_[candidate.p], number, live, before);
            if (!candidate.is_wall()) offer(first_[candidate.q], number, live, before);
        }
        // Only this second pass uses atomic exchanges, and only for numbers that were lost, because
        // an exchange costs as much as all other work for a candidate.
#pragma omp for schedule(static)
        for (std::int64_t k = 0; k < n_live; ++k) {
            const Candidate& candidate = live[static_cast<std::size_t>(k)];
            const auto number = static_cast<std::uint32_t>(k);
            insist(first_[candidate.p], number, live, before);
            if (!candidate.is_wall()) insist(first_[candidate.q], number, live, before);
        }
#pragma omp for schedule(static)
        for (std::int64_t k = 0; k < n_live; ++k) {
            const Candidate& candidate = live[static_cast<std::size_t>(k)];
            const auto number = static_cast<std::uint32_t>(k);
            const bool is_first = read(first_[candidate.p]) == number &&
                                  (candidate.is_wall() || read(first_[candidate.q]) == number);
            if (!is_first || has_halo_disc(candidate, population.n_own)) continue;
            kept.push_back(candidate);
            write(first_[candidate.p], taken_disc);
            if (!candidate.is_wall()) write(first_[candidate.q], taken_disc);
        }
#pragma omp for schedule(static)
        for (std::int64_t k = 0; k < n_live; ++k) {
            const Candidate& candidate = live[static_cast<std::size_t>(k)];
            const bool p_taken = read(first_[candidate.p]) == taken_disc;
            const bool q_taken = !candidate.is_wall() && read(first_[candidate.q]) == taken_disc;
            if (!p_taken) write(first_[candidate.p], free_disc);
            if (!candidate.is_wall() && !q_taken) write(first_[candidate.q], free_disc);
            if (!p_taken && !q_taken) rest.push_back(candidate);
        }
        // No disc of a live candidate has a kept candidate, so the marks are no longer needed.
        for (const Candidate& candidate : kept) {
            write(first_[candidate.p], free_disc);
            if (!candidate.is_wall()) write(first_[candidate.q], free_disc);
        }
#pragma omp single
        join_lists(live, verdicts);
        const auto [kept_place, rest_place] = places_[thread];
        std::ranges::copy(kept, verdicts.kept.data() + kept_place);
        std::ranges::copy(rest, live.data() + rest_place);
    }
    return verdicts.kept.size() - old_kept;
}

void LocalResolution::walk(const Population& population, Candidates& live, Verdicts& verdicts) {
    std::sort(live.begin(), live.end(), TotalOrder(population.discs));
    touched_.clear();
    const auto mark_both = [&](const Candidate& candidate, std::uint32_t mark) {
        for (const LocalIndex index : {candidate.p, candidate.q}) {
            if (index == wall_index || first_[index] == taken_disc) continue;
            first_[index] = mark;
            touched_.push_back(index);
        }
    };
    for (const Candidate& candidate : live) {
        const std::uint32_t p_mark = first_[candidate.p];
        const std::uint32_t q_mark = candidate.is_wall() ? free_disc : first_[candidate.q];
        if (p_mark == taken_disc || q_mark == taken_disc) continue;
        if (p_mark == blocked_disc || q_mark == blocked_disc ||
            has_halo_disc(candidate, population.n_own)) {
            verdicts.undecided.push_back(candidate);
            mark_both(candidate, blocked_disc);
        } else {
            verdicts.kept.push_back(candidate);
            mark_both(candidate, taken_disc);
        }
    }
    for (const LocalIndex index : touched_) first_[index] = free_disc;
    live.clear();
}

} // namespace carrom
