// SPDX-License-Identifier: BSD-3-Clause
// What a file of discs says of each disc beyond its place and velocity: `discs.columns` names it.
//
// Radii and masses are known before anything else is made of a scene, for its checks need them, and
// by every rank, since a dynamics asks for those of any disc. So rank 0 reads the file twice: for
// these columns, then for the discs. Discs that follow each other and are alike are one class; at
// worst each is a class of its own.
#pragma once

#include <istream>
#include <vector>

#include "scene/scene.hpp"

namespace carrom {

/// By id. Without `is_whole` the file has lines that are wrong, or not the right ones: DiscReader
/// says which.
struct DiscColumns {
    std::vector<Species> species; ///< empty where radii are no column
    FirstNumbers numbers{};       ///< likewise
    bool is_whole = true;
};

/// Reads all lines of `stream`, `id x y vx vy` and the scene's columns. Costs 32 bytes a disc while
/// it reads.
DiscColumns read_disc_columns(std::istream& stream, const Scene& scene);

bool has_column(const Scene& scene, DiscColumn column);
/// Where the column's number of a disc belongs.
double& number_of(DiscColumn column, SizeAndMass& body, BySideColumn<double>& beside);
/// As scenes call it.
const char* name_of(DiscColumn column);
/// Append discs, as a class or a run of their own only if they differ from those before.
void add_species(std::vector<Species>& species, const Species& next);
void add_numbers(std::vector<NumberRun>& runs, std::uint64_t count, double number);

} // namespace carrom
