// SPDX-License-Identifier: BSD-3-Clause
#include "engine/engine_base.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "engine/admission.hpp"
#include "engine/dynamics_of_scene.hpp"
#include "engine/long_flights.hpp"
#include "engine/near_pairs.hpp"
#include "engine/state_sums.hpp"
#include "engine/stretch_room.hpp"
#include "engine/window_choice.hpp"

namespace carrom {

namespace {

/// Settings for ranks that share a strip. The first one is the usual depth of a halo, in mean
/// distances between discs: one reach of the time-stepped method, or three reaches of the
/// event-driven method, whose windows are longer (tests/performance/rank_loads.cpp).
GroupChoice group_choice(Method method, const Tuning& tuning) {
    return {method == Method::time_stepped ? 1.2 : 10, tuning.ranks_across};
}

} // namespace

template <class Dynamics>
EngineBase<Dynamics>::EngineBase(const SceneParameters& scene, StoredState state,
                                 const Communicator& communicator, const Tuning& tuning)
    : communicator_(communicator), tuning_(tuning),
      dynamics_(dynamics_of<Dynamics>(scene, SyncAction::box_at(scene, state.kept_by_effects))),
      micro_steps_(scene.micro_steps), sync_every_(scene.sync_every),
      discs_(communicator, box(), std::move(state.discs), scene.effects.periods(box()),
             stored_columns(dynamics_, scene, state), tuning.threads,
             group_choice(scene.method, tuning)),
      n_micro_done_(state.micro_steps_done), species_(dynamics_.species_table()),
      sync_action_(scene, species_, communicator, tuning.threads), flight_length_(flight_length()),
      last_micro_step_(scene.steps * scene.micro_steps) {
    sync_action_.go_on(state.kept_by_effects);
    flown_before_ = static_cast<double>(last_sync() % flight_length_);
    dynamics_.begin_interval(last_sync());
    if (sync_action_.sizes()) dynamics_.resize(size());
    time_ = dynamics_.clock_at(static_cast<double>(n_micro_done_ % sync_every_));
    if constexpr (Dynamics::is_for_study) {
        for (DiscState& disc : discs_.all()) Dynamics::round(disc);
    }
    if constexpr (Dynamics::is_periodic) discs_.set_periods(dynamics_.periods());
    largest_speed_ = std::sqrt(squared_speed_of_own(time_));
}

/// The number of micro-steps between additions of flights to the sums of stress: the interval of
/// syncs if syncs change velocities, otherwise up to longest_flight.
template <class Dynamics> std::int64_t EngineBase<Dynamics>::flight_length() const {
    const bool sync_changes_velocities = Dynamics::has_moving_images || dynamics_.has_own_frame() ||
                                         sync_action_.has_effects();
    if (sync_changes_velocities) return sync_every_;
    return std::max<std::int64_t>(1, longest_flight / sync_every_) * sync_every_;
}

template <class Dynamics> void EngineBase<Dynamics>::distribute() {
    set_departed_aside();
    discs_.rebalance(time_, tuning_.rebalance_above, {discs_.n_own(), 0});
    redistribute_now(0, Covered::domain); // these cells show where discs are clustered
}

template <class Dynamics> void EngineBase<Dynamics>::set_departed_aside() {
    if (dynamics_.has_open_sides()) discs_.set_departed_aside();
}

template <class Dynamics>
void EngineBase<Dynamics>::redistribute_now(double least_reach, Covered covered) {
    bring_states();
    if (is_in_window_) leave_window();
    is_redistributed_ = true;
    set_departed_aside();
    migrate();
    const double radius = dynamics_.radius() * dynamics_.size_at(time_) + dynamics_.slack();
    const double touching = reach_of(
        {dynamics_.box(), radius, static_cast<double>(discs_.n_total()), 0, 0, 0}, 0);
    const double reach = std::max(touching, least_reach);
    Extent seen = discs_.extent_seen(extent(), reach);
    if (covered == Covered::discs) seen = where_discs_are(seen, reach);
    const GridGeometry geometry = make_sparse_geometry(seen, discs_.domains().axis(), reach,
                                                       discs_.n_own());
    discs_.sort_cells(geometry, time_);
    const PhaseClock::Scope scope(phases_, Phase::exchange);
    discs_.fetch_halo(time_, reach, nullptr);
}

/// The part of `seen` that contains the own discs and their partners within `reach`, or all of
/// `seen` if that part is not much smaller. Discs outside count in the nearest cell.
template <class Dynamics>
Extent EngineBase<Dynamics>::where_discs_are(const Extent& seen, double reach) const {
    constexpr double small = 0.25; // largest area of the part, relative to `seen`
    const std::span<const DiscState> discs = own();
    if (discs.empty()) return seen;
    Extent part = {seen.x_high, seen.x_low, seen.y_high, seen.y_low};
    double &x_low = part.x_low, &x_high = part.x_high, &y_low = part.y_low, &y_high = part.y_high;
#pragma omp parallel for num_threads(tuning_.threads) schedule(static)                             \
    reduction(min : x_low, y_low) reduction(max : x_high, y_high)
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const double x = discs[i].x_at(time_), y = discs[i].y_at(time_);
        x_low = std::min(x_low, x);
        x_high = std::max(x_high, x);
        y_low = std::min(y_low, y);
        y_high = std::max(y_high, y);
    }
    part = {std::max(seen.x_low, x_low - reach), std::min(seen.x_high, x_high + reach),
            std::max(seen.y_low, y_low - reach), std::min(seen.y_high, y_high + reach)};
    return part.size().area() < small * seen.size().area() ? part : seen;
}

template <class Dynamics>
void EngineBase<Dynamics>::refuse_long_flights([[maybe_unused]] double speed) const {
    if constexpr (Dynamics::is_periodic) {
        constexpr double most = 15000; // image counts are limited to 16000 (core/image.hpp)
        const std::int64_t left = last_micro_step_ - last_sync();
        const auto interval = static_cast<double>(left > 0 ? std::min(sync_every_, left)
                                                           : sync_every_);
        double lengths = most_lengths(discs_.periods(), speed, speed, interval);
        // a second test, because in a flow discs are far faster along x than along y
        if (lengths > most && Dynamics::has_moving_images)
            lengths = most_lengths(discs_.periods(), speed, communicator_.max(fastest_up(own())),
                                   interval);
        if (lengths <= most) return;
        throw CollectiveError(fmt::format(
            "at step {:.9g} the fastest disc flies {:.3g} times through the periodic box from one "
            "sync to the next; this version counts to {:g}: set time.sync_every to less, or let "
            "discs become less fast",
            (static_cast<double>(last_sync()) + time_) / static_cast<double>(micro_steps_), lengths,
            most));
    }
}

/// Stops no later than at the end of the step that contains the next sync, because a stop there
/// takes no extra time.
template <class Dynamics> void EngineBase<Dynamics>::advance_towards(std::int64_t last_step) {
    const std::int64_t step_after_sync = (last_sync() + sync_every_ + micro_steps_ - 1) /
                                         micro_steps_;
    const std::int64_t stop = std::min(last_step, step_after_sync) * micro_steps_;
    if (time_ != 0) windows_pass_stops_ = !is_redistributed_;
    is_redistributed_ = false;
    stop_interval_ = std::gcd(stop_interval_, stop - n_micro_done_);
    while (n_micro_done_ < stop) {
        const std::int64_t next_sync = last_sync() + sync_every_;
        if (n_micro_done_ == last_sync() && sync_action_.begins()) let_effects_begin();
        advance_to(std::min(stop, next_sync));
        if (n_micro_done_ == next_sync) sync();
    }
    if (time_ != 0) discs_.forget_images(); // at time 0, after a sync, there are no images
    if (n_micro_done_ != last_micro_step_) return;
    if (is_in_window_) leave_window();
    drop_scratch(); // frees memory for the output that follows a run
}

template <class Dynamics> std::int64_t EngineBase<Dynamics>::horizon_of(std::int64_t target) const {
    if (!windows_pass_stops_) return target;
    return std::max(target, std::min(last_sync() + sync_every_, last_micro_step_));
}

template <class Dynamics> void EngineBase<Dynamics>::sync() {
    const PhaseClock::Scope scope(phases_, Phase::sync);
    double largest_speed = restart_states();
    dynamics_.begin_interval(last_sync());
    if constexpr (Dynamics::is_periodic) discs_.set_periods(dynamics_.periods());
    if (sync_action_.has_effects()) largest_speed = let_effects_act();
    if (sync_action_.sizes()) change_volume();
    DiscSource* const source = Dynamics::may_lose_discs ? sync_action_.source() : nullptr;
    if (source) largest_speed = std::max(largest_speed, let_discs_in(*source));
    finish_sync(largest_speed);
    // the next migration also needs the speed of the discs that came in
    if (source) take_speed(largest_speed);
    redistributed_time_ -= time_;
    time_ = 0;
    stop_interval_ = 0;
    ++n_syncs_;
    if (tuning_.rebalance_every == 0 || n_syncs_ % tuning_.rebalance_every != 0) return;
    const PhaseClock::Scope wait(phases_, Phase::wait);
    discs_.rebalance(0, tuning_.rebalance_above, std::exchange(rank_work_, {}));
}

template <class Dynamics> bool EngineBase<Dynamics>::begin_flights() {
    const bool ends_flights = n_micro_done_ % flight_length_ == 0;
    flown_before_ = ends_flights ? 0 : flown_before_ + time_;
    return ends_flights;
}

template <class Dynamics> double EngineBase<Dynamics>::restart_states() {
    discs_.forget_halo();
    DiscStates& discs = discs_.all();
    const auto n = static_cast<std::int64_t>(discs.size());
    const bool frame_moves = dynamics_.frame_at(time_).is_moving;
    const FlightIntegral flight = flight_integral();
    const bool ends_flights = begin_flights();
    double fastest = 0;
    const bool is_work_asked = Dynamics::has_moving_images && work_ != nullptr;
    if (is_work_asked) *work_ -= energy_of_own();
#pragma omp parallel num_threads(tuning_.threads) reduction(max : fastest)
    {
        StressSums flights = no_stress_;
        StressTerms terms;
#pragma omp for schedule(static)
        for (std::int64_t i = 0; i < n; ++i) {
            DiscState& disc = discs[static_cast<std::size_t>(i)];
            if (Dynamics::may_lose_discs && disc.has_departed()) continue;
            if (ends_flights) terms.add_flight(dynamics_.mass_of(disc), disc, flight, flights);
            Dynamics::advance(disc, time_);
            if (frame_moves) dynamics_.restart_frame(disc, time_);
            if constexpr (Dynamics::is_periodic) this->wrap(disc);
            disc.tau = 0;
            disc.has_collided = 0;
            fastest = std::max(fastest, dynamics_.squared_speed(disc));
        }
        terms.add_to(flights);
        flights.energy += flights.xx;
        flights.energy += flights.yy;
#pragma omp critical(stress)
        if (stress_ && ends_flights) *stress_ += flights;
    }
    if (is_work_asked) *work_ += energy_of_own();
    return std::sqrt(fastest);
}

/// Returns the largest speed of own discs after the effects.
template <class Dynamics> double EngineBase<Dynamics>::let_effects_act() {
    if (this->before_effects_) {
        const double end = std::exchange(time_, 0); // all states are at time 0 already
        this->before_effects_();
        time_ = end;
    }
    const std::int64_t n_syncs = n_micro_done_ / sync_every_;
    const double reach = sync_action_.reach(n_syncs);
    if (reach > 0) fetch_neighbours(reach * size());
    sync_action_.act(
        discs_, n_syncs,
        {&this->wall_followers_, &this->pair_followers_, this->stress_, n_micro_done_},
        [this, reach](const SyncDiscs::VisitNear& visit) { visit_neighbours(reach, visit); });
    if (reach > 0) forget_neighbours();
    return largest_speed_of_all_states();
}

/// Lets effects act before the flights that follow a sync, also if a restart begins at this sync.
template <class Dynamics> void EngineBase<Dynamics>::let_effects_begin() {
    const PhaseClock::Scope scope(phases_, Phase::sync);
    discs_.forget_halo(); // the halo still has velocities from before the effects
    sync_action_.begin(discs_, n_micro_done_ / sync_every_);
    take_speed(largest_speed_of_all_states());
}

template <class Dynamics> double EngineBase<Dynamics>::largest_speed_of_all_states() const {
    double fastest = 0;
    const std::span<const DiscState> discs = own();
#pragma omp parallel for num_threads(tuning_.threads) schedule(static) reduction(max : fastest)
    for (std::size_t i = 0; i < discs.size(); ++i)
        fastest = std::max(fastest, dynamics_.squared_speed(discs[i]));
    return std::sqrt(fastest);
}

/// Lets an effect change all radii and, if there is such an effect, the ratio of the box's sides,
/// at most until the closest two discs touch. All states are those after the sync, at time 0.
template <class Dynamics> void EngineBase<Dynamics>::change_volume() {
    SizeChange& sizes = *sync_action_.sizes();
    ShapeChange* const shape = sync_action_.shape();
    const std::int64_t n_syncs = n_micro_done_ / sync_every_;
    const double stretch = shape ? shape->largest_stretch() : 1;
    fetch_neighbours(dynamics_.search_diameter() * sizes.largest_at(n_syncs) * stretch);
    const auto touching = [this] { return touching_of(dynamics_, 0, discs_.periods()); };
    const double room = largest_size(population(), discs_.grid(), touching(), communicator_,
                                     tuning_.threads);
    sizes.change(n_syncs, room);
    dynamics_.resize(sizes.size());
    if (shape)
        shape->stretch(n_syncs, stretch_room(population(), discs_.grid(), touching(),
                                             place_margin(), communicator_, tuning_.threads));
    forget_neighbours();
    if (shape) reshape(shape->box());
}

/// Stretches the box and the positions of all discs. States are those after the sync, at time 0.
template <class Dynamics> void EngineBase<Dynamics>::reshape(const Box& box) {
    dynamics_.reshape(box);
    discs_.reshape(box);
    for (DiscState& disc : discs_.own()) wrap(disc);
}

/// Fetches a halo in the middle of a sync, when all states are at time 0 already.
template <class Dynamics> void EngineBase<Dynamics>::fetch_neighbours(double reach) {
    const double end = std::exchange(time_, 0);
    redistributed_time_ -= end;
    redistribute_now(reach);
    redistributed_time_ += end;
    time_ = end;
}

/// Lets departed discs come in through inlets. All states are at the time of the sync. Returns the
/// largest speed of the discs that came in.
template <class Dynamics> double EngineBase<Dynamics>::let_discs_in(DiscSource& source) {
    const std::vector<Arrival> arrivals = source.arrivals(n_micro_done_ / sync_every_);
    if (arrivals.empty()) return 0;
    discs_.set_departed_aside();
    const Admission admission = admit(
        arrivals,
        {communicator_, dynamics_.box(), species_, dynamics_.radius(), dynamics_.has_pairs(),
         discs_.own(), discs_.departed(), discs_.departed_columns(),
         [this](const DiscState& from, const DiscState& to, double time) {
             return dynamics_.is_way_free(from, to, time);
         }});
    discs_.take_back(admission.discs);
    source.count(admission.counts);
    double fastest = 0;
    for (const ReturningDisc& disc : admission.discs)
        fastest = std::max(fastest, dynamics_.squared_speed(disc.state));
    return std::sqrt(fastest);
}

template <class Dynamics> void EngineBase<Dynamics>::forget_neighbours() {
    discs_.forget_images(true);
    discs_.forget_halo();
}

/// Calls `visit` with distances divided by size(), because an effect may have changed all radii by
/// this factor.
template <class Dynamics>
void EngineBase<Dynamics>::visit_neighbours(double reach, const SyncDiscs::VisitNear& visit) const {
    visit_pairs_within(discs_.grid(), population(), discs_.periods(), size(), reach, visit);
}

template <class Dynamics> double EngineBase<Dynamics>::squared_speed_of_own(double time) const {
    const std::span<const DiscState> discs = own();
    double fastest = 0;
#pragma omp parallel for num_threads(tuning_.threads) schedule(static) reduction(max : fastest)
    for (std::size_t i = 0; i < discs.size(); ++i)
        fastest = std::max(fastest, dynamics_.squared_speed_at(discs[i], time));
    return fastest;
}

template <class Dynamics> double EngineBase<Dynamics>::energy_of_own() const {
    double energy = 0;
    for (const DiscState& disc : own())
        energy += 0.5 * dynamics_.mass_of(disc) * squared_speed_of(disc);
    return energy;
}

/// Brings a state that a sync has changed into the box. Threads call it for different discs.
template <class Dynamics> void EngineBase<Dynamics>::wrap(DiscState& disc) {
    if constexpr (Dynamics::is_periodic) {
        const double x = disc.x, y = disc.y;
        dynamics_.wrap(disc);
        set_image(disc, {});
        if (!crossings_.empty() && (x != disc.x || y != disc.y))
            record_crossing(disc, x, y, dynamics_.periods());
    }
}

template <class Dynamics> void EngineBase<Dynamics>::add_to(Totals& totals) {
    redistribute_now();
    if (dynamics_.has_pairs())
        measure_overlaps(population(), discs_.grid(), time_,
                         touching_of(dynamics_, time_, discs_.periods()), communicator_,
                         tuning_.threads, totals);
    forget_images();
}

template <class Dynamics> LocalView EngineBase<Dynamics>::local_view(double reach) {
    redistribute_now(reach * (1 + 1e-6));
    return {population(),     &discs_.grid(), &discs_.domains(), time_, frame(),
            discs_.periods(), size()};
}

template <class Dynamics> Extent EngineBase<Dynamics>::extent() const {
    Extent box = dynamics_.extent_at(time_);
    const Periods& periods = discs_.periods();
    if (periods.x != 0) box.x_low = 0, box.x_high = periods.x;
    if (periods.y != 0) box.y_low = 0, box.y_high = periods.y;
    return box;
}

/// In a periodic box the frame counts as moving, because positions must be brought into the box.
template <class Dynamics> Frame EngineBase<Dynamics>::frame() const {
    Frame frame = dynamics_.frame_at(time_);
    if (!discs_.periods().are_any()) return frame;
    frame.periods = discs_.periods();
    frame.clock = time_;
    frame.is_moving = true;
    return frame;
}

#define CARROM_DEFINE(Dynamics) template class EngineBase<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom
