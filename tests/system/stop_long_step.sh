#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A request to stop is obeyed within 2 s even if no step ends: while discs are placed, while they
# are compressed, and inside a step that takes long, with both methods and on several ranks. A step
# that is given up leaves a state from before it, with the bits of a run to that step. Two seconds
# more are for a busy machine and the launcher.
source "$(dirname "$0")/common.sh"
most_seconds=4
gas=("$CARROM_SOURCE_DIR/inputs/gas.toml" --quiet --set output.folder=kept)
fast=(--set discs.count=5000 --set discs.speed=1e9 --steps 10)
placed=(--set discs.packing=0.5 --steps 10)
compressed=(--set discs.count=2000 --set discs.packing=0.8 --set discs.generator=compressed
            --set discs.growth_rate=1e-6 --steps 10)
heap=("$CARROM_SOURCE_DIR/inputs/rain.toml" --quiet --set output.folder=kept
      --set effects.contact.contact_time=1e-8)

# heeds_signals PROGRAM: waits until the program catches TERM (bit 14)
heeds_signals() {
    local caught i
    for ((i = 0; i < 300; ++i)); do
        caught=$(sed -n 's/^SigCgt:[[:space:]]*//p' "/proc/$1/status" 2>/dev/null)
        [ $((16#${caught:-0} & 16#4000)) -eq 0 ] || return
        sleep 0.1
    done
}

# given_up RANKS SIGNAL SECONDS WORD...: begins a run and sends the signal after some seconds.
given_up() {
    local ranks=$1 signal=$2 seconds=$3 launch=("$CARROM_MPIEXEC" -n "$1") program begin
    shift 3
    [ "$ranks" -gt 1 ] || launch=()
    rm -rf kept
    "${launch[@]}" "$CARROM_PROGRAM" run "$@" >"$test_folder/out" \
        2>"$test_folder/err" &
    program=$!
    [ "$ranks" -gt 1 ] || heeds_signals "$program"
    sleep "$seconds"
    begin=$(date +%s%N)
    kill -"$signal" "$program"
    wait "$program"
    code=$?
    [ $((($(date +%s%N) - begin) / 1000000)) -le $((1000 * most_seconds)) ] ||
        complain "more than $most_seconds s after $signal on $ranks ranks: $*"
    expect_code 75 "$signal on $ranks ranks: $*"
}

# expect_kept STEP: the one checkpoint is of that step, and has the bits of a run up to there.
expect_kept() {
    local file step hash
    file=kept/checkpoints/$(ls kept/checkpoints)
    step=$((10#$(tr -cd 0-9 <<<"${file%5}")))
    [ "$step" -ge "$1" ] || complain "the state kept is of step $step"
    run 1 info "$file"
    hash=$(sed -n 's/^state hash *//p' "$test_folder/out")
    shift
    run 1 run "$@" --set output.folder=again --steps "$step" --report report.json
    [ "$(json_value report.json state_hash)" = "$hash" ] ||
        complain "the state kept is not that of step $step"
    rm -rf again
}

# Each takes some seven seconds on one core: it is not done before the signal, and the next check
# for a stop comes soon.
given_up 1 TERM 1 "${gas[@]}" "${placed[@]}" --set discs.count=2000000
expect_told 'stopped on request while discs are placed at random' 'placing'
given_up 3 USR1 3 "${gas[@]}" "${placed[@]}" --set discs.count=4000000
expect_told 'stopped on request while discs are placed at random' 'placing on ranks'

given_up 1 TERM 3 "${gas[@]}" "${compressed[@]}"
expect_told 'stopped on request while discs are compressed' 'compression'
given_up 3 USR1 4 "${gas[@]}" "${compressed[@]}"
expect_told 'stopped on request while discs are compressed' 'compression on ranks'

given_up 1 TERM 3 "${gas[@]}" "${fast[@]}"
expect_told 'stopped on request inside a step after 0 of 10' 'a fast gas'
expect_told 'is of step 0; carrom run -o kept --resume goes on' 'a fast gas'
given_up 3 USR1 4 "${gas[@]}" "${fast[@]}"
expect_told 'the last state that is kept is of step 0' 'a fast gas on ranks'
given_up 1 TERM 4 "${gas[@]}" --set time.method=time-stepped --set time.micro_steps=1048576
expect_told 'the last state that is kept is of step 0' 'a step of many micro-steps'

given_up 1 TERM 10 "${heap[@]}"
expect_told 'inside a step after' 'a heap'
expect_kept 0 "${heap[@]}"
given_up 3 USR1 10 "${heap[@]}"
expect_told 'inside a step after' 'a heap on ranks'
expect_kept 0 "${heap[@]}"
finish
