#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The report has every key that is promised, with the numbers that the hand-computed scene is known
# to have.
source "$(dirname "$0")/common.sh"
expected=$CARROM_SOURCE_DIR/tests/system/expected

# expect_value KEY VALUE
expect_value() {
    local value
    value=$(json_value report.json "$1")
    [ "$value" = "$2" ] || complain "$1 is \"$value\", not \"$2\""
}

printf 'old\n' >report.json
run 2 run "$expected/three_discs.in" --threads 2 --report report.json
expect_code 0 'a run with a report'
for key in version state_hash n_discs steps wall_collisions pair_collisions rejected_candidates \
    overlapping_pairs \
    averages radius box packing temperature pressure compressibility pressure_tensor \
    lost_collisions kinetic_energy momentum \
    wall_seconds ns_per_disc_step ranks threads phase_seconds \
        phase_imbalance imbalance peak_bytes_per_disc; do
    grep -q "\"$key\": " report.json || complain "the report has no $key"
done
expect_value n_discs 3
expect_value steps 5
expect_value wall_collisions 3
expect_value pair_collisions 1
expect_value rejected_candidates 0
expect_value overlapping_pairs 0
expect_value kinetic_energy 1.125
expect_value ranks 2
expect_value threads 2
[[ $(json_value report.json state_hash) =~ ^[0-9a-f]{32}$ ]] ||
    complain 'the state hash is not 32 hexadecimal digits'
expect_told "$(json_value report.json state_hash)" 'the summary'
[ "$(ls -A)" = report.json ] || complain "more than the report was written: $(ls -A)"

run 1 run "$expected/three_discs.in" --steps 0 --quiet --report none.json
expect_code 0 'a run of no steps'
grep -A1 '"temperature"' none.json | grep -q '"value": null' ||
    complain 'temperature of no steps is not null'
grep -q '"value": [^n]' none.json && complain 'an average of no steps is not null'
rm none.json

# Files that look like a report being written are somebody else's.
printf 'precious\n' >victim
ln -s victim report.json.partial
run 1 run "$expected/three_discs.in" --quiet --report report.json
expect_code 0 'a report beside a link'
[ "$(cat victim)" = precious ] || complain 'a report was written through a link'
printf 'of another run\n' >other.json.partial
run 1 run nowhere.in --report other.json
expect_code 2 'a missing input'
[ "$(cat other.json.partial)" = 'of another run' ] || complain 'a file of another run is gone'
finish
