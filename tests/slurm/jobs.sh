#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The job scripts that run once: each is submitted to a Slurm, ends well, and has the same bits as
# the program alone, by srun and by mpirun, on one node and on two, as one job and as an array.
source "$(dirname "$0")/../system/common.sh"
source "$(dirname "$0")/cluster.sh"
start_cluster
export INPUT=inputs/gas.toml OPTIONS='--set discs.count=1000 --set discs.speed=2 --steps 60'

run 1 run "$CARROM_SOURCE_DIR/$INPUT" $OPTIONS --report alone.json --quiet
expect_code 0 'alone'
hash=$(json_value alone.json state_hash)
has_hash() { # REPORT RANKS WHAT
    [ "$(json_value "$1" state_hash)" = "$hash" ] || complain "another state hash: $3"
    [ "$(json_value "$1" ranks)" = "$2" ] || complain "not on $2 ranks: $3"
}

STEPS=20 submit smoke.sbatch
smoke=$job
LAUNCHER=mpirun STEPS=20 submit smoke.sbatch
smoke_mpirun=$job
REPORT=$PWD/one.json submit one_node.sbatch --ntasks=2 --cpus-per-task=2
one=$job
several=()
for launcher in srun mpirun; do
    LAUNCHER=$launcher REPORT=$PWD/$launcher.json submit several_nodes.sbatch --ntasks-per-node=2 \
        --cpus-per-task=1
    several+=("$job")
done
RANKS='1 2 3' DISCS=1000 STEPS=30 TABLE=$PWD/strong.csv submit strong_scaling.sbatch \
    --ntasks-per-node=3 --array=0-2
strong=$job
RANKS='1 4' DISCS_PER_RANK=500 STEPS=30 TABLE=$PWD/weak.csv submit weak_scaling.sbatch --nodes=2 \
    --ntasks-per-node=2 --array=0-1
weak=$job
small_study='--set discs.count=200 --set discs.speed=20 --starts 2 --repetitions 2'
small_study+=' --micro-steps 2 --collisions 3 --approach 2'
CARROM=$CARROM_PROGRAM SCENE=$INPUT OPTIONS=$small_study FOLDER=$PWD/accuracy submit \
    accuracy.sbatch --array=0-2
accuracy=$job
PROGRAM=/no/such/program submit smoke.sbatch
without=$job

for job in "$smoke" "$smoke_mpirun" "$one" "${several[@]}" "$strong" "$weak" "$accuracy"; do
    ends_as "$job" COMPLETED 90; done
ends_as "$without" FAILED 30
grep -q 'no program /no/such/program' carrom-smoke-"$without"-*.log ||
    complain 'a missing program is not told'
for log in carrom-smoke-"$smoke"-*.log carrom-smoke-"$smoke_mpirun"-*.log; do
    grep -q '^state hash ' "$log" || complain "no summary in $log"
done
has_hash one.json 2 'one node'
[ "$(json_value one.json threads)" = 2 ] || complain 'one node: not 2 threads'
has_hash srun.json 4 'two nodes, srun'
has_hash mpirun.json 4 'two nodes, mpirun'
grep -q 'on n\[1-2\]: srun' carrom-several-nodes-*.log || complain 'several nodes: not on two nodes'

[ "$(sed 1d strong.csv | cut -d, -f1 | sort | tr '\n' ' ')" = '1 2 3 ' ] ||
    complain "strong scaling: $(cat strong.csv)"
[ "$(sed 1d strong.csv | cut -d, -f7 | sort -u | wc -l)" -eq 1 ] ||
    complain "strong scaling: several hashes: $(cat strong.csv)"
[ "$(sed 1d weak.csv | cut -d, -f1,3 | sort | tr '\n' ' ')" = '1,500 4,2000 ' ] ||
    complain "weak scaling: $(cat weak.csv)"

# The array's three tables hold the lines of the whole study, but for the times.
run 1 accuracy "$CARROM_SOURCE_DIR/$INPUT" $small_study --output whole.csv --quiet
expect_code 0 'the study alone'
lines() { tail -qn +2 "$@" | cut -d, -f1-30 | sort; }
[ "$(ls accuracy | wc -l)" -eq 3 ] || complain "not a table for each task: $(ls accuracy)"
[ "$(lines whole.csv | wc -l)" -eq $((2 * 2 * 2 * 2 * 6)) ] ||
    complain "the study alone has $(lines whole.csv | wc -l) lines"
cmp <(lines whole.csv) <(lines accuracy/*.csv) ||
    complain 'the array made another study than one process'
finish
