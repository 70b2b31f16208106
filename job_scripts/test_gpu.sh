#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Test the kernels on a GPU, and measure them: bits against the CPU, compute-sanitizer on small
# scenes, speeds. It prints tables, and ends with 1 if anything is wrong. On a machine with the
# programs built it takes less than four minutes.
#
#   ./job_scripts/test_gpu.sh               builds in build-gpu what is missing, then tests
#   ./job_scripts/test_gpu.sh FOLDER        takes the programs of this build
#
# A machine that has a GPU, but neither MPI nor HDF5, needs only `device_table` of a build that was
# made elsewhere: FOLDER/tests/device_table, and FOLDER/lib with libraries that it lacks.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${1:-$top/build-gpu}
largest=${LARGEST:-10000000} # largest number of discs in the table of speeds

nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader
if [[ ! -x $build/tests/device_table ]]; then
    cmake -S "$top" -B "$build" -DCARROM_CUDA=ON -DCARROM_TESTS=ON -DCMAKE_UNITY_BUILD=ON
    cmake --build "$build" --parallel --target carrom device_table gpu_mpi_test
fi
export LD_LIBRARY_PATH=$build/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
table=$build/tests/device_table
wrong=0

heading() { printf '\n== %s (after %d s)\n' "$1" "$SECONDS"; }
check() { "$@" || {
    wrong=1
    echo "WRONG: $* ended with code $?"
}; }

heading "bits: GPU against CPU"
check "$table" bits
if [[ -x $build/tests/gpu_mpi_test ]]; then
    heading "the ordinary tests, on the GPU"
    CARROM_TEST_GPU=1 check "$build/tests/gpu_mpi_test"
fi
if [[ -x $build/carrom ]]; then
    heading "scenes by the program"
    for scene in gas periodic; do
        [[ -e $top/inputs/$scene.toml ]] || continue
        for gpu in false true; do
            check "$build/carrom" run "$top/inputs/$scene.toml" --quiet --set output.folder= \
                --set time.method=time-stepped --set machine.gpu=$gpu --digits 17 \
                --report "/tmp/$scene.$gpu.json" >"/tmp/$scene.$gpu.txt"
        done
        check cmp "/tmp/$scene.false.txt" "/tmp/$scene.true.txt"
        check python3 - "/tmp/$scene.false.json" "/tmp/$scene.true.json" <<'PYTHON'
import json, sys
cpu, gpu = (json.load(open(name)) for name in sys.argv[1:])
assert cpu["state_hash"] == gpu["state_hash"], "state hashes differ"
assert cpu["averages"] == gpu["averages"], "averages differ"
print(gpu["gpu"]["name"], "has the hash and the averages of the CPU")
PYTHON
    done
fi
PATH=$PATH:/usr/local/cuda/bin
if sanitizer=$(command -v compute-sanitizer); then
    for tool in memcheck racecheck; do
        heading "compute-sanitizer, $tool"
        check timeout 60 "$sanitizer" --tool "$tool" --error-exitcode 1 "$table" small
    done
else
    echo "compute-sanitizer is not here"
fi
heading "speed"
check "$table" speed "$largest"
heading "done"
exit $wrong
