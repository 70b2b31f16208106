#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests the program on a processor that this machine does not have: builds it with a cross compiler,
# runs scenes under QEMU's emulation, and compares their hashes with those of x86-64.
#
#   job_scripts/emulated.sh aarch64        also ppc64le, and riscv64 from Debian 13 on
#
# Needs Debian, root, debootstrap and 2 GB of disk. The foreign libraries are Debian's of the same
# release, unpacked into a folder; nothing of them is installed here. May be set from outside:
#   MIRROR      where the packages are; default: where apt of this machine takes its own from
#   FOLDER      where all is kept; default: build/emulated/PROCESSOR
#   RANKS       ranks of each run; default 1, because emulated ranks do not share memory everywhere
#   THREADS     threads of each rank; default 2
#   SCENES      files of inputs/ that run, as in 'gas.toml tiny.in'; default: all
#   FINGERPRINT `no` leaves out the random scenes, which take hours under emulation
#   QEMU_CPU    another model of the processor: cortex-a72 is an aarch64 with NEON and without SVE
#   TABLE       the file for the table of hashes; default FOLDER/hashes.csv
# The exit code is 1 if a hash differs.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

processor=${1:-}
case $processor in
    aarch64) debian=arm64 triple=aarch64-linux-gnu emulator=qemu-aarch64-static ;;
    ppc64le) debian=ppc64el triple=powerpc64le-linux-gnu emulator=qemu-ppc64le-static ;;
    riscv64) debian=riscv64 triple=riscv64-linux-gnu emulator=qemu-riscv64-static ;;
    *) sed -n '3,18s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac
export FINGERPRINT=${FINGERPRINT:-yes}
# Debian's MPICH for ppc64el uses UCX, whose sockets fail under emulation.
export UCX_TLS=${UCX_TLS:-self,sm}
folder=$(realpath -m "${FOLDER:-$top/build/emulated/$processor}")
system=$folder/system build=$folder/build emulated=$folder/emulated
table=${TABLE:-$folder/hashes.csv}
suite=$(source /etc/os-release && echo "$VERSION_CODENAME")
libraries=(libc6-dev libstdc++-12-dev libmpich-dev libhdf5-mpich-dev libfmt-dev libtomlplusplus-dev
           libcli11-dev nlohmann-json3-dev librandom123-dev libhwy-dev libxxhash-dev catch2)
case $suite in bookworm) ;; trixie) libraries[1]=libstdc++-14-dev ;; *) unset 'libraries[1]' ;; esac

# cross_build: builds the program and the fingerprint of random scenes. CMake finds programs on this
# machine, and everything else among the foreign libraries.
cross_build() {
    local place=$system/usr/lib/$triple
    export PKG_CONFIG_LIBDIR=$place/pkgconfig:$system/usr/share/pkgconfig
    export PKG_CONFIG_SYSROOT_DIR=$system
    cat >"$folder/toolchain.cmake" <<END
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR $processor)
set(CMAKE_C_COMPILER $triple-gcc)
set(CMAKE_CXX_COMPILER $triple-g++)
set(CMAKE_SYSROOT $system)
set(CMAKE_CROSSCOMPILING_EMULATOR $(command -v "$emulator") -L $system)
set(CMAKE_LIBRARY_ARCHITECTURE $triple)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
END
    configure -DCMAKE_TOOLCHAIN_FILE="$folder/toolchain.cmake" -DCARROM_TESTS=ON \
        -DMPI_C_LIB_NAMES=mpich -DMPI_mpich_LIBRARY="$place/libmpich.so" \
        -DMPI_C_HEADER_DIR="$system/usr/include/$triple/mpich" \
        -DMPIEXEC_EXECUTABLE="$(command -v mpiexec.mpich)" \
        -DHDF5_hdf5_LIBRARY_RELEASE="$place/hdf5/mpich/libhdf5.so" \
        -DHDF5_C_INCLUDE_DIR="$system/usr/include/hdf5/mpich"
    build_targets carrom $([ "$FINGERPRINT" = no ] || echo stability_hashes)
}

# wrap PROGRAM: makes a script of this name that runs the program under emulation
wrap() {
    mkdir -p "$(dirname "$emulated/$1")"
    printf '#!/bin/sh\nexec %s -L %s %s "$@"\n' "$emulator" "$system" "$build/$1" >"$emulated/$1"
    chmod +x "$emulated/$1"
}

mkdir -p "$folder"
[ "$(id -u)" -eq 0 ] || die "foreign libraries are unpacked by root only; try: sudo $0 $*"
install_packages "g++-${triple//_/-}" qemu-user-static debootstrap mpich
unpack_debian "$system" "$suite" "$debian" "${libraries[@]}" ||
    die "debootstrap failed; see $system.log"
cross_build
wrap carrom
wrap tests/stability_hashes
cp "$build/CMakeCache.txt" "$emulated/CMakeCache.txt"
"$emulated/carrom" --version --check
TABLE=$table RANKS=${RANKS:-1} "$top/tests/stability/scene_hashes.sh" "$emulated" --compare ||
    die "hashes on $processor differ; they are in $table"
say "the hashes of $processor are those of x86-64"
