// SPDX-License-Identifier: BSD-3-Clause
#include "engine.hpp"

#include <algorithm>
#include <cmath>

#include <omp.h>

#include "carrom/core/errors.hpp"
#include "carrom/parallel/exchange.hpp"

namespace carrom {

namespace {

/// Windows between two times that states are brought into the order of their cells.
constexpr std::int64_t windows_per_reorder = 8;
/// Room for discs that a window's collisions make faster, before it has to be cut short.
constexpr double speed_allowance = 1.02;

Disc disc_from(const InputDisc& input, std::int64_t micro_steps) {
    const auto k = static_cast<double>(micro_steps);
    Disc disc;
    disc.id = input.id;
    disc.x = input.x;
    disc.y = input.y;
    disc.vx = input.vx / k;
    disc.vy = input.vy / k;
    return disc;
}

Strips equal_strips(double box_size, int n_ranks) {
    std::vector<double> cuts;
    for (int k = 1; k < n_ranks; ++k) cuts.push_back(box_size * k / n_ranks);
    return Strips(cuts);
}

double speed_of(const Disc& disc) { return std::sqrt(disc.vx * disc.vx + disc.vy * disc.vy); }

} // namespace

Simulation::Engine::Engine(const Scene& scene, std::vector<InputDisc> discs, const Communicator& communicator,
                           const Tuning& tuning)
    : communicator_(communicator), tuning_(tuning), law_(scene.box_size, scene.radius), micro_steps_(scene.micro_steps),
      sync_every_(scene.sync_every), n_discs_(communicator.sum(static_cast<std::uint64_t>(discs.size()))),
      strips_(equal_strips(scene.box_size, communicator.size())), settled_strips_(strips_), exchange_(communicator),
      search_(law_, tuning.threads), local_(tuning.threads), across_strips_(communicator) {
    std::vector<std::vector<Disc>> to_owner(static_cast<std::size_t>(communicator.size()));
    if (communicator.size() == 1) {
        discs_.reserve(discs.size());
        for (const InputDisc& input : discs) discs_.push_back(disc_from(input, micro_steps_));
    } else {
        for (const InputDisc& input : discs) {
            to_owner[static_cast<std::size_t>(strips_.owner(input.x))].push_back(disc_from(input, micro_steps_));
        }
        discs = {};
        discs_ = send_to_owners(communicator, to_owner).items;
    }
    n_own_ = discs_.size();
    for (const Disc& disc : discs_) largest_speed_ = std::max(largest_speed_, speed_of(disc));
    rebalance();
}

void Simulation::Engine::advance_towards(std::int64_t last_step) {
    const std::int64_t next_sync = n_micro_done_ - micro_ + sync_every_;
    const std::int64_t good_stop = (next_sync + micro_steps_ - 1) / micro_steps_ * micro_steps_;
    const std::int64_t stop = std::min(last_step * micro_steps_, good_stop);
    while (n_micro_done_ < stop) {
        run_window(static_cast<int>(std::min(stop - n_micro_done_, sync_every_ - micro_)));
        if (micro_ == sync_every_) sync();
    }
}

/// Runs one window of at most `n_left` micro-steps: to its end, or to where discs have become too fast for it.
void Simulation::Engine::run_window(int n_left) {
    const Window window = settle(n_left);
    {
        const PhaseClock::Scope scope(clock_, Phase::search);
        search_.predict_all(population(), grid_, window);
    }
    int m = window.first_micro;
    while (m < window.end_micro() && run_micro_step(window, m)) ++m;
    ++n_windows_;
    if (window.is_part()) {
        if (++part_ < n_parts_) return;
        discs_.swap(outcomes_);
        outcomes_.clear();
        in_parts_ = false;
        part_ = 0;
        // A taken disc was settled where it would have come without its collision: as far again from where it is.
        settled_time_ = m - 2.0;
    }
    n_micro_done_ += m - window.first_micro;
    micro_ = m;
}

/// Brings every disc to its strip, the halo to every strip and all into cells, for the window that it chooses.
Window Simulation::Engine::settle(int n_left) {
    const PhaseClock::Scope scope(clock_, Phase::settle);
    if (part_ == 0 && n_windows_ % windows_per_reorder == 0 && n_windows_ > 0) {
        grid_.reorder(discs_, n_own_, tuning_.threads);
    }
    discs_.resize(n_own_);
    if (in_parts_) outcomes_.resize(n_own_);
    migrate();
    const Window window = choose(n_left);
    const double reach = reach_of(window_needs(), window.duration());
    fetch_halo(window.begin(), reach);
    build_grid(window.begin(), window.duration(), reach);
    return window;
}

void Simulation::Engine::settle_now() {
    discs_.resize(n_own_);
    migrate();
    const double reach = reach_of({law_.box_size(), law_.radius(), static_cast<double>(n_discs_), 0}, 0);
    fetch_halo(micro_, reach);
    build_grid(micro_, 1, reach);
}

void Simulation::Engine::build_grid(double time, double duration, double reach) {
    const double x_low = std::max(0.0, strips_.low(communicator_.rank()) - reach);
    const double x_high = std::min(law_.box_size(), strips_.high(communicator_.rank()) + reach);
    const GridFrame frame = make_frame(x_low, x_high, 0, law_.box_size(), reach, discs_.size(), tuning_.cell_width.value_or(0));
    grid_.build(discs_, frame, time, duration, tuning_.threads);
    is_hit_.resize(discs_.size(), 0);
}

Window Simulation::Engine::choose(int n_left) {
    Window window;
    window.first_micro = micro_;
    if (part_ == 0) {
        window_speed_ = largest_speed_ * speed_allowance;
        speed_exceeded_ = false;
        const WindowChoice choice = choose_window(window_needs(), n_left, tuning_.window);
        window.n_micro = choice.n_micro;
        n_parts_ = choice.n_parts;
        in_parts_ = n_parts_ > 1;
        if (in_parts_) outcomes_ = discs_;
    }
    if (n_parts_ > 1) {
        window.part_begin = static_cast<double>(part_) / n_parts_;
        window.part_end = static_cast<double>(part_ + 1) / n_parts_;
    }
    return window;
}

WindowNeeds Simulation::Engine::window_needs() const {
    return {law_.box_size(), law_.radius(), static_cast<double>(n_discs_), window_speed_};
}

void Simulation::Engine::migrate() {
    const double time = micro_ + static_cast<double>(part_) / n_parts_;
    if (part_ == 0) {
        const PhaseClock::Scope scope(clock_, Phase::wait);
        travel_speed_ = largest_speed_ = communicator_.max(largest_speed_);
    }
    const double farthest = travel_speed_ * (time - settled_time_) * (1 + 1e-6) + 64 * 0x1p-53 * law_.box_size();
    const TransferPlan plan = plan_migration(settled_strips_, strips_, communicator_.rank(), own(), time, farthest);
    settled_strips_ = strips_;
    settled_time_ = time;
    if (refreshed_speed_ > 0) largest_speed_ = std::exchange(refreshed_speed_, 0);
    if (communicator_.size() == 1) return;
    const PhaseClock::Scope scope(clock_, Phase::exchange);
    Received<Disc> arrived;
    const auto move_along = [&](std::vector<Disc>& values) {
        transfer(exchange_, plan, std::span<const Disc>(values), arrived);
        remove_leaving(plan, values);
        values.insert(values.end(), arrived.items.begin(), arrived.items.end());
    };
    move_along(discs_);
    if (in_parts_) move_along(outcomes_);
    n_own_ = discs_.size();
}

void Simulation::Engine::fetch_halo(double time, double reach) {
    halo_plan_ = plan_halo(strips_, communicator_.rank(), own(), time, reach);
    if (communicator_.size() == 1) return;
    const PhaseClock::Scope scope(clock_, Phase::exchange);
    Received<Disc> halo;
    const auto append = [&](std::vector<Disc>& values) {
        transfer(exchange_, halo_plan_, std::span<const Disc>(values), halo);
        values.insert(values.end(), halo.items.begin(), halo.items.end());
    };
    append(discs_);
    if (in_parts_) append(outcomes_);
    halo_offsets_.clear();
    for (const std::size_t offset : halo.offsets) halo_offsets_.push_back(n_own_ + offset);
    is_shown_.assign(n_own_, 0);
    for (const std::vector<LocalIndex>& shown : halo_plan_.leaving) {
        for (const LocalIndex index : shown) is_shown_[index] = 1;
    }
}

/// Decides and applies micro-step m. False, with nothing done, if discs have become faster than the window allows for.
bool Simulation::Engine::run_micro_step(const Window& window, int m) {
    {
        const PhaseClock::Scope scope(clock_, Phase::resolve);
        search_.collect(population(), window, m, live_);
    }
    std::uint64_t n_candidates = 0;
    for (const Candidate& candidate : live_) n_candidates += candidate.p < n_own_;
    if (in_parts_) strike_taken(live_);
    {
        const PhaseClock::Scope scope(clock_, Phase::resolve);
        local_.resolve(population(), live_, verdicts_);
    }
    // Within a micro-step no disc flies on after its collision, so only later ones have to worry about its speed.
    std::uint64_t news[2] = {verdicts_.undecided.size(), speed_exceeded_ && m > window.first_micro ? 1u : 0u};
    if (communicator_.size() > 1) {
        const PhaseClock::Scope scope(clock_, Phase::wait);
        communicator_.sum(news);
    }
    if (news[1] > 0) return false;
    if (news[0] > 0) {
        const PhaseClock::Scope scope(clock_, Phase::contested);
        across_strips_.decide(population(), verdicts_.undecided, news[0], verdicts_.kept);
    }
    n_candidates_ += n_candidates;
    for (const Candidate& candidate : verdicts_.kept) n_kept_ += candidate.p < n_own_;
    apply(window, m);
    return true;
}

/// Candidates with a disc that an earlier part of this micro-step has taken are lost, but they were candidates.
void Simulation::Engine::strike_taken(std::vector<Candidate>& live) const {
    const auto is_taken = [&](LocalIndex index) { return outcomes_[index].version() != discs_[index].version(); };
    std::erase_if(live, [&](const Candidate& c) { return is_taken(c.p) || (!c.is_wall() && is_taken(c.q)); });
}

void Simulation::Engine::apply(const Window& window, int m) {
    std::vector<Disc>& results = in_parts_ ? outcomes_ : discs_;
    {
        const PhaseClock::Scope scope(clock_, Phase::move);
        const auto n_kept = static_cast<std::int64_t>(verdicts_.kept.size());
        double fastest = 0;
#pragma omp parallel for num_threads(tuning_.threads) schedule(static) reduction(max : fastest) if (n_kept > 256)
        for (std::int64_t k = 0; k < n_kept; ++k) {
            const Candidate& c = verdicts_.kept[static_cast<std::size_t>(k)];
            if (c.is_wall()) {
                law_.bounce(results[c.p], m, c.time);
            } else {
                law_.collide(results[c.p], results[c.q], m, c.time);
                fastest = std::max({fastest, speed_of(results[c.p]), speed_of(results[c.q])});
            }
        }
        speed_exceeded_ = fastest > window_speed_;
        largest_speed_ = std::max(largest_speed_, fastest);
    }
    if (m + 1 >= window.end_micro()) return;
    remember_hits();
    if (communicator_.size() > 1) tell_neighbours();
    const PhaseClock::Scope scope(clock_, Phase::search);
    for (const LocalIndex index : hits_) grid_.update_flight(index, discs_[index]);
    search_.predict_again(population(), grid_, window, m + 1, hits_, is_hit_);
    for (const LocalIndex index : hits_) is_hit_[index] = 0;
}

void Simulation::Engine::remember_hits() {
    hits_.clear();
    for (const Candidate& c : verdicts_.kept) {
        hits_.push_back(c.p);
        if (!c.is_wall()) hits_.push_back(c.q);
    }
    for (const LocalIndex index : hits_) is_hit_[index] = 1;
}

/// Sends the new states of own discs to the ranks that have them in their halo, and takes over those of the own halo.
void Simulation::Engine::tell_neighbours() {
    struct News {
        Disc disc;
        std::uint64_t place; ///< among the discs that went to this neighbour's halo
    };
    const PhaseClock::Scope scope(clock_, Phase::exchange);
    std::vector<std::vector<News>> out(halo_plan_.partners.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
        const std::vector<LocalIndex>& shown = halo_plan_.leaving[k];
        for (const LocalIndex index : hits_) {
            if (index >= n_own_ || is_shown_[index] == 0) continue;
            const auto place = std::lower_bound(shown.begin(), shown.end(), index);
            if (place == shown.end() || *place != index) continue;
            out[k].push_back({discs_[index], static_cast<std::uint64_t>(place - shown.begin())});
        }
    }
    Received<News> in;
    exchange_.exchange(std::span<const int>(halo_plan_.partners), out, in);
    for (std::size_t k = 0; k < in.n_senders(); ++k) {
        for (const News& news : in.from(k)) {
            const auto index = static_cast<LocalIndex>(halo_offsets_[k] + news.place);
            ensure(discs_[index].id == news.disc.id, "a neighbour's news is about another disc than this rank's halo has");
            discs_[index] = news.disc;
            if (is_hit_[index] != 0) continue;
            is_hit_[index] = 1;
            hits_.push_back(index);
        }
    }
}

void Simulation::Engine::sync() {
    const PhaseClock::Scope scope(clock_, Phase::sync);
    const double time = micro_;
    double fastest = 0;
    const auto n = static_cast<std::int64_t>(n_own_);
#pragma omp parallel for num_threads(tuning_.threads) schedule(static) reduction(max : fastest)
    for (std::int64_t i = 0; i < n; ++i) {
        Disc& disc = discs_[static_cast<std::size_t>(i)];
        Law::advance(disc, time);
        disc.tau = 0;
        fastest = std::max(fastest, disc.vx * disc.vx + disc.vy * disc.vy);
    }
    // Discs may have moved at the old largest speed since they were last settled: the next migration allows for that.
    settled_time_ -= time;
    refreshed_speed_ = communicator_.max(std::sqrt(fastest));
    micro_ = 0;
    ++n_syncs_;
    if (tuning_.rebalance_every > 0 && n_syncs_ % tuning_.rebalance_every == 0) rebalance();
}

/// Moves the cuts to where every rank has the same work ahead; the discs follow when they are settled next.
void Simulation::Engine::rebalance() {
    const auto n_ranks = static_cast<std::uint64_t>(communicator_.size());
    if (n_ranks == 1) return;
    const double largest_share = static_cast<double>(communicator_.max(static_cast<std::uint64_t>(n_own_)) * n_ranks);
    if (largest_share <= tuning_.rebalance_above * static_cast<double>(n_discs_)) return;
    std::vector<std::uint64_t> weights(std::clamp<std::size_t>(256 * n_ranks, 4096, 65536), 0);
    const auto n_bins = static_cast<double>(weights.size());
    for (const Disc& disc : own()) {
        const double bin = disc.x_at(micro_) / law_.box_size() * n_bins;
        weights[static_cast<std::size_t>(std::clamp(bin, 0.0, n_bins - 1))] += 1;
    }
    communicator_.sum(weights);
    strips_ = Strips(balanced_cuts(weights, law_.box_size(), communicator_.size()));
}

} // namespace carrom
