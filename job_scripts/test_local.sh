#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Test this checkout, from nothing: install what is missing, build everything, run every test.
#
#   ./job_scripts/test_local.sh
#   ./job_scripts/test_local.sh -L unit        (options go to ctest)
#   MPI=mpich ./job_scripts/test_local.sh
#
# What run_local.sh has built is not built again. Sanitizers and fuzzers: job_scripts/sanitize.sh.
# The Python package: ./job_scripts/test_local.sh -C python -L python
# Hours of random scenes and long studies: ./job_scripts/test_local.sh -C long -L long
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages "${test_packages[@]}"
install_optional "${optional_test_packages[@]}"
configure -DCARROM_TESTS=ON
build_targets
# Tests run more threads than most machines have cores.
use_mpi_settings $((2 * $(cores)))
# Some tests wait longer than they compute: two more of them than there are cores.
exec ctest --test-dir "$build" --output-on-failure --no-tests=error \
    --parallel $(($(cores) + 2)) "$@" </dev/null
