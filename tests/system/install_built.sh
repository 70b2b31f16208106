#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests of install.sh for another kind of build:
#
#   shared   libcarrom.so, which programs link by CMake and by pkg-config without naming its own
#            libraries
#   clang    an archive by clang, for shared libraries of others too; g++ gets a word about it from
#            CMake, and links it by pkg-config
#
# usage: install_built.sh KIND CMAKE CXX WORD...    words for cmake, as for this build
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
kind=$1 cmake=$2 compiler=$3
words=("${@:4}" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DCARROM_TESTS=OFF)
case $kind in
    shared) words+=(-DCARROM_SHARED=ON -DCMAKE_CXX_COMPILER="$compiler") ;;
    clang)
        clang=$(command -v clang++) || { echo 'skipped: there is no clang++'; exit 77; }
        words+=(-DCMAKE_CXX_COMPILER="$clang" -DCMAKE_POSITION_INDEPENDENT_CODE=ON)
        ;;
esac
"$cmake" -S "$CARROM_SOURCE_DIR" -B "$test_folder/build" "${words[@]}" >log 2>&1 &&
    "$cmake" --build "$test_folder/build" --target carrom libcarrom >>log 2>&1 ||
    { tail -n 20 log; complain "no build: $kind"; finish; }
"$cmake" --install "$test_folder/build" --prefix "$test_folder/of_$kind" >log 2>&1 ||
    complain "no installation: $(tail -n 3 log)"
library=$(dirname "$(dirname "$(find "$test_folder/of_$kind" -name carrom.pc)")")
export PKG_CONFIG_PATH=$library/pkgconfig

if [ $kind = shared ]; then
    version=$(pkg-config --modversion carrom)
    [ "$(cd "$library" && find . -name 'libcarrom.*' -type f)" = "./libcarrom.so.$version" ] ||
        complain "other libraries: $(ls "$library")"
    readelf -d "$library/libcarrom.so" | grep -q "soname: .libcarrom.so.${version%.*}\]" ||
        complain "another SONAME: $(readelf -d "$library/libcarrom.so" | grep SONAME)"
    read -ra flags <<<"$(pkg-config --cflags --libs carrom)"
    program=("$compiler")
else
    read -ra flags <<<"$(pkg-config --cflags --static --libs carrom)"
    program=(g++)
    "$cmake" -S "$CARROM_SOURCE_DIR/docs/examples/embed" -B refused -DCMAKE_CXX_COMPILER=g++ \
        -DCMAKE_PREFIX_PATH="$test_folder/of_$kind" >log 2>&1 &&
        complain 'CMake takes an archive of clang for g++'
    tr -s '\n ' ' ' <log >line
    grep -q 'was built by Clang, whose OpenMP library GNU does not link; try:' line ||
        complain "no word of clang: $(tail -n 3 log)"
    compiler=$clang
fi
"${program[@]}" -std=c++20 "$CARROM_SOURCE_DIR/docs/examples/embed/embed.cpp" -o embed \
    "${flags[@]}" -Wl,-rpath,"$library" >log 2>&1 || complain "no link: $(tail -n 3 log)"
timeout 120 ./embed >out 2>err || complain "the example fails: $(tail -n 3 err)"
hash=$(tail -n 1 out)
timeout 120 "$CARROM_MPIEXEC" -n 2 ./embed >out 2>err || complain "two ranks: $(tail -n 3 err)"
[ -n "$hash" ] && [ "$(tail -n 1 out)" = "$hash" ] || complain "other bits on two ranks"
[ "$n_failures" -eq 0 ] || finish
exec bash "$CARROM_SOURCE_DIR/tests/system/install.sh" "$cmake" "$test_folder/build" "$compiler"
