#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checkpoints of version 0.1 are an error that names the file, the version and what to do; nothing
# is written. Those of version 0.2 go on with the same discs, and with the same tables but for
# errors; with measured stress they are an error that says how to begin anew.
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

# Version 0.2: the tables and the state hash are those that it made of the same checkpoint.
for name in sums thermo; do
    gunzip -c "$CARROM_SOURCE_DIR/tests/system/expected/checkpoint_0.2_$name.h5.gz" >"$name.h5"
done
for ranks in 1 2; do
    run "$ranks" run --restart sums.h5 --steps 100 --quiet -o "sums_$ranks"
    expect_code 0 "a checkpoint of version 0.2 on $ranks ranks"
    # Version 0.2 knew no errors of g(r), and its checkpoints hold nothing to make them of.
    [ "$(sed '/^#/d' "sums_$ranks/measurements/radial_distribution.csv" | sed 1d |
        cut -d, -f5 | sort -u)" = nan ] || complain 'errors of g(r) out of nothing'
    sed -i -e 's/; g_error: .*//' -e '/^[^#]/s/,[^,]*$//' \
        "sums_$ranks/measurements/radial_distribution.csv"
    (cd "sums_$ranks/measurements" &&
        md5sum --quiet -c "$CARROM_SOURCE_DIR/tests/system/expected/tables_of_version_0.2.md5") ||
        complain 'other tables than those of version 0.2'
    [ "$(json_value "sums_$ranks/report.json" state_hash)" = 38443b7e38e2941d203cb2daafc636f7 ] ||
        complain 'other discs than those of version 0.2'
    run "$ranks" run --restart thermo.h5 --steps 100 --quiet -o "thermo_$ranks"
    expect_code 2 "stress of version 0.2 on $ranks ranks"
    expect_told 'is of carrom 0.2, and its sums of "thermo" are of another kind: begin anew with' \
        'stress of version 0.2'
    run "$ranks" run --restart thermo.h5 --steps 100 --quiet -o "thermo_$ranks" \
        --set output.measurements.from_step=50
    expect_code 0 'stress that begins anew'
    [ "$(grep -c '^[0-9]' "thermo_$ranks/measurements/thermo.csv")" = 8 ] ||
        complain 'other rows than those of steps 50 to 99'
done
finish
