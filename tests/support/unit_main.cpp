// SPDX-License-Identifier: BSD-3-Clause
// The main of every unit test: no MPI, so that test discovery at build time is quick.
#define CARROM_CATCH_MAIN
#include "catch.hpp"

int main(int argc, char** argv) { return Catch::Session().run(argc, argv); }
