#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# One place, one run: a second run that would write where another is writing is refused, whatever became of that one's
# predecessors; and a run does not write over the checkpoints of another scene.
source "$(dirname "$0")/common.sh"
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=500 --set discs.speed=2 --quiet)
folder=(--set output.checkpoint.folder=kept)
trajectory=(--set output.trajectory.file=t.h5 --set output.trajectory.every_steps=1000000)
log=(--set output.collisions.file=c.h5)

# begin WORD...: an endless run that has begun, as `program`.
begin() {
    "$CARROM_PROGRAM" run "${scene[@]}" "$@" --steps 100000000 >"$test_folder/first" 2>&1 &
    program=$!
    for ((i = 0; i < 200; ++i)); do
        ls -A kept 2>/dev/null | grep -q '[.]lock$' || ls -A | grep -q '[.]lock$' || { sleep 0.1; continue; }
        break
    done
}
end() { # SIGNAL CODE WHAT
    kill -"$1" "$program"
    wait "$program" 2>/dev/null
    code=$?
    expect_code "$2" "$3"
}

begin "${folder[@]}" "${trajectory[@]}"
for ranks in 1 3; do
    run "$ranks" run "${scene[@]}" "${folder[@]}" --steps 5
    expect_code 2 "a second run into a folder on $ranks ranks"
    expect_told "output.checkpoint.folder kept: another run is writing there (process $program on" "a second run into a folder on $ranks ranks"
done
run 1 run "${scene[@]}" "${trajectory[@]}" --set output.checkpoint.folder=./kept/../kept --steps 5
expect_code 2 'a second run into both'
expect_told 'output.trajectory.file t.h5: another run is writing there' 'a second run into both'
expect_told 'output.checkpoint.folder ./kept/../kept: another run' 'a second run into both'
end KILL 137 'a killed run'
[ -e kept/.carrom.lock ] || complain 'the lock of a killed run is not what this test thinks it is'
run 2 run "${scene[@]}" "${folder[@]}" "${trajectory[@]}" --steps 5
expect_code 0 'a run after a killed one'
[ -z "$(ls -A . kept | grep 'lock$')" ] || complain "locks are left: $(ls -A . kept)"

begin "${log[@]}"
run 1 run "${scene[@]}" "${log[@]}" --steps 5
expect_code 2 'a second run into a log'
expect_told 'output.collisions.file c.h5: another run' 'a second run into a log'
end TERM 75 'the first run'
run 1 verify c.h5
expect_code 0 'the first log'

# The same scene begun anew is told of its older checkpoints, another is refused.
cp kept/checkpoint-000000000005.h5 before.h5
run 2 run "${scene[@]}" "${folder[@]}" --steps 5
expect_code 0 'the same run again'
expect_told 'kept has checkpoints of this very run up to step 5' 'the same run again'
run 1 diff before.h5 kept/checkpoint-000000000005.h5
expect_code 0 'the same run again has the same end'
before=$(md5sum kept/*)
for ranks in 1 3; do
    run "$ranks" run "${scene[@]}" "${folder[@]}" --steps 7 --set discs.seed=7 --report report.json
    expect_code 2 "another run on $ranks ranks"
    expect_told "checkpoint-000000000005.h5 is another run's ('discs.seed' is 3210 there and 7 here) and would be written over" "another run on $ranks ranks"
    [ ! -e report.json ] || complain 'a refused run has written'
done
run 1 run "${scene[@]}" --set output.checkpoint.folder=other --steps 3 --set discs.seed=7
expect_code 0 'another run elsewhere'
run 1 run --restart other --quiet --steps 9 --set output.checkpoint.folder=kept
expect_code 2 'going on into the folder of another run'
[ "$(md5sum kept/*)" = "$before" ] || complain 'checkpoints of a run were touched by another'
run 1 run --restart other --quiet --steps 4 --set output.checkpoint.folder=kept
expect_code 0 'going on beside checkpoints that are not reached'
expect_told "checkpoint-000000000005.h5 is another run's ('discs.seed' is 3210 there and 7 here), and --restart with this folder" 'going on beside them'
finish
