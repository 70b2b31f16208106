#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests that the fingerprint of some 1400 runs is the same for all compilers, optimisations and
# instruction sets.
#
#   tests/stability/compilers.sh FOLDER [PATTERN]
#
# Builds the engines once for each way below in FOLDER/<way>, runs them and compares. PATTERN (an
# extended regular expression) picks ways by name: 'gcc_O3' or 'O0'. The level `fast` has flags that
# would change arithmetic; carrom_numerics in CMakeLists.txt revokes them. Ways that this machine
# cannot build or run are named and left out. Some 6 minutes a way on one core; a run has failed if
# it takes an hour, or $MINUTES. Needs g++, clang++ and clang's OpenMP (Debian: clang libomp-dev).
set -euo pipefail
source_folder=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${1:?a folder to build in}
pattern=${2:-.}
mkdir -p "$folder"
export OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

# compiler KIND: prints the path of the first compiler of this kind that is installed.
compiler() {
    local name
    case $1 in
        gcc) set -- g++ ;;
        clang) set -- clang++ clang++-19 clang++-16 clang++-15 clang++-14 ;;
    esac
    for name; do command -v "$name" && return; done
    return 1
}
can_run() {
    case $1 in
        v1) true ;;
        v2) grep -qw sse4_2 /proc/cpuinfo ;;
        v3) grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo ;;
        v4) grep -qw avx512f /proc/cpuinfo && grep -qw avx512vl /proc/cpuinfo ;;
    esac
}

n_ways=0 n_failed=0 expected=
for kind in gcc clang; do
    for level in O3 O0 O2 fast; do
        for set in v1 v2 v3 v4; do
            way=${kind}_${level}_$set
            [[ $way =~ $pattern ]] || continue
            path=$(compiler $kind) || { echo "$way: left out, no such compiler"; continue; }
            can_run $set ||
                { echo "$way: left out, this machine has not got these instructions"; continue; }
            flags="-$level -march=x86-64"
            [ $level = fast ] && flags="-O3 -ffast-math -fno-finite-math-only -march=x86-64"
            [ $set = v1 ] || flags+="-$set"
            cmake -S "$source_folder" -B "$folder/$way" -DCMAKE_BUILD_TYPE=None \
                -DCMAKE_CXX_COMPILER="$path" \
                -DCMAKE_CXX_FLAGS="$flags" >"$folder/$way.log" 2>&1 &&
                cmake --build "$folder/$way" --parallel "${JOBS:-1}" --target stability_hashes \
                    >>"$folder/$way.log" 2>&1 ||
                {
                    echo "$way: does not build, see $folder/$way.log"
                    n_failed=$((n_failed + 1))
                    continue
                }
            hash=$(timeout "$((60 * ${MINUTES:-60}))" "$folder/$way/tests/stability_hashes" \
                2>>"$folder/$way.log") || hash='failed'
            echo "$way: $hash"
            n_ways=$((n_ways + 1))
            [ -n "$expected" ] || [ "$hash" = failed ] || expected=$hash
            [ "$hash" = "$expected" ] && [ "$hash" != failed ] || n_failed=$((n_failed + 1))
        done
    done
done
echo "$n_ways ways, $n_failed failed"
[ "$n_ways" -gt 1 ] && [ "$n_failed" -eq 0 ]
