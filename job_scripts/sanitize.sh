#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Look for wrong memory accesses, undefined behaviour and data races, and fuzz the readers of files.
#
#   ./job_scripts/sanitize.sh                      all of it: some two hours on two idle cores
#   ./job_scripts/sanitize.sh --short              what continuous integration runs, in some four minutes on two cores
#   ./job_scripts/sanitize.sh --only PART ...      some of these parts, one after the other:
#
#   address      address and undefined-behaviour sanitizers on unit, MPI and stability tests
#   scenes       libFuzzer with both on the readers of scenes, 20 minutes
#   checkpoints  the same on the reader of checkpoints, 10 minutes
#   files        damaged files of every kind, HDF5's metadata included, some 10 minutes
#   threads      thread sanitizer with clang's OpenMP and archer on threaded runs
#   memory       valgrind on a run of two ranks
#
# Each command may take an hour and a half ($SANITIZE_MINUTES says otherwise, for a machine that is busy or slow); what it
# says goes to a file that is named as it begins, in build/sanitize. Builds are in build, build-fuzz and build-tsan. The
# exit code is 1 if anything has been found; a line tells what is clean and what is not.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

all_parts=(address scenes checkpoints files threads memory)
is_short=no
parts=("${all_parts[@]}")
case ${1:-} in
    '') ;;
    --short) is_short=yes ;;
    --only) parts=("${@:2}") ;;
    *) die "what is $1? See the head of this script" ;;
esac
for part in "${parts[@]}"; do
    [[ " ${all_parts[*]} " == *" $part "* ]] || die "there is no part $part; there are ${all_parts[*]}"
done
install_sanitizer_packages
n_failures=0

# find_tool NAME...: the first one there is.
find_tool() {
    local name
    for name; do command -v "$name" && return; done
    return 1
}
if ! cxx=$(find_tool clang++ clang++-19 clang++-16 clang++-15 clang++-14); then
    say "sanitizers: left out, there is no clang++; ask for: apt-get install ${sanitizer_packages[*]}"
    [ $is_short = yes ] && exit 0 || exit 1
fi
cc=${cxx/++/}

# build_preset PRESET TARGET...
build_preset() {
    local preset=$1
    shift
    cmake -S "$top" --preset "$preset" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" >&2 </dev/null ||
        die "cmake could not configure $preset"
    cmake --build "$top/build-$preset" --parallel "$(nproc)" ${1:+--target "$@"} >&2 </dev/null || die "$preset does not build"
}
minutes=${SANITIZE_MINUTES:-90}
[ $is_short = no ] || minutes=${SANITIZE_MINUTES:-10}
log_folder=$build/sanitize
mkdir -p "$log_folder"
# try NAME WORD...: a command that must succeed within so many minutes.
try() {
    local name=$1 start=$SECONDS code=0 log
    log=$log_folder/$(tr -cs 'A-Za-z0-9\n' _ <<<"$name").log
    shift
    say "$name: begins at $(date +%H:%M); see $log"
    timeout "$((60 * minutes))" "$@" >"$log" 2>&1 </dev/null || code=$?
    case $code in
        0) say "$name: clean, $((SECONDS - start)) s" ;;
        124) say "$name: NOT DONE after $minutes minutes; SANITIZE_MINUTES allows more" ;;
        *) say "$name: FAILED, exit code $code" ;;
    esac
    [ $code -eq 0 ] || { tail -n 60 "$log" >&2; n_failures=$((n_failures + 1)); }
}
launch_settings $(($(nproc) + 1))
export OMP_WAIT_POLICY=passive
# MPI never gives some of its memory back.
# HDF5 asks for absurd amounts of memory where a file's metadata has been forged, and copes with getting none.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1

address() {
    if [ $is_short = no ]; then
        build_preset fuzz
        local kind
        for kind in unit stability mpi; do
            try "address, undefined: $kind tests" ctest --test-dir "$top/build-fuzz" -L "^$kind\$" -LE long --output-on-failure \
                --no-tests=error --parallel "$(nproc)"
        done
        return
    fi
    build_preset fuzz scene_fuzzer checkpoint_fuzzer check_mpi_test
    local tests=$top/build-fuzz/tests
    try 'address, undefined: both engines, 1 rank x 2 threads' env OMP_NUM_THREADS=2 CARROM_TEST_SECONDS=300 "$tests/check_mpi_test"
    # A quarter of the scenes: ranks that wait for each other take several times as long.
    try 'address, undefined: both engines, 2 ranks' env OMP_NUM_THREADS=1 CARROM_TEST_SECONDS=300 CARROM_TEST_PART=0/4 \
        mpiexec -n 2 "$tests/check_mpi_test"
}
scenes() { fuzz scene $([ $is_short = yes ] && echo 8 || echo 1200); }
checkpoints() { fuzz checkpoint $([ $is_short = yes ] && echo 8 || echo 600); }
# fuzz NAME SECONDS: new inputs are kept in build-fuzz/found_NAME.
fuzz() {
    local found=$top/build-fuzz/found_$1
    build_preset fuzz "$1_fuzzer"
    mkdir -p "$found"
    try "libFuzzer: $1, $2 s" "$top/build-fuzz/$1_fuzzer" -max_total_time="$2" -max_len=2000 -timeout=60 -detect_leaks=0 \
        -rss_limit_mb=4000 -malloc_limit_mb=4000 \
        -artifact_prefix="$found/" "$found" "$top/tests/fuzz/$1_corpus"
}
files() {
    build_target damaged_files
    try 'damaged files' "$build/tests/damaged_files" 20000 1000
}
threads() {
    local archer
    archer=$(find /usr/lib/llvm* /usr/lib/x86_64-linux-gnu -name libarcher.so 2>/dev/null | sort | tail -n 1) || true
    [ -n "$archer" ] || { say "threads: left out, there is no libarcher.so; ask for: apt-get install ${sanitizer_packages[*]}"; return; }
    # Without archer the sanitizer does not know what OpenMP's barriers order. MPI is not instrumented.
    local settings=(OMP_TOOL_LIBRARIES="$archer" TSAN_OPTIONS=ignore_noninstrumented_modules=1:halt_on_error=1 OMP_NUM_THREADS=2
                    CARROM_TEST_SECONDS=3600)
    if [ $is_short = yes ]; then
        build_preset tsan stability_hashes
        try 'threads: gases' env "${settings[@]}" "$top/build-tsan/tests/stability_hashes" gas
        return
    fi
    build_preset tsan
    try 'threads: all scenes' env "${settings[@]}" "$top/build-tsan/tests/stability_hashes"
    try 'threads: the tests of two threads' env "${settings[@]}" ctest --test-dir "$top/build-tsan" -R 'x 2 threads' \
        --output-on-failure --no-tests=error
}
memory() {
    local suppressions
    command -v valgrind >/dev/null || { say "valgrind: left out, it is not installed"; return; }
    suppressions=$(find /usr/share/openmpi /usr/local/share/openmpi -name openmpi-valgrind.supp 2>/dev/null | head -n 1) || true
    build_target carrom
    try 'valgrind: a run of two ranks with a checkpoint' mpiexec -n 2 valgrind --error-exitcode=9 --errors-for-leak-kinds=none \
        ${suppressions:+--suppressions="$suppressions"} --suppressions="$top/tests/valgrind.supp" \
        "$build/carrom" run "$top/inputs/dense.toml" --steps 4 --set discs.count=200 --threads 1 --check --quiet \
        --set output.checkpoint.folder="$build/valgrind_checkpoints"
}

[ $is_short = no ] || parts=(address scenes checkpoints threads memory) # the tests have some damaged files
for part in "${parts[@]}"; do $part; done
[ $n_failures -eq 0 ] || die "$n_failures of these have failed"
