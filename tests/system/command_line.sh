#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Help and version: on standard output, once for all ranks, exit code 0; and a help that names every exit code.
source "$(dirname "$0")/common.sh"

for ranks in 1 3; do
    run "$ranks" --version
    expect_code 0 '--version'
    grep -qxE 'carrom [0-9]+\.[0-9]+\.[0-9]+' "$test_folder/out" || complain 'no version'
    [ "$(wc -l <"$test_folder/out")" -eq 1 ] || complain "the version is told more than once on $ranks ranks"
    run "$ranks" --help
    expect_code 0 '--help'
    [ "$(grep -c '^Usage:' "$test_folder/out")" -eq 1 ] || complain "the help is not told once on $ranks ranks"
    for exit_code in 0 1 2 3 4 70 75; do
        grep -qE "^ +$exit_code " "$test_folder/out" || complain "the help does not explain exit code $exit_code"
    done
done

run 2 rnu tiny.in
expect_code 2 'a subcommand that is none'
expect_told "'rnu' is no subcommand (see carrom --help)" 'a subcommand that is none'
run 1
expect_code 2 'no words'
expect_told 'say what to do, as in carrom run SCENE.toml' 'no words'

run 1 run --help
expect_code 0 'run --help'
for option in --threads --steps --set --digits --output --report --quiet --window --cell-width --rebalance-every --rebalance-above; do
    grep -q -- "^  $option" "$test_folder/out" || complain "the help of run does not explain $option"
done

# A number of threads that is none is not heeded silently.
printf '2\n10\n1\n1\nperf\n' >tiny.in
for number in abc 0 -1 1000000; do
    export OMP_NUM_THREADS=$number
    run 3 run tiny.in --quiet
    expect_code 0 "OMP_NUM_THREADS=$number"
    expect_told "warning: OMP_NUM_THREADS = '$number' is not a number of threads from 1 to 1024" "OMP_NUM_THREADS=$number"
    [ "$(grep -c 'warning: OMP_NUM_THREADS' "$test_folder/err")" -eq 1 ] || complain "told on every rank: OMP_NUM_THREADS=$number"
done
for number in 2 ' 2' 2,1 ''; do
    export OMP_NUM_THREADS=$number
    run 1 run tiny.in --quiet
    if grep -q 'warning: OMP_NUM_THREADS' "$test_folder/err"; then complain "warned of OMP_NUM_THREADS='$number'"; fi
done
unset OMP_NUM_THREADS

# Threads that wait spin for a bounded time, unless the user has said how they shall wait.
printf '2\n10\n1\n1000000000\nperf\n' >endless.in
for policy in none passive; do
    if [ "$policy" = none ]; then setting=(env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT); else setting=(env OMP_WAIT_POLICY=passive); fi
    "${setting[@]}" "$CARROM_PROGRAM" run endless.in --quiet >/dev/null 2>&1 &
    program=$!
    sleep 1
    spins=$(tr '\0' '\n' <"/proc/$program/environ" | grep -c '^GOMP_SPINCOUNT=3000$')
    [ "$spins" -eq "$([ "$policy" = none ] && echo 1 || echo 0)" ] || complain "spinning with the policy $policy: $spins"
    [ "$(cat "/proc/$program/comm")" = carrom ] || complain 'the process has another name'
    kill -KILL "$program"
    wait "$program" 2>/dev/null
done
"${CARROM_MPIEXEC}" -n 3 env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT "$CARROM_PROGRAM" run - --quiet --steps 1 <tiny.in >"$test_folder/out" 2>"$test_folder/err"
[ "$(wc -l <"$test_folder/out")" -eq 4 ] || { complain 'not the lines of a run on standard input with spinning bounded'; show; }
rm tiny.in endless.in

run 3
expect_code 2 'no subcommand'
expect_silence 'no subcommand'
[ -z "$(ls -A)" ] || complain 'files were written'
finish
