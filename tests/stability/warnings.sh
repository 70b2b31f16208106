#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The program warns when a scene enters a case that loses digits, and only then
# (docs/understanding/hard-cases.md).
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

# scene SIZE SPEED SYNC METHOD: writes a scene of two discs of radius 1.
scene() {
    local text='[box]\nsize = %s\n[discs]\nradius = 1\nlist = [[3, 3, %s, 0], [7, 3, 0, 0]]\n'
    text+='[time]\nsteps = 1\nsync_every = %s\nmethod = "%s"\n'
    printf "$text" "$@" >scene.toml
}
ranks=2
expect_warning() {
    run "$ranks" run scene.toml --quiet
    expect_code 0 "$1"
    expect_told "$2" "$1"
}
expect_no_warning() {
    run "$ranks" run scene.toml --quiet
    expect_code 0 "$1"
    # Warnings that the method loses collisions or that units may be wrong do not count here.
    grep warning "$test_folder/err" | grep -Eqv 'loses about|speeds are lengths per step' &&
        { complain "a warning: $1"; show; }
}

scene 10 1e6 64 time-stepped && expect_no_warning 'a million radii a step'
scene 10 1e9 64 time-stepped && expect_warning 'a thousand million radii a step' \
    'in the rounding of a time'
scene 10 1 1073741824 event-driven && expect_warning 'a sync interval of 2^30' \
    'in the rounding of a time'
scene 10 1 1024 event-driven && expect_no_warning 'a sync interval of 2^10'
scene 1e7 1 64 event-driven && expect_warning 'a box of 1e7 radii' \
    'too coarse for contacts with walls'

# overlapping X: writes a scene with the second disc at X; at 5 it touches the first.
overlapping() {
    local text='[box]\nsize = 10\n[discs]\nradius = 1\nlist = [[3, 3, 0, 0], [%s, 3, 0, 0]]\n'
    printf "${text}[time]\nsteps = 1\nmethod = \"time-stepped\"\n" "$1" >scene.toml
}
overlapping 4.9 && expect_warning 'discs that overlap' '1 pair of discs overlap at the start'
overlapping 5 && expect_no_warning 'discs that touch'

# discs KIND ROW...: writes a scene of these discs, in a box of 10 with walls or periodic sides.
discs() {
    local kind=$1 rows=
    shift
    for row; do rows+="[$row], "; done
    printf '[box]\nsize = 10\nleft.kind = "%s"\nright.kind = "%s"\n' "$kind" "$kind" >scene.toml
    printf '[discs]\nradius = 1\nlist = [%s]\n[time]\nsteps = 1\n' "$rows" >>scene.toml
}
discs wall 3,3,0,0 5,3,0,0 7,3,0,0 && expect_warning 'a chain' \
    '1 disc touches two others or more at the start'
ranks=1
discs wall 3,3,0,0 5,3,0,0 7.000001,3,0,0 && expect_no_warning 'a chain with a gap of 1e-6'
ranks=2
discs wall 2,3,0,0 4,3,0,0 6,3,0,0 8,3,0,0 && expect_warning 'a chain of four' \
    '2 discs touch two others or more'
discs periodic 1,3,0,0 3,3,0,0 9,3,0,0 && expect_warning 'a chain across periodic sides' \
    '1 disc touches two others or more at the start'
discs wall 3,3,0,1 5,3,0,-1 && expect_warning 'a pair that slides' \
    '1 pair of discs that touch slide along each other at the start'
ranks=1
discs periodic 1,3,1e-9,1 9,3,0,-1 && expect_warning 'a pair that slides across periodic sides' \
    '1 pair of discs that touch slide along each other'
discs wall 3,3,0.1,1 5,3,0,-1 && expect_no_warning 'a pair that touches and meets'
discs wall 3,3,1,1 5,3,1,1 && expect_no_warning 'a pair that flies together'
discs periodic 3,3,1e6,0 5,7,0,0
run 2 run scene.toml --quiet
expect_code 2 'a million flights round a box'
expect_told '1e+05 times through the box with periodic sides' 'a million flights round a box'
discs periodic 3,3,1e3,0 5,7,0,0 && expect_no_warning 'a hundred flights round a box'
for method in time-stepped event-driven; do
    discs wall 3,3,0,1 5,3,0,-1
    run 1 run scene.toml --quiet --set time.method=$method --set box.size=20
    expect_told 'slide along each other' "a pair that slides, $method"
done
finish
