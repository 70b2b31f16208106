#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests that clang-tidy finds none of the faults that .clang-tidy lists.
#
#   bash tests/style/tidy.sh ENVIRONMENT BUILD                 all sources: some minutes
#   bash tests/style/tidy.sh ENVIRONMENT BUILD MODULE ...      those of some modules
#   bash tests/style/tidy.sh ENVIRONMENT BUILD --files src/a.cpp ...   some sources
#
# ENVIRONMENT is a folder for a Python environment, where clang-tidy comes from PyPI and is kept.
# BUILD is a configured build, whose libraries are used; sources are checked one by one, without
# unity files. The exit code is 77 if clang-tidy cannot be installed.
set -euo pipefail
source "$(dirname "$0")/python_tools.sh"
top=$(cd "$(dirname "$0")/../.." && pwd)
environment=$1 build=$(realpath "$2")
shift 2
version=$(sed -n 's/.*clang-tidy==\([0-9.]*\).*/\1/p' "$top/.clang-tidy")
get_tool "$environment" clang-tidy "$version"

libraries='MPI_C_COMPILER|HDF5_C_COMPILER_EXECUTABLE|RANDOM123_INCLUDE_DIR'
mapfile -t choices < <(grep -E "^($libraries):" "$build/CMakeCache.txt")
commands=$environment/commands
cmake -S "$top" -B "$commands" "${choices[@]/#/-D}" -DCARROM_TESTS=OFF -DCMAKE_UNITY_BUILD=OFF \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >"$environment/cmake.log" 2>&1 ||
    { cat "$environment/cmake.log"; exit 1; }
# The package has no omp.h, and GCC's omp.h is only for GCC.
mkdir -p "$environment/openmp"
printf 'extern "C" int omp_get_%s(void);\n' thread_num num_threads num_procs \
    >"$environment/openmp/omp.h"

if [ "${1:-}" = --files ]; then
    shift
    files=("${@/#/$top/}")
else
    [ $# -gt 0 ] || set -- .
    mapfile -t files < <(find "${@/#/$top/src/}" -name '*.cpp' \
        -not -path '*/python/extension/*' | sort)
    [ ${#files[@]} -ge 10 ] || { echo "only ${#files[@]} files found: a wrong folder?"; exit 1; }
fi
# A finding is an error: xargs fails if one run does.
printf '%s\0' "${files[@]}" |
    xargs -0 -P "${JOBS:-$(nproc)}" -n 4 "$tool" -p "$commands" --quiet \
        --extra-arg=-isystem"$(realpath "$environment")/openmp" 2>"$environment/tidy.log" ||
    { cat "$environment/tidy.log"; echo "clang-tidy $version: see above"; exit 1; }
echo "${#files[@]} files, clang-tidy $version"
