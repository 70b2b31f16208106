#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/sync_effect.patch adds an effect that acts at syncs, in at most four files.
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
. "$CARROM_SOURCE_DIR/tests/system/feature_patch.sh"
begin_patch $# sync_effect 4 keys
build_copy_with "$change" "$@"
expect_pages wind

gas_scene 40 300 0.2 0.5 60 >scene.toml
cat >>scene.toml <<'END'
sync_every = 8
[effects.wind]
rate = 0.1
speed = 0.3
[output]
checkpoint.every_steps = 25
END
for method in time-stepped event-driven; do
    expect_one_hash scene.toml "$method" --set "time.method=$method" --check
    grep -q 'wind of speed 0.3' "one_$method/report.json" || complain 'the report has no wind'
done

# Without collisions of walls, the mean velocity nears that of the wind: each sync of 8 steps leaves
# 1 - 0.1 * 8 / 2 of what is missing in the mean. Nine gusts leave a hundredth.
cat >free.toml <<'END'
[box]
size = 40
left.kind = "periodic"
right.kind = "periodic"
[discs]
count = 4000
radius = 0.1
speed = 0
[time]
steps = 72
sync_every = 8
[effects]
contact.kind = "none"
wind.rate = 0.1
wind.speed = 0.3
END
run 1 run free.toml -o free --quiet
expect_code 0 'discs at rest in a wind'
mean=$("$CARROM_PROGRAM" convert free/checkpoints/*72.h5 --to csv | awk -F, 'NR == 1 {
    for (k = 1; k <= NF; ++k) if ($k == "vx") column = k; next }
    { sum += $column; ++n } END { print sum / n }')
awk -v mean="$mean" 'BEGIN { left = 0.3 * 0.6 ^ 9; d = 0.3 - left - mean
    exit !(d < 0.002 && d > -0.002) }' || complain "the mean velocity is $mean"

# Replicas have winds of different seeds.
run 1 replicas free.toml --count 2 -o two
expect_code 0 'replicas of a wind'
[ "$(cut -d, -f3 two/replicas.csv | sort -u | wc -l)" = 3 ] || complain 'replicas are alike'
finish
