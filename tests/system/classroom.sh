#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The exercises of docs/classroom.md in short: each comes to its expected result. The page has a heading for each.
source "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || { echo 'skipped: there is no python3'; exit 77; }
export CARROM=$CARROM_PROGRAM MPIRUN=$CARROM_MPIEXEC
exercise=$CARROM_SOURCE_DIR/docs/exercises/exercise.py
for number in 1 2 3 4 5; do
    timeout 300 python3 "$exercise" "$number" --short --check >"$test_folder/out" 2>"$test_folder/err" || {
        complain "exercise $number: $(cat "$test_folder/out")"
        show
    }
    grep -q '^as expected$' "$test_folder/out" || complain "exercise $number does not say that it is as expected"
    grep -q "exercise.py $number\$" "$CARROM_SOURCE_DIR/docs/classroom.md" || complain "docs/classroom.md has no exercise $number"
done
# The check can fail: a program that does something else is noticed.
printf '#!/bin/sh\nexec "%s" "$@" --set time.micro_steps=2\n' "$CARROM_PROGRAM" >other
chmod +x other
CARROM=$PWD/other timeout 300 python3 "$exercise" 2 --check >"$test_folder/out" 2>&1 && complain 'exercise 2 passes with another program'
finish
