// SPDX-License-Identifier: BSD-3-Clause
#include "time_stepped/time_stepped_engine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stop_request.hpp"
#include "engine/dynamics_of_scene.hpp"
#include "engine/speed_survey.hpp"
#include "engine/state_sums.hpp"
#include "time_stepped/step_walls.hpp"

namespace carrom {

namespace {

/// Factors by which speeds may grow in a window before it is cut short. The first one applies in
/// equilibrium, the second one after a window that was cut.
constexpr double least_allowance = 1.02, allowance_after_cut = 1.15;

/// Uses fewer threads for few discs, because threads with little work cost more than they save.
Tuning with_useful_threads(Tuning tuning, const SceneParameters& scene, const Communicator& ranks) {
    const auto per_thread = std::max<std::uint64_t>(1, tuning.discs_per_thread),
               n_ranks = static_cast<std::uint64_t>(ranks.size());
    tuning.threads = static_cast<int>(std::clamp<std::uint64_t>(
        scene.n_discs / (n_ranks * per_thread), 1, static_cast<std::uint64_t>(tuning.threads)));
    return tuning;
}

} // namespace

template <class Dynamics>
TimeSteppedEngine<Dynamics>::TimeSteppedEngine(const SceneParameters& scene, StoredState state,
                                               const Communicator& communicator,
                                               const Tuning& tuning)
    : Base(scene, std::move(state), communicator, with_useful_threads(tuning, scene, communicator)),
      search_(dynamics_, tuning_.threads,
              usual_radius_of(scene.effects.species, dynamics_.radius(), scene.area())),
      local_(tuning_.threads), across_strips_(communicator) {
    this->distribute();
    discs_.forget_images();
    phases_ = {};
}

template <class Dynamics> void TimeSteppedEngine<Dynamics>::advance_to(std::int64_t target) {
    const auto left = [this](std::int64_t last) { return static_cast<int>(last - n_micro_done_); };
    const std::int64_t horizon = this->horizon_of(target);
    while (n_micro_done_ < target) run_window(left(target), left(horizon));
}

/// Runs micro-steps of a window until `n_left` of them are done, the window ends, or discs are too
/// fast for it. The window has at most `n_to_horizon` micro-steps.
template <class Dynamics>
void TimeSteppedEngine<Dynamics>::run_window(int n_left, int n_to_horizon) {
    if (std::exchange(this->is_in_window_, false))
        discs_.restore_images();
    else
        begin_window(n_to_horizon);
    const int begin = static_cast<int>(time_), end = window_.end_micro(),
              stop = std::min(end, begin + n_left);
    int m = begin;
    while (m < stop && run_micro_step(window_, m)) ++m;
    this->is_in_window_ = m == stop && m < end;
    if (this->is_in_window_)
        discs_.set_images_aside();
    else
        end_window(m < end);
    if (in_parts_) return;
    n_micro_done_ += m - begin;
    time_ = m;
}

template <class Dynamics> void TimeSteppedEngine<Dynamics>::begin_window(int n_left) {
    window_ = redistribute(n_left);
    const PhaseClock::Scope scope(phases_, Phase::search);
    search_.predict_all(population(), discs_.grid(), window_,
                        reach_of(usual_needs(), window_.duration(), usual_speed_));
}

/// Ends a window. If it was the last part of a micro-step, `outcomes_` become the states.
template <class Dynamics> void TimeSteppedEngine<Dynamics>::end_window(bool is_cut) {
    speed_allowance_ = is_cut ? allowance_after_cut
                              : std::max(least_allowance, (1 + speed_allowance_) / 2);
    ++n_windows_;
    if (!window_.is_part() || ++part_ < n_parts_) return;
    discs_.all().swap(outcomes_);
    outcomes_.clear();
    in_parts_ = false;
    part_ = 0;
}

/// Chooses a window. Then sends discs to the ranks whose domains contain them, and halo discs to
/// the ranks that need them, and sorts all of them into cells.
template <class Dynamics> Window TimeSteppedEngine<Dynamics>::redistribute(int n_left) {
    const PhaseClock::Scope scope(phases_, Phase::redistribute);
    if (part_ == 0) {
        this->set_departed_aside();
        survey_images();
        agree_on_speed();
        if (largest_speed_ > 0 && (n_windows_ == 0 || n_parts_ > 1)) // all ranks agree on this
            spread_ = survey_speeds(discs_.own(), largest_speed_, communicator_, tuning_.threads);
        if (n_windows_ == 0) hits_per_micro_step_ = guess_of_hits(window_needs());
    }
    const Window window = choose(n_left);
    migrate_at(window.anchor());
    const double reach = reach_of(window_needs(), window.duration()),
                 usual_reach = reach_of(usual_needs(), window.duration(), usual_speed_);
    sort(window, reach, usual_reach);
    {
        const PhaseClock::Scope exchange(phases_, Phase::exchange);
        discs_.fetch_halo(window.anchor(), reach, companion());
    }
    search_.list_large(population(), discs_.grid());
    if (usual_speed_ < window_speed_) discs_.grid().set_apart(usual_speed_ * (1 - 1e-6));
    states_.resize(this->count_seen());
#pragma omp parallel for num_threads(tuning_.threads) schedule(static)
    for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = 0;
    return window;
}

template <class Dynamics> void TimeSteppedEngine<Dynamics>::add_to(Totals& totals) {
    totals.rejected_candidates = communicator_.sum(n_candidates_ - n_kept_);
    Base::add_to(totals);
}

/// Sorts discs into cells that are made for `usual_reach`, and that cover a halo of depth `reach`.
/// Discs that are too fast for these cells will be set apart.
template <class Dynamics>
void TimeSteppedEngine<Dynamics>::sort(const Window& window, double reach, double usual_reach) {
    const Extent seen = discs_.extent_seen(extent(), reach);
    const GridGeometry geometry = make_geometry(seen, discs_.domains().axis(), usual_reach,
                                                discs_.n_own(), tuning_.cell_width.value_or(0));
    discs_.sort(geometry, window.anchor(), window.begin(), std::max(window.duration(), 1e-6),
                companion());
}

template <class Dynamics> Window TimeSteppedEngine<Dynamics>::choose(int n_left) {
    Window window;
    window.first_micro = static_cast<int>(time_);
    if (part_ == 0) {
        window_speed_ = largest_speed_ * speed_allowance_;
        speed_exceeded_ = false;
        WindowChoice choice = choose_window(usual_needs(), std::min(n_left, longest_window),
                                            tuning_.window);
        if constexpr (Dynamics::is_periodic) {
            const double longest = longest_in_period(discs_.periods(), window_speed_);
            if (choice.n_micro > longest * choice.n_parts)
                choice = choose_window(usual_needs(), std::min(n_left, longest_window), longest);
        }
        window.n_micro = choice.n_micro;
        n_parts_ = choice.n_parts;
        in_parts_ = n_parts_ > 1;
        usual_speed_ = in_parts_ && tuning_.usual_speed ? *tuning_.usual_speed * window_speed_
                                                        : choice.usual_speed;
        if (in_parts_) outcomes_ = discs_.all();
    }
    if (n_parts_ > 1) {
        window.part_begin = static_cast<double>(part_) / n_parts_;
        window.part_end = static_cast<double>(part_ + 1) / n_parts_;
    }
    return window;
}

template <class Dynamics> WindowNeeds TimeSteppedEngine<Dynamics>::window_needs() const {
    return {dynamics_.box(),
            dynamics_.radius() + dynamics_.slack(),
            static_cast<double>(discs_.n_total()),
            window_speed_,
            hits_per_micro_step_,
            static_cast<double>(discs_.n_total()) / communicator_.size(),
            spread_.largest > 0 ? &spread_ : nullptr};
}

/// Like window_needs, but for discs up to the radius for which cells are made.
template <class Dynamics> WindowNeeds TimeSteppedEngine<Dynamics>::usual_needs() const {
    WindowNeeds needs = window_needs();
    needs.radius = search_.usual_radius() + dynamics_.slack();
    return needs;
}

template <class Dynamics> void TimeSteppedEngine<Dynamics>::agree_on_speed() {
    const PhaseClock::Scope scope(phases_, Phase::wait);
    travel_speed_ = communicator_.max(largest_speed_);
    largest_speed_ = refreshed_speed_ > 0 ? std::exchange(refreshed_speed_, 0) : travel_speed_;
    this->refuse_long_flights(std::max(travel_speed_, largest_speed_));
}

/// If images move, a disc that crosses into another row of boxes gets another speed without a
/// collision. It may cross before the window's anchor, so the speed of the images is added.
template <class Dynamics> void TimeSteppedEngine<Dynamics>::survey_images() {
    if constexpr (Dynamics::has_moving_images) {
        const double fastest = this->squared_speed_of_own(time_);
        largest_speed_ = std::max(largest_speed_,
                                  std::sqrt(fastest) + std::fabs(dynamics_.periods().speed));
        if (refreshed_speed_ > 0) refreshed_speed_ += std::fabs(dynamics_.periods().speed);
    }
}

template <class Dynamics> void TimeSteppedEngine<Dynamics>::migrate() {
    agree_on_speed();
    migrate_at(time_);
}

/// A disc was sorted by a position on its old flight, but after a collision it is on a new flight,
/// which cannot have begun before `unchanged_until_`. So `flown` is the time on both flights, with
/// the change at `unchanged_until_`. Between the parts of a micro-step no state changes.
template <class Dynamics> void TimeSteppedEngine<Dynamics>::migrate_at(double time) {
    const double from = part_ > 0 ? redistributed_time_ : unchanged_until_;
    const double flown = (time - from) + std::fabs(redistributed_time_ - from);
    const double farthest = travel_speed_ * flown * (1 + 1e-6) + this->place_margin();
    const PhaseClock::Scope scope(phases_, Phase::exchange);
    discs_.migrate(time, farthest, companion());
    redistributed_time_ = time;
    if (part_ == 0) unchanged_until_ = time_;
}

/// Decides and applies micro-step m. Returns false, before anything changes, if discs have become
/// faster than the window allows for.
template <class Dynamics>
bool TimeSteppedEngine<Dynamics>::run_micro_step(const Window& window, int m) {
    const PhaseClock::Scope resolving(phases_, Phase::resolve);
    std::uint64_t n_candidates = 0;
    { // at the end of this scope the list is freed, before others grow
        Candidates live = search_.collect(window, m, states_);
        n_candidates = count_ours(live);
        if (in_parts_) strike_taken(live);
        local_.resolve(population(), live, verdicts_);
    }
    if (!discs_.has_no_halo()) {
        const PhaseClock::Scope scope(phases_, Phase::conflicts);
        across_strips_.resolve_boundary(population(), discs_.neighbours(), verdicts_.undecided,
                                        verdicts_.kept);
    }
    // A disc does not collide again in the same micro-step, so its speed after a collision matters
    // only for later micro-steps.
    std::uint64_t updates[] = {verdicts_.undecided.size(),
                               speed_exceeded_ && m > window.first_micro ? 1u : 0u,
                               is_stop_overdue() ? 1u : 0u};
    if (communicator_.size() > 1) {
        const PhaseClock::Scope scope(phases_, Phase::wait);
        communicator_.sum(updates);
    }
    if (updates[2] > 0) throw StopRequested("stopped on request inside a step");
    if (updates[1] > 0) return false;
    if (updates[0] > 0) {
        const PhaseClock::Scope scope(phases_, Phase::conflicts);
        across_strips_.decide(population(), discs_.neighbours(), verdicts_.undecided, updates[0],
                              verdicts_.kept);
    }
    n_candidates_ += n_candidates;
    this->rank_work_.of_pairs += n_candidates;
    n_kept_ += count_ours(verdicts_.kept);
    apply(window, m);
    return true;
}

/// Removes the candidates of discs that have collided in an earlier part of this micro-step. They
/// are still counted as candidates.
template <class Dynamics> void TimeSteppedEngine<Dynamics>::strike_taken(Candidates& live) const {
    const auto is_taken = [&](LocalIndex index) {
        return outcomes_[index].version() != population().discs[index].version();
    };
    std::erase_if(
        live, [&](const Candidate& c) { return is_taken(c.p) || (!c.is_wall() && is_taken(c.q)); });
}

template <class Dynamics> void TimeSteppedEngine<Dynamics>::apply(const Window& window, int m) {
    DiscStates& results = in_parts_ ? outcomes_ : discs_.all();
    {
        const PhaseClock::Scope scope(phases_, Phase::move);
        if (this->is_followed()) record_velocities(results);
        const double fastest = collide_all(window, m, results);
        if (this->is_followed()) log_collisions(results, m);
        largest_speed_ = std::max(largest_speed_, fastest);
        speed_exceeded_ = largest_speed_ > window_speed_;
    }
    if (m + 1 >= window.end_micro()) return; // the window ends, so no search needs these states
    update_halo(window, m);
    const PhaseClock::Scope scope(phases_, Phase::search);
    const double reach = reach_of(usual_needs(), window.duration());
    search_.predict_again(population(), discs_.grid(), window, m + 1, reach, hits_, states_);
}

template <class Dynamics>
[[gnu::always_inline]] inline void TimeSteppedEngine<Dynamics>::prefetch(const Candidate& candidate,
                                                                         const DiscStates& results,
                                                                         bool is_last) const {
    for (const LocalIndex index : {candidate.p, candidate.q}) {
        if (index == wall_index) continue;
        __builtin_prefetch(&results[index], 1);
        if (!is_last) discs_.grid().prefetch_flight(index);
    }
}

/// Carries out a collision. Returns the square of the largest speed after it, or 0 for a mirror
/// wall, which does not change speeds. If two ranks carry out the collision, the owner of the first
/// disc adds it to the sums.
template <class Dynamics>
[[gnu::always_inline]] inline double TimeSteppedEngine<Dynamics>::collide(const Candidate& c, int m,
                                                                          DiscStates& results,
                                                                          StressTerms& terms,
                                                                          StressSums& stress) {
    DiscState& p = results[c.p];
    const bool is_summed = this->stress_ && c.p < discs_.n_own();
    if (c.is_wall()) {
        const WallStress<Dynamics> before(p);
        StepWalls(dynamics_).bounce(p, m, c.time, spin_of(c.p));
        if (is_summed) before.add_to(terms, stress, dynamics_, p, m + c.time, this->flown_before_);
        return Dynamics::has_mirror_walls ? 0 : squared_speed_of(p);
    }
    DiscState& q = results[c.q];
    const PairStress<Dynamics> before(p, q);
    const Separation to = is_summed ? dynamics_.separation_at(p, q, m + c.time) : Separation{};
    // Spins do not affect the search, so they change immediately, even in a divided micro-step.
    dynamics_.collide(p, q, m + c.time, Dynamics::never, {spin_of(c.p), spin_of(c.q)});
    StepWalls(dynamics_).stop(p, m, c.time);
    StepWalls(dynamics_).stop(q, m, c.time);
    if (is_summed) {
        [[maybe_unused]] const double impulse = before.add_to(terms, stress, dynamics_, p, q, to,
                                                              m + c.time, this->flown_before_);
        if constexpr (Dynamics::has_moving_images)
            if (const double slip = dynamics_.periods().between(p, q, 0).vx;
                this->work_ && slip != 0) {
                const double work = impulse * slip;
#pragma omp atomic
                *this->work_ += work;
            }
    }
    if constexpr (Dynamics::has_moving_images) // halo discs count on their own ranks
        return std::max(c.p < discs_.n_own() ? dynamics_.squared_speed(p) : 0,
                        c.q < discs_.n_own() ? dynamics_.squared_speed(q) : 0);
    return std::max(squared_speed_of(p), squared_speed_of(q));
}

/// Carries out the kept candidates and returns the largest speed afterwards. Unless the window
/// ends here, records the discs, because their contacts must be predicted again.
template <class Dynamics>
double TimeSteppedEngine<Dynamics>::collide_all(const Window& window, int m, DiscStates& results) {
    constexpr std::int64_t prefetch_distance = 16;
    const bool is_last = m + 1 >= window.end_micro();
    const Candidates& kept = verdicts_.kept;
    const auto n_kept = static_cast<std::int64_t>(kept.size());
    hits_.resize(is_last ? 0 : 2 * kept.size());
    double fastest = 0;
#pragma omp parallel num_threads(tuning_.threads) reduction(max : fastest) if (n_kept > 256)
    {
        StressSums stress = this->no_stress_;
        StressTerms terms;
#pragma omp for schedule(static)
        for (std::int64_t k = 0; k < n_kept; ++k) {
            if (k + prefetch_distance < n_kept)
                prefetch(kept[static_cast<std::size_t>(k + prefetch_distance)], results, is_last);
            const Candidate& c = kept[static_cast<std::size_t>(k)];
            fastest = std::max(fastest, collide(c, m, results, terms, stress));
            if (is_last) continue;
            const auto place = static_cast<std::size_t>(2 * k);
            hits_[place] = c.p;
            hits_[place + 1] = c.q;
            for (const LocalIndex index : {c.p, c.q}) {
                if (index == wall_index) continue;
                states_[index] = window.state_after(m);
                update_flight(index, results[index]);
            }
        }
        terms.add_to(stress);
#pragma omp critical(stress)
        if (this->stress_) *this->stress_ += stress;
    }
    return std::sqrt(fastest);
}

/// Keeps the largest speed before the sync, because the next migration also covers earlier flights.
template <class Dynamics> void TimeSteppedEngine<Dynamics>::finish_sync(double largest_speed) {
    unchanged_until_ -= time_;
    if constexpr (Dynamics::has_moving_images) search_.change_dynamics(dynamics_);
    const PhaseClock::Scope wait(phases_, Phase::wait);
    refreshed_speed_ = communicator_.max(largest_speed);
    const auto n_kept = communicator_.sum(n_kept_ - std::exchange(n_kept_at_sync_, n_kept_));
    hits_per_micro_step_ = 2 * static_cast<double>(n_kept) /
                           (std::max(static_cast<double>(discs_.n_total()), 1.0) *
                            static_cast<double>(this->sync_every_));
}

/// The next migration covers flights with the new velocities, so the largest speed includes them.
template <class Dynamics> void TimeSteppedEngine<Dynamics>::take_speed(double largest_speed) {
    refreshed_speed_ = communicator_.max(largest_speed);
    largest_speed_ = std::max(largest_speed_, refreshed_speed_);
}

std::unique_ptr<Engine> make_time_stepped_engine(const SceneParameters& scene, StoredState state,
                                                 const Communicator& communicator,
                                                 const Tuning& tuning) {
    return with_dynamics_of(scene, [&]<class Dynamics>() -> std::unique_ptr<Engine> {
        return std::make_unique<TimeSteppedEngine<Dynamics>>(scene, std::move(state), communicator,
                                                             tuning);
    });
}

} // namespace carrom
