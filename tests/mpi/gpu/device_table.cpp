// SPDX-License-Identifier: BSD-3-Clause
// Compares a GPU with the serial device, without MPI and files: `device_table bits`, `device_table
// small` and `device_table speed [largest N]` print a table each, and end with 1 if bits differ.
//
// "small" is small enough for compute-sanitizer. "speed" has gases of packing 0.2 with speeds up to
// r/2, or up to r/100, in a micro-step.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "engine/window_choice.hpp"
#include "gpu/serial_device.hpp"
#include "gpu/stepper.hpp"
#include "scene_tools.hpp"

namespace carrom {
#ifdef CARROM_HAS_CUDA
const DeviceKind& cuda_device();
#endif
} // namespace carrom

using namespace carrom;

namespace {

constexpr int sync_every = 64;

const DeviceKind& gpu() {
#ifdef CARROM_HAS_CUDA
    return cuda_device();
#else
    return serial_device(); // so that this program can be tested without a GPU
#endif
}

struct Gas {
    std::string name;
    std::uint32_t n = 0;
    double speed = 0; ///< the largest speed, in radii per micro-step
    Effects effects = {};
    double packing = 0.2;

    double side() const { return std::sqrt(n * 3.14159265358979 / packing); }
};

/// Discs of radius 1 on a shaken lattice without overlaps.
DiscStates discs_of(const Gas& gas) {
    test::Random random(gas.n);
    const auto per_row = static_cast<std::uint32_t>(std::ceil(std::sqrt(gas.n)));
    const double pitch = (gas.side() - 2) / per_row, shake = 0.999 * (pitch / 2 - 1);
    DiscStates discs;
    for (std::uint32_t k = 0; k < gas.n; ++k) {
        DiscState disc;
        disc.id = k;
        disc.x = 1 + pitch * (k % per_row + 0.5) + random.uniform(-shake, shake);
        disc.y = 1 + pitch * (k / per_row + 0.5) + random.uniform(-shake, shake);
        const auto [x, y] = random.direction();
        const double speed = random.uniform(0, gas.speed);
        disc.vx = speed * x;
        disc.vy = speed * y;
        discs.push_back(disc);
    }
    return discs;
}

/// The loop of an engine: windows, and a sync after every 64 micro-steps.
class Run {
public:
    template <class Dynamics>
    Run(const DeviceKind& device, const Gas& gas, const Dynamics& dynamics)
        : gas_(gas), discs_(discs_of(gas)),
          stepper_(device.make_stepper(dynamics.motion(), dynamics.species_table(), gas.n)),
          radius_(dynamics.radius() + dynamics.slack()) {
        if constexpr (Dynamics::is_for_study)
            for (DiscState& disc : discs_) Dynamics::round(disc);
        for (const DiscState& disc : discs_)
            fastest_ = std::max(fastest_, std::sqrt(squared_speed_of(disc)));
        stepper_->put(discs_);
    }

    void advance(int n_micro) {
        while (n_micro > 0) {
            const int done = run_window(std::min(n_micro, sync_every - micro_));
            micro_ += done;
            n_micro -= done;
            if (micro_ == sync_every) sync();
        }
    }
    /// The states in the order of ids.
    DiscStates states() {
        stepper_->get(discs_);
        std::ranges::sort(discs_, {}, &DiscState::id);
        for (DiscState& disc : discs_) set_image(disc, {});
        return discs_;
    }
    StressSums stress() {
        StressSums sums(bound);
        stepper_->take_stress(sums);
        return sums;
    }
    DeviceOutcome outcome;

private:
    static constexpr double bound = 0x1p40;

    int run_window(int most) {
        const double speed = fastest_ * 1.1;
        const WindowNeeds needs{gas_.side(), radius_, static_cast<double>(gas_.n),
                                speed,       hits_,   static_cast<double>(gas_.n),
                                nullptr};
        DeviceWindow window;
        window.window.first_micro = micro_;
        window.window.n_micro = choose_window(needs, most, std::nullopt).n_micro;
        window.reach = reach_of(needs, window.window.duration());
        window.speed = speed;
        window.stress_scale = StressSums(bound).xx.scale();
        const std::uint64_t before = outcome.n_kept;
        outcome = stepper_->run(window);
        hits_ = 2 * static_cast<double>(outcome.n_kept - before) / gas_.n / outcome.n_micro;
        fastest_ = std::max(fastest_, std::sqrt(outcome.squared_speed));
        return outcome.n_micro;
    }
    void sync() {
        DeviceWindow window;
        window.stress_scale = StressSums(bound).xx.scale();
        fastest_ = std::sqrt(stepper_->restart(sync_every, true, window));
        micro_ = 0;
    }

    Gas gas_;
    DiscStates discs_;
    std::unique_ptr<Stepper> stepper_;
    double radius_, fastest_ = 0, hits_ = 0;
    int micro_ = 0;
};

bool are_same(const StressSums& a, const StressSums& b) {
    for (std::size_t k = 0; k < 4; ++k)
        if (a.parts()[k]->low_word() != b.parts()[k]->low_word() ||
            a.parts()[k]->high_word() != b.parts()[k]->high_word())
            return false;
    return true;
}

/// Prints a line of the table of bits.
template <class Dynamics>
bool compare(const Gas& gas, int n_micro, ContactFormula formula = ContactFormula::stable) {
    const Dynamics dynamics(gas.side(), 1, gas.effects, formula);
    Run serial(serial_device(), gas, dynamics), on_gpu(gpu(), gas, dynamics);
    serial.advance(n_micro);
    on_gpu.advance(n_micro);
    const DiscStates a = serial.states(), b = on_gpu.states();
    std::size_t n_different = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        n_different += std::memcmp(&a[k], &b[k], sizeof(DiscState)) != 0;
    const bool same_sums = are_same(serial.stress(), on_gpu.stress()),
               same_counts = serial.outcome.n_kept == on_gpu.outcome.n_kept &&
                             serial.outcome.n_candidates == on_gpu.outcome.n_candidates;
    std::printf("%-34s %8u discs %4d micro-steps %9llu collisions: %zu discs differ%s%s\n",
                gas.name.c_str(), gas.n, n_micro,
                static_cast<unsigned long long>(serial.outcome.n_kept), n_different,
                same_sums ? "" : ", sums differ", same_counts ? "" : ", counts differ");
    std::fflush(stdout);
    return n_different == 0 && same_sums && same_counts;
}

bool compare_all(std::uint32_t n, int n_micro) {
    Effects walled, periodic;
    periodic.boundaries.fill({BoundaryKind::periodic, 1, 0, 0});
    bool are_right = true;
    for (const double speed : {0.02, 0.5}) {
        const std::string words = speed < 0.1 ? ", slow" : ", fast";
        const auto with = [&](const char* name, Effects effects, bool is_lossy, bool is_mixed) {
            if (is_lossy) effects.contact = {ContactKind::restitution, 0.8, 0};
            if (is_mixed)
                effects.species = {{n / 4, 1, 4}, {n / 4, 0.7, 1}, {n - n / 4 * 2, 0.5, 0.5}};
            return Gas{name + words, n, speed, effects};
        };
        are_right &= compare<PlainDynamics>(with("plain", {}, false, false), n_micro);
        are_right &= compare<WalledDynamics>(with("inelastic", walled, true, false), n_micro);
        are_right &= compare<WalledMixedDynamics>(with("species", walled, true, true), n_micro);
        are_right &= compare<PeriodicDynamics>(with("periodic", periodic, true, false), n_micro);
        are_right &= compare<PeriodicMixedDynamics>(
            with("periodic, species", periodic, false, true), n_micro);
        are_right &= compare<StudyDynamics<float>>(with("single", {}, false, false), n_micro);
        for (const auto formula : {ContactFormula::naive, ContactFormula::naive_contracted}) {
            are_right &= compare<StudyDynamics<float>>(with("single, naive", {}, false, false),
                                                       n_micro, formula);
            are_right &= compare<StudyDynamics<double>>(with("double, naive", {}, false, false),
                                                        n_micro, formula);
        }
    }
    return are_right;
}

/// Prints a line of the table of speeds. The rate counts micro-steps and includes syncs.
template <class Dynamics> void measure(const Gas& gas, ContactFormula formula) {
    using Clock = std::chrono::steady_clock;
    const Dynamics dynamics(gas.side(), 1, gas.effects, formula);
    Run run(gpu(), gas, dynamics);
    run.advance(sync_every);
    const auto seconds_of = [&](int n_syncs) {
        const auto begin = Clock::now();
        run.advance(n_syncs * sync_every);
        return std::chrono::duration<double>(Clock::now() - begin).count();
    };
    const double once = seconds_of(1);
    const int n_syncs = std::clamp(static_cast<int>(0.5 / once), 1, 50);
    const double each = seconds_of(n_syncs) / (n_syncs * sync_every);
    std::printf("%-34s %9u discs %10.2f us a micro-step %9.3g disc-steps/s\n", gas.name.c_str(),
                gas.n, 1e6 * each, gas.n / each);
    std::fflush(stdout);
}

void measure_all(std::uint32_t largest) {
    for (const double speed : {0.5, 0.01})
        for (std::uint32_t n = 1000; n <= largest; n *= 10)
            measure<PlainDynamics>({speed > 0.1 ? "gas" : "slow gas", n, speed},
                                   ContactFormula::stable);
    for (const std::uint32_t n : {1000u, 4000u, 16000u, 64000u}) {
        const auto named = [&](const char* name) { return Gas{name, n, 0.5}; };
        measure<StudyDynamics<double>>(named("double, naive"), ContactFormula::naive);
        measure<StudyDynamics<double>>(named("double, naive, contracted"),
                                       ContactFormula::naive_contracted);
        measure<StudyDynamics<float>>(named("float, naive"), ContactFormula::naive);
        measure<StudyDynamics<float>>(named("float, naive, contracted"),
                                      ContactFormula::naive_contracted);
    }
}

int table(const std::string& what, std::uint32_t largest) {
    const DeviceFacts facts = gpu().facts();
    std::printf("%s, %.3g GB\n", facts.name.c_str(), 1e-9 * static_cast<double>(facts.bytes));
    if (what == "speed") {
        measure_all(largest);
        return 0;
    }
    return compare_all(what == "small" ? 200 : 3000, what == "small" ? 70 : 200) ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return table(argc > 1 ? argv[1] : "small",
                     argc > 2 ? static_cast<std::uint32_t>(std::atof(argv[2])) : 10000000);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
}
