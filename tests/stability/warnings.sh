#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The program warns when a scene enters a case that loses digits, and only then (docs/stability.md).
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

# scene SIZE SPEED SYNC RULE: two discs of radius 1.
scene() {
    printf '[box]\nsize = %s\n[discs]\nradius = 1\nlist = [[3, 3, %s, 0], [7, 3, 0, 0]]\n[time]\nsteps = 1\nsync_every = %s\ncollisions = "%s"\n' \
        "$@" >scene.toml
}
expect_warning() {
    run 2 run scene.toml --quiet
    expect_code 0 "$1"
    expect_told "$2" "$1"
}
expect_no_warning() {
    run 2 run scene.toml --quiet
    expect_code 0 "$1"
    grep -q warning "$test_folder/err" && { complain "a warning: $1"; show; }
}

scene 10 1e6 64 one && expect_no_warning 'a million radii a step'
scene 10 1e9 64 one && expect_warning 'a thousand million radii a step' 'in the rounding of a time'
scene 10 1 1073741824 all && expect_warning 'a sync interval of 2^30' 'in the rounding of a time'
scene 10 1 1024 all && expect_no_warning 'a sync interval of 2^10'
scene 1e7 1 64 all && expect_warning 'a box of 1e7 radii' 'too coarse for contacts with walls'

# overlapping X: the second disc at X, two radii from the first at 5.
overlapping() {
    printf '[box]\nsize = 10\n[discs]\nradius = 1\nlist = [[3, 3, 0, 0], [%s, 3, 0, 0]]\n[time]\nsteps = 1\n' "$1" >scene.toml
}
overlapping 4.9 && expect_warning 'discs that overlap' '1 pair of discs overlap at the start'
overlapping 5 && expect_no_warning 'discs that touch'
finish
