// SPDX-License-Identifier: BSD-3-Clause
#include "grading/rule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "dynamics/pair_contact.hpp"

namespace carrom {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

void advance(DiscState& disc, double time) {
    const double x = disc.x_at(time), y = disc.y_at(time);
    disc.x = x;
    disc.y = y;
    disc.tau = time;
}

bool is_wall(const PlainRule::Candidate& candidate) { return candidate.q == Collision::wall; }

/// The total order of candidates: by time, the lower id, wall before pair, then the other id.
auto place_in_order(const PlainRule::Candidate& c) {
    return std::make_tuple(c.t, c.p, is_wall(c) ? 0 : 1, c.q);
}

/// The key by which a program with this mistake sorts its candidates.
std::tuple<double, double, double, double> place_by_mistake(const PlainRule::Candidate& c,
                                                            Mistake mistake) {
    const double t = c.t, p = static_cast<double>(c.p), pair = is_wall(c) ? 0 : 1,
                 q = is_wall(c) ? -1 : static_cast<double>(c.q);
    if (mistake == Mistake::ties_by_higher_id) return {t, -p, pair, -q};
    if (mistake == Mistake::pair_before_wall) return {t, -pair, p, q};
    if (mistake == Mistake::order_of_ids) return {p, pair, q, t};
    if (mistake == Mistake::walls_first) return {pair, t, p, q};
    return {-pair, t, p, q}; // the mistake pairs_first
}

bool sorts_otherwise(Mistake mistake) {
    return mistake == Mistake::ties_by_higher_id || mistake == Mistake::pair_before_wall ||
           mistake == Mistake::order_of_ids || mistake == Mistake::walls_first ||
           mistake == Mistake::pairs_first;
}

} // namespace

/// A rectangle that contains all of a disc during a micro-step, if the disc flies straight.
struct PlainRule::Path {
    double x_low, x_high, y_low, y_high;
    const DiscState* disc;
};

PlainRule::PlainRule(const RuleSetting& setting, std::vector<DiscState> discs,
                     std::int64_t micro_steps_done, Mistake mistake, DiscId subject)
    : setting_(setting), x_walls_(setting.box.x, setting.radius, 1e-8 * setting.radius),
      y_walls_(setting.box.y, setting.radius, 1e-8 * setting.radius),
      deepest_overlap_(
          std::max(1e-12 * (2 * setting.radius), 16 * 0x1p-52 * setting.box.longest())),
      mistake_(mistake), subject_(subject), discs_(std::move(discs)),
      micro_steps_(micro_steps_done) {}

void PlainRule::run_micro_step() {
    const double m = clock();
    find_candidates(m);
    sort_candidates();
    if (mistake_ == Mistake::every_collision)
        keep_all_collisions(m);
    else
        keep_candidates(m);
    micro_steps_ += 1;
    if (micro_steps_ % setting_.sync_every == 0) synchronize();
}

void PlainRule::synchronize() {
    for (DiscState& disc : discs_) {
        advance(disc, static_cast<double>(setting_.sync_every));
        disc.tau = 0;
    }
}

void PlainRule::find_candidates(double m) {
    candidates_.clear();
    std::vector<Path> paths;
    const double margin = 1.01 * setting_.radius + 1e-12 * setting_.box.longest();
    for (const DiscState& disc : discs_) {
        const auto [x_low, x_high] = std::minmax({disc.x_at(m), disc.x_at(m + 1)});
        const auto [y_low, y_high] = std::minmax({disc.y_at(m), disc.y_at(m + 1)});
        paths.push_back({x_low - margin, x_high + margin, y_low - margin, y_high + margin, &disc});
        const double t = wall_time(disc, m);
        if (t != never) candidates_.push_back({t, disc.id});
    }
    std::sort(paths.begin(), paths.end(),
              [](const Path& a, const Path& b) { return a.x_low < b.x_low; });
    for (auto a = paths.begin(); a != paths.end(); ++a)
        for (auto b = a + 1; b != paths.end() && b->x_low <= a->x_high; ++b)
            if (b->y_low <= a->y_high && a->y_low <= b->y_high)
                a->disc->id < b->disc->id ? inspect(*a->disc, *b->disc, m)
                                          : inspect(*b->disc, *a->disc, m);
}

void PlainRule::inspect(const DiscState& p, const DiscState& q, double m) {
    const double t = contact_time(p, q, m);
    if (t >= 0 && t <= 1) candidates_.push_back({t, p.id, q.id});
}

/// The contact's time since the micro-step's start; `never` if the discs do not touch.
double PlainRule::contact_time(const DiscState& p, const DiscState& q, double m) const {
    if (const double t = overlap_time(p, q, m); t != never) return t;
    if (mistake_ == Mistake::overlap_at_end) return never;
    const auto contact = pair_contact<double>(p, q, 2 * setting_.radius, deepest_overlap_);
    return contact.exists() ? (contact.base - m) + contact.delay : never;
}

/// The time at which two overlapping discs collide; `never` by the rule, which lets them pass
/// through each other. Some mistakes make them collide.
double PlainRule::overlap_time(const DiscState& p, const DiscState& q, double m) const {
    const double sigma = 2 * setting_.radius;
    const double at = mistake_ == Mistake::overlap_at_end ? m + 1 : m;
    const double dx = q.x_at(at) - p.x_at(at), dy = q.y_at(at) - p.y_at(at);
    const double wx = q.vx - p.vx, wy = q.vy - p.vy;
    const double a = wx * wx + wy * wy, b = dx * wx + dy * wy;
    const double c = dx * dx + dy * dy - sigma * sigma;
    if (c >= -2 * sigma * deepest_overlap_) return never;
    if (mistake_ == Mistake::overlap_collides) return b < 0 ? 0 : never;
    if (mistake_ == Mistake::overlap_parting_collides) return 0;
    if (mistake_ == Mistake::overlap_at_end) return b < 0 ? 1 : never;
    if (mistake_ != Mistake::overlap_leaves || a == 0) return never;
    return (-b + std::sqrt(b * b - a * c)) / a;
}

double PlainRule::wall_time(const DiscState& disc, double m) const {
    return std::min(x_walls_.time(disc.x, disc.vx, disc.tau, m),
                    y_walls_.time(disc.y, disc.vy, disc.tau, m));
}

void PlainRule::sort_candidates() {
    std::sort(candidates_.begin(), candidates_.end(), [this](const auto& a, const auto& b) {
        if (sorts_otherwise(mistake_))
            return place_by_mistake(a, mistake_) < place_by_mistake(b, mistake_);
        return place_in_order(a) < place_in_order(b);
    });
}

void PlainRule::keep_candidates(double m) {
    if (mistake_ == Mistake::each_from_start || mistake_ == Mistake::last_from_start) {
        start_ = discs_;
        for (const Candidate& candidate : candidates_) keep_from_start(candidate, m);
        return;
    }
    std::vector<bool> is_taken(discs_.size(), false);
    for (Candidate& candidate : candidates_) {
        const bool is_free = !is_taken[candidate.p] &&
                             (is_wall(candidate) || !is_taken[candidate.q]);
        if (is_free && (is_first_of_subject(candidate, Mistake::pair_missed) ||
                        is_first_of_subject(candidate, Mistake::wall_missed)))
            continue;
        candidate.is_kept = is_free || mistake_ == Mistake::every_candidate;
        if (is_free || mistake_ == Mistake::first_choices_only) {
            is_taken[candidate.p] = true;
            if (!is_wall(candidate)) is_taken[candidate.q] = true;
        }
        if (candidate.is_kept) keep(candidate, m);
    }
}

/// Whether the mistake affects this candidate: it is the first candidate of disc `subject` of the
/// right kind (wall or pair). Returns true only once.
bool PlainRule::is_first_of_subject(const Candidate& candidate, Mistake mistake) {
    const bool is_its_own = candidate.p == subject_ ||
                            (!is_wall(candidate) && candidate.q == subject_);
    const bool is_its_kind = is_wall(candidate) == (mistake == Mistake::wall_missed);
    if (mistake_ != mistake || has_missed_ || !is_its_own || !is_its_kind) return false;
    has_missed_ = true;
    return true;
}

/// Carries out a micro-step with the mistake every_collision, which is to use the event-driven
/// method: after each collision, new collisions of its discs are searched for.
void PlainRule::keep_all_collisions(double m) {
    const auto sooner = [](const Candidate& a, const Candidate& b) {
        return place_in_order(a) < place_in_order(b);
    };
    std::set<Candidate, decltype(sooner)> due(candidates_.begin(), candidates_.end(), sooner);
    while (!due.empty()) {
        const Candidate next = *due.begin();
        keep(next, m);
        std::erase_if(due, [&next](const Candidate& c) {
            const auto is_hit = [&next](DiscId id) { return id == next.p || id == next.q; };
            return is_hit(c.p) || (!is_wall(c) && is_hit(c.q));
        });
        candidates_.clear();
        for (const DiscId id : {next.p, next.q}) {
            if (id == Collision::wall) continue;
            const DiscState& disc = discs_[id];
            const double t = wall_time(disc, m);
            if (t != never) candidates_.push_back({t, id});
            for (const DiscState& other : discs_)
                if (other.id != id)
                    other.id < id ? inspect(other, disc, m) : inspect(disc, other, m);
        }
        due.insert(candidates_.begin(), candidates_.end());
    }
}

void PlainRule::keep(const Candidate& candidate, double m) {
    DiscState& p = discs_[candidate.p];
    if (is_wall(candidate)) {
        bounce(p, m, candidate.t);
        stop(p, m, candidate.t);
        return;
    }
    DiscState& q = discs_[candidate.q];
    const DiscState before = discs_[subject_];
    collide(p, q, m + candidate.t);
    stop(p, m, candidate.t);
    stop(q, m, candidate.t);
    if (is_first_of_subject(candidate, Mistake::one_disc_only)) discs_[subject_] = before;
}

/// Carries out each collision with the discs as they were at the start of the micro-step, as if it
/// were the only one. A disc then flies on from its last collision. Its changes of velocity add up,
/// or only the last change counts, as in a program that writes the discs to a second array.
void PlainRule::keep_from_start(const Candidate& candidate, double m) {
    const auto change = [this](DiscId id, const DiscState& made) {
        const DiscState& start = start_[id];
        DiscState& disc = discs_[id];
        const bool adds_up = mistake_ == Mistake::each_from_start;
        disc.vx = adds_up ? disc.vx + (made.vx - start.vx) : made.vx;
        disc.vy = adds_up ? disc.vy + (made.vy - start.vy) : made.vy;
        disc.x = made.x;
        disc.y = made.y;
        disc.tau = made.tau;
        if (made.pair_collisions != start.pair_collisions)
            ++disc.pair_collisions;
        else
            ++disc.wall_collisions;
    };
    DiscState p = start_[candidate.p];
    if (is_wall(candidate)) {
        bounce(p, m, candidate.t);
        change(candidate.p, p);
    } else {
        DiscState q = start_[candidate.q];
        collide(p, q, m + candidate.t);
        change(candidate.p, p);
        change(candidate.q, q);
        stop(discs_[candidate.q], m, candidate.t);
    }
    stop(discs_[candidate.p], m, candidate.t);
}

void PlainRule::collide(DiscState& p, DiscState& q, double time) const {
    advance(p, time);
    advance(q, time);
    const double ex = q.x - p.x, ey = q.y - p.y;
    const double share = mistake_ == Mistake::half_impulse ? 0.5 : 1;
    const double k = share * ((q.vx - p.vx) * ex + (q.vy - p.vy) * ey) / (ex * ex + ey * ey);
    p.vx += k * ex;
    p.vy += k * ey;
    q.vx -= k * ex;
    q.vy -= k * ey;
    p.pair_collisions += 1;
    q.pair_collisions += 1;
}

void PlainRule::bounce(DiscState& disc, double m, double t) const {
    const double tx = x_walls_.time(disc.x, disc.vx, disc.tau, m);
    const double ty = y_walls_.time(disc.y, disc.vy, disc.tau, m);
    advance(disc, m + t);
    bool x_reverses = tx == t || x_walls_.touches(disc.x, disc.vx);
    bool y_reverses = ty == t || y_walls_.touches(disc.y, disc.vy);
    // This occurs only with the mistake every_candidate, after an earlier collision of the disc
    if (!x_reverses && !y_reverses) {
        const auto gap = [](const RestingWalls<double>& walls, double x, double v) {
            return v == 0 ? never : v < 0 ? x - walls.low() : walls.high() - x;
        };
        x_reverses = gap(x_walls_, disc.x, disc.vx) <= gap(y_walls_, disc.y, disc.vy);
        y_reverses = !x_reverses;
    }
    if (mistake_ == Mistake::corner_on_one_axis && x_reverses && y_reverses)
        (tx <= ty ? y_reverses : x_reverses) = false;
    if (x_reverses) disc.vx = -disc.vx;
    if (y_reverses) disc.vy = -disc.vy;
    disc.wall_collisions += 1;
}

void PlainRule::stop(DiscState& disc, double m, double t) const {
    if (mistake_ == Mistake::no_stop || mistake_ == Mistake::every_collision) return;
    const double sx = x_walls_.stop(disc.x, disc.vx, 1 - t),
                 sy = y_walls_.stop(disc.y, disc.vy, 1 - t);
    const double s = std::min(sx, sy);
    if (s == never) return;
    if (mistake_ == Mistake::stop_on_one_axis) {
        disc.x += disc.vx * std::min(sx, 1 - t);
        disc.y += disc.vy * std::min(sy, 1 - t);
        disc.tau = m + 1;
        return;
    }
    disc.x += disc.vx * s;
    disc.y += disc.vy * s;
    disc.tau = mistake_ == Mistake::bounce_for_stop ? m + t + s : m + 1;
    if (mistake_ != Mistake::bounce_for_stop && mistake_ != Mistake::stop_reverses) return;
    if (sx == s) disc.vx = -disc.vx;
    if (sy == s) disc.vy = -disc.vy;
}

} // namespace carrom
