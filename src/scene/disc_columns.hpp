// SPDX-License-Identifier: BSD-3-Clause
// The columns that `discs.columns` names besides ids, positions and velocities.
//
// The checks of a scene need radii and masses. All ranks need the columns of all discs, because the
// dynamics uses them. So rank 0 first reads these columns, and then the file is read for the discs.
// Successive discs of equal radius and mass form a species; at worst each disc is its own species.
#pragma once

#include <istream>
#include <vector>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// Numbers in order of id. If `is_whole` is false, the file is unreadable, or has wrong lines
/// or a wrong number of lines. DiscReader reports this when it reads the discs.
struct DiscColumns {
    std::vector<Species> species; ///< empty if the file has no column of radii
    FirstNumbers numbers{};       ///< empty if the file has no side columns
    bool is_whole = true;
};

/// Reads all lines of `stream` from the first one. This takes 48 bytes of memory per disc.
DiscColumns read_disc_columns(std::istream& stream, const SceneParameters& scene);

bool has_column(const SceneParameters& scene, DiscColumn column);
/// Whether the scene's lines of discs have a column that read_disc_columns reads.
bool has_columns_beside(const SceneParameters& scene);
/// Whether the lines of the scene's file contain velocities.
bool lines_have_velocities(const SceneParameters& scene);
/// The number in `body` or `beside` that belongs to a column of radii or masses or a side column.
double& number_of(DiscColumn column, SizeAndMass& body, BySideColumn<double>& beside);
/// The column's name in scenes.
const char* name_of(DiscColumn column);
/// These functions append discs to a list. They add an entry only if the discs differ from those
/// of the last entry; otherwise they increase the number of discs in the last entry.
void add_species(std::vector<Species>& species, const Species& next);
void add_numbers(std::vector<NumberRun>& runs, std::uint64_t count, double number);

} // namespace carrom
