// SPDX-License-Identifier: BSD-3-Clause
// What a file of discs (`discs.file`) says about itself: its columns and how many discs it has.
//
// A header line names columns, or a comment of nothing but their names does. Without one the number
// of words in the first line of data tells whether there are ids and velocities: `id x y vx vy`,
// `x y vx vy`, `id x y` or `x y`, each with the scene's `discs.columns` behind. Price: one block of
// the file; all of it once if the scene does not know the number of discs.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct SurveyOfDiscs {
    std::vector<std::string> settings; ///< `key=value`, what the scene does not say itself
    std::vector<Problem> problems;     ///< the file is no list of discs, or has other columns
};

/// Surveys the scene's file of discs from its beginning. Called on one rank.
SurveyOfDiscs survey_discs(std::istream& file, const SceneParameters& scene);

} // namespace carrom
