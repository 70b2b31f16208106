// SPDX-License-Identifier: BSD-3-Clause
// From an input's text to one checked `Scene` (docs/reference/keys.md). No MPI: rank 0 takes
// the text from the file, every rank reads the same text and so finds the same scene or the same
// problems.
//
// A name that ends in `.toml` is a TOML scene; everything else, and standard input, is the legacy
// text format. All problems are collected and thrown at once as an InputError, each with its line.
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
#include "scene/scene.hpp"

namespace carrom {

/// The part of an input that describes the scene: all of a TOML file, the course program's header.
struct SceneText {
    std::string name;
    std::string text;
    std::int64_t lines_before_discs = 0;  ///< legacy text: lines taken from the stream
    bool discs_follow = false;            ///< legacy text: the stream goes on with lines of discs
    std::optional<DiscColumns> columns{}; ///< once the scene is known to have some
                                          ///< (`discs.columns`); till then sizes are not checked
};

/// Opens a file to read; InputError where it is missing, no plain file (a device or a pipe may
/// never end), or not readable. One rank calls this.
std::ifstream open_input(const std::string& path);

/// Takes the scene's text from `stream` and leaves the stream at the first line of discs, if any.
/// One rank calls this.
SceneText read_scene_text(std::istream& stream, const std::string& name);

/// The scene of that text with `overrides`, "key=value" each, on top. Problems of an override have
/// the place
/// "--set KEY". Pure: same arguments, same scene or same InputError.
Scene read_scene(const SceneText& input, const std::vector<std::string>& overrides = {});

/// The same, but appends the problems to `problems`, in the order of lines. Where there are some
/// the scene is good for nothing but `disc_line_problems`: what is wrong in it is 0 or its default.
Scene read_scene(const SceneText& input, const std::vector<std::string>& overrides,
                 std::vector<Problem>& problems);

/// The same for a whole text, discs included.
Scene read_scene(std::string_view text, const std::string& name,
                 const std::vector<std::string>& overrides = {});

} // namespace carrom
