#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Help and version: on standard output, once for all ranks, exit code 0; and a help that names every
# exit code.
source "$(dirname "$0")/common.sh"

for ranks in 1 3; do
    run "$ranks" --version
    expect_code 0 '--version'
    grep -qxE 'carrom [0-9]+\.[0-9]+\.[0-9]+' "$test_folder/out" || complain 'no version'
    for line in 'commit    ([0-9a-f]{12}|unknown)' 'compiler  .*[0-9]' 'MPI       .*[0-9]' \
        'HDF5      1\.[0-9]+\.[0-9]+' 'vectors   [A-Z0-9_]+'; do
        grep -qxE "$line" "$test_folder/out" || complain "the version lacks a line like: $line"
    done
    [ "$(wc -l <"$test_folder/out")" -eq 6 ] ||
        complain "the version is not told once on $ranks ranks"
    run "$ranks" --version --check
    expect_code 0 '--version --check'
    [ "$(grep -cx 'bits      those of all builds' "$test_folder/out")" -eq 1 ] ||
        complain "this build computes other bits than recorded, or does not say so once"
    run "$ranks" --help
    expect_code 0 '--help'
    [ "$(grep -c '^Usage:' "$test_folder/out")" -eq 1 ] ||
        complain "the help is not told once on $ranks ranks"
    for exit_code in 0 1 2 3 4 70 75; do
        grep -qE "^ +$exit_code " "$test_folder/out" ||
            complain "the help does not explain exit code $exit_code"
    done
done

run 1 --check keys
expect_code 2 '--check without --version'
expect_told '--check goes with --version, or behind `run`' '--check without --version'
run 2 rnu tiny.in
expect_code 2 'a subcommand that is none'
expect_told "'rnu' is no subcommand (see carrom --help)" 'a subcommand that is none'
run 1
expect_code 2 'no words'
expect_told 'say what to do, as in carrom run SCENE.toml' 'no words'

run 1 run --help
expect_code 0 'run --help'
for option in --threads --steps --set --digits --output --report --quiet --window --cell-width \
    --ranks-across --rebalance-every --rebalance-above; do
    grep -q -- "^  $option" "$test_folder/out" ||
        complain "the help of run does not explain $option"
done

# An invalid number of threads gives a warning.
printf '2\n10\n1\n1\nperf\n' >tiny.in
for number in abc 0 -1 1000000; do
    export OMP_NUM_THREADS=$number
    run 3 run tiny.in --quiet
    expect_code 0 "OMP_NUM_THREADS=$number"
    expect_told "warning: OMP_NUM_THREADS = '$number' is not a number of threads from 1 to 1024" \
        "OMP_NUM_THREADS=$number"
    [ "$(grep -c 'warning: OMP_NUM_THREADS' "$test_folder/err")" -eq 1 ] ||
        complain "told on every rank: OMP_NUM_THREADS=$number"
done
for number in 2 ' 2' 2,1 ''; do
    export OMP_NUM_THREADS=$number
    run 1 run tiny.in --quiet
    if grep -q 'warning: OMP_NUM_THREADS' "$test_folder/err"; then
        complain "warned of OMP_NUM_THREADS='$number'"; fi
done
unset OMP_NUM_THREADS

# Waiting threads sleep, unless the user has chosen otherwise. /proc shows the variables of the
# program, which waits for its scene meanwhile.
wait_policy() { # VARIABLE=VALUE...: prints the policy of a run
    { sleep 3 && cat tiny.in; } | env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT "$@" \
        "$CARROM_PROGRAM" run - --quiet >/dev/null 2>&1 &
    local process=$! found=none
    for _ in $(seq 25); do
        # Until the program has started, the process is a shell or `env`, with the policy of the
        # tests.
        [ "$(readlink "/proc/$process/exe")" -ef "$CARROM_PROGRAM" ] || { sleep 0.1; continue; }
        found=$(tr '\0' '\n' <"/proc/$process/environ" |
            sed -nE 's/^(OMP_WAIT_POLICY|GOMP_SPINCOUNT)=//p' | sort | paste -sd' ')
        [ -z "$found" ] || break
        sleep 0.1
    done
    wait "$process" || found="an end with code $?"
    echo "$found"
}
[ "$(wait_policy A=1)" = '1000 passive' ] || complain 'threads spin for long while they wait'
[ "$(wait_policy OMP_WAIT_POLICY=active)" = active ] || complain 'the wait policy is not kept'
export OMP_WAIT_POLICY=passive
cores=$(nproc)
run 2 run tiny.in --quiet --threads "$cores"
[ ! -s "$test_folder/err" ] || { complain 'warned of ranks that share cores'; show; }

# MPI does not start if it is not needed, and a run without mpirun starts no daemon. The test
# detects MPI by the files of settings that it reads, and a daemon as another program.
run 1 run tiny.in --quiet -o kept --set output.trajectory.every_steps=1
expect_code 0 'a run with files'
file=kept/checkpoints/$(ls kept/checkpoints)
if command -v strace >/dev/null; then
    # opened WORD...: sets `n_mpi`, the number of MPI's files that are read, and `n_started`, the
    # number of programs that are started.
    opened() {
        strace -f -qq -e trace=openat,execve -o "$test_folder/trace" "$CARROM_PROGRAM" "$@" \
            >"$test_folder/out" 2>"$test_folder/err" </dev/null
        n_mpi=$(grep -cE 'openmpi-mca-params|pmix-mca-params|mpich\.conf|/libuct_|mca_[a-z]+_' \
            "$test_folder/trace")
        n_started=$(grep -c 'execve(.*= 0$' "$test_folder/trace")
    }
    while read -r words; do
        opened $words
        [ "$n_mpi $n_started" = '0 1' ] || complain \
            "MPI was started by: carrom $words ($n_mpi, $n_started)"
    done <<WORDS
--help
--version
run
run --help
walk
info $file
verify $file
verify t.h5
diff $file $file
convert $file --to csv
WORDS
    opened run tiny.in --quiet
    [ "$n_mpi" -gt 0 ] || complain 'the test does not notice that MPI is started'
    [ "$n_started" -eq 1 ] || complain \
        "a run without mpirun starts another program: $(grep execve "$test_folder/trace")"
else
    printf 'not looked at, for want of strace: what starts MPI\n'
fi
for command in info verify diff convert; do
    run 1 "$command" --help
    expect_code 0 "$command --help"
    grep -q "^  carrom $command " "$test_folder/out" ||
        complain "the help of $command has no example"
done

# Empty words come from variables that are not set.
for option in --output --report --restart; do
    run 1 run tiny.in "$option" ''
    expect_code 2 "$option with an empty word"
    expect_told "$option: has an empty value" "$option with an empty word"
done

# Control characters of files do not reach the terminal.
esc=$(printf '\033')
name="red${esc}[31m.in"
cp tiny.in "$name"
run 1 run "$name"
expect_code 0 'a name with control characters'
expect_told 'red\x1b[31m.in' 'a name with control characters'
printf 'x\n' >"$name"
for ranks in 1 2; do
    run "$ranks" run "$name"
    expect_code 2 'a wrong scene whose name has control characters'
    grep -q "$esc" "$test_folder/err" && complain 'control characters in a message'
done
rm -r "$name" kept t.h5 t.xdmf

# If a folder gives no right to write, or its disk cannot be written, the output fails with code 4.
mkdir locked
chmod 555 locked
if ! touch locked/probe 2>/dev/null; then readonly_place=locked
elif chattr +i locked 2>/dev/null; then readonly_place=locked
else readonly_place=; fi
if [ -n "$readonly_place" ]; then
    for option in --output --report; do
        run 2 run tiny.in "$option" "$readonly_place/file"
        expect_code 4 "$option where there are no rights"
        expect_silence "$option where there are no rights"
    done
    run 1 run tiny.in --report locked/file --steps -1
    expect_code 2 'a wrong option beside an output that fails'
    expect_told 'locked/file' 'a wrong option beside an output that fails'
else
    printf 'skipped: --output and --report into a folder without rights, there is none\n'
fi
chattr -i locked 2>/dev/null
chmod 755 locked
rm -r locked
rm tiny.in

run 3
expect_code 2 'no subcommand'
expect_silence 'no subcommand'
[ -z "$(ls -A)" ] || complain 'files were written'
finish
