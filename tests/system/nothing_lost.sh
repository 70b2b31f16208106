#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# If a folder or file cannot be read, a run does not start over the recordings of another run, and
# --overwrite removes only files that a run has written. Argument: a library that fails to list
# folders.
source "$(dirname "$0")/common.sh"
failing=$1
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=200 --set discs.packing=0.2 --quiet
       --set output.trajectory.every_steps=2 --set output.collisions=true
       --set output.checkpoint.every_steps=10 --set output.measurements.every_steps=5
       --set 'output.measurements.quantities=["thermo"]')
sums_of() { (cd "$1" && find . -type f ! -name '.carrom*' -exec md5sum {} + | sort); }

run 1 run "${scene[@]}" -o kept --steps 20
expect_code 0 'a run to lose'
sums_of kept >before

# still_there CASE: the run must have ended with code 2, and no file of the folder may have changed.
still_there() {
    expect_code 2 "$1"
    sums_of kept | cmp - before || complain "files have changed: $1"
}
for how in '--resume' '--restart latest'; do
    for ranks in 1 3; do
        # shellcheck disable=SC2086 # two words
        CARROM_FAIL_LISTING=/checkpoints LD_PRELOAD=$failing run "$ranks" run "${scene[@]}" \
            -o kept --steps 30 $how
        still_there "a folder that cannot be listed, $how on $ranks ranks"
        expect_told 'kept/checkpoints: cannot be listed: Input/output error' "$how"
    done
    mv kept/checkpoints aside
    # shellcheck disable=SC2086
    run 2 run "${scene[@]}" -o kept --steps 30 $how
    mv aside kept/checkpoints
    still_there "no folder of checkpoints, $how"
    expect_told 'has report.json of a run and no checkpoint to go on from' "$how"
    mv kept/checkpoints aside
    ln -s checkpoints kept/checkpoints
    # shellcheck disable=SC2086
    run 1 run "${scene[@]}" -o kept --steps 30 $how
    rm kept/checkpoints
    mv aside kept/checkpoints
    still_there "a folder that is a link to itself, $how"
    expect_told 'cannot be listed: Too many levels of symbolic links' "$how"
done
CARROM_FAIL_LISTING=/checkpoints LD_PRELOAD=$failing run 1 run -o kept --resume --steps 30 --quiet
still_there 'a folder that cannot be listed, without a scene'

# An ordinary user's folders without rights. Root may read everything, so it becomes nobody.
nobody=()
if [ "$(id -u)" -eq 0 ]; then
    nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
    "${nobody[@]}" test -x "$CARROM_PROGRAM" || nobody=(no)
    "${nobody[@]}" test -r "$CARROM_SOURCE_DIR/inputs/gas.toml" || nobody=(no)
fi
cp -r kept locked
chown -R "$(id -u | sed 's/^0$/65534/')" locked
sums_of locked >before_locked
as_nobody() { # CASE TEXT WORD...
    local case=$1 text=$2
    shift 2
    n_runs=$((n_runs + 1))
    "${nobody[@]}" timeout 60 "$CARROM_PROGRAM" run "${scene[@]}" -o locked --steps 30 "$@" \
        >"$test_folder/out" 2>"$test_folder/err"
    code=$?
    chmod 755 locked/*/
    expect_code 2 "$case"
    expect_told "$text" "$case"
    sums_of locked | cmp - before_locked || complain "files have changed: $case"
}
if [ "${nobody[*]}" = no ]; then
    echo 'skipped: nobody may not run the program there'
else
    for mode in 000 444; do
        for name in checkpoints trajectory collisions measurements; do
            chmod $mode locked/$name
            as_nobody "$name $mode, --overwrite" "locked/$name" --overwrite
        done
        chmod $mode locked/trajectory
        as_nobody "trajectory $mode, --resume" \
            'trajectory.h5: its part trajectory/0001.h5: cannot be opened: Permission' --resume
    done
    chmod 000 locked/checkpoints
    as_nobody 'checkpoints 000, --resume' 'cannot be listed: Permission denied' --resume
    chmod 555 locked/measurements
    as_nobody 'measurements 555, --overwrite' '--overwrite cannot remove' --overwrite
fi

# A --resume that ends with code 2 has replaced nothing, not even the copy of the scene, and has not
# cut back one recording where the other one is damaged.
rm -rf part
cp -r kept part
rm part/checkpoints/checkpoint-000000000020.h5
printf 'damage' | dd of=part/collisions/0001.h5 bs=1 seek=100 conv=notrunc status=none
sums_of part >before_damaged
for ranks in 1 3; do
    run "$ranks" run "${scene[@]}" -o part --steps 30 --resume --output lines.txt
    expect_code 2 "a damaged log, --resume on $ranks ranks"
    expect_told 'its part collisions/0001.h5: its structure is damaged' 'a damaged log'
    sums_of part | cmp - before_damaged || complain "--resume has replaced files on $ranks ranks"
    [ ! -e lines.txt ] || complain "lines of a run that has not begun, on $ranks ranks"
done

# If a checkpoint cannot be opened because too many files are open, an older one is not used
# instead, at any limit.
sums_of kept >before_limit
printf '#!/bin/sh\nulimit -n "$LIMIT" && exec "%s" "$@"\n' "$CARROM_PROGRAM" >limited.sh
chmod +x limited.sh
program=$CARROM_PROGRAM CARROM_PROGRAM=$PWD/limited.sh
n_limited=0
for ranks in 1 3; do
    for LIMIT in {9..33..3}; do
        export LIMIT
        rm -rf part
        cp -r kept part
        run "$ranks" run -o part --steps 20 --resume --quiet
        grep -q 'passing over' "$test_folder/err" &&
            complain "a checkpoint is passed over, $LIMIT open files on $ranks ranks"
        grep -q 'raise that limit (ulimit -n' "$test_folder/err" || continue
        n_limited=$((n_limited + 1))
        expect_code 3 "a limit of $LIMIT open files on $ranks ranks"
        sums_of part | cmp - before_limit || complain "files have changed: $LIMIT open files"
    done
    [ "$n_limited" -gt 0 ] || complain "no limit of open files was in the way on $ranks ranks"
done
# HDF5 gives fill values for segments that it cannot open.
run 1 convert kept/collisions.h5 --to csv --output whole.csv
for LIMIT in {4..14}; do
    export LIMIT
    rm -f limited.csv
    run 1 convert kept/collisions.h5 --to csv --output limited.csv
    [ "$code" -ne 0 ] || cmp whole.csv limited.csv || complain "wrong numbers, $LIMIT open files"
done
CARROM_PROGRAM=$program

# Each kind of recording alone protects a folder, but a run that has recorded only its start begins
# again.
for name in trajectory.h5 collisions.h5 measurements/thermo.csv; do
    rm -rf part
    mkdir -p part/measurements
    cp kept/scene.toml part/
    cp -r "kept/$name" "part/$name"
    [ ! -d "kept/${name%.h5}" ] || cp -r "kept/${name%.h5}" part/
    run 1 run "${scene[@]}" -o part --steps 30 --resume
    expect_code 2 "$name and no checkpoint"
    expect_told "has $name of a run" "$name and no checkpoint"
    cmp "kept/$name" "part/$name" || complain "$name was replaced"
done
# A segment of which the joining file was deleted is a recording all the same.
for name in trajectory collisions; do
    rm -rf part
    mkdir part
    cp -r kept/scene.toml "kept/$name" part/
    for ranks in 1 3; do
        run "$ranks" run "${scene[@]}" -o part --steps 30 --resume
        expect_code 2 "$name/0001.h5 alone on $ranks ranks"
        expect_told "has $name/0001.h5 of a run and no checkpoint" "$name/0001.h5 alone"
    done
    cp -r kept/checkpoints part/
    run 1 run "${scene[@]}" -o part --steps 30 --resume
    expect_code 2 "a checkpoint, and $name/0001.h5 without $name.h5"
    expect_told "$name.h5: is not there, and its segment $name/0001.h5 is" "$name.h5 is lost"
    cmp "kept/$name/0001.h5" "part/$name/0001.h5" || complain "a segment of $name was replaced"
done
run 1 run "${scene[@]}" -o start --steps 0 --set output.checkpoint.at_end=false
expect_code 0 'a start'
rm start/report.json
run 2 run "${scene[@]}" -o start --steps 10 --resume
expect_code 0 'a run that recorded its start only'

# --overwrite removes nothing before the new run is sure to begin. Overlapping discs and a scene
# that --check does not support are errors that are found late.
printf '0 3 3 1 0\n1 3.5 3 0 1\n' >overlapping.txt
printf '[box]\nsize = 20\n[discs]\ncount = 2\nradius = 1\nfile = "overlapping.txt"\n%s' \
    $'[time]\nsteps = 2\nmethod = "event-driven"\n[output]\ntext = "none"\n' >overlapping.toml
for ranks in 1 2; do
    run "$ranks" run overlapping.toml -o kept --overwrite --quiet
    still_there "discs that overlap, --overwrite on $ranks ranks"
done
run 1 run "${scene[@]}" -o kept --overwrite --check --set time.precision=single
still_there 'a check that cannot be, --overwrite'

# --overwrite removes what the run has written, and nothing else, and nothing behind a link.
cp -r kept mine
foreign=(mine/measurements/lab.csv mine/measurements/thermo_old.csv mine/trajectory/notes.h5
         mine/collisions/lab.csv mine/checkpoints/checkpoint-best.h5 mine/checkpoints/lab.h5
         mine/checkpoints/checkpoint-20.h5 mine/checkpoints/checkpoint-notes.partial
         mine/measurements/tables.h5)
for file in "${foreign[@]}"; do echo mine >"$file"; done
touch mine/trajectory/0009.h5
run 2 run "${scene[@]}" -o mine --overwrite --steps 4
expect_code 0 '--overwrite beside files of somebody'
for file in "${foreign[@]}"; do [ -e "$file" ] || complain "$file was removed"; done
[ ! -e mine/trajectory/0009.h5 ] || complain 'a segment of the run before is left'
[ "$(ls mine/checkpoints/checkpoint-0*)" = mine/checkpoints/checkpoint-000000000004.h5 ] ||
    complain "other checkpoints: $(ls mine/checkpoints)"
# A foreign file that has the name of a table is not replaced.
for how in '-o tabled' '-o kept --resume' '-o kept --overwrite'; do
    folder=$(cut -d ' ' -f 2 <<<"$how")
    mkdir -p "$folder/measurements"
    [ "$folder" = tabled ] || mv kept/measurements/thermo.csv aside.csv
    printf 'day,temperature\n1,290\n' >"$folder/measurements/thermo.csv"
    sums_of "$folder" >before_table
    # shellcheck disable=SC2086 # several words
    run 2 run "${scene[@]}" --steps 30 $how
    expect_code 2 "a foreign thermo.csv, $how"
    expect_told "$folder/measurements/thermo.csv is no table that a run has written" "$how"
    sums_of "$folder" | cmp - before_table || complain "files have changed: foreign table, $how"
    [ "$folder" = tabled ] || mv aside.csv kept/measurements/thermo.csv
done
sums_of kept | cmp - before || complain 'the test has not brought the table back'

# A file of tables, which a run with `hdf5` would replace, is not replaced either.
cp -r mine/measurements/tables.h5 tabled/measurements/
rm tabled/measurements/thermo.csv
run 1 run "${scene[@]}" -o tabled --overwrite --steps 1 --set output.measurements.hdf5=1 \
    --set 'output.measurements.quantities=["profiles"]'
expect_code 2 'a foreign tables.h5'
expect_told 'tabled/measurements/tables.h5 is no table that a run has written' 'a foreign tables.h5'
rm tabled/measurements/tables.h5
for k in 1 2; do
    run 1 run "${scene[@]}" -o tabled --overwrite --steps $k --set output.measurements.hdf5=1 \
        --set 'output.measurements.quantities=["profiles"]'
    expect_code 0 "tables that a run has written, $k"
done

# A run that goes on from another folder has a checkpoint in its own, even at its first step.
for ranks in 1 3; do
    rm -rf branch
    run "$ranks" run --restart kept -o branch --steps 20 --quiet
    expect_code 0 "a branch that ends where it begins, on $ranks ranks"
    run "$ranks" run -o branch --resume --steps 24 --quiet
    expect_code 0 "going on with a branch that ended where it began, on $ranks ranks"
done

# If a run ends before the end of the recordings that it continues, it drops their later part and
# prints a warning.
rm -rf part
cp -r kept part
earlier=part/checkpoints/checkpoint-000000000010.h5
run 2 run --restart "$earlier" -o part --steps 14 --quiet
expect_code 0 'an end before that of what is recorded'
for name in trajectory collisions; do
    expect_told "part/$name.h5: had steps up to 20, and loses those after step 14" \
        'an end before that of what is recorded'
done
run 1 run --restart "$earlier" -o part --steps 20 --quiet
expect_code 0 'an earlier checkpoint, and the end of before'
grep 'loses' "$test_folder/err" && complain 'a loss is told where there is none'
run 1 diff part/trajectory.h5 kept/trajectory.h5
expect_code 0 'an earlier checkpoint, and the end of before: the same frames'

# A folder whose name has a line break: a scene's copy could not name its file of discs.
mkdir $'two\nlines'
printf '0 3 3 1 0\n1 8 8 0 1\n' >$'two\nlines/discs.txt'
printf '[box]\nsize = 20\n[discs]\ncount = 2\nradius = 1\nfile = "discs.txt"\n%s' \
    $'[time]\nsteps = 2\nmethod = "event-driven"\n[output]\ntext = "none"\n' \
    >$'two\nlines/scene.toml'
run 1 run $'two\nlines/scene.toml' -o broken --quiet
expect_code 2 'a line break in the path of discs'
expect_told 'the path of that file has a line break' 'a line break in the path of discs'

mkdir far
mv mine/checkpoints/* far/
rmdir mine/checkpoints
ln -s ../far mine/checkpoints
(cd far && md5sum -- *) >before_far
run 1 run "${scene[@]}" -o mine --overwrite --steps 6
expect_code 2 '--overwrite through a link'
expect_told 'mine/checkpoints is a symbolic link' '--overwrite through a link'
(cd far && md5sum -- *) | cmp - before_far || complain 'files behind a link have changed'

# Unfinished tables and reports of a killed run are removed, and no other files.
rm mine/checkpoints
touch mine/measurements/velocities.csv.123-0.partial mine/report.json.77-3.partial \
    mine/measurements/lab.csv.partial
run 1 run "${scene[@]}" -o mine --overwrite --steps 2
expect_code 0 'after a killed run'
[ -e mine/measurements/lab.csv.partial ] || complain 'a foreign .partial was removed'
[ ! -e mine/measurements/velocities.csv.123-0.partial ] || complain 'a table is left unfinished'
[ ! -e mine/report.json.77-3.partial ] || complain 'a report is left unfinished'

# A gap in the log of collisions is reported, now and later.
run 1 run "${scene[@]}" -o gap --steps 10
cp -r gap/collisions gap/collisions.h5 .
run 1 run "${scene[@]}" -o gap --resume --steps 20
rm -r gap/collisions gap/collisions.h5
mv collisions collisions.h5 gap/
run 2 run "${scene[@]}" -o gap --resume --steps 30
expect_code 0 'an older log'
expect_told 'has no collisions of steps 11 to 20, and goes on with step 21' 'an older log'
run 1 verify gap/collisions.h5
expect_code 6 'verify of a log with a gap'
grep -q 'without the collisions of steps 11 to 20$' "$test_folder/out" || complain 'no gap is named'
run 1 verify kept/collisions.h5
expect_code 0 'verify of a log without a gap'

run 1 replicas "${scene[@]}" --set output.collisions=false --count 2 -o many --steps 20
expect_code 0 'replicas'
(cd many && find . -type f -exec md5sum {} + | sort) >before_replicas
CARROM_FAIL_LISTING=0001/checkpoints LD_PRELOAD=$failing run 2 replicas "${scene[@]}" \
    --set output.collisions=false --count 2 -o many --steps 30
expect_code 2 'replicas that cannot be listed'
(cd many/0001 && find . -type f -exec md5sum {} + | sort) | cmp - <(sed -n 's, ./0001/, ./,p' \
    before_replicas) || complain 'a replica has changed'
finish
