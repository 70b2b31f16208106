#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The job script that goes on by itself, on a Slurm whose jobs are signalled, preempted, lose their
# node, or are killed at their time limit: each time the finished run has the state hash of the
# uninterrupted one.
source "$(dirname "$0")/../system/common.sh"
source "$(dirname "$0")/cluster.sh"
start_cluster
export INPUT=inputs/gas.toml STEPS=4000
small='--set discs.count=3000 --set discs.speed=2 --quiet'
export OPTIONS="$small --set output.checkpoint.every_steps=300"

begin() { # NAME WORD...: the folder of the run is named after it
    local name=$1
    shift
    FOLDER=$PWD/$name submit long_run.sbatch --ntasks=2 --ntasks-per-node=2 --cpus-per-task=1 "$@"
    declare -g "$name=$job"
}
has_checkpoint() { compgen -G "$1/checkpoints/checkpoint-*.h5" >/dev/null; }
under_way() { wait_until 60 has_checkpoint "$1" || complain "$1: no checkpoint within a minute"; }
has_hash() {
    [ "$(json_value "$1/report.json" state_hash)" = "$hash" ] || complain "another state hash: $1"
    [ "$(json_value "$1/report.json" first_step)" -gt 0 ] ||
        complain "$1: the last part began at the start"
}
restarts() { restart "${!1}" || complain "$1: not requeued: $(job_state "${!1}")"; }

# This one hangs once it has a checkpoint: until its limit of a minute is over, while the others are
# tried.
cat >stalls.sh <<END
#!/bin/sh
(
    until ls "$PWD/limit"/checkpoints/checkpoint-*.h5; do sleep 0.1; done
    kill -STOP \$\$
) >/dev/null 2>&1 &
exec "$CARROM_PROGRAM" "\$@"
END
chmod +x stalls.sh
PROGRAM=$PWD/stalls.sh begin limit --time=1 --signal=B:CONT@1 --ntasks=1 --ntasks-per-node=1 \
    --nodelist=n2

run 2 run "$CARROM_SOURCE_DIR/$INPUT" $small --steps "$STEPS" --report whole.json
expect_code 0 'uninterrupted'
hash=$(json_value whole.json state_hash)

# Slurm's warning, which reaches the script alone, with both launchers.
for launcher in srun mpirun; do
    LAUNCHER=$launcher begin "warned_$launcher"
    under_way "warned_$launcher"
    scancel --signal=USR1 --batch "$job"
    restarts "warned_$launcher"
    ends_as "$job" COMPLETED 90
    has_hash "warned_$launcher"
    grep -q 'requeued to go on from checkpoint-' carrom-long-run-"$job"-*.log ||
        complain "warned_$launcher: no word of being requeued"
done

# TERM to the ranks themselves, as on preemption.
begin preempted
under_way preempted
scancel --signal=TERM "$job"
restarts preempted
ends_as "$job" COMPLETED 90
has_hash preempted

# A job that is cancelled stays away.
begin cancelled
under_way cancelled
scancel "$job"
wait_until 30 is_over "$job"
has_state "$job" CANCELLED || complain "a cancelled job is $(job_state "$job")"

# The node goes down, with all that runs on it and its daemon: Slurm requeues the job, which goes on
# on the other node.
begin failed --nodelist=n1
under_way failed
mapfile -t daemons < <(pgrep -f "slurmstepd: \[$job\.")
mapfile -t processes < <(pgrep -P "$(IFS=, && echo "${daemons[*]}")")
# children last, so that no parent can report their end
kill -KILL "$(cat "$cluster/run/slurmd.n1.pid")" "${daemons[@]}" "${processes[@]}"
scontrol update NodeName=n1 State=DOWN Reason=test
restarts failed
ends_as "$job" COMPLETED 90
has_hash failed
scontrol show job -o "$job" | grep -q 'NodeList=n2 ' ||
    complain 'failed: did not move to the other node'

ends_as "$limit" TIMEOUT 120
under_way limit
begin limit
ends_as "$job" COMPLETED 90
has_hash limit
finish
