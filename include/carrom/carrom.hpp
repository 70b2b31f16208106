// SPDX-License-Identifier: BSD-3-Clause
// The public API of Carrom: hard discs colliding in a box, the same bits on any number of MPI ranks
// and OpenMP threads. Include this header alone. docs/reference/library.md shows how to use it.
#pragma once

#include <carrom/averages.hpp>
#include <carrom/box.hpp>
#include <carrom/disc.hpp>
#include <carrom/errors.hpp>
#include <carrom/measured_table.hpp>
#include <carrom/scene.hpp>
#include <carrom/session.hpp>
#include <carrom/simulation.hpp>
#include <carrom/totals.hpp>
#include <carrom/trajectory.hpp>
#include <carrom/version.hpp>

// The names for a program that uses the library. They stand here and not in the headers above: the
// library's own code has other types of the same names in namespace carrom.
namespace carrom {

using api::CheckpointSchedule;
using api::Disc;
using api::FrameReader;
using api::Options;
using api::Scene;
using api::SceneFacts;
using api::Session;
using api::Simulation;
using api::TrajectoryFields;
using api::TrajectoryWriter;

} // namespace carrom
