// SPDX-License-Identifier: BSD-3-Clause
// The one place that decides what may be written where. Every output of every subcommand that a
// user names is checked here, before anything is opened for writing, so that no file is lost.
//
// An output must not be a file that is read, another output, or a file that a run or replicas own
// (owned_files.hpp). It must not replace a file with another kind of content.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"

namespace carrom {

/// A file that is read, and its name in messages, for example "the scene".
struct NamedFile {
    std::string name;
    std::string path;
};

/// How an output is written, and which files it may replace.
enum class Output {
    text,   ///< written in place, so it may be a pipe or a terminal; replaces FileContent::other
    report, ///< written as a whole; replaces reports
    table,  ///< a new CSV file
    /// A scene, or a file of discs, whose name this program has
    /// chosen; written as a whole; replaces scenes and discs
    scene,
    folder,   ///< a folder of a run or of replicas
    of_folder ///< a file of the run's own folder, which the run may replace
};

/// An output, and its name in messages, for example "--output".
struct Destination {
    std::string name;
    std::string path;
    Output kind = Output::text;
};

/// The problems of these destinations. `sources` are files that are read; `own_folder` is the
/// folder of the present run, or empty.
std::vector<Problem> problems_with(const std::vector<Destination>& destinations,
                                   const std::vector<NamedFile>& sources,
                                   const std::string& own_folder = {});

} // namespace carrom
