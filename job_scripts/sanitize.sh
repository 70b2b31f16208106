#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Look for wrong memory accesses, undefined behaviour and data races, and fuzz the readers of files.
#
#   ./job_scripts/sanitize.sh              all of it: an hour or more on two cores
#   ./job_scripts/sanitize.sh --short      what continuous integration runs, in some three minutes on two cores; no threads' races
#
# Address and undefined-behaviour sanitizers on unit and MPI tests, libFuzzer on the readers of scenes and checkpoints,
# thread sanitizer with clang's OpenMP and archer on threaded runs, valgrind on a run of two ranks. Builds are in
# build-fuzz and build-tsan.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

is_short=no
[ "${1:-}" != --short ] || is_short=yes
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
# try NAME WORD...: a command that must succeed within ten minutes (--short) or an hour.
try() {
    local name=$1 limit=3600 start=$SECONDS
    [ $is_short = no ] || limit=600
    shift
    if timeout "$limit" "$@" >"$log" 2>&1 </dev/null; then
        say "$name: clean, $((SECONDS - start)) s"
    else
        say "$name: FAILED"
        tail -n 60 "$log" >&2
        n_failures=$((n_failures + 1))
    fi
}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
launch_settings $(($(nproc) + 1))
export OMP_WAIT_POLICY=passive
# MPI never gives some of its memory back.
# HDF5 asks for absurd amounts of memory where a file's metadata has been forged, and copes with getting none.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1

address_and_undefined() {
    if [ $is_short = no ]; then
        build_preset fuzz
        try 'address, undefined: unit and MPI tests' ctest --test-dir "$top/build-fuzz" -L 'unit|mpi|stability' -LE long \
            --output-on-failure --no-tests=error --parallel "$(nproc)"
        return
    fi
    build_preset fuzz scene_fuzzer checkpoint_fuzzer check_mpi_test
    local tests=$top/build-fuzz/tests
    try 'address, undefined: both engines, 1 rank x 2 threads' env OMP_NUM_THREADS=2 CARROM_TEST_SECONDS=300 "$tests/check_mpi_test"
    try 'address, undefined: both engines, 3 ranks' env OMP_NUM_THREADS=1 CARROM_TEST_SECONDS=300 mpiexec -n 3 "$tests/check_mpi_test"
}
# fuzz NAME SECONDS: new inputs are kept in build-fuzz/found_NAME.
fuzz() {
    local found=$top/build-fuzz/found_$1
    mkdir -p "$found"
    try "libFuzzer: $1, $2 s" "$top/build-fuzz/$1_fuzzer" -max_total_time="$2" -max_len=2000 -timeout=60 -detect_leaks=0 \
        -rss_limit_mb=4000 -malloc_limit_mb=4000 \
        -artifact_prefix="$found/" "$found" "$top/tests/fuzz/$1_corpus"
}
threads() {
    local archer
    archer=$(find /usr/lib/llvm* /usr/lib/x86_64-linux-gnu -name libarcher.so 2>/dev/null | sort | tail -n 1) || true
    [ -n "$archer" ] || { say "threads: left out, there is no libarcher.so; ask for: apt-get install ${sanitizer_packages[*]}"; return; }
    # Without archer the sanitizer does not know what OpenMP's barriers order. MPI is not instrumented.
    local settings=(OMP_TOOL_LIBRARIES="$archer" TSAN_OPTIONS=ignore_noninstrumented_modules=1:halt_on_error=1 OMP_NUM_THREADS=2
                    CARROM_TEST_SECONDS=3600)
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

address_and_undefined
if [ $is_short = yes ]; then
    fuzz scene 8
    fuzz checkpoint 8
else
    fuzz scene 1200
    fuzz checkpoint 600
fi
[ $is_short = yes ] || threads # building everything once more takes a minute or two
memory
[ $n_failures -eq 0 ] || die "$n_failures of these have failed"
