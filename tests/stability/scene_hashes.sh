#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The state hash of every scene of inputs/ under both methods, and the fingerprint of hashes.cpp, as
# CSV in the order of its lines: two systems' tables can be compared by diff.
#
#   tests/stability/scene_hashes.sh [BUILD]              prints the table; default: build
#   tests/stability/scene_hashes.sh [BUILD] --compare    prints what differs from scene_hashes.csv
#
# Scenes run 100 steps, on 3 ranks of 2 threads; RANKS, THREADS and STEPS set other numbers. ACROSS
# is the number of ranks that share a strip (default: as the program chooses). Some two minutes on
# two cores, of which the fingerprint takes one and a half: FINGERPRINT=no leaves it out.
# SCENES='gas.toml tiny.in' runs these files of inputs/ alone. TABLE is a file for the table that
# --compare makes. Code 1: a hash differs.
set -euo pipefail
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$tests/../..
source "$top/job_scripts/setup.sh"
build=$top/build
is_comparison=no
for word; do
    case $word in --compare) is_comparison=yes ;; *) build=$word ;; esac
done
build=$(cd "$build" && pwd)
launcher=$(mpi_launcher "$build")
export OMP_NUM_THREADS=${THREADS:-2}
use_mpi_settings $((2 * $(nproc)))
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# scene_hash SCENE METHOD: a hash, or `refused` for a scene that needs the other method, or more
# steps
scene_hash() {
    local code=0
    rm -f "$folder/report.json"
    "$launcher" -n "${RANKS:-3}" "$build/carrom" run "$1" --set time.method="$2" \
        --steps "${STEPS:-100}" ${ACROSS:+--ranks-across "$ACROSS"} \
        -o "$folder/run" --overwrite --quiet \
        --report "$folder/report.json" >"$folder/said" 2>&1 </dev/null || code=$?
    case $code in
        0) sed -n 's/^ *"state_hash": "\(.*\)",*$/\1/p' "$folder/report.json" ;;
        2) grep -q 'time.method\|beyond the last step' "$folder/said" && echo refused ||
            echo 'failed with code 2' ;;
        *) echo "failed with code $code" ;;
    esac
}

table() {
    local scene method
    echo 'scene,method,hash'
    for scene in "$top"/inputs/*.toml "$top"/inputs/*.in; do
        [[ " ${SCENES:-${scene##*/}} " == *" ${scene##*/} "* ]] || continue
        for method in time-stepped event-driven; do
            echo "${scene##*/},$method,$(cd "$folder" && scene_hash "$scene" $method)"
        done
    done
    [ "${FINGERPRINT:-yes}" = yes ] || return 0
    echo "fingerprint,both,$("$build/tests/stability_hashes" 2>/dev/null || echo failed)"
}

export LC_ALL=C
if [ $is_comparison = no ]; then table; exit 0; fi
made=${TABLE:-$folder/table}
table >"$made"
# The committed rows of the scenes that ran.
awk -F, 'NR == FNR { has_run[$1] = 1; next } $1 in has_run' "$made" "$tests/scene_hashes.csv" |
    diff - "$made"
n_rows=$(($(wc -l <"$made") - 1))
[ $n_rows -gt 0 ] || die "no file of inputs/ is called ${SCENES:-so}"
echo "all $n_rows hashes agree"
