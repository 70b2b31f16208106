// SPDX-License-Identifier: BSD-3-Clause
// The main of every unit test: no MPI, so that test discovery at build time is quick.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
