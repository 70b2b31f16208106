// SPDX-License-Identifier: BSD-3-Clause
#include "apps/command_line.hpp"

#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/accuracy_command.hpp"
#include "apps/file_commands.hpp"
#include "machine/machine.hpp"
#include "apps/run_command.hpp"

namespace carrom {

namespace {

constexpr const char* examples = R"(Examples:
  carrom run inputs/gas.toml
  mpirun -np 4 carrom run inputs/gas.toml --threads 2 --report report.json
  carrom run inputs/gas.toml --set time.steps=50 --set discs.count=2000
  carrom accuracy inputs/gas.toml --output gas.csv
  carrom info FILE.h5
  carrom diff A.h5 B.h5
  carrom convert FILE.h5 --to xyz > discs.xyz
  carrom run --help

Discs move freely and collide with each other and with the walls of a square box.
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

Action printed(std::string text) {
    return [text = std::move(text)](const Communicator& ranks) {
        if (ranks.is_root()) fmt::print("{}\n", text);
        return ExitCode::success;
    };
}

} // namespace

Action parse_command_line(int argc, char** argv) {
    CLI::App app("Carrom: hard discs in a square box, the same bits on every machine shape",
                 "carrom");
    app.set_version_flag("--version", "carrom " + version());
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.footer(examples);
    app.require_subcommand(1);
    Action action;
    add_run_command(app, action);
    add_accuracy_command(app, action);
    add_file_commands(app, action);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return printed(app.help());
    } catch (const CLI::CallForVersion&) {
        return printed("carrom " + version());
    } catch (const CLI::ParseError& error) {
        std::string reason = error.what();
        if (argc < 2)
            reason = "say what to do, as in carrom run SCENE.toml";
        else if (app.get_subcommands().empty())
            reason = fmt::format("'{}' is no subcommand", argv[1]);
        throw InputError({{"command line", 0, reason + " (see carrom --help)"}});
    }
    return action;
}

} // namespace carrom
