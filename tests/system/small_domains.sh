#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The program warns if many ranks have few discs each, so that their halos hold more than they own
# (docs/how-to/cluster.md). The shape that it proposes uses as many cores.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

told='into small domains'
# gas COUNT METHOD: a thin gas in a box of 100.
gas() {
    local text='[box]\nsize = 100\n[discs]\ncount = %s\nradius = 0.1\nspeed = 0.01\n'
    printf "${text}[time]\nsteps = 1\nmethod = \"%s\"\n" "$@" >scene.toml
}
expect_no_warning() {
    expect_code 0 "$1"
    grep -qF "$told" "$test_folder/err" && { complain "a warning: $1"; show; }
}

# 40 mean distances along the box are two strips of 16 and more.
gas 1600 event-driven
run 8 run scene.toml --quiet --threads 1
expect_code 0 '8 ranks of 1600 discs'
expect_told "8 ranks cut 1600 discs $told" '8 ranks of 1600 discs'
expect_told 'try: 2 ranks with --threads 4' '8 ranks of 1600 discs'
run 2 run scene.toml --quiet --threads 4
expect_no_warning 'the shape that the warning proposes'
run 3 run scene.toml --quiet --threads 1
expect_no_warning 'few ranks'
# Three strips of 16 would be possible, but three ranks cannot share eight cores.
gas 2500 event-driven
run 8 run scene.toml --quiet --threads 1
expect_told 'try: 2 ranks with --threads 4' '8 ranks of 2500 discs'
# Squares need some 1500 discs for each rank.
gas 11800 event-driven
run 8 run scene.toml --quiet --threads 1
expect_told 'try: 4 ranks with --threads 2' '8 ranks of 11800 discs'
gas 12000 event-driven
run 8 run scene.toml --quiet --threads 1
expect_no_warning '8 ranks of 12000 discs'
gas 1600 time-stepped
run 8 run scene.toml --quiet --threads 1
expect_no_warning 'the time-stepped method'
finish
