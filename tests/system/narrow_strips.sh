#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The program warns if many ranks cut few discs into strips that are narrower than their halos
# (docs/how-to/cluster.md).
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

told='into narrow strips'
# gas COUNT METHOD: a thin gas in a box of 100.
gas() {
    local text='[box]\nsize = 100\n[discs]\ncount = %s\nradius = 0.1\nspeed = 0.01\n'
    printf "${text}[time]\nsteps = 1\nmethod = \"%s\"\n" "$@" >scene.toml
}
expect_no_warning() {
    expect_code 0 "$1"
    grep -qF "$told" "$test_folder/err" && { complain "a warning: $1"; show; }
}

# 30 mean distances along the box are two strips of 15.
gas 900 event-driven
run 8 run scene.toml --quiet --threads 1
expect_code 0 '8 ranks of 900 discs'
expect_told "8 ranks cut 900 discs $told" '8 ranks of 900 discs'
expect_told 'try: 2 ranks with --threads 4' '8 ranks of 900 discs'
run 2 run scene.toml --quiet --threads 4
expect_no_warning 'the shape that the warning proposes'
run 3 run scene.toml --quiet --threads 1
expect_no_warning 'few ranks'
gas 14400 event-driven # 120 mean distances
run 8 run scene.toml --quiet --threads 1
expect_no_warning '8 ranks of 14400 discs'
gas 900 time-stepped
run 8 run scene.toml --quiet --threads 1
expect_no_warning 'the time-stepped method'
finish
