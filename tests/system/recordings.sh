#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Trajectory and collisions: the same numbers for every machine shape, and for a run that was
# stopped, killed far beyond its last checkpoint, and continued. Arguments: the input and options;
# it must run 90 steps.
source "$(dirname "$0")/common.sh"
input=$CARROM_SOURCE_DIR/$1
shift
small=("$@" --quiet)
record=(--set output.collisions=true --set output.trajectory.every_steps=4 \
    --set output.trajectory.precision=double
        --set 'output.trajectory.fields=["position", "velocity", "collisions"]'
        --set output.checkpoint.every_steps=25 --set output.checkpoint.keep=1000000)
same() { # FOLDER WHAT
    for file in trajectory.h5 collisions.h5; do
        run 1 diff "whole/$file" "$1/$file"
        [ "$code" -eq 0 ] ||
            { complain "$file differs: $2"; sed 's/^/    /' "$test_folder/out"; show; }
        run 2 verify "$1/$file"
        expect_code 0 "verify $1/$file: $2"
    done
}

run 2 run "$input" "${small[@]}" "${record[@]}" -o whole
expect_code 0 'uninterrupted'
run 1 info whole/trajectory.h5
grep -q 'frames *23, of steps 0 to 88' "$test_folder/out" ||
    complain "not the frames of steps 0 to 88: $(cat "$test_folder/out")"
run 1 info whole/collisions.h5
n_logged=$(sed -n 's/^collisions *//p' "$test_folder/out")
n_made=$(($(json_value whole/report.json wall_collisions) + \
    $(json_value whole/report.json pair_collisions)))
[ "$n_logged" = "$n_made" ] || complain "$n_logged collisions in the log, $n_made made"
[ "$n_made" -gt 100 ] || complain 'hardly any collisions'
[ "$(find whole -name '.carrom*' | wc -l)" -eq 0 ] ||
    complain "something is left: $(find whole -name '.carrom*')"

for shape in '1 3' '3 1' '7 1'; do
    read -r ranks threads <<<"$shape"
    run "$ranks" run "$input" "${small[@]}" "${record[@]}" -o "shape$ranks" --threads "$threads"
    expect_code 0 "$ranks ranks"
    same "shape$ranks" "$ranks ranks x $threads threads"
done

# Two stretches; then from an earlier checkpoint again, so that both recordings have to be cut back.
run 3 run "$input" "${small[@]}" "${record[@]}" -o parts --steps 60
expect_code 0 'the first part'
run 1 run -o parts --resume --steps 90 --quiet --threads 2
expect_code 0 'the second part'
same parts 'stopped and gone on with'
run 4 run --restart parts/checkpoints/checkpoint-000000000025.h5 --quiet --set time.steps=90
expect_code 0 'again from step 25'
same parts 'cut back and gone on with'

# Killed somewhere after a checkpoint, and read while it runs: later records are made again.
"$CARROM_PROGRAM" run -o parts --resume --quiet --steps 10000000 >/dev/null 2>&1 &
program=$!
for ((i = 0; i < 3; ++i)); do
    sleep 0.5
    run 1 verify parts/trajectory.h5
    expect_code 0 'a trajectory that grows'
    run 1 convert parts/collisions.h5 --to csv --output log.csv
    expect_code 0 'a log that grows'
done
kill -KILL "$program"
wait "$program" 2>/dev/null
run 1 verify parts/trajectory.h5
expect_code 0 'a trajectory of a run that was killed'
run 2 run --restart parts/checkpoints/checkpoint-000000000075.h5 --steps 90 --quiet
expect_code 0 'after a kill'
same parts 'killed and gone on with'

# Every flipped bit is found, and a damaged recording is not continued.
RANDOM=3210
for file in whole/trajectory.h5 whole/collisions.h5 whole/trajectory/0001.h5; do
    joined=${file/\/0001/}
    for ((i = 0; i < 15; ++i)); do
        size=$(stat -c %s "$file")
        [ "$file" = "$joined" ] || size=20000 # leaves out the unused space
        place=$(((RANDOM * 32768 + RANDOM) % size))
        cp --sparse=always "$file" kept_file
        byte=$(od -An -tu1 -j "$place" -N 1 "$file")
        printf "\\x$(printf %02x $((byte ^ (1 << RANDOM % 8))))" |
            dd of="$file" bs=1 seek="$place" conv=notrunc status=none
        run 1 verify "$joined"
        expect_code 2 "a flipped bit at byte $place of $file"
        mv kept_file "$file"
    done
done
run 1 verify whole/trajectory.h5
expect_code 0 'a mended trajectory'
# A restart checks all segments that it keeps: the one to which it writes next, and earlier ones.
[ "$(ls parts/trajectory | wc -l)" -gt 1 ] || complain 'a trajectory of one segment'
for segment in $(ls parts/trajectory | sed -n '1p;$p'); do
    cp --sparse=always "parts/trajectory/$segment" kept_file
    byte=$(od -An -tu1 -j 9000 -N 1 kept_file)
    printf "\\x$(printf %02x $((byte ^ 4)))" | dd \
        of="parts/trajectory/$segment" bs=1 seek=9000 conv=notrunc status=none
    for ranks in 1 3; do
        run "$ranks" run --restart parts/checkpoints/checkpoint-000000000090.h5 --quiet --steps 95
        expect_code 2 "going on with a damaged trajectory on $ranks ranks"
        expect_told "parts/trajectory.h5: its part trajectory/$segment: its numbers are damaged" \
            'a damaged trajectory'
    done
    mv kept_file "parts/trajectory/$segment"
done

# Missing frames and collisions are reported.
rm -r parts/trajectory* parts/collisions*
run 2 run --restart parts/checkpoints/checkpoint-000000000025.h5 --quiet
expect_code 0 'a restart without the recordings of before'
expect_told 'parts/trajectory.h5: has no frames of steps 0 to 24, and goes on with step 28' \
    'a restart without its trajectory'
expect_told 'parts/collisions.h5: begins with step 26' 'a restart without its log'

# Frames at steps that grow by a factor: a restart continues them, and reports missing frames.
decades=(--set output.trajectory.every_steps=2 --set output.trajectory.frames_per_decade=4
         --set output.checkpoint.every_steps=25 --set output.checkpoint.keep=1000000)
run 3 run "$input" "${small[@]}" "${decades[@]}" -o decades
expect_code 0 'frames at growing steps'
run 1 convert decades/trajectory.h5 --to xyz --output frames.xyz
steps=$(grep -o 'Time=[0-9]*' frames.xyz | cut -d= -f2 | tr '\n' ' ')
[ "$steps" = '0 2 4 6 11 20 36 63 ' ] || complain "frames at steps $steps"
run 2 run "$input" "${small[@]}" "${decades[@]}" -o decades_parts --steps 40
run 1 run -o decades_parts --resume --steps 90 --quiet
run 1 diff decades/trajectory.h5 decades_parts/trajectory.h5
expect_code 0 'frames at growing steps, gone on with'
rm -r decades_parts/trajectory*
run 2 run --restart decades_parts/checkpoints/checkpoint-000000000025.h5 --quiet --steps 90
expect_told 'trajectory.h5: has no frames of steps 0 to 20, and goes on with step 36' \
    'a restart without its frames at growing steps'

# Frames without image counts get none; after a checkpoint without them they count from there.
periodic=()
for side in left right bottom top; do periodic+=(--set "box.$side.kind=periodic"); done
run 2 run "$CARROM_SOURCE_DIR/inputs/gas.toml" "${periodic[@]}" -o bare --steps 20 --quiet \
    --set output.trajectory.every_steps=10 --set 'output.trajectory.fields=["position"]'
expect_code 0 'a periodic run without image counts'
with_image=(--resume --steps 40 --quiet --set 'output.trajectory.fields=["position","image"]')
run 1 run -o bare "${with_image[@]}"
expect_code 2 'a trajectory that would begin to have image counts'
expect_told 'bare/trajectory.h5: has other columns than this run records' 'other fields'
rm -r bare/trajectory*
run 3 run -o bare "${with_image[@]}"
expect_code 0 'a checkpoint without image counts'
expect_told 'bare/trajectory.h5: image counts from step 20; the checkpoint has no counts' \
    'a checkpoint without image counts'
run 1 verify bare/trajectory.h5
expect_code 0 'a trajectory with image counts'
finish
