// SPDX-License-Identifier: BSD-3-Clause
// Jams are detected if collision rates follow the law of a jam, and not otherwise.
#include "event_driven/jam_watch.hpp"

#include <cmath>
#include <cstdint>

#include "catch.hpp"

using namespace carrom;

namespace {

struct Ending {
    JamWatch::Sign sign = JamWatch::Sign::none;
    double safe = 0;
};

/// Runs to the end or to a jam. `before(t)` is the number of collisions before the time t. The
/// windows cut each bin into `n_windows`.
template <class Before>
Ending watch(const JamWatch::Setting& growth, double start, int n_windows, const Before& before) {
    JamWatch watched(growth);
    double sync = std::floor(start / growth.interval) * growth.interval, time = start - sync;
    watched.start(time, sync);
    while (sync + time < growth.end) {
        const double end = watched.bin_end(), width = (end - time) / n_windows;
        for (int k = 0; k < n_windows; ++k) {
            const double begin = sync + time + k * width;
            const double n = std::min(1e15, before(begin + width) - before(begin));
            if (watched.add(static_cast<std::uint64_t>(n)))
                return {JamWatch::Sign::ever_more_frequent, watched.safe_until()};
        }
        time = end;
        if (watched.finish_bin()) return {JamWatch::Sign::no_room_left, watched.safe_until()};
        if (time == growth.interval) sync += time, time = 0;
    }
    return {};
}

/// Collisions at the rate a / (t_J - t)^2.
auto jam_at(double jam, double a) {
    return [=](double t) { return t < jam ? a / (jam - t) : 1e300; };
}

} // namespace

TEST_CASE("a jam before the end is found, near it, whatever the windows are") {
    const JamWatch::Setting growth{0.001, 64, 735, 200};
    for (const double a : {1e5, 8e6, 1e8})
        for (const int n_windows : {1, 7}) {
            const Ending found = watch(growth, 0, n_windows, jam_at(708.6, a)),
                         one = watch(growth, 0, 1, jam_at(708.6, a));
            INFO(a << ": at " << found.safe);
            CHECK(found.sign != JamWatch::Sign::none);
            CHECK(found.safe < 708.6);
            CHECK(found.safe > 690);
            CHECK(found.safe == one.safe);
        }
}

TEST_CASE("runs that end before the jam, and gases in which collisions are frequent, go on") {
    const JamWatch::Setting growth{0.001, 64, 700, 200};
    CHECK(watch(growth, 0, 1, jam_at(708.6, 1e8)).sign == JamWatch::Sign::none);
    CHECK(watch(growth, 0, 1, [](double t) { return 1e8 * t; }).sign == JamWatch::Sign::none);
    // A fluid that would jam at 400 freezes at 300. Then collisions become rarer, and there is more
    // room.
    const auto freezing = [](double t) {
        return t < 300 ? 1e8 * t / (400 - t) : 3e8 + 1e6 * (t - 300) * (1 + 0.001 * t);
    };
    CHECK(watch({0.001, 64, 480, 200}, 0, 1, freezing).sign == JamWatch::Sign::none);
}

TEST_CASE("a run that begins a moment before the jam finds it as well") {
    const JamWatch::Setting growth{0.001, 64, 735, 200};
    for (const double start : {704.0, 708.0, 708.5}) {
        const Ending found = watch(growth, start, 1, jam_at(708.6, 8e6));
        CHECK(found.sign != JamWatch::Sign::none);
        CHECK(found.safe >= start);
    }
}

TEST_CASE("with losses collisions go as 1 / (t_J - t), and the jam is found") {
    const JamWatch::Setting growth{0.01, 16, 100, 20};
    const auto lossy = [](double t) { return t < 60 ? -1e5 * std::log((60 - t) / 60) : 1e300; };
    const Ending found = watch(growth, 0, 1, lossy);
    CHECK(found.sign != JamWatch::Sign::none);
    CHECK(std::abs(found.safe - 60) < 0.1);
}

TEST_CASE("discs that do not grow have no bins") {
    JamWatch watched({0, 64, 100, 10});
    watched.start(0, 0);
    CHECK(!watched.is_on());
    CHECK(std::isinf(watched.bin_end()));
    CHECK(!watched.add(std::uint64_t{1} << 60));
}
