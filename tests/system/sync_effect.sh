#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/sync_effect.patch adds an effect that acts at syncs, in at most four files.
#
#   sync_effect.sh                      does it still apply?
#   sync_effect.sh CMAKE OPTION...      builds a copy of the tree with it, and runs that
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
change=$CARROM_SOURCE_DIR/docs/examples/sync_effect.patch

n_files=$(grep -c '^+++ ' "$change")
[ "$n_files" -le 4 ] || complain "it touches $n_files files, not four at most"
check_patch "$change"
[ $# -gt 0 ] || finish
[ "$n_failures" -eq 0 ] || finish

plain=$CARROM_PROGRAM
build_copy_with "$change" "$@"
"$CARROM_PROGRAM" keys | diff <("$plain" keys) - >keys.diff
[ "$(grep -c '^> .*effects.wind' keys.diff)" -ge 3 ] || complain 'the page of keys has no wind'

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
    options=(--quiet --set "time.method=$method")
    run 1 run scene.toml "${options[@]}" --check -o "one_$method"
    expect_code 0 "$method on 1 rank"
    hash=$(json_value "one_$method/report.json" state_hash)
    grep -q 'wind of speed 0.3' "one_$method/report.json" || complain 'the report has no wind'
    run 3 run scene.toml "${options[@]}" --check -o "three_$method"
    expect_code 0 "$method on 3 ranks"
    run 3 run --restart "one_$method/checkpoints/checkpoint-000000000050.h5" --quiet \
        -o "again_$method"
    expect_code 0 "$method on 3 ranks, from a checkpoint of 1"
    for folder in "three_$method" "again_$method"; do
        [ "$(json_value "$folder/report.json" state_hash)" = "$hash" ] ||
            complain "$folder: another state hash"
    done
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
