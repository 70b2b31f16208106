// SPDX-License-Identifier: BSD-3-Clause
// Opens a file for reading whose name comes from a user or a folder. Anything except a plain file
// is an error, because a pipe without a writer would make the open wait for ever.
#pragma once

#include <fstream>
#include <string>

namespace carrom {

/// Why a stream could not be opened, for messages; empty if it was.
struct OpenProblem {
    std::string text;
    /// The path is not a plain file, but a folder; or a pipe, a device or a socket
    bool is_folder = false, is_special = false;
};

/// Opens a plain file for reading as bytes. Otherwise the stream has failed, and `problem` says
/// why. Never waits.
std::ifstream open_plain_file(const std::string& path, OpenProblem& problem);
std::ifstream open_plain_file(const std::string& path);

} // namespace carrom
