// SPDX-License-Identifier: BSD-3-Clause
#include "apps/accuracy/accuracy_study.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "apps/accuracy/accuracy_table.hpp"
#include "apps/run_command/progress.hpp"
#include "core/errors.hpp"
#include "run/files/csv_table.hpp"
#include "simulation/first_discs.hpp"

namespace carrom {

namespace {

/// Both methods, each with K = 1, `factor`, factor^2, ... micro-steps per step. The first setting
/// is the reference: the event-driven method with default arithmetic.
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

/// The data that all trials of a study share.
struct Study {
    Study(const SceneParameters& of_scene, const std::vector<InputDisc>& first_discs,
          const StudyOptions& with_options, const Communicator& on_ranks)
        : scene(of_scene), discs(first_discs), options(with_options), ranks(on_ranks) {
        tuning.threads = options.threads;
    }

    const SceneParameters& scene;
    const std::vector<InputDisc>& discs;
    const StudyOptions& options;
    const Communicator& ranks;
    Tuning tuning;
};

/// Makes initial state `number`. The states are independent, because each has its own seed or, if
/// the discs come from a file, its own number of collisions before the trials.
TrialStart make_start(const Study& study, int number) {
    const double approach = study.options.approach;
    if (study.scene.generator == Generator::file)
        return bring_to_equilibrium(study.scene, study.discs, approach * (number + 1), study.ranks,
                                    study.tuning);
    SceneParameters other = study.scene;
    other.seed += static_cast<std::uint64_t>(number);
    return bring_to_equilibrium(other, first_discs(other, nullptr, study.ranks, study.tuning),
                                approach, study.ranks, study.tuning);
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

double cost_of(const RunSetting& setting) {
    return setting.method == Method::event_driven ? 5
                                                  : static_cast<double>(setting.micro_steps) + 4;
}

/// One trial of a study: a setting, the number of an initial state, and the number of a repetition.
struct Item {
    int start = 0, repetition = 0;
    RunSetting setting;
};

/// The trials that this process runs, sorted by initial state, then by repetition, then by setting.
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

/// Makes each initial state once and calls `begin(start)` for it, and then `run(item, start)` for
/// each of its trials.
template <class Begin, class Run>
void run_all(const Study& study, const std::vector<Item>& items, const Begin& begin,
             const Run& run) {
    double all = 0, done = 0;
    for (const Item& item : items) all += cost_of(item.setting);
    StatusLine status(!study.options.quiet);
    TrialStart start;
    int number = -1;
    for (const Item& item : items) {
        if (item.start != number) {
            number = item.start;
            start = make_start(study, number);
            begin(start);
        }
        run(item, start);
        done += cost_of(item.setting);
        if (status.is_due())
            status.show(fmt::format("accuracy: {:.1f} % done, {} left", 100 * done / all,
                                    time_text(status.seconds() * (all - done) / done)));
    }
}

/// Runs the scene with this setting, and returns the discs, in order of id, every `every` steps.
/// Throws InputError if a run cannot continue.
std::vector<std::vector<InputDisc>> trace(const Study& study, const RunSetting& setting,
                                          const TrialStart& start, std::int64_t every,
                                          std::int64_t steps) {
    SceneParameters here = with_setting(study.scene, setting);
    here.steps = steps;
    DiscSystem system(here, start.discs, study.ranks, study.tuning);
    std::vector<std::vector<InputDisc>> samples;
    for (std::int64_t step = every; step <= steps; step += every) {
        advance_to(system, step);
        samples.push_back(discs_now(system));
    }
    return samples;
}

/// Runs one trial. `exact` has the discs of the exact run at `length.early_step`.
TrialOutcome attempt(const Study& study, const RunSetting& setting, const TrialStart& start,
                     const TrialLength& length, const std::vector<InputDisc>& exact) {
    try {
        Trial trial = run_trial(study.scene, setting, start, length, study.ranks, study.tuning);
        const Distance distance = distance_between(trial.early, exact, 2 * study.scene.radius);
        return {std::move(trial), distance, ""};
    } catch (const InputError& error) {
        return {{}, {}, error.problems().front().text};
    } catch (const CollectiveError& error) { // a collision cascade ended the run
        return {{}, {}, error.what()};
    }
}

std::int64_t at_least_one(double number) { return std::max<std::int64_t>(1, std::llround(number)); }

} // namespace

void study_costs(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                 const StudyOptions& options, const Communicator& ranks) {
    const Study study(scene, discs, options, ranks);
    CsvTable table(options.table, costs_header());
    const std::vector<RunSetting> settings = settings_of(options, 2);
    TrialLength length;
    std::vector<InputDisc> exact; // discs of the exact run at `length.early_step`
    const auto begin = [&](const TrialStart& start) {
        length.steps = at_least_one(options.collisions / start.frequency);
        length.early_step = std::min(at_least_one(1 / start.frequency), length.steps);
        const TrialLength early = {length.early_step, length.early_step, 1};
        exact = run_trial(scene, settings[0], start, early, ranks, study.tuning).early;
    };
    const auto run = [&](const Item& item, const TrialStart& start) {
        const TrialKey key{item.start, item.setting, length, item.repetition};
        table.append(costs_line(scene, start, key,
                                attempt(study, item.setting, start, length, exact),
                                options.threads));
    };
    run_all(study, items_of(options, settings, options.n_repetitions), begin, run);
}

void study_distances(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                     const StudyOptions& options, const Communicator& ranks) {
    const Study study(scene, discs, options, ranks);
    CsvTable table(options.table, distances_header());
    const std::vector<RunSetting> settings = settings_of(options, 16);
    std::vector<Item> items = items_of(options, settings, 1);
    std::erase_if(items, [&](const Item& item) {
        return item.setting == settings[0];
    }); // the exact run is not compared with itself
    std::int64_t every = 1, last = 1;
    std::vector<std::vector<InputDisc>> exact;
    const auto begin = [&](const TrialStart& start) {
        every = at_least_one(1 / start.frequency);
        last = every *
               at_least_one(options.collisions / (start.frequency * static_cast<double>(every)));
        exact = trace(study, settings[0], start, every, last);
    };
    const auto run = [&](const Item& item, const TrialStart& start) {
        const TrialKey key{item.start, item.setting, {}, 0};
        const auto samples = trace(study, item.setting, start, every, last);
        for (std::size_t k = 0; k < samples.size(); ++k) {
            const auto step = static_cast<std::int64_t>(k + 1) * every;
            const double collisions = start.frequency * static_cast<double>(step);
            table.append(distances_line(scene, start, key, step, collisions,
                                        distance_between(samples[k], exact[k], 2 * scene.radius)));
        }
    };
    run_all(study, items, begin, run);
}

} // namespace carrom
