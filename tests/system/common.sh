# SPDX-License-Identifier: BSD-3-Clause
# Functions that system tests share: they run the real program, print each failure, and fail at the
# end. To be sourced.
#
# Each test runs in a folder of its own. The program's working folder is `files`. Its output is kept
# beside this folder in `out` and `err`, so that unexpected files are found.
set -u
exec </dev/null

# There are more threads than cores, so waiting threads must not spin.
export OMP_WAIT_POLICY=passive

test_folder=$PWD
rm -rf files out err
mkdir files
cd files || exit

n_failures=0 n_runs=0
complain() {
    printf 'FAILED: %s\n' "$*"
    n_failures=$((n_failures + 1))
}
finish() {
    printf '%s runs of the program\n' "$n_runs"
    [ "$n_failures" -eq 0 ] || { printf '%s failures\n' "$n_failures"; exit 1; }
    exit 0
}

# The launcher of Open MPI 5.0.7 (Debian 13) sometimes sends some bytes of standard output to
# standard error. So with this launcher each rank writes to the files itself.
past_launcher=() has_proxy=no
case $("$CARROM_MPIEXEC" --version 2>&1) in
    *'Open MPI) 5'* | *PRRTE*)
        past_launcher=(sh -c 'exec "$@" >>"$0/out" 2>>"$0/err"' "$test_folder") ;;
    *HYDRA*) has_proxy=yes ;;
esac

# ranks_of LAUNCHER: prints the process ids of its ranks. MPICH's launcher has a process between
# itself and the ranks.
ranks_of() {
    local parent=$1
    [ $has_proxy = no ] || parent=$(pgrep -d , -P "$1") || return
    pgrep -P "$parent"
}

# run RANKS WORD...: runs the program on that many ranks, for at most `patience` seconds, and sets
# `code`. One rank runs without mpiexec, which takes two seconds to end when its only rank has
# failed.
patience=60
run() {
    local launch=("$CARROM_MPIEXEC" -n "$1" "${past_launcher[@]}")
    [ "$1" -gt 1 ] || launch=()
    shift
    n_runs=$((n_runs + 1))
    : >"$test_folder/out"
    : >"$test_folder/err"
    timeout --kill-after=5 "$patience" "${launch[@]}" "$CARROM_PROGRAM" "$@" >>"$test_folder/out" \
        2>>"$test_folder/err"
    code=$?
    [ "$code" -ne 124 ] || complain "no end within $patience seconds: $*"
}
show() { sed 's/^/    /' "$test_folder/err"; }

expect_code() { [ "$code" -eq "$1" ] || { complain "exit code $code, not $1: $2"; show; }; }
expect_silence() { [ ! -s "$test_folder/out" ] || complain "standard output is not empty: $1"; }
expect_told() {
    grep -qF -- "$1" "$test_folder/err" || { complain "not printed: \"$1\", in: $2"; show; }
}
expect_same() { cmp "$1" "$2" || complain "$3"; }

# gas_scene SIZE COUNT PACKING SPEED STEPS: prints a scene of randomly placed discs.
gas_scene() {
    local text='[box]\nsize = %s\n[discs]\ncount = %s\npacking = %s\nspeed = %s\n'
    printf "${text}[time]\nmethod = \"time-stepped\"\nsteps = %s\n" "$@"
}

# periodic_box SIZE: prints a scene's table of a square box with four periodic sides.
periodic_box() {
    printf '[box]\nsize = %s\n' "$1"
    printf '%s.kind = "periodic"\n' left right bottom top
}

# json_value FILE KEY: prints the value of a key that is on a line of its own.
json_value() { sed -n "s/^ *\"$2\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}\$/\1/p" "$1"; }

# check_patch PATCH: fails unless the patch applies to the sources without fuzz.
check_patch() {
    patch --dry-run --batch --fuzz=0 -p1 -d "$CARROM_SOURCE_DIR" -i "$1" ||
        complain 'the patch does not apply: make it anew'
}

# build_copy_with PATCH CMAKE OPTION...: builds the program of a copy of the sources with the patch;
# CARROM_PROGRAM is that program afterwards. The copy is in $copy, without any builds.
build_copy_with() {
    local change=$1 cmake=$2
    shift
    copy=$test_folder/copy
    rm -rf "$copy" && mkdir "$copy"
    for entry in "$CARROM_SOURCE_DIR"/*; do
        [ -e "$entry/CMakeCache.txt" ] || cp -r "$entry" "$copy/"
    done
    patch --batch --fuzz=0 -p1 -d "$copy" -i "$change" >"$test_folder/out"
    { "$@" -S "$copy" -B "$copy/build" -DCARROM_TESTS=OFF &&
        "$cmake" --build "$copy/build" --target carrom --parallel "${JOBS:-1}"; } \
        >"$test_folder/out" 2>&1 || {
        complain 'the copy does not build'
        tail -n 30 "$test_folder/out"
        finish
    }
    CARROM_PROGRAM=$copy/build/carrom
}
