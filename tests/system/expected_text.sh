#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Compares the output of two small scenes byte by byte with lines that were computed by hand, as
# expected/README.md shows. All numbers in them are exact in binary. The scenes are read from
# a file and from standard input, and run on one rank and on several.
source "$(dirname "$0")/common.sh"
expected=$CARROM_SOURCE_DIR/tests/system/expected

# compare RANKS EXPECTED WHAT WORD...
compare() {
    local ranks=$1 file=$2 what=$3
    shift 3
    run "$ranks" "$@"
    expect_code 0 "$what"
    expect_same "$test_folder/out" "$expected/$file" "$what on $ranks ranks is not $file"
}

for ranks in 1 2 5; do
    for scene in three_discs wall_stop; do
        compare "$ranks" "$scene.txt" "$scene" run "$expected/$scene.in"
        compare "$ranks" "$scene.8.txt" "$scene with 8 decimals" run --digits 8 \
            "$expected/$scene.in" --threads 2
    done
    compare "$ranks" three_discs.txt 'from standard input' run - --quiet <"$expected/three_discs.in"
    [ ! -s "$test_folder/err" ] || complain '--quiet is not quiet'

    # `perf` prints the first and the last step; no step at all prints the start, without counters.
    grep -E '^(0|5) ' "$expected/three_discs.txt" >"$test_folder/ends"
    sed 's/print/perf/' "$expected/three_discs.in" >perf.in
    run "$ranks" run perf.in
    expect_same "$test_folder/out" "$test_folder/ends" \
        'perf does not print the first and the last step'
    grep -E '^0 ' "$expected/three_discs.txt" >"$test_folder/start"
    for input in perf.in "$expected/three_discs.in"; do
        run "$ranks" run "$input" --steps 0
        expect_code 0 'no steps'
        expect_same "$test_folder/out" "$test_folder/start" \
            'no steps do not print the start, once and without counters'
    done

    run "$ranks" run "$expected/three_discs.in" --output lines.txt
    expect_silence '--output'
    expect_same lines.txt "$expected/three_discs.txt" '--output does not write the lines'
done
finish
