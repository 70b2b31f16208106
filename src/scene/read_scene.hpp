// SPDX-License-Identifier: BSD-3-Clause
// Reads checked `SceneParameters` from an input's text (docs/reference/keys.md). Uses no MPI: rank
// 0 reads the file, and every rank parses the same text, so all find the same scene or the same
// problems.
//
// A file whose name ends in `.toml` is a TOML scene. All other input has the legacy text format.
// Problems are collected and thrown together as an InputError, each with its line.
#pragma once

#include <cstdint>
#include <fstream>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.hpp"
#include "scene/disc_columns.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// The part of an input that describes the scene: a whole TOML file, or a legacy header.
struct SceneText {
    std::string name;
    std::string text;
    std::int64_t lines_before_discs = 0; ///< legacy text: number of lines read from the stream
    bool discs_follow = false;           ///< legacy text: the stream continues with lines of discs
    /// The numbers in the columns of `discs.columns`. If the scene has such columns, sizes are not
    /// checked before this is set
    std::optional<DiscColumns> columns{};
};

/// Opens a file for reading. Throws InputError if it does not exist, is not a plain file (a device
/// or a pipe may never end), or is not readable. Called on one rank.
std::ifstream open_input(const std::string& path);

/// Reads the scene's text from `stream` and leaves the stream at the first line of discs, if there
/// is one. Called on one rank.
SceneText read_scene_text(std::istream& stream, const std::string& name);

/// Reads the scene of `input`; `overrides`, each of the form "key=value", replace its settings. A
/// problem in an override has the place "--set KEY". A pure function: the same arguments give the
/// same scene or the same InputError.
SceneParameters read_scene(const SceneText& input, const std::vector<std::string>& overrides = {});

/// Like the function above, but appends problems to `problems`, in the order of lines, and does not
/// throw. If there are problems, use the scene only for `disc_line_problems`, because wrong values
/// are 0 or the default.
SceneParameters read_scene(const SceneText& input, const std::vector<std::string>& overrides,
                           std::vector<Problem>& problems);

/// Reads a scene from a whole text. Lines of discs after a legacy header are not read.
SceneParameters read_scene(std::string_view text, const std::string& name,
                           const std::vector<std::string>& overrides = {});

} // namespace carrom
