#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Replicas: each has the bits of a run of its own, means and errors are those of the reports, what
# is done is left alone, and what is wrong is told once.
source "$(dirname "$0")/common.sh"
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=300 --set discs.packing=0.2
       --steps 300 --set 'output.measurements.quantities=["velocities"]'
       --set output.measurements.every_steps=10)

for ranks in 1 3; do
    run "$ranks" replicas "${scene[@]}" --count 5 -o "all$ranks"
    expect_code 0 "replicas on $ranks ranks"
    expect_told 'replicas           5' 'the number of replicas'
done
cmp all1/replicas.csv all3/replicas.csv || complain 'other averages on three ranks'
cmp all1/replicas.json all3/replicas.json || complain 'other means on three ranks'
cmp all1/velocities.csv all3/velocities.csv || complain 'another table on three ranks'

seed=$(awk -F, '$1 == 3 { print $2 }' all1/replicas.csv)
run 2 run "${scene[@]}" --set discs.seed="$seed" -o one --quiet
hash=$(awk -F, '$1 == 3 { print $3 }' all1/replicas.csv)
[ "$(json_value one/report.json state_hash)" = "$hash" ] ||
    complain 'replica 3 is not the run of its seed'
[ "$(cut -d, -f3 all1/replicas.csv | sort -u | wc -l)" = 6 ] || complain 'replicas are alike'

# Means and errors by other means.
awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == "pressure") column = k; next }
    { sum += $column; squares += $column ^ 2; ++n }
    END { printf "%.9g %.5g\n", sum / n, sqrt((squares / n - (sum / n) ^ 2) / (n - 1)) }' \
    all1/replicas.csv >by_awk
tr -d ' \n' <all1/replicas.json |
    sed -E 's/.*"pressure":\{"value":([^,]*),"error":([^}]*)\}.*/\1 \2/' |
    awk '{ printf "%.9g %.5g\n", $1, $2 }' >by_program
cmp by_awk by_program || complain "other means: $(cat by_awk by_program)"

# No two columns have one name. D_error is the error over replicas, D_run_error the mean of the
# errors
# that runs claim.
run 1 replicas "${scene[@]}" --count 3 -o flights --quiet --set box.left.kind=periodic \
    --set box.right.kind=periodic --set 'output.measurements.quantities=["diffusion"]' \
    --set output.measurements.correlation_steps=50
expect_code 0 'replicas with errors of their own'
[ "$(grep -v '^#' flights/diffusion.csv | head -n 1 | cut -d, -f1-3)" = 'D,D_error,D_run_error' ] ||
    complain "columns $(grep -v '^#' flights/diffusion.csv | head -n 1)"
for table in flights/*.csv; do
    [ -z "$(grep -v '^#' "$table" | head -n 1 | tr , '\n' | sort | uniq -d)" ] ||
        complain "two columns of $table have one name"
done

# What is done stays; what is missing is made again, and more may be asked for.
before=$(stat -c %Y.%i all1/0001/report.json)
rm -r all1/0002
run 2 replicas "${scene[@]}" --count 6 -o all1 --quiet
expect_code 0 'one is missing, one is new'
[ "$(stat -c %Y.%i all1/0001/report.json)" = "$before" ] || complain 'a replica was run again'
[ "$(sed 7q all1/replicas.csv | head -n 6)" = "$(cat all3/replicas.csv)" ] ||
    complain 'a replica that was made again is another'
[ "$(wc -l <all1/replicas.csv)" -eq 7 ] || complain 'not six replicas'

# A damaged report is made anew from the replica's checkpoint, or is an error that names it.
cp all1/0001/report.json whole_report.json
for damage in 's/"first_step": [0-9]*/"first_step": "x"/' 's/"steps": [0-9]*/"steps": null/' \
    '5q'; do
    sed "$damage" whole_report.json >all1/0001/report.json
    run 2 replicas "${scene[@]}" --count 6 -o all1 --quiet
    expect_code 0 "a damaged report: $damage"
    [ "$(json_value all1/0001/report.json state_hash)" = \
        "$(json_value whole_report.json state_hash)" ] || complain "another replica: $damage"
done
sed 's/"state_hash": "[^"]*"/"state_hash": 5/' whole_report.json >all1/0001/report.json
run 2 replicas "${scene[@]}" --count 6 -o all1 --quiet
expect_code 2 'a report without a state hash'
expect_told 'all1/0001/report.json: is no whole report' 'a report without a state hash'
cp whole_report.json all1/0001/report.json

run 3 replicas "${scene[@]}" --count 6 -o all1 --set discs.packing=0.3
expect_code 2 'another scene in the same folder'
run 3 replicas "${scene[@]}" --count 0 -o none --set discs.colour=red
expect_code 2 'wrong words'
expect_told 'must be a whole number from 1 to 10000' 'a count of nought'
expect_told 'discs.colour' 'a wrong key beside it'
[ ! -e none ] || complain 'a folder was made for nothing'
finish
