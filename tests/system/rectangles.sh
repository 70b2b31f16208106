#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Rectangles through the real program: the same bits on one rank and on three, for wide and high
# boxes, and after a restart; and both edges in every file and report.
source "$(dirname "$0")/common.sh"

# scene NAME SIZE: a gas in a box of that size.
scene() {
    printf '[box]\nsize = %s\n[discs]\ncount = 120\nradius = 1\n[time]\nsteps = 40\n' "$2" >"$1"
}
# Lines `step id x y vx vy`, with x and y, vx and vy exchanged, in the order of ids.
turned() { awk '{ print $1, $2, $4, $3, $6, $5 }' "$1" | sort -k1,1n -k2,2n; }

scene wide.toml '[80, 20]'
scene tall.toml '[20, 80]'
for method in event-driven time-stepped; do
    for ranks in 1 3; do
        for box in wide tall; do
            run "$ranks" run "$box.toml" --set time.method="$method" --threads 2 --quiet \
                --check --output "$box.$ranks" --set output.text=ends --report "$box.json" \
                -o "$box-$method-$ranks" --set output.checkpoint.every_steps=20 \
                --set output.trajectory.every_steps=10 --set output.trajectory.precision=double
            expect_code 0 "$box on $ranks ranks, $method"
        done
        turned "tall.$ranks" >tall.lying
        cut -d' ' -f1-6 "wide.$ranks" | sort -k1,1n -k2,2n | cmp - tall.lying ||
            complain "the box that stands has other discs, $ranks ranks, $method"
        expect_same "wide.1" "wide.$ranks" "another result on $ranks ranks, $method"
        tr -d ' \n' <wide.json | grep -qF '"box":[80.0,20.0]' ||
            complain "the report has other edges: $(grep -A2 '"box"' wide.json)"
    done
done

folder=tall-event-driven-3
last=$folder/checkpoints/checkpoint-000000000040.h5
for file in "$last" "$folder/trajectory.h5"; do
    for ranks in 1 3; do
        run "$ranks" verify "$file"
        expect_code 0 "verify $file"
    done
    run 1 info "$file"
    grep -q 'discs       120 in a box of 20 x 80' "$test_folder/out" ||
        complain "info has other edges: $(cat "$test_folder/out")"
done
run 1 diff "$last" "tall-event-driven-1/checkpoints/checkpoint-000000000040.h5"
expect_code 0 'diff of two numbers of ranks'
run 1 diff "$last" "wide-event-driven-1/checkpoints/checkpoint-000000000040.h5"
expect_code 1 'diff of two boxes'
grep -q '^first: the files, box: 20 and 80$' "$test_folder/out" || complain 'diff names no edge'
run 1 convert "$folder/trajectory.h5" --to xyz
sed -n 2p "$test_folder/out" | grep -q '^Lattice="20 0 0 0 80 0 0 0 1"' ||
    complain 'extended XYZ has another box'

# A restart from the checkpoint of step 20 on two ranks, and one with another box, which is an
# error.
cp -r "$folder" again
rm "again/checkpoints/checkpoint-000000000040.h5"
run 2 run tall.toml -o again --resume --set time.method=event-driven --quiet \
    --set output.checkpoint.every_steps=20 --set output.trajectory.every_steps=10 \
    --set output.trajectory.precision=double
expect_code 0 'a restart'
run 1 diff "$last" again/checkpoints/checkpoint-000000000040.h5
expect_code 0 'a restart has other discs'
run 1 run wide.toml -o again --resume --set time.method=event-driven --quiet
expect_code 2 'a restart in another box'
expect_told "'box.size' is [20, 80] there and [80, 20] here" 'a restart in another box'

for size in '[1]' '[1, 2, 3]' '"wide"' '[80, "wide"]' '[80, -20]' '-3'; do
    run 3 run wide.toml --set "box.size=$size"
    expect_code 2 "box.size = $size"
    expect_told "'box.size' must be" "box.size = $size"
    [ "$(grep -c 'box\.size' "$test_folder/err")" -eq 1 ] ||
        complain "not one line for box.size = $size"
done
finish
