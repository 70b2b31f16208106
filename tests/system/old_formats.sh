#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checkpoints of version 0.1 are an error that names the file, the version and what to do; nothing
# is written.
source "$(dirname "$0")/common.sh"

# 60 discs of inputs/gas.toml at step 100, by version 0.1.
gunzip -c "$CARROM_SOURCE_DIR/tests/system/expected/checkpoint_format_2.h5.gz" >old.h5
[ "$(head -n 1 old.h5)" = 'carrom checkpoint, format 2' ] || complain 'not a file of format 2'
for ranks in 1 3; do
    for command in 'verify old.h5' 'info old.h5' 'convert old.h5 --to csv' \
        'run --restart old.h5 --steps 150 --quiet'; do
        run "$ranks" $command
        expect_code 2 "$command on $ranks ranks"
        expect_told 'old.h5: is a checkpoint of carrom 0.1; this version reads format 3 only' \
            "$command on $ranks ranks"
        expect_silence "$command on $ranks ranks"
    done
done
[ "$(ls)" = old.h5 ] || complain "files are written: $(ls)"

# In a folder it is passed over, and never written over.
mkdir -p kept/checkpoints
cp old.h5 kept/checkpoints/checkpoint-000000000100.h5
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=60 --set discs.speed=2 \
    --quiet --set output.folder=kept)
run 2 run "${scene[@]}" --steps 150 --restart latest
expect_code 2 'a folder of old checkpoints alone'
expect_told \
    'passing over kept/checkpoints/checkpoint-000000000100.h5: is a checkpoint of carrom 0.1' \
    'a folder of old checkpoints alone'
run 2 run "${scene[@]}" --steps 150 --set output.checkpoint.every_steps=100
expect_code 2 'a run that would write over it'
expect_same old.h5 kept/checkpoints/checkpoint-000000000100.h5 'the old file has changed'
finish
