# SPDX-License-Identifier: BSD-3-Clause
# Functions that run_local.sh, test_local.sh and sanitize.sh share: they install packages, build,
# and choose settings. To be sourced.
#
# Only missing packages are installed. Nothing else is written outside the build folder. Variables
# that the user has set are kept: CMAKE_GENERATOR, those of mpi_settings.txt, and
#   BUILD_DIR   the build folder; default build, or build-$MPI
#   MPI         openmpi or mpich; default: the one whose HDF5 is installed, else openmpi

unset CDPATH # cd would print where it goes
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${BUILD_DIR:-$top/build${MPI:+-$MPI}}
source "$top/job_scripts/mpi.sh"

say() { printf '%s\n' "$*" >&2; }
die() { say "$(basename "$0"): $*"; exit 1; }

case ${MPI:-} in '' | openmpi | mpich) ;; *) die "MPI is openmpi or mpich, not $MPI" ;; esac

# Packages that the program needs, without the MPI library and its HDF5.
packages=(cmake ninja-build g++ pkg-config libfmt-dev libtomlplusplus-dev libcli11-dev
          nlohmann-json3-dev librandom123-dev libhwy-dev libxxhash-dev)
openmpi_packages=(openmpi-bin libopenmpi-dev libhdf5-openmpi-dev)
mpich_packages=(mpich libmpich-dev libhdf5-mpich-dev)

test_packages=(catch2 patch procps)
# Some tests need these: a Slurm of their own, failing disks, Python programs that open our files, a
# simulated cluster, micro-benchmarks. Without them such a test is skipped, and prints the reason.
optional_test_packages=(slurmctld slurmd slurm-client slurm-wlm-basic-plugins munge strace
                        python3-venv libsimgrid-dev libbenchmark-dev)

sanitizer_packages=(clang libclang-rt-dev libomp-dev valgrind)

# missing_packages PACKAGE...: prints the packages that are not installed
missing_packages() {
    local package
    for package in "$@"; do
        dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
            printf '%s\n' "$package"
    done
}

# has_apt: whether the system has apt. Without apt the build itself reports missing packages.
has_apt() { command -v dpkg-query >/dev/null && command -v apt-get >/dev/null; }

# install PACKAGE...: installs missing packages. Fails if some of them cannot be installed;
# `missing` lists them.
missing=()
install() {
    has_apt || return 0
    mapfile -t missing < <(missing_packages "$@")
    [ ${#missing[@]} -eq 0 ] || install_missing "${missing[@]}"
}

# mpi_library: prints the library that MPI names, else the one whose HDF5 is installed, else Open
# MPI
mpi_library() {
    if [ -z "${MPI:-}" ] && has_apt && [ -z "$(missing_packages libhdf5-mpich-dev)" ] &&
        [ -n "$(missing_packages libhdf5-openmpi-dev)" ]; then
        echo mpich
    else
        echo "${MPI:-openmpi}"
    fi
}
mpi_packages() {
    [ "$(mpi_library)" = mpich ] && printf '%s\n' "${mpich_packages[@]}" ||
        printf '%s\n' "${openmpi_packages[@]}"
}

# install_packages [PACKAGE...]: installs the packages that the program needs, and these
install_packages() {
    has_apt || return 0
    local for_mpi
    mapfile -t for_mpi < <(mpi_packages)
    install "${packages[@]}" "${for_mpi[@]}" "$@" ||
        die "packages are missing; try: apt-get install ${missing[*]}"
}

# install_optional PACKAGE...: installs those of the packages that this system offers
install_optional() {
    local package
    install "$@" && return
    for package in "${missing[@]}"; do install "$package" || true; done
    mapfile -t missing < <(missing_packages "$@")
    [ ${#missing[@]} -eq 0 ] || say "left out, since these packages are missing: ${missing[*]}"
}

# install_missing PACKAGE...: installs packages; if that fails, prints the reason and fails
install_missing() {
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || { say "you are neither root nor have sudo"; return 1; }
        as_root=(sudo)
    fi
    say "installing $*"
    # The package lists may be old or missing: they are fetched only if the first try fails.
    apt_get install --no-install-recommends "$@" ||
        { apt_get update && apt_get install --no-install-recommends "$@"; } ||
        { say "apt-get could not install: $*"; return 1; }
}
apt_get() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 \
        "$@" >&2 </dev/null
}

# debian_mirror: prints MIRROR, or else the mirror that apt uses on this machine
debian_mirror() {
    local suite
    suite=$(source /etc/os-release && echo "$VERSION_CODENAME")
    [ -z "${MIRROR:-}" ] || { echo "$MIRROR"; return; }
    apt-get indextargets --format '$(RELEASE) $(COMPONENT) $(REPO_URI)' 'Created-By: Packages' |
        awk -v suite="$suite" '$1 == suite && $2 == "main" { print $3; exit }'
}

# unpack_debian FOLDER SUITE ARCHITECTURE PACKAGE...: unpacks packages and all that they need, for
# compilers and emulators. Scripts of packages are not run, because they need the system for which
# they are made. Needs root.
unpack_debian() {
    local folder=$1 suite=$2 architecture=$3 names package
    [ ! -e "$folder/unpacked" ] || return 0
    shift 3
    mkdir -p "$folder"
    printf -v names '%s,' "$@"
    say "fetching libraries of $suite for $architecture"
    debootstrap --foreign --variant=minbase --arch="$architecture" --include="${names%,}" \
        "$suite" "$folder" "$(debian_mirror)" >"$folder.log" 2>&1 || return 1
    for package in "$folder"/var/cache/apt/archives/*.deb; do
        dpkg-deb --fsys-tarfile "$package" |
            tar -x --keep-directory-symlink --no-same-owner -C "$folder" || return 1
    done
    rm "$folder"/var/cache/apt/archives/*.deb
    # Absolute links would otherwise lead to files of this machine.
    find "$folder/usr" -type l -lname '/*' -printf '%l\0%p\0' |
        xargs -0 -r -n 2 sh -c 'ln -snf "$0$1" "$2"' "$folder"
    touch "$folder/unpacked"
}

# mpi_words: prints cmake's options for mpi_library, unless cmake finds it by itself. Debian may
# have several MPI libraries, and an HDF5 for each; all parts of a build must use the same one.
mpi_words() {
    local library
    library=$(mpi_library)
    command -v "mpicc.$library" >/dev/null && command -v "h5pcc.$library" >/dev/null || return 0
    [ -n "${MPI:-}" ] || [ ! "$(command -v mpicc)" -ef "$(command -v "mpicc.$library")" ] ||
        return 0
    printf '%s\n' "-DMPI_C_COMPILER=$(command -v "mpicc.$library")" \
        "-DMPIEXEC_EXECUTABLE=$(command -v "mpiexec.$library")" \
        "-DHDF5_C_COMPILER_EXECUTABLE=$(command -v "h5pcc.$library")"
}

# configure WORD...: configures the build folder with these options of cmake. Several sources are
# compiled as one (unity build), which is fastest if everything is built once.
configure() {
    local words=()
    export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
    [ -e "$build/CMakeCache.txt" ] || mapfile -t words < <(mpi_words)
    cmake -S "$top" -B "$build" -DCMAKE_UNITY_BUILD=ON "${words[@]}" "$@" >&2 </dev/null ||
        die "cmake could not configure the build in $build"
}

# build_targets [TARGET...]: builds these targets, or all
build_targets() {
    cmake --build "$build" --parallel "$(cores)" ${1:+--target "$@"} >&2 </dev/null ||
        die "the build in $build failed"
}

# mpi_launcher FOLDER: prints the launcher that belongs to the build in FOLDER
mpi_launcher() {
    local launcher
    launcher=$(sed -n 's/^MPIEXEC_EXECUTABLE:[A-Z]*=//p' "$1/CMakeCache.txt")
    printf '%s\n' "${launcher:-mpiexec}"
}
