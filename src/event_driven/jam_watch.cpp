// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/jam_watch.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

namespace {

/// In one bin radii grow by at most this share of the initial radii.
constexpr double most_in_bin = 0x1p-10;
/// The width of the first bin after a start, relative to the usual width. It is short, because no
/// earlier collision rate is known. Each next bin is twice as long, up to the usual width.
constexpr double first_bin = 0x1p-10;
/// A bin shows a jam only if it has more collisions than this: a fixed number, plus a number for
/// each disc. Fewer collisions are no evidence, and a run needs only about a second for them.
constexpr double enough_of_all = 0x1p20, enough_per_disc = 0x1p6;
constexpr double ever_more = 3, rarer = 4;
/// By the first rule a run ends only if its remaining time is more than this many times the time to
/// the jam, because a dense fluid gains room when it freezes.
constexpr double sure = 2;

} // namespace

JamWatch::JamWatch(const Setting& setting)
    : setting_(setting), width_(setting.interval),
      enough_(enough_of_all + enough_per_disc * setting.n_discs) {
    while (setting.rate * width_ > most_in_bin) width_ /= 2;
}

void JamWatch::start(double time, double sync) {
    if (!is_on()) return;
    sync_ = sync;
    begin_bin(time, first_bin * width_);
}

/// Starts a bin. No bin extends beyond a multiple of the usual width; syncs are at such multiples.
void JamWatch::begin_bin(double begin, double width) {
    if (begin >= setting_.interval) {
        sync_ += setting_.interval;
        begin = 0;
    }
    begin_ = begin;
    end_ = std::min(begin + width, (std::floor(begin / width_) + 1) * width_);
    safe_until_ = sync_ + begin_;
    n_collisions_ = 0;
}

bool JamWatch::add(std::uint64_t n_collisions) {
    n_collisions_ += static_cast<double>(n_collisions);
    if (is_on() && n_collisions_ > limit_) sign_ = Sign::ever_more_frequent;
    return sign_ != Sign::none;
}

bool JamWatch::finish_bin() {
    const double width = end_ - begin_;
    const Past now{sync_ + end_, n_collisions_ / width};
    if (n_collisions_ > enough_)
        if (const Past* const then = when_rarer(now.rate)) {
            const double room = now.time - then->time; // time for which the discs still have room
            if (setting_.end - now.time > sure * room) sign_ = Sign::no_room_left;
        }
    if (width == width_) remember(now);
    begin_bin(end_, std::min(2 * width, width_));
    limit_ = std::max(enough_, ever_more * now.rate * (end_ - begin_));
    return sign_ != Sign::none;
}

void JamWatch::remember(const Past& bin) {
    // Keeps only records whose rates differ by at least this factor, so that the list stays short
    constexpr double step = 1.05;
    while (!pasts_.empty() && pasts_.back().rate >= bin.rate) pasts_.pop_back();
    if (pasts_.empty() || bin.rate > step * pasts_.back().rate) pasts_.push_back(bin);
}

/// The latest recorded bin whose collision rate was at most `rate` / `rarer`, or null.
const JamWatch::Past* JamWatch::when_rarer(double rate) const {
    const auto after = std::ranges::upper_bound(pasts_, rate / rarer, {}, &Past::rate);
    return after == pasts_.begin() ? nullptr : &*(after - 1);
}

} // namespace carrom
