// SPDX-License-Identifier: BSD-3-Clause
// Files that a run writes must not be files that it reads, nor each other, nor devices.
// This is checked before anything is opened for writing, so that nothing is lost.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"

namespace carrom {

/// A file and what names it, for example "--output" or "the scene".
struct NamedFile {
    std::string name;
    std::string path;
    bool may_be_special = false; ///< written in place, so a pipe or a terminal is allowed
};

/// The problems of these destinations; `sources` are files that are read.
std::vector<Problem> problems_with(const std::vector<NamedFile>& destinations,
                                   const std::vector<NamedFile>& sources);

} // namespace carrom
