// SPDX-License-Identifier: BSD-3-Clause
// The public API of Carrom: hard discs that collide in a box. Results have the same bits on any
// number of MPI ranks and OpenMP threads. Include only this header (docs/reference/library.md).
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
