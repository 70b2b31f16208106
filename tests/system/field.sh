#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/field.patch adds a field that acts in flight, air that moves, in at most two files
# and a line in a list.
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
. "$CARROM_SOURCE_DIR/tests/system/feature_patch.sh"
begin_patch $# field 4 keys
build_copy_with "$change" "$@"
expect_pages air

# One disc in air of velocity u has v = u + (v0 - u) exp(-c t), and goes u t + (v0 - u) (1 -
# exp(-c t)) / c.
cat >one.toml <<'END'
[box]
size = 100
[discs]
radius = 0.5
list = [[20, 50, 0.8, 0.1]]
[time]
steps = 100
method = "event-driven"
[effects]
drag.rate = 0.02
air.x = 0.3
air.y = -0.1
END
run 1 run one.toml --quiet --check -o one
expect_code 0 'one disc in air'
"$CARROM_PROGRAM" convert one/checkpoints/*100.h5 --to csv >disc.csv
awk -F, 'function near(a, b) { return a - b < 1e-11 && b - a < 1e-11 }
    NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
    NR == 2 { left = exp(-2); way = (1 - left) / 0.02
              good = near($column["vx"], 0.3 + 0.5 * left) &&
                     near($column["vy"], -0.1 + 0.2 * left) &&
                     near($column["x"], 20 + 30 + 0.5 * way) &&
                     near($column["y"], 50 - 10 + 0.2 * way) }
    END { exit !good }' disc.csv || complain "$(tail -n 1 disc.csv)"

# Gases between walls, without and with gravity, and in a periodic channel.
for box in walls gravity channel; do
    gas_scene 40 300 0.2 0.5 60 >"$box.toml"
    printf 'sync_every = 8\n[output]\ncheckpoint.every_steps = 25\n[effects]\ndrag.rate = 0.01\n' \
        >>"$box.toml"
    printf 'air.x = 0.2\nair.y = 0.05\n' >>"$box.toml"
done
printf 'gravity.y = -0.001\ncontact = { kind = "restitution", restitution = 0.9 }\n' >>gravity.toml
printf '[box.left]\nkind = "periodic"\n[box.right]\nkind = "periodic"\n' >>channel.toml
for box in walls gravity channel; do
    expect_one_hash "$box.toml" "$box" --set time.method=event-driven --check
    grep -q 'air of velocity (0.2, 0.05)' "one_$box/report.json" || complain "$box: no air reported"
done

# The self-check allows the energy that the air gives to a slow gas.
sed 's/speed = 0.5/speed = 1e-3/' channel.toml >still.toml
run 2 run still.toml --quiet --check --set time.method=event-driven -o still
expect_code 0 'a gas at rest in air'
# In air at rest the key changes nothing.
for air in 0 -0.0; do
    run 1 run walls.toml --quiet --set time.method=event-driven --set "effects.air.x=$air" \
        --set effects.air.y=0 -o "rest_$air"
    expect_code 0 'air at rest'
done
grep -v '^air' walls.toml >dragged.toml
run 1 run dragged.toml --quiet --set time.method=event-driven -o dragged
expect_code 0 'drag alone'
for air in 0 -0.0; do
    [ "$(json_value "rest_$air/report.json" state_hash)" = \
        "$(json_value dragged/report.json state_hash)" ] || complain "air at $air changes bits"
done
finish
