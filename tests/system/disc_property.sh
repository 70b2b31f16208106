#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/disc_property.patch gives each disc a charge, a number that goes where the disc
# goes, in at most six files.
#
#   disc_property.sh                             does it still apply?
#   disc_property.sh PYTHON CMAKE OPTION...      builds a copy of the tree with it, and runs that
#
# PYTHON is a folder for a Python environment with h5py, CMAKE OPTION... configure the copy.
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
change=$CARROM_SOURCE_DIR/docs/examples/disc_property.patch
printed=(keys conflicts) # pages of the reference that the program prints

n_files=$(($(grep -c '^+++ ' "$change") + ${#printed[@]}))
[ "$n_files" -le 6 ] || complain "it touches $n_files files, not six at most"
check_patch "$change"
[ $# -gt 0 ] || finish
[ "$n_failures" -eq 0 ] || finish

python=$1/bin/python
{ [ -x "$python" ] || python3 -m venv "$1"; } >"$test_folder/err" 2>&1 &&
    { "$python" -c 'import h5py' 2>/dev/null ||
        timeout 200 "$python" -m pip install --quiet --disable-pip-version-check \
            --only-binary :all: --retries 1 --timeout 10 h5py >>"$test_folder/err" 2>&1; } || {
    printf 'skipped: no h5py: %s\n' "$(tail -n 1 "$test_folder/err")"
    exit 77
}
shift

# The plain program stays: discs must fly there as here.
plain=$CARROM_PROGRAM
build_copy_with "$change" "$@"
charged=$CARROM_PROGRAM
for page in "${printed[@]}"; do
    words=(keys)
    [ "$page" = keys ] || words+=("--$page")
    "$charged" "${words[@]}" | diff "$CARROM_SOURCE_DIR/docs/reference/$page.md" - >"$page.diff"
    [ "$(grep -c '^>' "$page.diff")" -gt 0 ] || complain "$page.md does not change"
    grep '^>' "$page.diff" | grep -qv charge && complain "other lines of $page.md change"
done

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
cat >periodic.toml <<'END'
[box]
size = 40
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "periodic"
top.kind = "periodic"
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
        run 1 run $scene.toml "${options[@]}" -o "one_$name"
        expect_code 0 "$name on 1 rank"
        hash=$(json_value "one_$name/report.json" state_hash)
        run 3 run $scene.toml "${options[@]}" -o "three_$name"
        expect_code 0 "$name on 3 ranks"
        run 3 run --restart "one_$name/checkpoints/checkpoint-000000000050.h5" --quiet \
            -o "again_$name"
        expect_code 0 "$name on 3 ranks, from a checkpoint of 1"
        for folder in "three_$name" "again_$name"; do
            [ "$(json_value "$folder/report.json" state_hash)" = "$hash" ] ||
                complain "$folder: another state hash"
        done
        [ "$hash" != "$(json_value "plain_$name/report.json" state_hash)" ] ||
            complain "$name: the state hash does not cover charges"
        cmp <(places "$plain" "plain_$name") <(places "$charged" "one_$name") ||
            complain "$name: discs fly otherwise with charges"
        "$python" "$CARROM_SOURCE_DIR/tests/system/disc_property.py" $scene lines \
            "one_$name" "three_$name" "again_$name" || complain "$name: other charges"
    done
done

# Another run's checkpoint brings its charges along. (The last run had no overlaps.)
{ grep -v 'file\|columns' periodic.toml | sed '/radius/a from = "'"one_$name/$last"'"'; } >from.toml
CARROM_PROGRAM=$charged
run 2 run from.toml --quiet --steps 0 -o from
expect_code 0 'discs of another run'
"$python" "$CARROM_SOURCE_DIR/tests/system/disc_property.py" periodic lines from ||
    complain 'other charges of the discs of another run'
finish
