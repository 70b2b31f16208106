#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# USR1, TERM and INT: every rank stops at the same step, a checkpoint is there, the exit code is 75,
# and going on gives the bits of the uninterrupted run.
source "$(dirname "$0")/common.sh"
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=2000 --set discs.speed=2 --quiet)
store=(--set output.folder=kept)

# stopped RANKS SIGNAL: begins an endless run and sends the signal, to mpiexec where there are
# several ranks.
stopped() {
    local launch=("$CARROM_MPIEXEC" -n "$1") program
    # the shell makes background programs ignore INT
    [ "$1" -gt 1 ] || launch=(env --default-signal=INT)
    rm -rf kept
    "${launch[@]}" "$CARROM_PROGRAM" run "${scene[@]}" "${store[@]}" --steps 100000000 \
        >"$test_folder/out" 2>"$test_folder/err" &
    program=$!
    sleep 3
    kill -"$2" "$program"
    wait "$program"
    code=$?
    expect_code 75 "$2 on $1 ranks"
    expect_told 'told to stop: the steps under way' "$2 on $1 ranks"
    expect_told 'stopped on request at step' "$2 on $1 ranks"
    [ "$(ls kept/checkpoints | wc -l)" -eq 1 ] ||
        complain "$2 on $1 ranks did not leave one checkpoint: $(ls kept/checkpoints)"
}

goes_on() {
    local file step
    file=kept/checkpoints/$(ls kept/checkpoints)
    step=$((10#$(ls kept/checkpoints | tr -cd 0-9 | sed 's/5$//') + 50))
    run 2 run --restart "$file" --steps "$step" --quiet --report report.json
    expect_code 0 'going on'
    local hash
    hash=$(json_value report.json state_hash)
    run 3 run "${scene[@]}" --steps "$step" --report report.json
    [ "$(json_value report.json state_hash)" = "$hash" ] ||
        complain 'another state hash after a stop'
}

stopped 1 USR1
stopped 1 TERM
stopped 1 INT
expect_told 'once more ends the run at once' 'INT'
stopped 3 USR1
goes_on

# A signal that comes while the discs are still being made is heeded too: once this rank catches
# USR1 (bit 9).
rm -rf kept
"$CARROM_PROGRAM" run "${scene[@]}" "${store[@]}" --set discs.count=1000000 --steps 100000000 \
    >"$test_folder/out" 2>"$test_folder/err" &
program=$!
for ((i = 0; i < 300; ++i)); do
    caught=$(sed -n 's/^SigCgt:[[:space:]]*//p' "/proc/$program/status")
    [ $((16#${caught: -4} & 16#200)) -eq 0 ] || break
    sleep 0.1
done
kill -USR1 "$program"
wait "$program"
code=$?
expect_code 75 'USR1 while discs are made'
# On a busy machine the start takes so long that it is given up.
grep -qF 'stopped on request while discs are placed' "$test_folder/err" ||
    [ "$(ls kept/checkpoints)" = checkpoint-000000000000.h5 ] ||
    complain "USR1 while discs are made did not leave the start: $(ls kept/checkpoints)"

# A signal at any moment, from MPI's start to its end, does not make a failure of a short run: it is
# complete, or has stopped with a checkpoint.
printf '2\n10\n1\n100\nperf\n' >short.in
n_complete=0
for ((k = 0; k < 24; ++k)); do
    rm -rf kept
    "$CARROM_PROGRAM" run short.in --quiet "${store[@]}" >"$test_folder/out" 2>"$test_folder/err" &
    program=$!
    for ((i = 0; i < 1000; ++i)); do
        caught=$(sed -n 's/^SigCgt:[[:space:]]*//p' "/proc/$program/status" 2>/dev/null)
        [ $((16#${caught:-0} & 16#200)) -eq 0 ] || break
    done
    sleep "$(printf '0.%02d' $((k % 12)))"
    kill -USR1 "$program" 2>/dev/null
    wait "$program"
    code=$?
    [ "$code" -eq 0 ] && n_complete=$((n_complete + 1))
    [ "$code" -eq 0 ] || [ "$code" -eq 75 ] ||
        { complain "code $code after a signal at moment $k"; show; }
    [ "$(ls kept/checkpoints | wc -l)" -ge 1 ] ||
        complain "no checkpoint after a signal at moment $k"
done
[ "$n_complete" -lt 24 ] || complain 'no signal came early enough to stop a short run'

# After the last step a run is complete, whatever signal comes, because it writes its report last.
for ((k = 0; k < 8; ++k)); do
    rm -rf kept
    "$CARROM_PROGRAM" run short.in --quiet "${store[@]}" >"$test_folder/out" 2>"$test_folder/err" &
    program=$!
    begin=$SECONDS
    until [ -e kept/report.json ] || [ $((SECONDS - begin)) -gt 20 ]; do :; done
    kill -USR1 "$program" 2>/dev/null
    wait "$program"
    code=$?
    expect_code 0 "a signal after the last step, $k"
done

# Without a folder for checkpoints the run ends in order too: its recordings are complete, and it
# prints that nothing else is kept.
for signal in TERM USR1; do
    folder=(-o "recorded_$signal" --set output.trajectory.every_steps=1000)
    [ "$signal" = TERM ] || folder=()
    "$CARROM_PROGRAM" run "${scene[@]}" "${folder[@]}" --steps 100000000 \
        >"$test_folder/out" 2>"$test_folder/err" &
    program=$!
    sleep 2
    kill -"$signal" "$program"
    wait "$program"
    code=$?
    expect_code 75 "$signal without checkpoints"
    if [ "$signal" = USR1 ]; then
        expect_told 'nothing is kept to go on from' "$signal without a folder"
        continue
    fi
    expect_told 'carrom run -o recorded_TERM --resume goes on' "$signal with a folder"
    run 1 verify recorded_TERM/trajectory.h5
    expect_code 0 "the trajectory after $signal"
done
finish
