// SPDX-License-Identifier: BSD-3-Clause
// Measures how the wall time of a rank is spent. A `PhaseClock::Scope` adds its lifetime to
// one phase. Scopes may be nested, and the time of an inner scope is not added to the outer one.
// Cost: two readings of the clock per scope, so no scope should be inside a loop over discs.
#pragma once

#include <array>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace carrom {

enum class Phase { redistribute, search, resolve, conflicts, move, exchange, wait, sync, n_phases };

class PhaseClock {
public:
    class Scope {
    public:
        Scope(PhaseClock& clock, Phase phase) : clock_(clock), outer_(clock.switch_to(phase)) {}
        ~Scope() { clock_.switch_to(outer_); }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        PhaseClock& clock_;
        Phase outer_;
    };

    std::vector<std::pair<std::string, double>> seconds() const {
        static constexpr std::array names = {"redistribute", "search",   "resolve", "conflicts",
                                             "move",         "exchange", "wait",    "sync"};
        static_assert(names.size() == static_cast<std::size_t>(Phase::n_phases));
        std::vector<std::pair<std::string, double>> list;
        for (std::size_t k = 0; k < names.size(); ++k) list.emplace_back(names[k], seconds_[k]);
        return list;
    }

private:
    using Clock = std::chrono::steady_clock;

    Phase switch_to(Phase phase) {
        const Clock::time_point now = Clock::now();
        seconds_[static_cast<std::size_t>(phase_)] +=
            std::chrono::duration<double>(now - since_).count();
        since_ = now;
        return std::exchange(phase_, phase);
    }

    std::array<double, static_cast<std::size_t>(Phase::n_phases) + 1>
        seconds_{}; ///< the last entry is the time outside all scopes
    Phase phase_ = Phase::n_phases;
    Clock::time_point since_ = Clock::now();
};

} // namespace carrom
