#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The source archive of a release, which `git archive` makes, builds, and passes the tests of its
# modules and of its hashes.
#
#   source_archive.sh CMAKE OPTION...    skipped where the sources are no checkout of git
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
git -C "$CARROM_SOURCE_DIR" rev-parse HEAD >/dev/null 2>&1 || {
    printf 'skipped: the sources are no checkout of git\n'
    exit 77
}
mkdir archive
git -C "$CARROM_SOURCE_DIR" archive HEAD | tar -x -C archive
git -C "$CARROM_SOURCE_DIR" ls-tree -r --name-only HEAD | sort >tracked
(cd archive && find . ! -type d | cut -c 3- | sort) >unpacked
cmp -s tracked unpacked || complain "the archive lacks files: $(diff tracked unpacked | head -n 3)"
{ "$@" -S archive -B built -DCARROM_TESTS=ON && "$1" --build built --parallel 2 &&
    ctest --test-dir built --output-on-failure -L '^unit$' -j 2 &&
    FINGERPRINT=no bash archive/tests/stability/scene_hashes.sh built --compare; } >log 2>&1 ||
    { complain 'the archive does not build, or fails'; tail -n 30 log; }
CARROM_PROGRAM=$PWD/built/carrom run 1 --version
expect_code 0 'the version of a program from an archive'
finish
