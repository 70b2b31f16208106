#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Files that older versions have written are read as ever: whole ones give the bits they always gave, damaged ones are noticed.
source "$(dirname "$0")/common.sh"

# 60 discs of inputs/gas.toml at step 100, by the last version that wrote format 1.
gunzip -c "$CARROM_SOURCE_DIR/tests/system/expected/checkpoint_format_1.h5.gz" >old.h5
[ "$(head -n 1 old.h5)" = 'carrom checkpoint, format 1' ] || complain 'not a file of format 1'
run 1 verify old.h5
expect_code 0 'verify a file of format 1'
for ranks in 1 3; do
    run "$ranks" run --restart old.h5 --steps 150 --quiet --report report_1.json --set output.folder=kept
    expect_code 0 "go on from format 1 on $ranks ranks"
    mv kept "kept_$ranks"
done
expect_same kept_1/checkpoints/checkpoint-000000000150.h5 kept_3/checkpoints/checkpoint-000000000150.h5 'another file on other ranks'
run 1 run "$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=60 --set discs.speed=2 --steps 150 --quiet --report report.json
[ "$(json_value report.json state_hash)" = "$(json_value report_1.json state_hash)" ] || complain 'format 1 goes on with other bits'
[ "$(head -n 1 kept_1/checkpoints/checkpoint-000000000150.h5)" = 'carrom checkpoint, format 2' ] || complain 'what is written is not of format 2'

# flipped PLACE: verify notices one other byte there.
flipped() {
    cp old.h5 damaged.h5
    printf "\\x$(printf %x $(($(od -An -tu1 -j "$1" -N 1 old.h5) ^ 1)))" | dd of=damaged.h5 bs=1 seek="$1" conv=notrunc status=none
    run 1 verify damaged.h5
    expect_code 2 "a flipped bit in byte $1"
    expect_told 'damaged.h5: ' "a flipped bit in byte $1"
}
for place in 34 50 4000 20000; do flipped "$place"; done
finish
