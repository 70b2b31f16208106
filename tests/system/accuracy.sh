#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `carrom accuracy` writes a line for each trial into a new table and can be shared out;
# `--accuracy` settles on a setting that a restart keeps.
source "$(dirname "$0")/common.sh"
gas_scene 46 200 0.3 0.2 20 >small.toml
study=(accuracy small.toml --starts 2 --repetitions 2 --micro-steps 2 --collisions 10 --approach 5 \
    --quiet)

# All but the times.
bits() { cut -d, -f1-30 "$1" | sort; }

run 1 "${study[@]}" --output whole.csv
expect_code 0 'a study'
expect_silence 'a study'
[ "$(wc -l <whole.csv)" -eq $((1 + 2 * 2 * 2 * 2 * 6)) ] ||
    complain "the table has $(wc -l <whole.csv) lines"
[ "$(cut -d, -f9-13 whole.csv | sort | uniq -c | awk '$1 == 4' | wc -l)" -eq 24 ] ||
    complain 'not every setting was run twice from both starts'
[ "$(awk -F, 'NR > 1 && ($17 <= 0 || $31 <= 0)' whole.csv | wc -l)" -eq 0 ] ||
    complain 'a trial without collisions or cost'

mkdir elsewhere
cp small.toml elsewhere
run 1 accuracy elsewhere/small.toml "${study[@]:2}" --output moved.csv
cmp <(bits whole.csv) <(bits moved.csv) || complain 'the folder of a scene is no part of its name'

# A table is a new file: what is there already is left as it is.
cp whole.csv known.csv
for place in whole.csv small.toml /dev/full; do
    run 1 "${study[@]}" --output "$place"
    expect_code 2 "a table in $place"
    expect_told "--output $place: is there already; name a new file" "a table in $place"
done
expect_same whole.csv known.csv 'a table was written over'
run 1 "${study[@]}" --output nowhere/table.csv
expect_code 2 'a table in a folder that is not there'

for k in 1 2 3; do
    run 1 "${study[@]}" --share "$k/3" --output "share$k.csv"
    expect_code 0 "share $k of 3"
done
cmp <(bits whole.csv) <((head -1 share1.csv; tail -qn +2 share?.csv) | cut -d, -f1-30 | sort) ||
    complain 'three shares are not the whole'

[ "$(cut -d, -f1-15,17-30 whole.csv | sed 1d | sort | uniq -c | awk '$1 != 2' | wc -l)" -eq 0 ] ||
    complain 'a repetition has other results'

# Distances: none between the event-driven method and itself, all above 0 and below the box's
# diagonal, and the same again.
run 1 "${study[@]}" --distances --arithmetic stable --output distances.csv
expect_code 0 'distances'
[ "$(cut -d, -f9-11 distances.csv | sed 1d | sort -u | wc -l)" -eq 3 ] ||
    complain 'not three settings beside the exact one'
[ "$(sed 1d distances.csv | wc -l)" -ge $((2 * 3 * 9)) ] ||
    complain 'not a look for every collision'
[ "$(awk -F, 'NR > 1 && !($16 > 0 && $16 < 65 * 1.5)' distances.csv | wc -l)" -eq 0 ] ||
    complain 'distances that cannot be'
run 1 "${study[@]}" --distances --arithmetic stable --output again.csv
expect_same distances.csv again.csv 'distances are others the second time'

run 2 "${study[@]}" --output two.csv
expect_code 2 'a study on two ranks'
expect_told 'runs on one rank' 'a study on two ranks'
[ ! -e two.csv ] || complain 'a refused study wrote a table'
run 1 accuracy small.toml --starts 0 --share 4/3 --arithmetic some --output none.csv
expect_code 2 'wrong options'
for option in --starts --share --arithmetic; do expect_told "$option" 'all wrong options at once'
done

for ranks in 1 2; do
    run "$ranks" run small.toml --accuracy 1e-6 --set output.folder="kept$ranks"
    expect_code 0 "a run with an accuracy on $ranks ranks"
    expect_told 'method = "event-driven"' 'what was chosen'
done
run 1 run small.toml --accuracy 1e-6 --steps 30 --set output.folder=kept1 --restart latest
expect_code 0 'going on from a run with an accuracy'
expect_told 'going on with the checkpoint' 'a restart does not choose again'
run 1 run --restart kept1 --steps 40 --accuracy 0.2
expect_code 0 'going on without the scene, asking again'
expect_told "going on with the checkpoint's setting" 'a restart does not choose again'
run 1 run --restart kept2 --steps 30 --report report.json --quiet
expect_code 0 'going on without the scene'
[ "$(json_value report.json method)" = event-driven ] ||
    complain 'the choice is not in the checkpoint'

for ranks in 1 3; do
    run "$ranks" run small.toml --set time.precision=single --set time.arithmetic=naive \
        --set time.contraction=true --report report.json --quiet
    expect_code 0 "single precision on $ranks ranks"
    [ "$(json_value report.json precision)" = single ] ||
        complain 'the report does not name the precision'
done
finish
