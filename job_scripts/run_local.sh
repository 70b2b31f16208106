#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Run a scene on all cores of this machine, from nothing: install what is missing, build, run.
#
#   ./job_scripts/run_local.sh inputs/gas.toml
#   ./job_scripts/run_local.sh inputs/gas.toml --steps 100 --report report.json
#   RANKS=2 ./job_scripts/run_local.sh inputs/gas.toml --threads 4
#   MPI=mpich ./job_scripts/run_local.sh inputs/gas.toml
#
# Everything after the scene goes to `carrom run`. RANKS (default: all cores), OMP_NUM_THREADS (1)
# and MPI (openmpi or mpich) may be set from outside. If neither number is set, 16 cores or more are
# shared by ranks of 4 threads, because the strips of many ranks are narrow.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

if [ $# -lt 1 ] || [ "$1" = --help ] || [ "$1" = -h ]; then
    sed -n '3,12s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi

if [ -z "${RANKS:-}${OMP_NUM_THREADS:-}" ] && [ "$(whole_cores)" -ge 16 ]; then
    OMP_NUM_THREADS=4
    RANKS=$(($(whole_cores) / 4))
fi
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1}
for number in "${RANKS:=$(cores)}" "$OMP_NUM_THREADS"; do
    [[ $number =~ ^[1-9][0-9]*$ ]] ||
        die "RANKS and OMP_NUM_THREADS are whole numbers from 1, not $number"
done

install_packages
# Builds the program alone. A build folder with tests keeps them, because test_local.sh uses the
# same folder.
if [ -e "$build/CMakeCache.txt" ]; then configure; else configure -DCARROM_TESTS=OFF; fi
build_targets carrom libcarrom # all that `cmake --install` installs

use_mpi_settings $((RANKS * OMP_NUM_THREADS))
exec "$(mpi_launcher "$build")" -n "$RANKS" "$build/carrom" run "$@"
