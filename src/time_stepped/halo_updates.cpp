// SPDX-License-Identifier: BSD-3-Clause
// How the time-stepped engine treats discs and candidates that exist on two ranks.
#include "time_stepped/time_stepped_engine.hpp"

namespace carrom {

namespace {
/// with fewer candidates or updates, starting threads costs more than it saves
constexpr std::size_t least_for_threads = 1000;
} // namespace

/// A candidate may exist on two ranks. Only the owner of its first disc counts it.
template <class Dynamics>
std::uint64_t TimeSteppedEngine<Dynamics>::count_ours(std::span<const Candidate> candidates) const {
    if (discs_.has_no_halo()) return candidates.size();
    std::uint64_t n = 0;
#pragma omp parallel for num_threads(tuning_.threads) schedule(static)                             \
    reduction(+ : n) if (candidates.size() > least_for_threads)
    for (std::size_t k = 0; k < candidates.size(); ++k) n += candidates[k].p < discs_.n_own();
    return n;
}

/// Exchanges new states with the neighbours. Appends the updated halo discs to `hits_`. For a disc
/// whose collision this rank has also carried out, appends `wall_index`, which later code skips.
template <class Dynamics>
void TimeSteppedEngine<Dynamics>::update_halo(const Window& window, int m) {
    if (discs_.has_no_halo()) return;
    const PhaseClock::Scope scope(phases_, Phase::exchange);
    updates_.clear();
    discs_.send_updates(hits_, updates_);
#pragma omp parallel for num_threads(tuning_.threads)                                              \
    schedule(static) if (updates_.size() > least_for_threads)
    for (std::size_t k = 0; k < updates_.size(); ++k) {
        LocalIndex& index = updates_[k];
        if (states_[index] == window.state_after(m)) {
            index = wall_index; // this rank has carried out the disc's collision itself
            continue;
        }
        states_[index] = window.state_after(m);
        update_flight(index, discs_.all()[index]);
    }
    hits_.insert(hits_.end(), updates_.begin(), updates_.end());
}

// These members are called from time_stepped_engine.cpp, where the rest of the class is compiled.
#define CARROM_DEFINE(Dynamics)                                                                    \
    template std::uint64_t TimeSteppedEngine<Dynamics>::count_ours(std::span<const Candidate>)     \
        const;                                                                                     \
    template void TimeSteppedEngine<Dynamics>::update_halo(const Window&, int);
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
