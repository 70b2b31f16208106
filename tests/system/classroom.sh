#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The exercises of docs/classroom.md in short form: each gives its expected result, and the page
# contains its commands.
source "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || { echo 'skipped: there is no python3'; exit 77; }
export CARROM=$CARROM_PROGRAM MPIRUN=$CARROM_MPIEXEC
page=$CARROM_SOURCE_DIR/docs/classroom.md
exercise() { # NUMBER OPTION...
    timeout 300 python3 "$CARROM_SOURCE_DIR/docs/tools/exercise.py" "$@" --check \
        >"$test_folder/out" 2>"$test_folder/err"
}
for number in 1 2 3 4 5; do
    exercise "$number" --short || {
        complain "exercise $number: $(cat "$test_folder/out")"
        show
    }
    grep -q '^as expected$' "$test_folder/out" || complain "exercise $number: not as expected"
    grep -q "exercise.py $number\$" "$page" || complain "docs/classroom.md has no exercise $number"
done
# The check can fail: it detects a program with other results.
printf '#!/bin/sh\nexec "%s" "$@" --set time.micro_steps=2\n' "$CARROM_PROGRAM" >other
chmod +x other
CARROM=$PWD/other exercise 2 && complain 'exercise 2 passes with another program'
finish
