#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Test this checkout, from nothing: install what is missing, build everything, run the short form of
# job_scripts/sanitize.sh, then every test.
#
#   ./job_scripts/test_local.sh
#   ./job_scripts/test_local.sh -L unit        (options go to ctest; no sanitizers then)
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages
install_test_packages
build_target
# Tests run more threads than most machines have cores: those that wait must not spin. Open MPI's settings are made by
# the tests themselves (tests/functions.cmake).
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
code=0
[ $# -gt 0 ] || bash "$top/job_scripts/sanitize.sh" --short || code=1
# Many tests wait longer than they compute: two more of them than there are cores.
ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel $(($(nproc) + 2)) "$@" </dev/null || code=$?
exit $code
