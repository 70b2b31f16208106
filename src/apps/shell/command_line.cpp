// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/command_line.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/run_command/run_command.hpp"
#include "apps/shell/subcommands.hpp"
#include "io/start_io.hpp"
#include "machine/machine.hpp"
#include "parallel/mpi.hpp"
#include "simulation/known_bits.hpp"

namespace carrom {

namespace {

constexpr const char* examples = R"(Examples:
  carrom run inputs/gas.toml
  mpirun -np 4 carrom run inputs/gas.toml --threads 2 --report report.json
  carrom run inputs/gas.toml --set time.steps=50 --set discs.count=2000
  mpirun -np 8 carrom replicas inputs/gas.toml --count 64 -o FOLDER
  carrom accuracy inputs/gas.toml --output gas.csv
  carrom info FILE.h5
  carrom diff A.h5 B.h5
  carrom convert FILE.h5 --to xyz > discs.xyz
  carrom compare OUTPUT FILE.in
  carrom keys
  carrom run --help

Discs move freely and collide with each other and with the walls of a rectangular box.
The result is bit for bit the same for any number of ranks and threads.

Standard output carries data only; progress, summary and messages go to standard error.

Exit codes:
  0   done
  1   a comparison found a difference
  2   the command line or an input is wrong; nothing was computed or written
  3   an operation of all ranks failed, on at least one of them
  4   output could not be written
  70  a check of --check failed, or the program itself is wrong
  75  stopped on request before the end; run again to go on)";

constexpr const char* help_words = "-h,--help";
constexpr const char* help_of_help = "Print this help and exit";

Action printed(std::string text) {
    return {[text = std::move(text)](const Communicator& ranks) {
        if (ranks.is_root()) std::fputs((text + '\n').c_str(), stdout);
        return ExitCode::success;
    }};
}

/// Facts on this build that a bug report should contain. Does not need MPI.
std::string version_text() {
    const BuildFacts facts = build_facts();
    return fmt::format("carrom {}\n"
                       "commit    {}\n"
                       "compiler  {}\n"
                       "MPI       {}\n"
                       "HDF5      {}\n"
                       "vectors   {}",
                       version(), facts.commit, facts.compiler, mpi_version(), hdf5_version(),
                       vector_target());
}

/// Prints the version, and whether this build computes the same bits as other builds do.
Action version_and_bits() {
    return {[](const Communicator& ranks) {
                const std::string difference = warning_of_other_bits(ranks);
                if (ranks.is_root())
                    std::fputs(fmt::format("{}\nbits      {}\n", version_text(),
                                           difference.empty() ? "those of all builds" : difference)
                                   .c_str(),
                               stdout);
                return difference.empty() ? ExitCode::success : ExitCode::broken_invariant;
            },
            true};
}

Action refused(const std::string& reason) {
    return failing({{"command line", 0, reason + " (see carrom --help)"}});
}

/// Declares a switch. A value is an error, because CLI11 would read `NAME=no` as switched off.
void declare_switch(CLI::App& command, const Option& option, bool& is_on) {
    const auto complaint = [](const std::string& word) {
        return word == "true" ? std::string{} : "takes no value; leave \"=" + word + "\" out";
    };
    command.add_flag(option.name, is_on, option.help)
        ->check(CLI::Validator(complaint, ""))
        ->group(option.group);
}

void declare(CLI::App& command, const Option& option) {
    if (bool* const* is_on = std::get_if<bool*>(&option.value)) {
        declare_switch(command, option, **is_on);
        return;
    }
    CLI::Option* declared = nullptr;
    if (std::string* const* word = std::get_if<std::string*>(&option.value))
        declared = command.add_option(option.name, **word, option.help);
    else if (std::vector<std::string>* const* words = std::get_if<std::vector<std::string>*>(
                 &option.value))
        declared = command.add_option(option.name, **words, option.help)->allow_extra_args(false);
    else
        declared = command.add_option(option.name)->description(option.help);
    declared->type_name(option.type_name)->required(option.is_required)->group(option.group);
}

void declare(CLI::App& app, const Subcommand& subcommand) {
    CLI::App* const command = app.add_subcommand(subcommand.name, subcommand.help);
    command->set_help_flag(help_words, help_of_help);
    for (const Option& option : subcommand.options) declare(*command, option);
    command->footer(subcommand.footer);
    // CLI11 accepts extra words here, so that one message lists them all
    command->allow_extras();
}

/// Problems of words that belong to no option. If options are unknown, only these are reported,
/// because the other words may be their values.
std::vector<Problem> leftovers(const Subcommand& subcommand, const CLI::App& command) {
    const std::string see = std::string("; see carrom ") + subcommand.name + " --help";
    std::vector<Problem> unknown, others;
    for (const std::string& word : command.remaining()) {
        if (word.size() > 1 && word.front() == '-')
            unknown.push_back({word, 0, "no such option" + see});
        else
            others.push_back({word, 0, subcommand.word_too_many + see});
    }
    return unknown.empty() ? others : unknown;
}

/// Reports empty words, which mostly come from unset shell variables.
void add_empty_values(const CLI::App& command, std::vector<Problem>& problems) {
    for (const CLI::Option* option : command.get_options()) {
        const std::vector<std::string>& words = option->results();
        if (std::find(words.begin(), words.end(), "") != words.end())
            problems.push_back({option->get_name(), 0, "has an empty value; give it one"});
    }
}

void take_words(const Subcommand& subcommand, const CLI::App& command,
                std::vector<Problem>& problems) {
    for (const Option& option : subcommand.options)
        if (const TakeWord* take = std::get_if<TakeWord>(&option.value))
            for (const std::string& word : command.get_option(option.name)->results())
                if (!word.empty()) (*take)(option.name, word, problems);
}

Action action_of(const Subcommand& subcommand, const CLI::App& command) {
    std::vector<Problem> problems = leftovers(subcommand, command);
    add_empty_values(command, problems);
    const bool are_words_certain = problems.empty();
    take_words(subcommand, command, problems);
    Action action = subcommand.action(problems);
    return are_words_certain ? action : failing(std::move(problems));
}

} // namespace

Action failing(std::vector<Problem> problems) {
    return {[problems = std::move(problems)](const Communicator&) -> ExitCode {
        throw InputError(problems);
    }};
}

Action parse_command_line(int argc, char** argv) {
    CLI::App app("Carrom: hard discs in a box, the same bits on every machine shape", "carrom");
    app.set_version_flag("--version", version_text);
    bool is_check_asked = false;
    const CLI::Option* const check = app.add_flag(
        "--check", is_check_asked,
        "With --version: compare the state hashes of two small scenes with those of all builds");
    app.set_help_flag(help_words, help_of_help);
    app.footer(examples);
    app.require_subcommand(1);
    const std::vector<Subcommand> subcommands = {
        run_subcommand(),     replicas_subcommand(), accuracy_subcommand(),
        info_subcommand(),    verify_subcommand(),   diff_subcommand(),
        convert_subcommand(), compare_subcommand(),  keys_subcommand()};
    for (const Subcommand& subcommand : subcommands) declare(app, subcommand);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_name() == "CallForHelp") return printed(app.help());
        if (error.get_name() == "CallForVersion")
            return check->count() > 0 ? version_and_bits() : printed(version_text());
        if (argc < 2) return refused("say what to do, as in carrom run SCENE.toml");
        if (app.get_subcommands().empty())
            return refused('\'' + std::string(argv[1]) + "' is no subcommand");
        return refused(error.what());
    }
    if (check->count() > 0) return refused("--check goes with --version, or behind `run`");
    const CLI::App& chosen = *app.get_subcommands().front();
    const auto subcommand = std::find_if(
        subcommands.begin(), subcommands.end(),
        [&chosen](const Subcommand& one) { return chosen.get_name() == one.name; });
    return action_of(*subcommand, chosen);
}

} // namespace carrom
