// SPDX-License-Identifier: BSD-3-Clause
// Finds the columns and the number of discs in a file of discs (`discs.file`).
//
// Columns are named by a header line, or by a comment that consists of their names. Otherwise the
// number of words in the first line of data shows whether there are ids and velocities: `id x y vx
// vy`, `x y vx vy`, `id x y` or `x y`, each followed by the scene's `discs.columns`. Cost: reads
// one block of the file, or all of it if the scene does not give the number of discs.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct SurveyOfDiscs {
    /// Settings `key=value` that the file adds to the scene: its columns and its number of discs
    std::vector<std::string> settings;
    /// errors, such as another file format, or columns that differ from those of the scene
    std::vector<Problem> problems;
};

/// Surveys the scene's file of discs from its beginning. Called on one rank.
SurveyOfDiscs survey_discs(std::istream& file, const SceneParameters& scene);

} // namespace carrom
