#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/energy_at_syncs.patch adds an effect at syncs with an energy of its own, a harmonic
# trap, in one file and a line in a list.
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
. "$CARROM_SOURCE_DIR/tests/system/feature_patch.sh"
begin_patch $# energy_at_syncs 4 keys conflicts
build_copy_with "$change" "$@"
expect_pages trap

drift() { json_value "$1/report.json" energy_drift; }
# is_within NUMBER BOUND: whether -BOUND <= NUMBER <= BOUND.
is_within() { awk -v x="$1" -v most="$2" 'BEGIN { exit !(x <= most && -x <= most) }'; }

# If discs pass through each other and never reach a wall, the sum of kinetic energy and energy in
# the trap is conserved up to rounding, and an ellipse closes: with the frequency w of the discrete
# motion, 2 (1 - cos(w t)) = k t^2 for the time t between syncs.
cat >free.toml <<'END'
[box]
size = 40
[discs]
count = 300
radius = 0.01
speed = 0.1
[time]
steps = 60
sync_every = 8
[effects]
contact.kind = "none"
trap.stiffness = 1e-3
[output]
checkpoint.every_steps = 25
END
sed 's/^count = 300/list = [[14, 20, 0, 0.1], [22, 25, 0.05, -0.03], [20, 12, 0.12, 0]]/
     /^speed/d' free.toml >bound.toml
for method in time-stepped event-driven; do
    run 2 run bound.toml --quiet --check --set "time.method=$method" --set time.steps=4000 \
        -o "bound_$method"
    expect_code 0 "$method: three discs in a trap"
    is_within "$(drift "bound_$method")" 1e-12 ||
        complain "$method: the energy changes by $(drift "bound_$method")"
    grep -q '"potential_energy"' "bound_$method/report.json" || complain 'no energy in the report'
    grep -q 'in the trap' "$test_folder/out" && complain 'a quiet run has a summary'
done

# With collisions the splitting changes the energy slightly, and less with shorter times between
# syncs.
gas_scene 40 300 0.2 0.5 60 >gas.toml
printf 'sync_every = 8\n[output]\ncheckpoint.every_steps = 25\n[effects]\ntrap.stiffness = 1e-3\n' \
    >>gas.toml
for method in time-stepped event-driven; do
    expect_one_hash gas.toml "$method" --set "time.method=$method" --check
    grep -q 'trap of stiffness 0.001' "one_$method/report.json" || complain 'no trap in the report'
done
run 1 run gas.toml --quiet --check --set time.method=event-driven -o long
is_within "$(drift long)" 0.05 || complain "the energy changes by $(drift long)"
run 1 run gas.toml --quiet --check --set time.method=event-driven --set time.micro_steps=8 \
    --set time.sync_every=4 -o short
is_within "$(drift short)" 3e-3 || complain "with short times the energy changes by $(drift short)"

run 1 run gas.toml --set box.left.kind=periodic --set box.right.kind=periodic -o wrong
expect_code 2 'a trap in a periodic box'
expect_told 'a trap needs a box with a middle' 'a periodic box'
finish
