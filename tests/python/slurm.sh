#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A sweep as an array job of a real Slurm: it submits, collects, and submits what is missing.
# Its folder has a space in its name. Argument: the folder of environments.
source "$(dirname "$0")/../system/common.sh"
source "$(dirname "$0")/environment.sh"

use_environment "$1/package"
has h5py h5py && has numpy numpy || skip_test "h5py is not to be had: $(said)"
install_package
release_environment
source "$(dirname "$0")/../slurm/cluster.sh"
start_cluster

cat >sweep.py <<'END'
import sys
import carrom

scene = {
    "box": {"size": 20},
    "discs": {"count": 50, "packing": 0.2},
    "time": {"steps": 40, "method": "event-driven"},
}
grid = {"discs.packing": [float(word) for word in sys.argv[2:]]}
slurm = {"time": "00:05:00"} if sys.argv[1] == "submit" else False
ranks = 2 if sys.argv[1] == "submit" else 1
sweep = carrom.sweep(scene, grid, folder="a sweep", slurm=slurm, ranks=ranks)
print(sweep.job, *(run.state_hash for run in sweep.runs))
END
ask() { "$python" sweep.py "$@" 2>err || { complain "sweep.py $*"; sed 's/^/    /' err; }; }

read -r job hashes <<<"$(ask submit 0.1 0.2)"
ends_as "$job" COMPLETED 90
n=$(squeue -h -j "$job" 2>/dev/null | wc -l)
[ "$n" -eq 0 ] || complain "job $job still has $n tasks"
read -r job hashes <<<"$(ask submit 0.1 0.2)"
[ "$job" = None ] || complain "finished runs are submitted again: job $job"
[ "$(wc -w <<<"$hashes")" -eq 2 ] ||
    { complain "not two runs: $hashes"; tail -n 5 "a sweep"/*.log; }

# A third point is run alone. All have the bits of runs without Slurm.
read -r job more <<<"$(ask submit 0.1 0.2 0.3)"
ends_as "$job" COMPLETED 90
[ "$(wc -l <"a sweep/commands.txt")" -eq 1 ] ||
    complain "not one command: $(cat "a sweep/commands.txt")"
mv "a sweep" by_slurm
read -r _ here <<<"$(ask here 0.1 0.2 0.3)"
mv by_slurm sweep.slurm && mv "a sweep" here && mv sweep.slurm "a sweep"
read -r _ there <<<"$(ask submit 0.1 0.2 0.3)"
[ -n "$here" ] && [ "$here" = "$there" ] || complain "other bits: $here and $there"

# A job that still waits is not submitted twice.
scontrol update NodeName=n[1-2] State=DRAIN Reason=test
read -r job _ <<<"$(ask submit 0.1 0.2 0.3 0.4)"
"$python" sweep.py submit 0.1 0.2 0.3 0.4 >out 2>err && complain 'submitted twice'
grep -q "job $job still works at this sweep" err ||
    complain "not told of job $job: $(tail -n 1 err)"
scancel "$job"
finish
