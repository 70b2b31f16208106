// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_options.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

namespace carrom {

namespace {

constexpr const char* teaching = R"(Input:
  SCENE.toml   a scene; inputs/ has some, docs/user.md lists the keys
  FILE.in      legacy text: N, L, r, S, print|perf, one per line, then nothing
               or N lines `id x y vx vy`
  -            legacy text on standard input (mpirun hands it to rank 0)

Standard output gets the lines `step id x y vx vy`, ids ascending, and nothing
else: steps 0 and S for `perf`, every step for `print`, what output.text says for
a scene. The lines of the last step end in ` p_c w_c`: collisions with discs, with walls.

Examples:
  carrom run inputs/gas.toml --threads 2
  mpirun -np 4 carrom run inputs/gas.toml --threads 2 --report report.json
  carrom run inputs/gas.toml --steps 100 --set output.text=every_step > gas.txt
  carrom run inputs/gas.toml --set output.checkpoint.folder=kept
  carrom run inputs/gas.toml --set output.checkpoint.folder=kept --restart latest
  carrom run --digits 8 - < input.in > output.txt

Exit codes: 0 done; 2 wrong input, nothing was done; 3 a rank failed; 4 output
could not be written; 70 a broken invariant; 75 stopped on request before the end.)";

template <class Number> std::optional<Number> number(std::string_view word) {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
}

/// Reads options from words; a missing word leaves the default.
class Checker {
public:
    explicit Checker(std::vector<Problem>& problems) : problems_(problems) {}

    template <class Integer>
    std::optional<Integer> integer(const char* option, const std::string& word, Integer least,
                                   Integer most) {
        if (word.empty()) return std::nullopt;
        const auto value = number<Integer>(word);
        if (value && *value >= least && *value <= most) return value;
        const std::string range = most == std::numeric_limits<Integer>::max()
                                      ? fmt::format("at least {}", least)
                                      : fmt::format("from {} to {}", least, most);
        complain(option, word, "a whole number " + range);
        return std::nullopt;
    }

    /// A finite number from `least` on.
    std::optional<double> real_from(const char* option, const std::string& word, double least,
                                    const char* why) {
        const auto value = word.empty() ? std::nullopt : number<double>(word);
        if (word.empty() || (value && std::isfinite(*value) && *value >= least)) return value;
        complain(option, word, fmt::format("a number from {:g} on ({})", least, why));
        return std::nullopt;
    }

    /// A finite number >= 0, or > 0 if `zero_is_wrong`.
    std::optional<double> real(const char* option, const std::string& word, bool zero_is_wrong) {
        if (word.empty()) return std::nullopt;
        const auto value = number<double>(word);
        if (value && std::isfinite(*value) && (zero_is_wrong ? *value > 0 : *value >= 0))
            return value;
        complain(option, word, zero_is_wrong ? "a number above 0" : "a number, 0 or above");
        return std::nullopt;
    }

private:
    void complain(const char* option, const std::string& word, const std::string& wanted) {
        problems_.push_back({option, 0, fmt::format("must be {}, not \"{}\"", wanted, word)});
    }

    std::vector<Problem>& problems_;
};

} // namespace

CLI::Option* add_switch(CLI::App& command, const std::string& name, bool& is_on,
                        const std::string& what_it_does) {
    const auto complaint = [](const std::string& word) {
        return word == "true" ? std::string{} : "takes no value; leave \"=" + word + "\" out";
    };
    return command.add_flag(name, is_on, what_it_does)->check(CLI::Validator(complaint, ""));
}

void declare_run_options(CLI::App& command, RunWords& words) {
    command.set_help_flag("-h,--help", "Print this help and exit");
    command.add_option("INPUT", words.input, "SCENE.toml, FILE.in, or - for standard input")
        ->type_name("");
    command
        .add_option(
            "--threads", words.threads,
            "Threads per rank; default OMP_NUM_THREADS if set, else this rank's share of the cores")
        ->type_name("T");
    command
        .add_option("--restart", words.restart,
                    "Go on from a checkpoint: a FILE, a FOLDER (its newest whole one), or `latest` "
                    "in the scene's folder; "
                    "INPUT may be left out with FILE and FOLDER")
        ->type_name("FILE|FOLDER|latest");
    command.add_option("--steps", words.steps, "Steps to run, instead of the input's")
        ->type_name("S");
    command
        .add_option("--accuracy", words.accuracy,
                    "Let a short pilot choose the cheapest rule and micro-steps whose collision "
                    "rate and pressure are within "
                    "this share of the truth")
        ->type_name("X");
    command
        .add_option("--set", words.overrides,
                    "Set any scene key, as in --set time.steps=100; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command
        .add_option("--digits", words.digits,
                    "17 (the default): 17 significant digits, which read back as the same bits; "
                    "1 to 16: that many decimals (8 gives the course program's look)")
        ->type_name("D");
    command
        .add_option("--output", words.output,
                    "Write the lines to FILE, not to standard output (under mpirun only so a full "
                    "disk is noticed)")
        ->type_name("FILE");
    command.add_option("--report", words.report, "Write the summary's numbers to FILE as JSON")
        ->type_name("FILE");
    add_switch(command, "--quiet", words.quiet,
               "No progress and no summary; errors are still told");
    add_switch(command, "--check", words.check,
               "After every step hold the state to its invariants; exit code 70 and the scene of "
               "the discs around where "
               "one is broken");
    const std::string group = "Cost only, never bits";
    command
        .add_option(
            "--window", words.window,
            "Micro-steps per window; below 1 a micro-step is cut into parts, at most 100000")
        ->type_name("W")
        ->group(group);
    command
        .add_option("--cell-width", words.cell_width, "Width of a cell, in reaches of the window")
        ->type_name("C")
        ->group(group);
    command
        .add_option("--rebalance-every", words.rebalance_every,
                    "Syncs between looks at the load; 0 keeps the first strips")
        ->type_name("K")
        ->group(group);
    command
        .add_option("--rebalance-above", words.rebalance_above,
                    "Largest over mean load that is tolerated; 0 moves the cuts at every look")
        ->type_name("X")
        ->group(group);
    command.footer(teaching);
    command.allow_extras();
}

RunOptions checked_run_options(const RunWords& words, std::vector<Problem>& problems) {
    Checker checker(problems);
    constexpr auto unbounded = std::numeric_limits<std::int64_t>::max();
    RunOptions options;
    options.input = words.input;
    options.restart = words.restart;
    options.overrides = words.overrides;
    options.output = words.output;
    options.report = words.report;
    options.quiet = words.quiet;
    options.check = words.check;
    options.threads = checker.integer<int>("--threads", words.threads, 1, 1024);
    options.digits = checker
                         .integer<int>("--digits", words.digits, 1, RunOptions::round_trip_digits)
                         .value_or(options.digits);
    if (const auto accuracy = checker.real("--accuracy", words.accuracy, true))
        options.overrides.push_back(fmt::format("time.accuracy={}", *accuracy));
    if (const auto steps = checker.integer<std::int64_t>("--steps", words.steps, 0, unbounded))
        options.overrides.push_back(fmt::format("time.steps={}", *steps));
    Tuning& tuning = options.tuning;
    tuning.window = checker.real_from("--window", words.window, 1e-5,
                                      "a hundred thousand windows to a micro-step");
    tuning.cell_width = checker.real("--cell-width", words.cell_width, true);
    tuning.rebalance_every = checker
                                 .integer<std::int64_t>("--rebalance-every", words.rebalance_every,
                                                        0, unbounded)
                                 .value_or(tuning.rebalance_every);
    tuning.rebalance_above = checker.real("--rebalance-above", words.rebalance_above, false)
                                 .value_or(tuning.rebalance_above);
    return options;
}

} // namespace carrom
