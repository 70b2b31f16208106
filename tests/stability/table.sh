#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the tables of docs/data/hard_cases again: every case, its bound, and the worst value that
# was measured.
#
#   tests/stability/table.sh [BUILD] [--long | --long=FAMILY]
#
# Runs the tests of BUILD (default: build), one rank with one thread: some 20 seconds. With --long
# also the long cases, each in a process of its own, as many at a time as there are cores (or
# $JOBS); a line reports how long each took. With a family only its rows are made again. Without
# --long their table stays as it is.
set -euo pipefail
source_folder=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
tables=$source_folder/docs/data/hard_cases
build=$source_folder/build
is_long=no family=
for word; do
    case $word in
        --long) is_long=yes ;;
        --long=*) is_long=yes family=${word#--long=} ;;
        *) build=$word ;;
    esac
done
export OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export CARROM_TEST_SECONDS=7200
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# table NAME [FAMILY]: writes the measured lines to NAME.csv. They replace all its lines, or only
# those of the family.
table() {
    {
        echo 'family,case,method,bound,worst'
        [ -z "${2:-}" ] || grep -v -e '^family,' -e "^$2," "$tables/$1.csv" || true
        awk -F '\t' '{ print $1 ",\"" $2 "\"," $3 "," $4 "," $5 }' "$CARROM_STABILITY_TABLE"
    } >"$folder/table"
    mv "$folder/table" "$tables/$1.csv"
}

export CARROM_STABILITY_TABLE=$folder/short
"$build/tests/stability_unit_test"
"$build/tests/stability_mpi_test"
table cases
[ $is_long = yes ] || exit 0

# One table for each case, in the order in which they are listed, however they end.
long_case() {
    local number=$1 name=$2 start=$SECONDS code=0
    export CARROM_STABILITY_TABLE=$folder/long.$number
    "$build/tests/stability_mpi_test" "${name//,/\\,}" >"$folder/said.$number" 2>&1 </dev/null ||
        code=$?
    echo "$name: exit code $code after $((SECONDS - start)) s" >&2
    [ $code -eq 0 ] || { cat "$folder/said.$number" >&2; touch "$folder/failed"; }
}
# Catch2 3 has another option for a list of names; the exit code of Catch2 2 is their number.
list=(--list-tests --verbosity quiet)
if "$build/tests/stability_mpi_test" --help | grep -- --list-test-names-only >/dev/null; then
    list=(--list-test-names-only)
fi
mapfile -t cases < <("$build/tests/stability_mpi_test" "${list[@]}" "[hours]${family:+[$family]}" \
    || true)
[ ${#cases[@]} -gt 0 ] || { echo "there are no long cases of the family $family" >&2; exit 2; }
for number in "${!cases[@]}"; do
    # `wait -n` sometimes misses the end of a process
    while [ "$(jobs -rp | wc -l)" -ge "${JOBS:-$(nproc)}" ]; do sleep 1; done
    long_case "$number" "${cases[number]}" &
done
wait
[ ! -e "$folder/failed" ] || exit 1
export CARROM_STABILITY_TABLE=$folder/long
for number in "${!cases[@]}"; do cat "$folder/long.$number"; done >"$folder/long"
table long_cases "$family"
