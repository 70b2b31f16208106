#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/examples/quantity.patch adds a quantity by one new file and one line.
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
. "$CARROM_SOURCE_DIR/tests/system/feature_patch.sh"
patch=$CARROM_SOURCE_DIR/docs/examples/quantity.patch
[ "$(grep -c '^--- /dev/null' "$patch")" -eq 1 ] || complain 'one of the two is no new file'
[ "$(sed -n '/^+++ .*CMakeLists/,/^---/p' "$patch" | grep -c '^[-+] ')" -eq 1 ] ||
    complain 'it changes other than one line of the list'
begin_patch $# quantity 2
get_python "$1" h5py
shift
build_copy_with "$change" "$@"

"$CARROM_PROGRAM" keys >keys.md
for word in '^| `energies` | Distribution of kinetic energies. | `bins`, `largest_energy` |' \
    '^| `output.measurements.largest_energy` |.*without "energies" among' \
    '^| `output.measurements.bins` |.*"energies"'; do
    grep -q "$word" keys.md || complain "keys.md has no $word"
done

cat >gas.toml <<'END'
[box]
size = 40
[discs]
count = 300
radius = 0.5
speed = 1
[time]
steps = 60
[output]
checkpoint.every_steps = 25
[output.measurements]
quantities = ["energies"]
every_steps = 7
END
run 1 run gas.toml --set output.measurements.largest_energy=-1 -o wrong
expect_code 2 'a negative energy'
run 1 run gas.toml --quiet -o one
expect_code 0 'on one rank'
run 2 run gas.toml --quiet -o two
expect_code 0 'on two ranks'
run 2 run --restart one/checkpoints/checkpoint-000000000050.h5 --quiet -o again
expect_code 0 'on two ranks, from a checkpoint of one'
run 1 run --restart one/checkpoints/checkpoint-000000000050.h5 --quiet -o other \
    --set output.measurements.largest_energy=3
expect_code 2 'sums of another largest energy'
for folder in two again; do
    cmp one/measurements/energies.csv $folder/measurements/energies.csv ||
        complain "$folder: another table"
done
export PYTHONPATH=$CARROM_SOURCE_DIR/src/python
"$python" - one <<'END' || complain 'another table in Python'
import json, sys, pathlib
import carrom
folder = pathlib.Path(sys.argv[1])
table = carrom.open(folder).tables["energies"]
report = json.loads((folder / "report.json").read_text())["measurements"]["energies"]
assert sum(table["count"]) == 9 * 300, sum(table["count"])
assert list(table["count"]) == report["count"], "the report has other counts"
mean = sum(table["count"] * (table["from"] + table["to"]) / 2) / sum(table["count"])
assert abs(mean - 0.5) < 0.06, mean  # half the mean square of speeds, which is 1; bins of 0.1
END
finish
