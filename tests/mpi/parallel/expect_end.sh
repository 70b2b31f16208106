#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# expect_end.sh CODE TIMES TEXT COMMAND ARG...: the command must end with CODE and print TEXT on
# TIMES lines of standard error. If TIMES is above 1, ranks race to abort, and one line is enough.
expected_code=$1 times=$2 text=$3
shift 3
"$@" 2> stderr.txt
code=$?
found=$(grep -c -F -e "$text" stderr.txt)
cat stderr.txt
if [ "$code" -ne "$expected_code" ]; then
    echo "ended with $code, not $expected_code"
    exit 1
fi
if [ "$found" -gt "$times" ] || { [ "$times" -gt 0 ] && [ "$found" -eq 0 ]; }; then
    echo "\"$text\" was printed on $found lines, not $times"
    exit 1
fi
