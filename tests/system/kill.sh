#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# kill -9 of a random rank at random moments, again and again, also while a checkpoint is written; each time `--restart
# latest` goes on. In the end the hash is that of the uninterrupted run. Argument: how many kills.
source "$(dirname "$0")/common.sh"
n_kills=$1
RANDOM=3210
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=3000 --set discs.speed=2 --quiet
       --set output.checkpoint.folder=kept --set output.checkpoint.every_steps=20)
steps=$((n_kills * 150))

# kill_once RANKS MILLISECONDS: starts or goes on, and kills one rank after that time. False if the run was over before.
kill_once() {
    local launcher rank
    "$CARROM_MPIEXEC" -n "$1" "$CARROM_PROGRAM" run "${scene[@]}" --steps "$steps" --restart latest --report report.json \
        >"$test_folder/out" 2>"$test_folder/err" &
    launcher=$!
    sleep "$(printf '%d.%03d' $(($2 / 1000)) $(($2 % 1000)))"
    mapfile -t rank_pids < <(pgrep -P "$launcher")
    [ ${#rank_pids[@]} -eq 0 ] || kill -KILL "${rank_pids[RANDOM % ${#rank_pids[@]}]}" 2>/dev/null
    wait "$launcher"
}

n_survived=0
for ((i = 0; i < n_kills; ++i)); do
    if kill_once $((RANDOM % 3 + 2)) $((RANDOM % 1500 + 300)); then
        n_survived=$((n_survived + 1))
        rm -r kept # it was over before it was killed: from the start
    fi
    grep -q 'passing over' "$test_folder/err" && grep 'passing over' "$test_folder/err"
done
[ "$n_survived" -le $((n_kills / 2)) ] || complain "$n_survived of $n_kills runs were over before they were killed"
run 3 run "${scene[@]}" --steps "$steps" --restart latest --report report.json
expect_code 0 'the last stretch'
killed=$(json_value report.json state_hash)
run 2 run "${scene[@]}" --steps "$steps" --set output.checkpoint.folder=whole --report report.json
expect_code 0 'uninterrupted'
[ "$(json_value report.json state_hash)" = "$killed" ] || complain "another state hash after $n_kills kills"
[ "$(find kept -name '*.h5' | wc -l)" -ge 1 ] || complain 'no checkpoint is left'
finish
