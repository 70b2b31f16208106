#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `pip install ./src/python` in a clean environment: numpy and h5py come along, nothing else, and
# a scene runs. Argument: the folder of environments.
source "$(dirname "$0")/../system/common.sh"
source "$(dirname "$0")/environment.sh"

rm -rf "$1/clean"
use_environment "$1/clean"
copy_package "$test_folder/package"
install "$test_folder/package" || skip_test "PyPI is not to be had: $(said)"

"$python" -m pip list --format=freeze 2>/dev/null | sed 's/==.*//' | sort >installed
printf '%s\n' carrom h5py numpy pip setuptools | sort >wanted
comm -23 installed wanted >more_packages
[ ! -s more_packages ] || complain "pip has installed more: $(tr '\n' ' ' <more_packages)"

cat >scene.py <<'END'
import carrom

scene = {
    "box": {"size": 20},
    "discs": {"count": 50, "packing": 0.2},
    "time": {"steps": 10, "method": "event-driven"},
    "output": {"trajectory": {"every_steps": 5}},
}
run = carrom.run(scene, folder="run", progress=True)
assert run.frames[-1].x.shape == (50, 2), run.frames
assert run.state_hash == carrom.open("run").checkpoints[-1].state_hash
try:
    run.tables["displacement"]
except carrom.NoDataError as error:
    print(error)
try:
    carrom.Simulation(scene)
except carrom.MissingPackageError as error:
    print(error)
END
CARROM_CORE=$test_folder/none "$python" scene.py >out 2>err ||
    complain "the scene: $(tail -n 3 err)"
grep -q 'has no table' out || complain 'an absent table is no error'
grep -q 'needs the extension.*install a wheel that holds it.*-DCARROM_PYTHON=ON' out ||
    complain "carrom.Simulation does not say how to get the extension: $(cat out)"
"$1/clean/bin/carrom-plot" frame run -o p.png 2>err &&
    complain 'carrom-plot draws without matplotlib'
grep -qF 'pip install carrom[plot]' err ||
    complain "carrom-plot does not name the extra: $(cat err)"
finish
