#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# kill -9 of a random rank at random moments, again and again, also while a checkpoint is written;
# each time `--restart latest` goes on. In the end the hash is that of the uninterrupted run.
# Argument: how many kills.
source "$(dirname "$0")/common.sh"
n_kills=$1
RANDOM=3210
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=3000 --set discs.speed=2 --quiet
       --set output.folder=kept --set output.checkpoint.every_steps=20
       --set output.trajectory.every_steps=10 --set output.collisions=true)
endless=1000000000 # so many that no run ends before it is killed

# kill_once RANKS MILLISECONDS: starts or continues the run, and kills one rank this long after
# ranks have started.
kill_once() {
    local launcher how=(--restart latest)
    [ "$(newest)" -gt 0 ] || how=(--overwrite) # there are recordings without a checkpoint
    "$CARROM_MPIEXEC" -n "$1" "$CARROM_PROGRAM" run "${scene[@]}" --steps "$endless" \
        "${how[@]}" \
        >"$test_folder/out" 2>"$test_folder/err" &
    launcher=$!
    while ! ranks_of "$launcher" >/dev/null && kill -0 "$launcher" 2>/dev/null; do sleep 0.05; done
    sleep "$(printf '%d.%03d' $(($2 / 1000)) $(($2 % 1000)))"
    mapfile -t rank_pids < <(ranks_of "$launcher")
    [ ${#rank_pids[@]} -eq 0 ] || kill -KILL "${rank_pids[RANDOM % ${#rank_pids[@]}]}" 2>/dev/null
    end_of "$launcher"
}

# end_of LAUNCHER: returns its exit code. All ranks must have ended half a minute after one was
# killed. Open MPI 4.1's launcher may stay nevertheless, if the rank was killed while it registered.
# The test prints this, and ends the launcher.
end_of() {
    local i
    for ((i = 0; i < 300; ++i)); do
        kill -0 "$1" 2>/dev/null || break
        sleep 0.1
    done
    if kill -0 "$1" 2>/dev/null; then
        [ -n "$(ps -o stat= --ppid "$1" | sed '/^Z/d')" ] &&
            complain 'ranks live on after one of them was killed'
        echo 'the launcher did not come back though all its ranks were gone'
        kill -KILL "$1"
    fi
    wait "$1"
}

# newest: prints the step of the newest complete checkpoint; 0 if there is none.
newest() {
    local step
    step=$(find kept/checkpoints -name 'checkpoint-*.h5' 2>/dev/null | sed \
        's/.*checkpoint-0*//; s/[.]h5$//' | sort -n | tail -1)
    echo "${step:-0}"
}

# Ranks are killed before and after their first step, however long it takes on a busy machine.
begin=$(date +%s%N)
run 4 run "${scene[@]}" --steps 1 --set output.folder=first
expect_code 0 'a first step'
start_milliseconds=$((($(date +%s%N) - begin) / 1000000))

for ((i = 0; i < n_kills; ++i)); do
    # MPICH's launcher sometimes returns 0 although a rank was killed.
    kill_once $((RANDOM % 3 + 2)) $((RANDOM % (1500 + start_milliseconds) + 300)) &&
        [ $has_proxy = no ] && complain 'a run of endless steps ended well'
    grep 'passing over' "$test_folder/err"
done
[ "$(newest)" -gt 0 ] || complain "no checkpoint was finished in $n_kills runs"
steps=$(($(newest) + 100))
echo "after $n_kills kills at step $(newest); on to step $steps"
patience=300
run 3 run "${scene[@]}" --steps "$steps" --restart latest --report report.json
expect_code 0 'the last stretch'
killed=$(json_value report.json state_hash)
run 2 run "${scene[@]}" --steps "$steps" --set output.folder=whole \
    --set output.checkpoint.every_steps="$endless" --report report.json
expect_code 0 'uninterrupted'
[ "$(json_value report.json state_hash)" = "$killed" ] ||
    complain "another state hash after $n_kills kills"
[ "$(find kept/checkpoints -name '*.h5' | wc -l)" -ge 1 ] || complain 'no checkpoint is left'
for file in trajectory.h5 collisions.h5; do # what was recorded between the kills
    run 1 verify "kept/$file"
    expect_code 0 "verify $file"
    run 1 diff "kept/$file" "whole/$file"
    expect_code 0 "$file is that of the uninterrupted run"
done
finish
