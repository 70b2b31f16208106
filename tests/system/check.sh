# SPDX-License-Identifier: BSD-3-Clause
# Runs that are right pass the self-check, on 1 and 3 ranks, with the same bits and the same log of
# collisions as without it.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

# expect_unchanged WHAT WORD...: runs with and without --check must have the same results.
expect_unchanged() {
    local what=$1 ranks
    shift
    run 1 run "$@" --quiet --report plain.json -o plain --overwrite --set output.collisions=true
    expect_code 0 "$what, unchecked"
    for ranks in 1 3; do
        run "$ranks" run "$@" --quiet --check --threads 2 --report checked.json -o checked \
            --overwrite --set output.collisions=true
        expect_code 0 "$what on $ranks ranks"
        [ "$(json_value checked.json state_hash)" = "$(json_value plain.json state_hash)" ] ||
            complain "other bits with --check: $what"
        run 1 diff plain/collisions.h5 checked/collisions.h5
        expect_code 0 "the log of $what on $ranks ranks"
    done
}

inputs=$CARROM_SOURCE_DIR/inputs
expect_unchanged 'a gas' "$inputs/gas.toml" --set time.method=time-stepped --steps 70 \
    --set discs.count=600 --set discs.speed=2
expect_unchanged 'micro-steps' "$inputs/gas.toml" --set time.method=time-stepped --steps 20 \
    --set discs.count=500 --set discs.speed=20 \
    --set time.micro_steps=4 --set time.sync_every=6
expect_unchanged 'the event-driven method' "$inputs/dense.toml" --steps 20 --set discs.count=600 \
    --set discs.speed=0.5 --set time.method=event-driven

run 3 run "$inputs/gas.toml" --steps 1 --set discs.count=100 --check --set time.precision=single
expect_code 2 'single precision'
expect_told '--check: its bounds are those of time.precision = "double"' 'single precision'
finish
