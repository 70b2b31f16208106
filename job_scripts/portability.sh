#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests README's two commands on another system: makes that system in a folder, clones this checkout
# into it, runs the commands there, and compares the hashes of all scenes with the committed ones.
#
#   job_scripts/portability.sh bookworm            Debian 12 with Open MPI 4
#   job_scripts/portability.sh trixie              Debian 13 with Open MPI 5
#   job_scripts/portability.sh trixie mpich        the same with MPICH
#   MIRROR=URL job_scripts/portability.sh noble    Ubuntu 24.04, from a mirror of Ubuntu
#   COMPILERS='clang-18 g++-14' job_scripts/portability.sh noble   with these compilers besides
#
# Needs root and debootstrap, 5 GB of disk, and an hour on two cores, most of it for compiling and
# testing. Uncommitted changes are left out. May be set from outside:
#   MIRROR      where the packages are; default: where apt of this machine takes its own from
#   KEYRING     file with the key of that system, where this machine does not have it
#   FOLDER      keep the system there and use it again; default: a temporary folder, then removed
#   TESTS       options for ctest, as in '-L unit'; `none` leaves the tests out
#   COMPILERS   packages of compilers that build the program and run all scenes, too: 6 CPU minutes
#               each
#   TABLE       file for the table of hashes; default build/portability/SUITE-MPI.csv
# The exit code is 1 if a command or a test fails or a hash differs.
set -euo pipefail
unset CDPATH
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
say() { printf '%s\n' "$*" >&2; }
die() { say "$(basename "$0"): $*"; exit 1; }

# host_mirror SUITE: prints the mirror that apt uses on this machine, if the system is of the same
# family
host_mirror() {
    local family=debian
    case $1 in jammy | noble | oracular | plucky | questing) family=ubuntu ;; esac
    (
        source /etc/os-release
        [ "$ID" = $family ] || exit 0
        apt-get indextargets --format '$(RELEASE) $(COMPONENT) $(REPO_URI)' 'Created-By: Packages' |
            awk -v suite="$VERSION_CODENAME" '$1 == suite && $2 == "main" { print $3; exit }'
    )
}

# make_system: makes a minimal Debian or Ubuntu in $folder
make_system() {
    [ ! -e "$folder/usr/bin/apt-get" ] || return 0
    local start=$SECONDS script=()
    # An older debootstrap has no script for a new release, but the script is the same for all
    # releases of Ubuntu.
    [[ $mirror != *ubuntu* || -e /usr/share/debootstrap/scripts/$suite ]] || script=(gutsy)
    say "making $suite in $folder from $mirror"
    mkdir -p "$folder"
    debootstrap --variant=minbase --include=ca-certificates ${KEYRING:+"--keyring=$KEYRING"} \
        "$suite" "$folder" "$mirror" "${script[@]}" >"$folder/debootstrap.log" 2>&1 ||
        die "debootstrap failed; see $folder/debootstrap.log"
    case $mirror in
        *ubuntu*) printf "deb $mirror %s main universe\n" "$suite" "$suite-updates" ;;
        *) echo "deb $mirror $suite main" ;;
    esac >"$folder/etc/apt/sources.list"
    say "$suite is there after $((SECONDS - start)) s"
}

# in_system WORD...: runs a command in the clone. Of this machine's environment it keeps only
# proxies and the variables of CMake and ccache.
in_system() {
    local kept=() name
    for name in http_proxy https_proxy no_proxy; do
        [ -z "${!name:-}" ] || kept+=("$name=${!name}")
    done
    for name in "${!CMAKE_@}" "${!CCACHE_@}"; do kept+=("$name=${!name}"); done
    [ -z "$mpi" ] || kept+=("MPI=$mpi")
    chroot "$folder" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
        "${kept[@]}" sh -c 'cd /srv/carrom && exec "$@"' sh "$@" </dev/null
}

# with_compiler PACKAGE: builds the program with another compiler, and compares the hashes of all
# scenes
with_compiler() {
    local version=${1##*-} needed=("$1") build=/srv/carrom/build-$1 names
    case $1 in
        clang-*)
            needed+=("libomp-$version-dev") # two versions exclude each other
            names=("CC=$1" "CXX=clang++-$version")
            ;;
        *) names=("CC=gcc-$version" "CXX=$1") ;;
    esac
    in_system env DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends \
        "${needed[@]}" >&2 &&
        in_system env "${names[@]}" BUILD_DIR="$build" ./job_scripts/run_local.sh inputs/gas.toml \
            --steps 10 --quiet &&
        in_system env FINGERPRINT=no tests/stability/scene_hashes.sh "$build" --compare
}

# stage NAME WORD...: runs a command of this check, and prints how long it takes
n_failures=0
stage() {
    local name=$1 start=$SECONDS code=0
    shift
    say "$suite ${mpi:-openmpi}: $name"
    "$@" || code=$?
    say "$suite ${mpi:-openmpi}: $name: exit code $code, $((SECONDS - start)) s"
    [ $code -eq 0 ] || n_failures=$((n_failures + 1))
}

# All mounts and processes of the check live in namespaces of their own, and end with it.
if [ "${1:-}" != --inside ]; then
    suite=${1:-}
    case "${suite:---help} ${2:-openmpi}" in
        -*) sed -n '3,22s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
        *' openmpi' | *' mpich') ;;
        *) die "the MPI library is openmpi or mpich, not $2" ;;
    esac
    [ "$(id -u)" -eq 0 ] || die "a new system can be made by root only; try: sudo $0 $*"
    command -v debootstrap >/dev/null || die "needs debootstrap; try: apt-get install debootstrap"
    mirror=${MIRROR:-$(host_mirror "$suite")}
    [ -n "$mirror" ] || die "apt has no mirror for $suite on this machine; set MIRROR=URL"
    folder=${FOLDER:-$(mktemp -d)}
    export folder mirror
    code=0
    unshare --mount --pid --fork --kill-child bash "${BASH_SOURCE[0]}" --inside "$@" || code=$?
    [ -n "${FOLDER:-}" ] || rm -rf --one-file-system "$folder"
    exit $code
fi

suite=$2 mpi=${3:-}
make_system
mount -t proc proc "$folder/proc"
mount --rbind /sys "$folder/sys"
mount --rbind /dev "$folder/dev"
cp /etc/resolv.conf "$folder/etc/resolv.conf"
printf '127.0.0.1 localhost\n127.0.1.1 %s\n' "$(hostname)" >"$folder/etc/hosts"
rm -rf "$folder/srv/carrom"
git clone --quiet --no-hardlinks "$top" "$folder/srv/carrom"

table=${TABLE:-$top/build/portability/$suite-${mpi:-openmpi}.csv}
mkdir -p "$(dirname "$table")"
build=build${mpi:+-$mpi}
stage 'first command' in_system ./job_scripts/run_local.sh inputs/gas.toml
[ "${TESTS:-}" = none ] || stage 'second command' in_system ./job_scripts/test_local.sh ${TESTS:-}
# A program of the tests makes the fingerprint, so it is left out without tests.
[ "${TESTS:-}" = none ] && fingerprint=no || fingerprint=yes
stage 'hashes as everywhere' in_system env FINGERPRINT=$fingerprint TABLE=/srv/carrom/table.csv \
    tests/stability/scene_hashes.sh "$build" --compare
cp "$folder/srv/carrom/table.csv" "$table"
say "the hashes are in $table"
for compiler in ${COMPILERS:-}; do
    stage "$compiler" with_compiler "$compiler"
done
versions='(libhdf5-(openmpi|mpich)-dev|lib(openmpi|mpich)-dev|catch2|cmake)'
in_system sh -c '. /etc/os-release; echo "$PRETTY_NAME"; c++ --version; dpkg-query -W' |
    grep -E "^(Debian GNU|Ubuntu|c\\+\\+|$versions\\b)" >&2
[ $n_failures -eq 0 ] || die "$n_failures of these failed on $suite"
say "$suite ${mpi:-openmpi}: all is well"
