#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures everything that docs/understanding/performance.md shows, in about twelve minutes of an
# otherwise idle machine:
#
#   tests/studies/measure_all.sh [BUILD [FOLDER]]       BUILD: build; FOLDER: docs/data/performance
#   tests/studies/page.py                               then draws the page anew
#
# Builds what is missing. MINUTES (6.5) is for the comparison with peers, the rest takes five and
# more. EDMD names programs that planar_edmd.py builds, as EDMD="cell multi"; the fastest counts.
# MOST_RANKS=1024 takes half an hour longer on the simulated cluster (256), and 13 GB for each of as
# many simulations as there are cores: see `simulate.py --jobs`. SHORT=1 runs everything for a
# fraction of its time, to see that it works; its numbers mean nothing. Parts that need SimGrid or
# Google Benchmark are left out, and listed, where these are missing.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../.." && pwd)
build=${1:-$top/build}
folder=${2:-$top/docs/data/performance}
mkdir -p "$folder"
say() { printf '%s: %s\n' "$(date +%T)" "$*" >&2; }

targets=(carrom machine_peaks)
known=$(cmake --build "$build" --target help)
have() { grep -q "$1" <<<"$known"; }
for target in simulated_cluster replay_cluster carrom_benchmarks; do
    if have "$target"; then targets+=("$target")
    else say "$target cannot be built here: its part is left out"; fi
done
say "building ${targets[*]}"
cmake --build "$build" --target "${targets[@]}" >&2

say 'peaks of the machine'
# 64 bytes read and 64 written in so many nanoseconds
gbytes() { awk -v ns="$1" 'BEGIN { printf "%.2f", 128 / ns }'; }
{
    "$build/tests/machine_peaks" arithmetic 2
    printf 'stream_cache %s\n' "$(gbytes "$("$build/tests/machine_peaks" stream 8000 20000 1)")"
    printf 'stream_memory %s\n' "$(gbytes "$("$build/tests/machine_peaks" stream 4000000 8 1)")"
} >"$folder/peaks.txt"

if [ -x "$build/tests/carrom_benchmarks" ]; then
    say 'kernels'
    if [ -n "${SHORT:-}" ]; then least=0.01; else least=0.2; fi
    "$build/tests/carrom_benchmarks" --benchmark_format=json --benchmark_min_time="$least" \
        --benchmark_repetitions=3 \
        --benchmark_report_aggregates_only=true ${SHORT:+--benchmark_filter=-.*00000} \
            >"$folder/kernels.json"
fi
say 'beside peers'
read -ra edmd <<<"${EDMD:-}"
python3 "$here/compare.py" --build "$build" --output "$folder/rates.csv" \
    --minutes "${MINUTES:-6.5}" ${EDMD:+--edmd "${edmd[@]}"} ${SHORT:+--short}
if [ -x "$build/tests/simulated_cluster" ]; then
    say 'simulated cluster'
    python3 "$here/simulate.py" "$build/tests/simulated_cluster" --study "$folder/cluster.csv" \
        --jobs "$(nproc)" --most-ranks "${MOST_RANKS:-256}" ${SHORT:+--largest 140000}
    say 'large cluster'
    python3 "$here/cluster_model.py" "$build/tests/replay_cluster" \
        --study "$folder/large_cluster.csv" --ranks 1 16 64 256 ${MOST_RANKS:+1024 8192}
fi
say 'done; tests/studies/page.py draws the page'
