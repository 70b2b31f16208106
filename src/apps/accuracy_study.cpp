// SPDX-License-Identifier: BSD-3-Clause
#include "apps/accuracy_study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/accuracy_table.hpp"
#include "apps/standard_streams.hpp"
#include "apps/stopwatch.hpp"
#include "core/errors.hpp"
#include "initial_state/initial_state.hpp"

namespace carrom {

namespace {

/// Both rules with K = 1, `factor`, factor^2, ...; the first one is the reference: the event-driven
/// method as runs use it.
std::vector<RunSetting> settings_of(const StudyOptions& options, std::int64_t factor) {
    std::vector<RunSetting> settings;
    for (std::int64_t k = 1; k <= options.most_micro_steps; k *= factor) {
        for (const Method method : {Method::event_driven, Method::time_stepped}) {
            for (const Precision precision : {Precision::double_, Precision::single}) {
                settings.push_back({method, k, precision});
                if (options.formulas == Formulas::usual) break;
                if (options.formulas == Formulas::stable) continue;
                settings.push_back({method, k, precision, Arithmetic::naive, false});
                settings.push_back({method, k, precision, Arithmetic::naive, true});
            }
        }
    }
    return settings;
}

/// Independent starts: other seeds where discs are generated, else the same discs after more and
/// more collisions.
TrialStart make_start(const Scene& scene, const std::vector<InputDisc>& discs, int number,
                      const StudyOptions& options, const Communicator& ranks,
                      const Tuning& tuning) {
    if (scene.generator == Generator::file)
        return bring_to_equilibrium(scene, discs, options.approach * (number + 1), ranks, tuning);
    Scene other = scene;
    other.seed += static_cast<std::uint64_t>(number);
    return bring_to_equilibrium(other, initial_state(other, nullptr, ranks), options.approach,
                                ranks, tuning);
}

Distance distance_between(const std::vector<InputDisc>& a, const std::vector<InputDisc>& b,
                          double diameter) {
    std::vector<double> squares;
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double dx = a[i].x - b[i].x, dy = a[i].y - b[i].y;
        squares.push_back(dx * dx + dy * dy);
        sum += squares.back();
    }
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::nth_element(squares.begin(), middle, squares.end());
    return {std::sqrt(sum / static_cast<double>(a.size())) / diameter,
            std::sqrt(*middle) / diameter};
}

/// What is left to do, as time goes on. Costs are in the micro-steps of a start, about.
class StudyProgress {
public:
    StudyProgress(double all, bool wanted)
        : all_(all), wanted_(wanted), on_terminal_(isatty(STDERR_FILENO) == 1) {}
    ~StudyProgress() {
        if (wanted_ && on_terminal_) print_message("\n");
    }
    StudyProgress(const StudyProgress&) = delete;
    StudyProgress& operator=(const StudyProgress&) = delete;

    /// `measured` is false for what was there already.
    void show(double cost, bool measured) {
        (measured ? done_ : found_) += cost;
        since_shown_ += watch_lap();
        if (!wanted_ || !measured || since_shown_ < (on_terminal_ ? 0.2 : 20)) return;
        since_shown_ = 0;
        const auto left = static_cast<std::int64_t>(seconds_ * (all_ - found_ - done_) / done_ +
                                                    0.5);
        print_message("{}accuracy: {:.1f} % done, {}:{:02}:{:02} left{}", on_terminal_ ? "\r" : "",
                      100 * (found_ + done_) / all_, left / 3600, left / 60 % 60, left % 60,
                      on_terminal_ ? "\x1b[K" : "\n");
        std::fflush(stderr);
    }

private:
    double watch_lap() {
        const double lap = watch_.lap();
        seconds_ += lap;
        return lap;
    }

    double all_, done_ = 0, found_ = 0, seconds_ = 0, since_shown_ = 1e9;
    bool wanted_, on_terminal_;
    Stopwatch watch_;
};

double cost_of(const RunSetting& setting) {
    return setting.method == Method::event_driven ? 5
                                                  : static_cast<double>(setting.micro_steps) + 4;
}

/// One trial of a study: a start, a repetition, a setting.
struct Item {
    int start = 0, repetition = 0;
    RunSetting setting;
};

/// This process's share, start by start; settings take turns.
std::vector<Item> items_of(const StudyOptions& options, const std::vector<RunSetting>& settings,
                           int n_repetitions) {
    std::vector<Item> items;
    int number = 0;
    for (int start = 0; start < options.n_starts; ++start)
        for (int repetition = 0; repetition < n_repetitions; ++repetition)
            for (const RunSetting& setting : settings)
                if (number++ % options.n_shares == options.share - 1)
                    items.push_back({start, repetition, setting});
    return items;
}

/// Makes each start once and calls `run(item, start)`, which returns whether anything had to be
/// done, for its items.
void run_all(const Scene& scene, const std::vector<InputDisc>& discs, const StudyOptions& options,
             const std::vector<Item>& items, const Communicator& ranks, const Tuning& tuning,
             const std::function<bool(const Item&, const TrialStart&)>& run) {
    double cost = 0;
    for (const Item& item : items) cost += cost_of(item.setting);
    StudyProgress progress(cost, !options.quiet);
    std::optional<TrialStart> start;
    int number = -1;
    for (const Item& item : items) {
        if (item.start != number)
            start = make_start(scene, discs, number = item.start, options, ranks, tuning);
        progress.show(cost_of(item.setting), run(item, *start));
    }
}

Tuning tuning_of(const StudyOptions& options) {
    Tuning tuning;
    tuning.threads = options.threads;
    return tuning;
}

/// Discs by id at each look: after about every collision of a disc. Throws InputError where a run
/// cannot go on.
std::vector<std::vector<InputDisc>> trace(const Scene& scene, const RunSetting& setting,
                                          const TrialStart& start, std::int64_t every,
                                          std::int64_t steps, const Communicator& ranks,
                                          const Tuning& tuning) {
    Scene here = with_setting(scene, setting);
    here.steps = steps;
    Simulation simulation(here, start.discs, ranks, tuning);
    std::vector<std::vector<InputDisc>> looks;
    for (std::int64_t step = every; step <= steps; step += every) {
        advance_to(simulation, step);
        looks.push_back(discs_now(simulation));
    }
    return looks;
}

} // namespace

void study_costs(const Scene& scene, const std::vector<InputDisc>& discs,
                 const StudyOptions& options, const Communicator& ranks) {
    AccuracyTable table(options.table);
    const std::vector<RunSetting> settings = settings_of(options, 2);
    const Tuning tuning = tuning_of(options);
    std::vector<InputDisc> exact; // at the early step
    int reference_start = -1;
    run_all(scene, discs, options, items_of(options, settings, options.n_repetitions), ranks,
            tuning, [&](const Item& item, const TrialStart& start) {
                TrialLength length;
                length.steps = std::max<std::int64_t>(
                    1, std::llround(options.collisions / start.frequency));
                length.early_step = std::clamp<std::int64_t>(std::llround(1 / start.frequency), 1,
                                                             length.steps);
                const TrialKey key{item.start, item.setting, length, item.repetition};
                if (table.has(scene, start, key)) return false;
                if (reference_start != item.start) {
                    exact = run_trial(scene, settings[0], start,
                                      {length.early_step, length.early_step, 1}, ranks, tuning)
                                .early;
                    reference_start = item.start;
                }
                std::string failure;
                Trial trial;
                try {
                    trial = run_trial(scene, item.setting, start, length, ranks, tuning);
                } catch (const InputError& error) {
                    failure = error.problems().front().text;
                } catch (const CollectiveError& error) { // collisions without end
                    failure = error.what();
                }
                if (failure.empty())
                    table.add(scene, start, key, trial,
                              distance_between(trial.early, exact, 2 * scene.radius),
                              options.threads);
                else
                    table.add_failure(scene, start, key, failure, options.threads);
                return true;
            });
}

void study_distances(const Scene& scene, const std::vector<InputDisc>& discs,
                     const StudyOptions& options, const Communicator& ranks) {
    DistanceTable table(options.table);
    const std::vector<RunSetting> settings = settings_of(options, 16);
    const Tuning tuning = tuning_of(options);
    std::vector<std::vector<InputDisc>> exact;
    int reference_start = -1;
    std::vector<Item> items = items_of(options, settings, 1);
    std::erase_if(items, [&](const Item& item) {
        return item.setting == settings[0];
    }); // no distance from itself
    run_all(scene, discs, options, items, ranks, tuning,
            [&](const Item& item, const TrialStart& start) {
                const TrialKey key{item.start, item.setting, {}, 0};
                const auto every = std::max<std::int64_t>(1, std::llround(1 / start.frequency));
                const std::int64_t n_looks = std::max<std::int64_t>(
                    1, std::llround(options.collisions /
                                    (start.frequency * static_cast<double>(every))));
                if (table.has(scene, start, key, n_looks * every)) return false;
                if (reference_start != item.start)
                    exact = trace(scene, settings[0], start, every, n_looks * every, ranks, tuning);
                reference_start = item.start;
                const auto looks = trace(scene, item.setting, start, every, n_looks * every, ranks,
                                         tuning);
                for (std::size_t k = 0; k < looks.size(); ++k) {
                    const auto step = static_cast<std::int64_t>(k + 1) * every;
                    if (table.has(scene, start, key, step)) continue;
                    table.add(scene, start, key, step, start.frequency * static_cast<double>(step),
                              distance_between(looks[k], exact[k], 2 * scene.radius));
                }
                return true;
            });
}

} // namespace carrom
