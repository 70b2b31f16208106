#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# One scene, many machine shapes, one set of bits: the state hash and the lines of the last step
# must not change with ranks, threads, windows, cell widths and rebalancing; nor must the averages
# of the report. Arguments: "few" or "all" of the shapes, the input and options that make it small.
source "$(dirname "$0")/common.sh"
shapes=$1 input=$CARROM_SOURCE_DIR/$2
shift 2
small=("$@")
[ -r "$input" ] || { complain "no input $input"; finish; }

averages() { sed -n '/^  "averages"/,/^  }/p; /^  "temperature"/,$p' report.json; }

# shape RANKS THREADS OPTION...: runs it and compares with the first run.
shape() {
    local ranks=$1 threads=$2
    shift 2
    run "$ranks" run "$input" "${small[@]}" --set output.text=ends --threads "$threads" "$@" \
        --report report.json --quiet
    expect_code 0 "$ranks ranks x $threads threads $*"
    if [ -z "${hash:-}" ]; then
        hash=$(json_value report.json state_hash)
        [ -n "$hash" ] || complain 'no state hash'
        cp "$test_folder/out" "$test_folder/first"
        first_averages=$(averages)
        [ "$(wc -l <<<"$first_averages")" -gt 25 ] || complain "no averages in the report"
    fi
    [ "$(json_value report.json state_hash)" = "$hash" ] ||
        complain "another state hash: $ranks ranks x $threads threads $*"
    [ "$(averages)" = "$first_averages" ] || complain \
        "other averages: $ranks ranks x $threads threads $*"
    expect_same "$test_folder/out" "$test_folder/first" \
        "other lines: $ranks ranks x $threads threads $*"
}

shape 1 1
[ "$(json_value report.json pair_collisions)" -gt 0 ] ||
    complain 'a scene without collisions shows nothing'
shape 3 2 --window 0.3 --cell-width 2.5 --rebalance-every 1 --rebalance-above 0
shape 1 3 --window 1
shape 2 2 --cell-width 1.7
shape 5 1 --ranks-across 2
[ "$(json_value report.json ranks_across)" = 2 ] ||
    complain 'the report does not say that two ranks share a strip'
shape 7 1 --rebalance-every 0
[ "$shapes" = all ] || finish
for ranks_threads in '1 3' '2 1' '2 2' '3 3' '4 1' '7 2'; do
    shape $ranks_threads
done
for window in 0.07 1 64; do
    shape 1 2 --window "$window"
    shape 3 1 --window "$window" --rebalance-every 1 --rebalance-above 0
done
shape 2 2 --cell-width 1
shape 2 2 --cell-width 4
shape 4 1 --rebalance-every 0
shape 4 1 --ranks-across 4
shape 4 2 --window 0.3 --ranks-across 2 --rebalance-every 1 --rebalance-above 0
finish
