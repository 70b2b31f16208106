# SPDX-License-Identifier: BSD-3-Clause
# What run_local.sh and test_local.sh share: packages, build, and Open MPI's settings for one machine. To be sourced.
#
# Nothing is installed that is there already, and nothing outside the build folder is written otherwise.
# Settings that the caller has made (CMAKE_GENERATOR, OMPI_MCA_*, BUILD_DIR) are kept.

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${BUILD_DIR:-$top/build}

packages=(cmake ninja-build g++ pkg-config openmpi-bin libopenmpi-dev libhdf5-openmpi-dev
          libfmt-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev
          librandom123-dev libhwy-dev libxxhash-dev catch2)

say() { printf '%s\n' "$*" >&2; }
die() { say "$(basename "$0"): $*"; exit 1; }

# What some tests need; they are skipped, with the reason, where these cannot be had: a Slurm of their own, failing disks,
# Python programs that open our files, a simulated cluster, micro-benchmarks.
test_packages=(slurmctld slurmd slurm-client slurm-wlm-basic-plugins munge strace python3-venv libsimgrid-dev libbenchmark-dev)

# What job_scripts/sanitize.sh needs.
sanitizer_packages=(clang-14 libclang-rt-14-dev libomp-14-dev valgrind)

# missing_packages PACKAGE...: those that are not installed
missing_packages() {
    local package
    for package in "$@"; do
        dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || printf '%s\n' "$package"
    done
}

# On a system without apt the build itself says what it does not find.
install_packages() {
    local missing
    command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || return 0
    mapfile -t missing < <(missing_packages "${packages[@]}")
    [ ${#missing[@]} -eq 0 ] || install_missing "${missing[@]}" || die "packages are missing. Ask for: apt-get install ${missing[*]}"
}

install_test_packages() {
    local missing
    command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || return 0
    mapfile -t missing < <(missing_packages "${test_packages[@]}")
    [ ${#missing[@]} -eq 0 ] || install_missing "${missing[@]}" || say "some tests will be skipped, for want of ${missing[*]}"
}

install_sanitizer_packages() {
    local missing
    command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || return 0
    mapfile -t missing < <(missing_packages "${sanitizer_packages[@]}")
    [ ${#missing[@]} -eq 0 ] || install_missing "${missing[@]}" || say "packages are missing: ${missing[*]}"
}

# install_missing PACKAGE...: false, with the reason told, if that does not work.
install_missing() {
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || { say "you are neither root nor have sudo"; return 1; }
        as_root=(sudo)
    fi
    say "installing $*"
    local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300)
    # The package lists may be old or not there at all: they are fetched only if the first try fails.
    "${apt[@]}" install --no-install-recommends "$@" >&2 </dev/null ||
        { "${apt[@]}" update >&2 </dev/null && "${apt[@]}" install --no-install-recommends "$@" >&2 </dev/null; } ||
        { say "apt-get could not install: $*"; return 1; }
}

# build_target TARGET...: configure where needed, then build (all, if no target is named).
build_target() {
    export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
    cmake -S "$top" -B "$build" >&2 </dev/null || die "cmake could not configure the build in $build"
    cmake --build "$build" --parallel "$(nproc)" ${1:+--target "$@"} >&2 </dev/null || die "the build failed"
}

# Open MPI refuses to run as root and on more ranks than cores, binds a rank with all its threads to one core, and
# spins while it waits, as OpenMP does. Each is undone only where it bites. n_workers: ranks x threads at once.
launch_settings() {
    local n_workers=$1
    if [ "$(id -u)" -eq 0 ]; then
        export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    fi
    # Open MPI counts whole cores, nproc counts hardware threads: with one rank per nproc its count may be exceeded.
    export OMPI_MCA_rmaps_base_oversubscribe=${OMPI_MCA_rmaps_base_oversubscribe:-1}
    export OMPI_MCA_hwloc_base_binding_policy=${OMPI_MCA_hwloc_base_binding_policy:-none}
    if [ "$n_workers" -gt "$(nproc)" ]; then
        export OMPI_MCA_mpi_yield_when_idle=${OMPI_MCA_mpi_yield_when_idle:-1}
        export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
    fi
}
