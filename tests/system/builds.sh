#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# CMake's part before anything is compiled: an unsuitable system is an error of one line, a project
# that adds Carrom as a folder keeps its build type, flags that change arithmetic are revoked, and
# --version shows changes.
#
# usage: builds.sh CMAKE CXX
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
cmake=$1 compiler=$2

# configured FOLDER WORD...: runs cmake, with its output in `log`; fails if cmake fails
configured() {
    rm -rf "$test_folder/build"
    timeout 200 "$cmake" -S "$1" -B "$test_folder/build" -DCARROM_TESTS=OFF \
        -DCMAKE_CXX_COMPILER="$compiler" "${@:2}" >log 2>&1
}
# expect_refusal WHAT WORD...
expect_refusal() {
    configured "$CARROM_SOURCE_DIR" "${@:2}" && complain "no word of $1"
    tr -s '\n ' ' ' <log >line
    grep -qF "Carrom needs Linux on a 64-bit little-endian processor, not $1" line ||
        { complain "not refused in one line: $1"; tail -n 5 log; }
    [ "$(grep -c 'CMake Error' log)" -eq 1 ] || complain "several errors for $1"
}
expect_refusal FreeBSD -DCMAKE_SYSTEM_NAME=FreeBSD
expect_refusal Darwin -DCMAKE_SYSTEM_NAME=Darwin
# expect_refusal_of_data BYTES ORDER: sets the properties that CMake would detect for such a
# compiler.
expect_refusal_of_data() {
    local language words=()
    for language in C CXX; do
        words+=("-DCMAKE_${language}_ABI_COMPILED=1" "-DCMAKE_${language}_SIZEOF_DATA_PTR=$1"
                "-DCMAKE_${language}_BYTE_ORDER=$2")
    done
    expect_refusal "Linux with $((8 * $1)) bits, $2" "${words[@]}"
}
expect_refusal_of_data 4 LITTLE_ENDIAN
expect_refusal_of_data 8 BIG_ENDIAN

# HDF5 of another MPI library is an error, also if a link hides the library's name.
multiarch=$("$compiler" -print-multiarch)
libraries=/usr/lib/$multiarch
# with_openmpi_hdf5 NAME LIBRARY HEADERS: Open MPI's HDF5 with that MPI library, named by a link
with_openmpi_hdf5() {
    ln -sf "$(realpath "$2")" "lib$1.so"
    configured "$CARROM_SOURCE_DIR" -DHDF5_C_COMPILER_EXECUTABLE=/usr/bin/h5pcc.openmpi \
        -DMPI_C_LIB_NAMES="$1" "-DMPI_$1_LIBRARY=$PWD/lib$1.so" -DMPI_C_HEADER_DIR="$3"
}
if [ -e "$libraries/hdf5/openmpi/libhdf5.so" ] && [ -e "$libraries/libmpich.so" ]; then
    with_openmpi_hdf5 mpi "$libraries/openmpi/lib/libmpi.so" "$libraries/openmpi/include" ||
        { complain 'Open MPI by a link'; tail -n 5 log; }
    with_openmpi_hdf5 mpich "$libraries/libmpich.so" "/usr/include/$multiarch/mpich" &&
        complain 'MPICH with the HDF5 of Open MPI'
    grep -q 'was built with another MPI library' log ||
        { complain 'no word of two MPI libraries'; tail -n 5 log; }
else
    printf 'skipped: Debian has not both MPI libraries installed\n'
fi

# A folder with a name that HDF5's h5pcc cannot handle.
odd="$test_folder/it's of ä"
mkdir "$odd"
timeout 200 "$cmake" -S "$CARROM_SOURCE_DIR" -B "$odd/build" -DCARROM_TESTS=OFF \
    -DCMAKE_CXX_COMPILER="$compiler" >log 2>&1 ||
    { complain 'a folder of odd name'; tail -n 5 log; }
rm -rf "$odd"

mkdir parent
cat >parent/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.25)
project(parent LANGUAGES C CXX)
add_subdirectory("$CARROM_SOURCE_DIR" carrom)
get_target_property(folder carrom RUNTIME_OUTPUT_DIRECTORY)
message(STATUS "the program is put into \${folder}/")
END
unset CMAKE_BUILD_TYPE
configured parent -DCMAKE_EXPORT_COMPILE_COMMANDS=ON ||
    { complain 'a parent project'; tail -n 5 log; }
grep -qx 'CMAKE_BUILD_TYPE:STRING=' "$test_folder/build/CMakeCache.txt" ||
    complain "the parent's build type: $(grep BUILD_TYPE: "$test_folder/build/CMakeCache.txt")"
# Elsewhere it would need the name that the parent gives to the folder of this project.
grep -q 'the program is put into .*/build/carrom/$' log ||
    complain "the program of a parent's build: $(grep 'is put into' log)"

# A user's flags that change arithmetic are revoked. The compiler itself lists the options in
# effect.
mapfile -t flags < <(grep -m 1 '"command".*src/core/' "$test_folder/build/compile_commands.json" |
    grep -o ' -f[a-z=-]*' | tr -d ' ')
in_force() {
    case $("$compiler" --version) in
        *clang*)
            "$compiler" -O3 "$@" -'###' -c -x c++ -o out.o main.cpp 2>&1 | grep -e -cc1
            ;;
        *) "$compiler" -O3 "$@" -Q --help=optimizers | grep -v '^ *-o ' ;;
    esac
}
: >main.cpp
in_force "${flags[@]}" >plain
[ ${#flags[@]} -gt 2 ] || complain "the core is compiled without flags: ${flags[*]}"
for unsafe in '-ffast-math -fno-finite-math-only' -funsafe-math-optimizations -freciprocal-math \
    '-fassociative-math -fno-signed-zeros -fno-trapping-math' -ffp-contract=fast; do
    read -ra words <<<"$unsafe"
    in_force "${flags[@]}" "${words[@]}" | cmp -s - plain &&
        complain "the compiler does not show what $unsafe does"
    in_force "${words[@]}" "${flags[@]}" >unsafe
    diff plain unsafe >differences || complain "$unsafe has an effect: $(head -n 3 differences)"
done

# The commit of a tree that was changed is marked.
if command -v git >/dev/null && git -C "$CARROM_SOURCE_DIR" rev-parse HEAD >/dev/null 2>&1; then
    git clone -q --no-hardlinks "$CARROM_SOURCE_DIR" clone 2>err || complain 'git clone'
    commit=$(git -C clone rev-parse --short=12 HEAD)
    for mark in '' -modified; do
        [ -z "$mark" ] || echo '# changed' >>clone/README.md
        configured clone -G Ninja || { complain 'the clone'; tail -n 5 log; }
        grep -q "CARROM_COMMIT=.*${commit}${mark}[\\\\\"]" "$test_folder/build/build.ninja" ||
            complain "--version would not show $commit$mark"
    done
fi
rm -rf "$test_folder/build" clone
finish
