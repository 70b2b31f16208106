// SPDX-License-Identifier: BSD-3-Clause
// The one place that decides what may be written where. Every output of every subcommand that a
// user names is checked here, before anything is opened for writing, so that nothing is lost.
//
// An output must not be a file that is read, nor another output, nor a file that a run or replicas
// own (owned_files.hpp), nor replace a file that holds something else than the output does.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"

namespace carrom {

/// A file that is read, and what names it, for example "the scene".
struct NamedFile {
    std::string name;
    std::string path;
};

/// How an output is written, which decides what it may replace.
enum class Output {
    text,     ///< in place, so a pipe or a terminal is allowed; replaces texts
    report,   ///< as a whole; replaces reports
    table,    ///< a new file of CSV
    scene,    ///< as a whole, with a name that only this program gives; replaces scenes and discs
    folder,   ///< a folder of a run or of replicas
    of_folder ///< a file of the run's own folder, which the run may replace
};

/// An output, and what names it, for example "--output".
struct Destination {
    std::string name;
    std::string path;
    Output kind = Output::text;
};

/// The problems of these destinations; `sources` are files that are read. `own_folder` is that of
/// the run at hand, or empty.
std::vector<Problem> problems_with(const std::vector<Destination>& destinations,
                                   const std::vector<NamedFile>& sources,
                                   const std::string& own_folder = {});

} // namespace carrom
