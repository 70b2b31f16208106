#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Contacts that last: the heap of inputs/heap.toml passes the self-check, comes to rest and then
# costs no collision; the force on the floor and the virial theorem give its weight; and rows that
# just fill a box, with and without friction, come to rest as well.
source "$(dirname "$0")/common.sh"
heap=$CARROM_SOURCE_DIR/inputs/heap.toml

run 1 run "$heap" --check --quiet --steps 400 --report checked.json
expect_code 0 'the self-check of a heap'

run 2 run "$heap" -o heap --quiet --set output.averages_from_step=600 \
    --set 'output.measurements.quantities=["wall_pressure", "pressure"]' \
    --set output.measurements.from_step=600 --set output.measurements.every_steps=10
expect_code 0 'a heap on two ranks'
# The box is 80 x 60, and 400 discs of mass 1 weigh 4. The heap's energy of height is 4 times the
# mean height, and its disc centres are a radius higher than the floor's line of contact.
python3 - heap/report.json <<'END' || complain 'the forces of the heap'
import json
import sys

report = json.load(open(sys.argv[1], encoding="utf-8"))
tables = report["measurements"]
floor = tables["wall_pressure"]["bottom"][0] * 80
height = report["potential_energy"]
stress = report["pressure_tensor"]["yy"]["value"] * 80 * 60
print("floor", floor, "stress", stress, "height less a radius", height - 4)
assert abs(floor / 4 - 1) < 0.01, floor
assert abs(stress / (height - 4) - 1) < 0.01, (stress, height - 4)
# With friction two forces hold a disc in place and one keeps it from turning. A contact has two, so
# a heap has at least 1.5 contacts a disc; discs of one size touch 3 each at most, walls apart.
assert 1.5 * 400 <= report["lasting_contacts"] <= 3 * 400 + 100, report["lasting_contacts"]
assert report["compressibility"]["value"] is None, report["compressibility"]
END

run 1 run "$heap" --quiet --steps 700 --report early.json
expect_code 0 'the same on one rank'
[ "$(json_value early.json pair_collisions)" = "$(json_value heap/report.json pair_collisions)" ] ||
    complain 'discs at rest collide'
lasting() { json_value "$1" lasting_contacts; }
[ "$(lasting early.json)" = "$(lasting heap/report.json)" ] ||
    complain 'contacts at rest come and go'

# Rows of exactly 30 discs. Without the effect their run takes hundreds of times as long, and warns.
for ranks in 1 3; do
    run $ranks run "$heap" --quiet --steps 128 --set "box.size=[60, 60]" --set time.sync_every=16 \
        --set effects.lasting_contacts.speed=0 --set effects.contact.contact_time=0.1
    expect_code 0 "a heap of collisions on $ranks ranks"
    grep 'warning: .* collided .* times in a contact time' "$test_folder/err" >warned_$ranks
    [ "$(wc -l <warned_$ranks)" = 1 ] || complain "not one warning of a heap on $ranks ranks"
done
grep -q 'try: effects.lasting_contacts.speed = 0.05$' warned_1 || complain 'another remedy'
cmp warned_1 warned_3 || complain 'another warning of a heap on 3 ranks'

for friction in 0 0.5; do
    run 1 run "$heap" --check --quiet --steps 600 --set "box.size=[60, 60]" \
        --set effects.contact.friction=$friction --report full.json
    expect_code 0 "rows that fill the box, friction $friction"
    grep -q warning "$test_folder/err" && complain "a warning of a heap at rest, friction $friction"
    [ "$(json_value full.json pair_collisions)" -lt 300000 ] ||
        complain "collisions of rows that fill the box, friction $friction"
done

# Gravity adds 0.02 between two syncs, and a fall by a radius gives 0.14. A pair that meets at 1.1
# may be 2.2 apart at a sync before it, which is more than a diameter.
warned() { grep -c 'warning: ' "$test_folder/err"; }
for speed in 0.019 0.29; do
    run 1 run "$heap" --quiet --steps 2 --set effects.lasting_contacts.speed=$speed
    expect_code 0 "a slow speed of lasting contacts"
    expect_told "speed = $speed is " "a slow speed of lasting contacts"
    expect_told 'take some 0.04' "a slow speed of lasting contacts"
done
for speed in 0.021 0.28; do
    run 1 run "$heap" --quiet --steps 2 --set effects.lasting_contacts.speed=$speed
    [ "$(warned)" = 0 ] || complain "a warning of the speed $speed"
done
for speed in 1.1 1e300; do
    run 1 run "$heap" --quiet --set effects.lasting_contacts.speed=$speed
    expect_code 2 "the speed $speed"
    expect_told 'discs would look for partners' "the speed $speed"
done
for every in 3 4; do
    run 1 run "$heap" --quiet --steps 12 --set output.measurements.every_steps=$every -o samples \
        --overwrite --set 'output.measurements.quantities=["thermo"]'
    [ "$(warned)" = $((every % 2)) ] || complain "samples after $every steps"
done

# Each problem is reported once, and no problem is computed from a wrong time between syncs.
for wrong in time.sync_every=0 effects.gravity.y=-1e10; do
    run 1 run "$heap" --quiet --set $wrong
    expect_code 2 "$wrong"
    [ "$(wc -l <"$test_folder/err")" = 1 ] || complain "more than one message of $wrong"
done
run 1 run "$heap" --quiet --set time.sync_every=0 --set effects.gravity.y=-10
expect_told "'time.sync_every' must be from 1" 'a wrong time between syncs'
[ "$(wc -l <"$test_folder/err")" = 1 ] || complain 'more than one message of a wrong sync'

for wrong in time.sync_every=64 effects.gravity.y=0 effects.contact.kind=elastic \
    box.bottom.kind=thermal; do
    run 1 run "$heap" --quiet --set $wrong
    expect_code 2 "$wrong"
done
# A side of another kind drops its restitution, and the friction that needs it.
run 1 run "$heap" --quiet --steps 2 --set box.bottom.kind=open
expect_code 0 'a heap over an open side'
finish
