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

# The drift velocity is that of the centre of mass: 30 discs of mass 2 and 10 of mass 1 that move
# at (0.25, -0.5) with the left half and at (0.75, 0.5) with the right one. Its reference is the sum
# over the discs of the last checkpoint, as text.
{ periodic_box 40; cat; } >streams.toml <<'END'
[[discs.species]]
count = 30
radius = 1
mass = 2
[[discs.species]]
count = 10
radius = 0.5
mass = 1
[discs]
speed = 0.1
streams = [{ region = [0, 0, 20, 40], velocity = [0.25, -0.5] },
           { region = [20, 0, 40, 40], velocity = [0.75, 0.5] }]
[time]
method = "event-driven"
steps = 50
END
run 2 run streams.toml --quiet --threads 1 --report drift.json -o streams
expect_code 0 'two streams of two species'
run 1 convert streams/checkpoints/checkpoint-000000000050.h5 --to text
expect_code 0 'the discs of two streams as text'
sed -n '/"drift_velocity"/,/]/s/^ *\(-*[0-9][^,]*\),*$/\1/p' drift.json >reported
awk 'NF == 8 && $1 !~ /#/ { mass = $2 < 30 ? 2 : 1; all += mass; x += mass * $5; y += mass * $6 }
     FILENAME == "reported" && NF == 1 { got[++n] = $1 }
     END { exit !(all == 70 && n == 2 && (got[1] - x / all) ^ 2 < 1e-24 &&
                  (got[2] - y / all) ^ 2 < 1e-24 && x > 0.3 * all && y ^ 2 > 1e-6) }' \
    reported "$test_folder/out" ||
    complain "drift velocity $(cat reported) is not that of $(cat "$test_folder/out")"
rm -r streams streams.toml drift.json reported

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
