#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Run a scene on all cores of this machine, from nothing: install what is missing, build, run, print the summary.
#
#   ./job_scripts/run_local.sh inputs/gas.toml
#   ./job_scripts/run_local.sh inputs/gas.toml --steps 100 --report report.json
#   RANKS=2 ./job_scripts/run_local.sh inputs/gas.toml --threads 4
#
# Everything after the scene goes to `carrom run`. RANKS (all cores) and OMP_NUM_THREADS (1) may be set from outside.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

if [ $# -lt 1 ] || [ "$1" = --help ] || [ "$1" = -h ]; then
    sed -n '3,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi

install_packages
build_target carrom

ranks=${RANKS:-$(nproc)}
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1}
launch_settings $((ranks * OMP_NUM_THREADS))
exec mpirun -np "$ranks" "$build/carrom" run "$@"
