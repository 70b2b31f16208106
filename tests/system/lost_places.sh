#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The folder of a run, or a file in it, is moved, removed or replaced while the run writes there.
# The run ends with code 4 and names the folder or file, on 1 and 3 ranks, and writes to no other
# files.
source "$(dirname "$0")/common.sh"
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=200 --set discs.packing=0.2 --quiet
       --set output.trajectory.every_steps=100 --set output.collisions=true
       --set output.checkpoint.every_steps=200 --set output.measurements.every_steps=50
       --set 'output.measurements.quantities=["thermo"]')
sums_of() { (cd "$1" && find . -type f -exec md5sum {} + | sort); }

folder=kept
newest_of() { # FOLDER: prints the step of its newest checkpoint
    find "$1/checkpoints" -name 'checkpoint-*.h5' | sed 's/.*-0*//; s/\.h5$//' | sort -n | tail -n 1
}
# begin RANKS WORD...: starts an endless run in the background, and waits until it has a checkpoint.
begin() {
    local launch=("$CARROM_MPIEXEC" -n "$1")
    [ "$1" -gt 1 ] || launch=()
    shift
    rm -rf moved "$folder"
    n_runs=$((n_runs + 1))
    timeout --kill-after=5 60 "${launch[@]}" "$CARROM_PROGRAM" run "${scene[@]}" \
        -o "$folder" --steps 4000000 "$@" >"$test_folder/out" 2>"$test_folder/err" &
    program=$!
    for ((i = 0; i < 300; ++i)); do
        [ -z "$(newest_of "$folder" 2>/dev/null)" ] || return
        kill -0 "$program" 2>/dev/null || break
        sleep 0.1
    done
    complain "no checkpoint after $((i / 10)) seconds: $*"
    show
}
# ends TEXT CASE: the run must end by itself with code 4 and this text.
ends() {
    wait "$program"
    code=$?
    expect_code 4 "$2"
    expect_told "$1" "$2"
}
goes_on() { # CASE
    run 1 run -o kept --resume --steps "$(newest_of kept)" --quiet
    expect_code 0 "going on: $1"
    run 1 verify kept/trajectory.h5
    expect_code 0 "the trajectory: $1"
}

run 1 run "${scene[@]}" -o other --steps 400
expect_code 0 'the run of somebody else'
echo mine >mine
sums_of other >before
lost='was moved, removed or replaced while the run wrote there'
for ranks in 1 3; do
    begin "$ranks"
    mv kept moved
    ends "output.folder kept: it, or its lock, $lost" "a folder that is moved, $ranks ranks"
    [ ! -e kept ] || complain "the folder was made anew: $(find kept)"
    mv moved kept
    goes_on "a folder that was moved, $ranks ranks"

    begin "$ranks"
    rm -rf kept 2>/dev/null # the run may make a file meanwhile, or miss one before the folder
    ends kept "a folder that is removed, $ranks ranks"
    grep -q -e "$lost" -e 'cannot be opened: No such file' "$test_folder/err" ||
        complain "another text of a folder that is removed, $ranks ranks"

    begin "$ranks"
    mv kept moved
    cp -r other kept
    ends "$lost" "a folder that is replaced by another run's, $ranks ranks"
    sums_of kept | cmp - before || complain "another run was touched, $ranks ranks"

    for name in trajectory/0001.h5 collisions/0001.h5 trajectory.h5 measurements/thermo.csv; do
        begin "$ranks"
        cp mine replacing
        mv replacing "kept/$name"
        ends 'while the run wrote there' "$name is replaced, $ranks ranks"
        expect_told "$name" "$name is replaced, $ranks ranks"
        cmp mine "kept/$name" || complain "$name of somebody was written to, $ranks ranks"
    done

    begin "$ranks"
    : >kept/trajectory/0001.h5
    ends 'trajectory/0001.h5 was moved, removed, replaced or cut short while the run wrote there' \
        "a segment that is emptied, $ranks ranks"
done
begin 1 --set output.text=every_step --output lines.txt
rm lines.txt
kill -TERM "$program"
ends 'lines.txt: was removed while it was written' 'lines that are removed'

# A disk that is unmounted. (With open files it cannot be made read-only.)
mkdir disk
if mount -t tmpfs -o size=200m tmpfs disk 2>/dev/null; then
    trap 'umount -l "$test_folder/files/disk" 2>/dev/null' EXIT
    folder=disk/kept
    for ranks in 1 3; do
        begin "$ranks"
        umount -l disk
        ends "$lost" "a disk that is gone, $ranks ranks"
        [ -z "$(ls -A disk)" ] || complain "the place of a disk that is gone has $(ls -A disk)"
        mount -t tmpfs -o size=200m tmpfs disk
    done
else
    echo 'skipped: a disk that goes away (mounting a tmpfs is not allowed here)'
fi
finish
