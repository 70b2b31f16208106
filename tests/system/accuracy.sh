#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `carrom accuracy` writes a line for each trial, goes on where it was stopped and can be shared out; `--accuracy` settles
# on a setting that a restart keeps.
source "$(dirname "$0")/common.sh"
gas_scene 46 200 0.3 0.2 20 >small.toml
study=(accuracy small.toml --starts 2 --repetitions 2 --micro-steps 2 --collisions 10 --approach 5 --quiet)

# All but the times.
bits() { cut -d, -f1-30 "$1" | sort; }

run 1 "${study[@]}" --output whole.csv
expect_code 0 'a study'
expect_silence 'a study'
[ "$(wc -l <whole.csv)" -eq $((1 + 2 * 2 * 2 * 2 * 6)) ] || complain "the table has $(wc -l <whole.csv) lines"
[ "$(cut -d, -f9-13 whole.csv | sort | uniq -c | awk '$1 == 4' | wc -l)" -eq 24 ] || complain 'not every setting was run twice from both starts'
[ "$(awk -F, 'NR > 1 && ($17 <= 0 || $31 <= 0)' whole.csv | wc -l)" -eq 0 ] || complain 'a trial without collisions or cost'

mkdir elsewhere
cp small.toml elsewhere
cp whole.csv moved.csv
run 1 accuracy elsewhere/small.toml "${study[@]:2}" --output moved.csv
expect_same moved.csv whole.csv 'the folder of a scene is no part of its name'

head -c 4000 whole.csv >stopped.csv
run 1 "${study[@]}" --output stopped.csv
expect_code 0 'a study that goes on'
cmp <(bits whole.csv) <(bits stopped.csv) || complain 'a study that goes on ends in another table'
cp stopped.csv finished.csv
run 1 "${study[@]}" --output stopped.csv
expect_same stopped.csv finished.csv 'a finished study was run again'

# What is no table, or a damaged one, is refused and left as it is; so are places that have no end to go on from.
printf 'no table, and no newline' >foreign.csv
(sed -n 1,2p whole.csv; sed -n 3p whole.csv | cut -d, -f1-20; sed -n 4p whole.csv) >damaged.csv
cp damaged.csv damaged.before
run 1 "${study[@]}" --output foreign.csv
expect_code 2 'a table in a file of another kind'
[ "$(cat foreign.csv)" = 'no table, and no newline' ] || complain 'a file of another kind was changed'
run 1 "${study[@]}" --output damaged.csv
expect_code 2 'a damaged table'
expect_told 'damaged.csv:3: has 20 fields' 'the damaged line'
expect_same damaged.csv damaged.before 'a damaged table was changed'
run 1 "${study[@]}" --output /dev/full
expect_code 2 'a table in a device'
sed 's/,GNU /,Other /; s/,Clang /,Other /' whole.csv >other.csv
run 1 "${study[@]}" --output other.csv
expect_told 'not comparable' 'lines of another compiler'
(
    exec 9>held.csv.lock
    flock 9
    run 1 "${study[@]}" --output held.csv 9>&-
    [ "$code" -eq 2 ] && [ ! -e held.csv ]
) || complain 'two studies with one table'

for k in 1 2 3; do
    run 1 "${study[@]}" --share "$k/3" --output "share$k.csv"
    expect_code 0 "share $k of 3"
done
cmp <(bits whole.csv) <((head -1 share1.csv; tail -qn +2 share?.csv) | cut -d, -f1-30 | sort) || complain 'three shares are not the whole'

[ "$(cut -d, -f1-15,17-30 whole.csv | sed 1d | sort | uniq -c | awk '$1 != 2' | wc -l)" -eq 0 ] || complain 'a repetition has other results'

# Distances: none between the event-driven method and itself, all above 0 and below the box's diagonal, and the same again.
run 1 "${study[@]}" --distances --arithmetic stable --output distances.csv
expect_code 0 'distances'
[ "$(cut -d, -f9-11 distances.csv | sed 1d | sort -u | wc -l)" -eq 3 ] || complain 'not three settings beside the exact one'
[ "$(sed 1d distances.csv | wc -l)" -ge $((2 * 3 * 9)) ] || complain 'not a look for every collision'
[ "$(awk -F, 'NR > 1 && !($16 > 0 && $16 < 65 * 1.5)' distances.csv | wc -l)" -eq 0 ] || complain 'distances that cannot be'
cp distances.csv known.csv
run 1 "${study[@]}" --distances --arithmetic stable --output distances.csv
expect_same distances.csv known.csv 'finished distances were run again'
run 1 "${study[@]}" --output distances.csv
expect_code 2 'rates into a table of distances'

run 2 "${study[@]}" --output two.csv
expect_code 2 'a study on two ranks'
expect_told 'runs on one rank' 'a study on two ranks'
[ ! -e two.csv ] || complain 'a refused study wrote a table'
run 1 accuracy small.toml --starts 0 --share 4/3 --arithmetic some --output none.csv
expect_code 2 'wrong options'
for option in --starts --share --arithmetic; do expect_told "$option" 'all wrong options at once'; done
run 1 "${study[@]}" --output small.toml
expect_code 2 'a table over another file'

for ranks in 1 2; do
    run "$ranks" run small.toml --accuracy 1e-6 --set output.checkpoint.folder="kept$ranks"
    expect_code 0 "a run with an accuracy on $ranks ranks"
    expect_told 'method = "event-driven"' 'what was chosen'
done
run 1 run small.toml --accuracy 1e-6 --steps 30 --set output.checkpoint.folder=kept1 --restart latest
expect_code 0 'going on from a run with an accuracy'
expect_told 'going on with the checkpoint' 'a restart does not choose again'
run 1 run --restart kept1 --steps 40 --accuracy 0.2
expect_code 0 'going on without the scene, asking again'
expect_told "going on with the checkpoint's setting" 'a restart does not choose again'
run 1 run --restart kept2 --steps 30 --report report.json --quiet
expect_code 0 'going on without the scene'
[ "$(json_value report.json rule)" = all ] || complain 'the choice is not in the checkpoint'

for ranks in 1 3; do
    run "$ranks" run small.toml --set time.precision=single --set time.arithmetic=naive --set time.contraction=true --report report.json --quiet
    expect_code 0 "single precision on $ranks ranks"
    [ "$(json_value report.json precision)" = single ] || complain 'the report does not name the precision'
done
finish
