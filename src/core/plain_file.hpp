// SPDX-License-Identifier: BSD-3-Clause
// Opens files for reading. The names come from users or from listings of folders, so a name may
// refer to a pipe. Only plain files are accepted, because opening a pipe that has no writer would
// wait for ever.
#pragma once

#include <fstream>
#include <string>

namespace carrom {

/// The reason why a file could not be opened, for messages; empty if it could be opened.
struct OpenProblem {
    std::string text;
    /// Whether the path is a folder; whether it is a pipe, a device or a socket
    bool is_folder = false, is_special = false;
};

/// Opens a plain file for reading bytes, without waiting. If that fails, the stream's fail bit is
/// set and `problem` has the reason.
std::ifstream open_plain_file(const std::string& path, OpenProblem& problem);
std::ifstream open_plain_file(const std::string& path);

} // namespace carrom
