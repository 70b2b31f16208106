// SPDX-License-Identifier: BSD-3-Clause
// Opens files for reading that a user can name or put into a folder. Anything but a plain file is
// refused on the open handle, because a pipe without a writer would make the open wait for ever.
#pragma once

#include <fstream>
#include <string>

namespace carrom {

/// Why a stream could not be opened, for messages; empty if it was.
struct OpenProblem {
    std::string text;
    bool is_folder = false, is_special = false; ///< a pipe, a device or a socket
};

/// Opens a plain file for reading as bytes. Otherwise the stream has failed, and `problem` says
/// why. Waits for nothing.
std::ifstream open_plain_file(const std::string& path, OpenProblem& problem);
std::ifstream open_plain_file(const std::string& path);

} // namespace carrom
