#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Trajectory and collisions: the same numbers for every machine shape, and for a run that was stopped, killed far beyond
# its last checkpoint and gone on with. Arguments: the input and options; it must run 90 steps.
source "$(dirname "$0")/common.sh"
input=$CARROM_SOURCE_DIR/$1
shift
small=("$@" --quiet)
recordings() { # FOLDER
    printf '%s\n' --set "output.trajectory.file=$1/t.h5" --set output.trajectory.every_steps=4 --set "output.collisions.file=$1/c.h5" \
        --set 'output.trajectory.fields=["position", "velocity", "collisions"]' --set output.trajectory.precision=double
}
same() { # FOLDER WHAT
    for file in t.h5 c.h5; do
        run 1 diff "whole/$file" "$1/$file"
        [ "$code" -eq 0 ] || { complain "$file differs: $2"; sed 's/^/    /' "$test_folder/out"; show; }
        run 2 verify "$1/$file"
        expect_code 0 "verify $1/$file: $2"
    done
}

mkdir whole
mapfile -t record < <(recordings whole)
run 2 run "$input" "${small[@]}" "${record[@]}" --report report.json
expect_code 0 'uninterrupted'
run 1 info whole/t.h5
grep -q 'frames *23, of steps 0 to 88' "$test_folder/out" || complain "not the frames of steps 0 to 88: $(cat "$test_folder/out")"
run 1 info whole/c.h5
n_logged=$(sed -n 's/^collisions *//p' "$test_folder/out")
n_made=$(($(json_value report.json wall_collisions) + $(json_value report.json pair_collisions)))
[ "$n_logged" = "$n_made" ] || complain "$n_logged collisions in the log, $n_made made"
[ "$n_made" -gt 100 ] || complain 'hardly any collisions'

for shape in '1 3' '3 1' '7 1'; do
    read -r ranks threads <<<"$shape"
    mkdir "shape$ranks"
    mapfile -t record < <(recordings "shape$ranks")
    run "$ranks" run "$input" "${small[@]}" "${record[@]}" --threads "$threads"
    expect_code 0 "$ranks ranks"
    same "shape$ranks" "$ranks ranks x $threads threads"
done

# Two stretches; then from an earlier checkpoint again, so that both files have to be cut back.
mkdir parts
mapfile -t record < <(recordings parts)
store=(--set output.checkpoint.folder=kept --set output.checkpoint.every_steps=25 --set output.checkpoint.keep=1000000)
run 3 run "$input" "${small[@]}" "${record[@]}" "${store[@]}" --steps 60
expect_code 0 'the first part'
run 1 run "$input" "${small[@]}" "${record[@]}" "${store[@]}" --restart latest --threads 2
expect_code 0 'the second part'
same parts 'stopped and gone on with'
run 4 run --restart kept/checkpoint-000000000025.h5 --quiet --set time.steps=90
expect_code 0 'again from step 25'
same parts 'cut back and gone on with'

# Killed somewhere after a checkpoint: what was added since is taken back first.
"$CARROM_PROGRAM" run "$input" "${small[@]}" "${record[@]}" "${store[@]}" --restart latest --steps 100000 >/dev/null 2>&1 &
program=$!
sleep 2
kill -KILL "$program"
wait "$program" 2>/dev/null
run 2 run "$input" "${small[@]}" "${record[@]}" "${store[@]}" --restart kept/checkpoint-000000000075.h5
expect_code 0 'after a kill'
same parts 'killed and gone on with'
[ ! -e parts/t.h5.undo ] || complain 'an undo journal is left'

# Another run's recordings are not gone on with, nor are files of the other kind; what is missing is told.
mkdir others
mapfile -t record < <(recordings others)
run 1 run "$input" "${small[@]}" "${record[@]}" --steps 40 --set time.sync_every=7
expect_code 0 'another run'
cp others/*.h5 .
for ranks in 1 3; do
    run "$ranks" run "$input" "${small[@]}" "${record[@]}" "${store[@]}" --restart kept/checkpoint-000000000025.h5
    expect_code 2 "a restart onto another run's trajectory on $ranks ranks"
    expect_told "others/t.h5: is another run's ('time.sync_every' is 7 there and" "a restart onto another run's trajectory"
done
cmp t.h5 others/t.h5 || complain "another run's trajectory was touched"
cp whole/t.h5 others/
run 1 run "$input" "${small[@]}" "${record[@]}" "${store[@]}" --restart kept/checkpoint-000000000025.h5
expect_code 2 "a restart onto another run's log"
expect_told "others/c.h5: is another run's" "a restart onto another run's log"
cmp c.h5 others/c.h5 || complain "another run's log was touched"
cp whole/t.h5 others/c.h5
run 1 run "$input" "${small[@]}" "${record[@]}" "${store[@]}" --restart kept/checkpoint-000000000025.h5
expect_code 2 'a trajectory in the place of a log'
expect_told 'others/c.h5: is no log of collisions' 'a trajectory in the place of a log'
rm others/*
run 2 run "$input" "${small[@]}" "${record[@]}" "${store[@]}" --restart kept/checkpoint-000000000025.h5
expect_code 0 'a restart without the recordings of before'
expect_told 'others/t.h5: has no frames of steps 0 to 24, and goes on with step 28' 'a restart without its trajectory'
expect_told 'others/c.h5: begins with step 26' 'a restart without its log'

run 3 run "$input" "${small[@]}" "${record[@]}" --steps 1 --set output.trajectory.file=no/such/folder.h5
expect_code 2 'a trajectory in no folder'
expect_told 'output.trajectory.file no/such/folder.h5: cannot be written: No such file or directory' 'a trajectory in no folder'
run 2 run "$input" "${small[@]}" "${record[@]}" --set output.collisions.file=whole/t.h5 --set output.trajectory.file=whole/t.h5
expect_code 2 'two recordings in one file'
expect_told 'are the same file' 'two recordings in one file'
run 1 verify whole/t.h5
expect_code 0 'a file that was refused as the place for two recordings'
finish
