#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/disc_property.patch gives each disc a charge, a number that goes where the disc
# goes, in at most six files.
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
. "$CARROM_SOURCE_DIR/tests/system/feature_patch.sh"
begin_patch $# disc_property 6 keys conflicts
get_python "$1" h5py
shift

# The plain program is kept for comparison: the patch must not change how discs move.
plain=$CARROM_PROGRAM
build_copy_with "$change" "$@"
charged=$CARROM_PROGRAM
expect_pages charge

# Discs in a box with an open side, with charges of species, and in a periodic one, from a file.
cat >open.toml <<'END'
[box]
size = 40
right.kind = "open"
[discs]
speed = 1
[[discs.species]]
count = 100
radius = 0.5
charge = 1
[[discs.species]]
count = 150
radius = 0.5
charge = -2.5
[[discs.species]]
count = 50
radius = 0.5
END
awk 'BEGIN { for (i = 0; i < 300; ++i) {
                 k = (i * 7) % 300
                 printf "%d %.17g %.17g %.17g %.17g %.17g\n", k, 1 + 2 * (k % 20),
                        1 + 2 * int(k / 20), sin(k), cos(3 * k), k / 7 - 20 } }' >lines
{ periodic_box 40; cat; } >periodic.toml <<'END'
[discs]
count = 300
radius = 0.5
file = "lines"
columns = ["charge"]
END
for scene in open periodic; do
    cat >>$scene.toml <<'END'
[time]
steps = 60
micro_steps = 2
sync_every = 16
[output]
checkpoint.every_steps = 25
trajectory.every_steps = 20
END
    grep -v charge $scene.toml >plain_$scene.toml
done
cut -d' ' -f 1-5 lines >plain_lines
sed -i 's/"lines"/"plain_lines"/' plain_periodic.toml

last=checkpoints/checkpoint-000000000060.h5
places() { # PROGRAM SCENE: id, place, velocity and counters at the end
    "$1" convert "$2/$last" --to csv | cut -d, -f 1-8
}
for method in time-stepped event-driven; do
    for scene in open periodic; do
        name=${scene}_$method
        options=(--quiet --set "time.method=$method")
        CARROM_PROGRAM=$plain
        run 1 run plain_$scene.toml "${options[@]}" -o "plain_$name"
        expect_code 0 "$name without charges"
        CARROM_PROGRAM=$charged
        run 1 run plain_$scene.toml "${options[@]}" -o "none_$name"
        expect_code 0 "$name without charges, with the patch"
        [ "$(json_value "plain_$name/report.json" state_hash)" = \
            "$(json_value "none_$name/report.json" state_hash)" ] ||
            complain "$name: another state hash without charges"
        expect_one_hash $scene.toml "$name" --set "time.method=$method"
        [ "$hash" != "$(json_value "plain_$name/report.json" state_hash)" ] ||
            complain "$name: the state hash does not cover charges"
        cmp <(places "$plain" "plain_$name") <(places "$charged" "one_$name") ||
            complain "$name: discs fly otherwise with charges"
        "$python" "$CARROM_SOURCE_DIR/tests/system/disc_property.py" $scene lines \
            "one_$name" "three_$name" "again_$name" || complain "$name: other charges"
    done
done

# Discs from another run's checkpoint keep their charges. (The last run had no overlaps.)
{ grep -v 'file\|columns' periodic.toml | sed '/radius/a from = "'"one_$name/$last"'"'; } >from.toml
CARROM_PROGRAM=$charged
run 2 run from.toml --quiet --steps 0 -o from
expect_code 0 'discs of another run'
"$python" "$CARROM_SOURCE_DIR/tests/system/disc_property.py" periodic lines from ||
    complain 'other charges of the discs of another run'
finish
