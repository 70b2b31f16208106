#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Look for wrong memory accesses, undefined behaviour and data races, and fuzz the readers of files.
#
#   ./job_scripts/sanitize.sh                      all of it: some two hours on two idle cores
#   ./job_scripts/sanitize.sh --short              a short form, as continuous integration runs it
#   ./job_scripts/sanitize.sh --only PART ...      some of these parts, one after the other:
#
#   address      address and undefined-behaviour sanitizers on unit, MPI and stability tests
#   scenes       libFuzzer with both on the readers of scenes, 20 minutes
#   checkpoints  the same on the reader of checkpoints, 10 minutes
#   files        damaged files of every kind, HDF5's metadata included, some 10 minutes
#   threads      thread sanitizer with clang's OpenMP and archer on threaded runs
#   memory       valgrind on a run of two ranks
#
# Each command may take 90 minutes; SANITIZE_MINUTES sets another limit for a busy or slow machine.
# Its output goes to a file in build/sanitize that is printed as it begins. Builds are in build,
# build-fuzz and build-tsan. The exit code is 1 if anything has been found; the last lines say what.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

all_parts=(address scenes checkpoints files threads memory)
is_short=no
parts=("${all_parts[@]}")
case ${1:-} in
    '') ;;
    # tests damage files too
    --short) is_short=yes parts=(address scenes checkpoints threads memory) ;;
    --only) parts=("${@:2}") ;;
    *) die "unknown option $1; see the head of this script" ;;
esac
[ ${#parts[@]} -gt 0 ] || die "--only needs a part; there are ${all_parts[*]}"
[[ ${SANITIZE_MINUTES:-90} =~ ^[1-9][0-9]*$ ]] ||
    die "SANITIZE_MINUTES is a whole number, not $SANITIZE_MINUTES"
for part in "${parts[@]}"; do
    [[ " ${all_parts[*]} " == *" $part "* ]] || die "unknown part $part; there are ${all_parts[*]}"
done
install_packages "${test_packages[@]}"
install_optional "${sanitizer_packages[@]}"
n_failures=0

# find_tool NAME...: prints the first of these tools that is installed
find_tool() {
    local name
    for name; do command -v "$name" && return; done
    return 1
}
remedy="try: apt-get install ${sanitizer_packages[*]}"
if ! cxx=$(find_tool clang++ clang++-19 clang++-18 clang++-16 clang++-15 clang++-14); then
    say "sanitizers: left out, there is no clang++; $remedy"
    [ $is_short = yes ] && exit 0 || exit 1
fi

# build_preset PRESET [TARGET...]
build_preset() {
    local preset=$1 words
    shift
    mapfile -t words < <(mpi_words)
    words+=(-DCMAKE_C_COMPILER="${cxx/++/}" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_UNITY_BUILD=ON)
    (cd "$top" && cmake --preset "$preset" "${words[@]}") >&2 </dev/null ||
        die "cmake could not configure $preset"
    build=$top/build-$preset build_targets "$@"
}

minutes=${SANITIZE_MINUTES:-90}
[ $is_short = no ] || minutes=${SANITIZE_MINUTES:-10}
log_folder=$build/sanitize
mkdir -p "$log_folder"
# try NAME WORD...: runs a command, which must succeed within $minutes minutes
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
use_mpi_settings $(($(cores) + 1))
# MPI libraries keep some memory to the end. If a file's metadata are forged, HDF5 may request
# absurd amounts of memory, and handles the refusal.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1

address() {
    local kind tests=$top/build-fuzz/tests
    if [ $is_short = no ]; then
        build_preset fuzz
        for kind in unit stability mpi; do
            try "address, undefined: $kind tests" ctest --test-dir "$top/build-fuzz" \
                -L "^$kind\$" -LE long --output-on-failure --no-tests=error --parallel "$(cores)"
        done
        return
    fi
    build_preset fuzz scene_fuzzer checkpoint_fuzzer check_mpi_test
    try 'address, undefined: both engines, 1 rank x 2 threads' \
        env OMP_NUM_THREADS=2 CARROM_TEST_SECONDS=300 "$tests/check_mpi_test"
    # A quarter of the scenes: ranks that wait for each other take several times as long.
    try 'address, undefined: both engines, 2 ranks' \
        env OMP_NUM_THREADS=1 CARROM_TEST_SECONDS=300 CARROM_TEST_PART=0/4 \
        "$(mpi_launcher "$top/build-fuzz")" -n 2 "$tests/check_mpi_test"
}

scenes() { fuzz scene $([ $is_short = yes ] && echo 8 || echo 1200); }
checkpoints() { fuzz checkpoint $([ $is_short = yes ] && echo 8 || echo 600); }
# fuzz NAME SECONDS: runs a fuzzer, and keeps new inputs in build-fuzz/found_NAME
fuzz() {
    local found=$top/build-fuzz/found_$1
    build_preset fuzz "$1_fuzzer"
    mkdir -p "$found"
    try "libFuzzer: $1, $2 s" "$top/build-fuzz/$1_fuzzer" -max_total_time="$2" -max_len=2000 \
        -timeout=60 -detect_leaks=0 -rss_limit_mb=4000 -malloc_limit_mb=4000 \
        -artifact_prefix="$found/" "$found" "$top/tests/fuzz/$1_corpus"
}

files() {
    configure -DCARROM_TESTS=ON
    build_targets damaged_files
    try 'damaged files' "$build/tests/damaged_files" 20000 1000
}

threads() {
    local archer hashes=$top/build-tsan/tests/stability_hashes settings programs=()
    local tests=(--test-dir "$top/build-tsan" -R 'x 2 threads')
    # Prefers the library of the same compiler, because several may be installed.
    archer=$(find "$(dirname "$(realpath "$(command -v "$cxx")")")/../lib" /usr/lib/*-linux-gnu \
        -name libarcher.so 2>/dev/null | head -n 1) || true
    [ -n "$archer" ] || { say "threads: left out, there is no libarcher.so; $remedy"; return; }
    # Without archer the sanitizer ignores the order that OpenMP's barriers impose. MPI is not
    # instrumented.
    settings=(env OMP_TOOL_LIBRARIES="$archer" OMP_NUM_THREADS=2 CARROM_TEST_SECONDS=3600
              TSAN_OPTIONS=ignore_noninstrumented_modules=1:halt_on_error=1)
    if [ $is_short = yes ]; then
        build_preset tsan stability_hashes
        try 'threads: gases' "${settings[@]}" "$hashes" gas
        return
    fi
    build_preset tsan carrom stability_hashes
    mapfile -t programs < <(ctest "${tests[@]}" -N -V | grep -o '[a-z_]*_mpi_test' | sort -u)
    build_preset tsan "${programs[@]}"
    try 'threads: a run with a checkpoint' "${settings[@]}" "$top/build-tsan/carrom" run \
        "$top/inputs/dense.toml" --steps 20 --threads 2 --check --quiet \
        -o "$top/build-tsan/run" --overwrite
    try 'threads: all scenes' "${settings[@]}" "$hashes"
    try 'threads: the tests of two threads' "${settings[@]}" ctest "${tests[@]}" \
        --output-on-failure --no-tests=error
}

memory() {
    local words=() file
    command -v valgrind >/dev/null ||
        { say "memory: left out, there is no valgrind; $remedy"; return; }
    for file in /usr/{,local/}share/openmpi/openmpi-valgrind.supp "$top/tests/valgrind.supp"; do
        [ ! -r "$file" ] || words+=(--suppressions="$file")
    done
    configure
    build_targets carrom
    try 'valgrind: a run of two ranks with a checkpoint' "$(mpi_launcher "$build")" -n 2 \
        valgrind --error-exitcode=9 --errors-for-leak-kinds=none "${words[@]}" \
        "$build/carrom" run "$top/inputs/dense.toml" --steps 4 --set discs.count=200 --threads 1 \
        --check --quiet -o "$build/valgrind_run" --overwrite
}

for part in "${parts[@]}"; do $part; done
[ $n_failures -eq 0 ] || die "$n_failures of these have failed"
