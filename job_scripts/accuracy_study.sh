#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Repeats the study of docs/understanding/accuracy.md: tables of CSV in a folder, one for each gas,
# then one for each kind of study, and the figures. Tables that are there are kept, so a study that
# was stopped goes on with the same command. It needs an idle machine, and takes some ten minutes.
#
#   job_scripts/accuracy_study.sh [FOLDER]           all of it on one core, into build/accuracy
#   CORES=2 job_scripts/accuracy_study.sh            on two cores, each with half the trials
#   PAGE=docs/understanding/accuracy.md job_scripts/accuracy_study.sh
#                                                    writes the tables of that page, too
#   SHARE=2/8 job_scripts/accuracy_study.sh FOLDER   the second of eight shares: its own tables and
#                                                    no figures
#   PYTHON=build/pictures/bin/python job_scripts/accuracy_study.sh
#                                        with the environment of docs/tools/README.md
#
# Lengths are in disc diameters. At K = 1 a disc collides with others once in four steps: the speed
# is set so, from nu sigma = (4 / sqrt(pi)) (Z - 1) sqrt(kT) with the compressibility factor Z (the
# rates of the tables are measured ones).
set -euo pipefail
unset CDPATH
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
carrom=${CARROM:-$here/build/carrom}
folder=${1:-$here/build/accuracy}
share=${SHARE:-1/1} cores=${CORES:-1}
suffix=
[ "$share" = 1/1 ] || suffix=-${share/\//-of-}
mkdir -p "$folder"

# study TABLE N PACKING Z OPTION...: makes a table unless it is there. With several cores it does
# nothing, because each core runs a share of all tables.
study() {
    [ "$cores" = 1 ] || return 0
    local table=$folder/$1-$2-$3$suffix.csv n=$2 packing=$3 z=$4
    shift 4
    [ ! -e "$table" ] || return 0
    rm -f "$table.unfinished"
    local box speed
    box=$(awk -v n="$n" -v p="$packing" 'BEGIN { printf "%.10g", sqrt(n * atan2(0, -1) / 4 / p) }')
    speed=$(awk -v z="$z" \
        'BEGIN { printf "%.6g", sqrt(2) * 0.25 / (4 / sqrt(atan2(0, -1)) * (z - 1)) }')
    echo "$(basename "$table"): $n discs, packing $packing" >&2
    "$carrom" accuracy "$here/docs/data/accuracy/gas.toml" --set box.size="$box" \
        --set discs.count="$n" --set discs.speed="$speed" \
        --share "$share" --output "$table.unfinished" "$@"
    mv "$table.unfinished" "$table"
}

if [ "$cores" -gt 1 ]; then
    shares=()
    for ((k = 1; k <= cores; ++k)); do
        CORES=1 SHARE=$k/$cores "$0" "$folder" &
        shares+=($!)
    done
    for one in "${shares[@]}"; do wait "$one"; done
fi

# Error against cost and against nu dt.
study error 1024 0.1 1.236 --arithmetic default --starts 8 --collisions 100
study error 1024 0.3 2.063 --arithmetic default --starts 8 --collisions 100
study error 1024 0.5 4.10 --arithmetic default --starts 8 --collisions 100
study error 1024 0.7 10.31 --arithmetic default --starts 8 --collisions 100
# The same for a large gas, in which the fixed cost of a micro-step is small.
study large 16384 0.1 1.236 --arithmetic default --starts 3 --collisions 100 --repetitions 1
study large 16384 0.3 2.063 --arithmetic default --starts 3 --collisions 100 --repetitions 1
study large 16384 0.5 4.10 --arithmetic default --starts 3 --collisions 100 --repetitions 1
study large 16384 0.7 10.31 --arithmetic default --starts 3 --collisions 100 --repetitions 1
# Longer runs: in dense gases errors grow with time.
study long 1024 0.3 2.063 --arithmetic default --starts 4 --collisions 400 --repetitions 1
study long 1024 0.5 4.10 --arithmetic default --starts 4 --collisions 400 --repetitions 1
study long 1024 0.7 10.31 --arithmetic default --starts 4 --collisions 400 --repetitions 1
# Thinner gases, where flights are long.
for gas in '0.1 1.236' '0.01 1.0204' '0.001 1.002'; do
    read -r packing z <<<"$gas"
    study dilute 16384 "$packing" "$z" --arithmetic default --starts 3 --collisions 40 \
        --repetitions 1
done
# All settings: K, both methods, both precisions, both formulas.
study arithmetic 1024 0.3 2.063 --starts 4 --collisions 50 --repetitions 2
study arithmetic 1024 0.7 10.31 --starts 4 --collisions 50 --repetitions 2
# Cost against N.
for n in 256 1024 4096 16384 65536; do
    study size "$n" 0.3 2.063 --micro-steps 1 --starts 4 --collisions 20 --approach 10
done
# Few small discs and long flights, as in the course program's own scenes: here formulas lose
# collisions.
study thin 1024 0.0000785 1.000157 --micro-steps 16 --starts 5 --collisions 15 --approach 10 \
    --repetitions 2
# Distances to the exact run along time.
study distances 256 0.1 1.236 --distances --arithmetic stable --starts 4 --collisions 25
study distances 256 0.3 2.063 --distances --arithmetic stable --starts 4 --collisions 45
study distances 256 0.5 4.10 --distances --arithmetic stable --starts 4 --collisions 75

[ "$share" = 1/1 ] || exit 0
for kind in error large long dilute arithmetic size thin distances; do
    awk 'FNR == 1 && NR > 1 { next } { print }' "$folder/$kind"-*.csv >"$folder/$kind.csv"
done
"${PYTHON:-python3}" "$here/docs/tools/plot_accuracy.py" \
    "$folder"/{error,large,long,dilute,arithmetic,size,thin}.csv \
    --output "$folder" ${PAGE:+--page "$PAGE"}
"${PYTHON:-python3}" "$here/docs/tools/plot_distances.py" "$folder/distances.csv" \
    --output "$folder"
