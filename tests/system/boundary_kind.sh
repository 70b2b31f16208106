#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/boundary_kind.patch adds a kind of side, a wall that runs along itself like a belt,
# in at most six files.
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
. "$CARROM_SOURCE_DIR/tests/system/feature_patch.sh"
begin_patch $# boundary_kind 6 keys conflicts
build_copy_with "$change" "$@"
expect_pages belt

# One disc between two belts. A contact with a belt of speed u turns v_x into 2 u - v_x and v_y into
# -v_y. From (5, 5) with (0.2, -1) the disc, of radius 0.5, meets the bottom after 4.5 steps and the
# top after 13.5, where v_x becomes 0.4 and then -0.6. So at step 20 it is at x = 5 + 0.2 * 4.5 +
# 0.4 * 9 - 0.6 * 6.5 = 5.6 and y = 9.5 - 6.5 = 3.
cat >one.toml <<'END_OF_SCENE'
[box]
size = 10
left.kind = "periodic"
right.kind = "periodic"
bottom = { kind = "belt", belt_speed = 0.3 }
top = { kind = "belt", belt_speed = -0.1 }
[discs]
radius = 0.5
list = [[5, 5, 0.2, -1]]
[time]
steps = 20
END_OF_SCENE
# A gas between a belt and a belt at rest, which gives no energy.
gas_scene 40 400 0.3 0.5 60 >gas.toml
cat >>gas.toml <<'END_OF_SCENE'
[box.bottom]
kind = "belt"
belt_speed = 0.2
[box.left]
kind = "belt"
belt_speed = 0
[output]
checkpoint.every_steps = 25
END_OF_SCENE

for method in time-stepped event-driven; do
    options=(--quiet --set "time.method=$method")
    run 1 run one.toml "${options[@]}" --check -o "disc_$method"
    expect_code 0 "$method: one disc"
    "$CARROM_PROGRAM" convert "disc_$method"/checkpoints/*20.h5 --to csv >disc.csv
    awk -F, 'function near(a, b) { return a - b < 1e-12 && b - a < 1e-12 }
        NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
        NR == 2 { good = near($column["x"], 5.6) && near($column["y"], 3) &&
                         near($column["vx"], -0.6) && near($column["vy"], -1) }
        END { exit !good }' disc.csv || complain "$method: $(tail -n 1 disc.csv)"

    expect_one_hash gas.toml "$method" --set "time.method=$method" --check
    grep -q 'bottom belt of speed 0.2' "one_$method/report.json" ||
        complain 'the report has no belt'
    # The self-check holds the energy of all discs to 1e-12 where both belts are at rest.
    run 2 run gas.toml "${options[@]}" --set box.bottom.belt_speed=0 --check -o "rest_$method"
    expect_code 0 "$method: belts at rest"
done

sed '/box.left/,/belt_speed/ s/"belt"/"wall"/' gas.toml >wrong.toml
run 1 run wrong.toml --quiet -o wrong
expect_code 2 'a speed of a belt for another wall'
expect_told "'box.left.belt_speed' has no meaning without box.left.kind = \"belt\"" 'a wrong scene'
finish
