#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Output that cannot be written ends all ranks with exit code 4 and a message, and soon: a full
# disk, a closed pipe.
source "$(dirname "$0")/common.sh"
expected=$CARROM_SOURCE_DIR/tests/system/expected
[ -c /dev/full ] || exit 0

run 3 run "$expected/three_discs.in" --output /dev/full
expect_code 4 'a full disk'
expect_told 'cannot write to /dev/full: No space left' 'a full disk'

# ended CODE: records the exit code of a run that was not started by `run`.
ended() {
    code=$1
    n_runs=$((n_runs + 1))
}

# Without mpirun in between, standard output is the program's own.
"$CARROM_PROGRAM" run "$expected/three_discs.in" >/dev/full 2>"$test_folder/err"
ended $?
expect_code 4 'standard output on a full disk'
expect_told 'cannot write to standard output: No space left' 'standard output on a full disk'

"$CARROM_PROGRAM" keys >/dev/full 2>"$test_folder/err"
ended $?
expect_code 4 'text on a full disk'
expect_told 'standard output: cannot be written to' 'text on a full disk'

mkfifo pipe
exec 3<>pipe
"$CARROM_PROGRAM" run "$expected/three_discs.in" --steps 100000 --quiet >pipe 2>"$test_folder/err" \
    3>&- &
program=$!
exec 4<pipe
exec 3>&-
read -r line <&4
exec 4<&-
wait "$program"
ended $?
expect_code 4 'a closed pipe'
expect_told 'cannot write to standard output: Broken pipe' 'a closed pipe'

# Messages that cannot be written end nothing, and never land in the data.
"$CARROM_PROGRAM" run "$expected/three_discs.in" --quiet >lines.txt
for kind in full closed unread; do
    case $kind in
    full) "$CARROM_PROGRAM" run "$expected/three_discs.in" --output "$kind.txt" 2>/dev/full ;;
    closed) "$CARROM_PROGRAM" run "$expected/three_discs.in" --output "$kind.txt" <&- >&- 2>&- ;;
    unread) "$CARROM_PROGRAM" run "$expected/three_discs.in" --output "$kind.txt" 2> \
        >(exec <&-; exec sleep 0) ;;
    esac
    ended $?
    expect_code 0 "standard error that is $kind"
    cmp lines.txt "$kind.txt" || complain "other lines where standard error is $kind"
done
"$CARROM_PROGRAM" run "$expected/three_discs.in" >&- 2>"$test_folder/err"
ended $?
expect_code 4 'standard output that is closed'
expect_told 'cannot write to standard output: Bad file descriptor' 'standard output that is closed'
finish
