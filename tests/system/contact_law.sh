#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/contact_law.patch changes the law of contacts: the restitution falls with the speed
# of approach, in at most two files.
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
. "$CARROM_SOURCE_DIR/tests/system/feature_patch.sh"
begin_patch $# contact_law 3 keys
build_copy_with "$change" "$@"
expect_pages softening

# Two discs meet head on with the speed v = 1.5: e / (1 + a v) = 0.9 / 1.75 of it is left. They meet
# after 4 / 1.5 steps at x = 4 + 2.667 and 9 - 1.333.
cat >two.toml <<'END'
[box]
size = 20
[discs]
radius = 0.5
list = [[4, 10, 1, 0], [9, 10, -0.5, 0]]
[time]
steps = 5
[effects.contact]
kind = "restitution"
restitution = 0.9
softening = 0.5
END
for method in time-stepped event-driven; do
    run 1 run two.toml --quiet --check --set "time.method=$method" -o "two_$method"
    expect_code 0 "$method: two discs"
    "$CARROM_PROGRAM" convert "two_$method"/checkpoints/*05.h5 --to csv >discs.csv
    awk -F, 'function near(a, b) { return a - b < 1e-12 && b - a < 1e-12 }
        NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k; next }
        { vx[NR - 2] = $column["vx"] }
        END { e = 0.9 / 1.75
              exit !(near(vx[0], 0.25 - 0.75 * e) && near(vx[1], 0.25 + 0.75 * e)) }' discs.csv ||
        complain "$method: $(tail -n 2 discs.csv)"
done

gas_scene 40 300 0.3 0.5 60 >gas.toml
printf 'sync_every = 8\n[output]\ncheckpoint.every_steps = 25\n[effects.contact]\n' >>gas.toml
printf 'kind = "restitution"\nrestitution = 0.9\nsoftening = 0.5\n' >>gas.toml
for method in time-stepped event-driven; do
    expect_one_hash gas.toml "$method" --set "time.method=$method" --check
    soft=$hash
    run 1 run gas.toml --quiet --set "time.method=$method" --set effects.contact.softening=0 \
        -o "hard_$method"
    hard=$(json_value "hard_$method/report.json" state_hash)
    [ "$soft" != "$hard" ] || complain "$method: softening changes nothing"
    sed '/softening/d' gas.toml >without.toml
    run 1 run without.toml --quiet --set "time.method=$method" -o "without_$method"
    [ "$hard" = "$(json_value "without_$method/report.json" state_hash)" ] ||
        complain "$method: softening of 0 changes bits"
done
finish
