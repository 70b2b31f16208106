#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Print what quantities take of a run, in instructions: docs/performance/quantities.csv.

  tests/performance/quantity_costs.py CARROM [QUANTITY ...]

A gas at a packing of 0.3 in a periodic box runs on one thread with the event-driven method. Each
disc collides once in a step on average. valgrind counts the instructions of the whole program.
Runs of two lengths are subtracted from each other, so that the start does not count. `once` is the
share of the run's instructions where a sample is taken after each collision of a disc, and
`seldom` where it is taken after ten.
"""
import math
import re
import subprocess
import sys
import tempfile

DISCS, SHORT, LONG = 4000, 20, 60
SCENE = """[box]
size = {size}
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "periodic"
top.kind = "periodic"
[discs]
count = {discs}
packing = 0.3
speed = {speed}
[time]
steps = {steps}
method = "event-driven"
"""
MEASURED = """[output.measurements]
quantities = ["{name}"]
every_steps = {every}
"""
QUANTITIES = ("velocities", "density", "displacement", "pressure", "thermo", "profiles",
              "correlations", "transport")


def instructions(program, scene):
    """Of a whole run."""
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/scene.toml", "w", encoding="utf-8") as file:
            file.write(scene)
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, "run",
                   f"{folder}/scene.toml", "--quiet", "--threads", "1", "-o", f"{folder}/run"]
        result = subprocess.run(command, check=True, capture_output=True, text=True)
        return int(re.search(r"Collected : (\d+)", result.stderr)[1])


def of_steps(program, name="", every=1):
    """Of the steps that the longer run has more."""
    size = math.sqrt(DISCS * math.pi / 0.3) # of a radius of 1
    counts = []
    for steps in (SHORT, LONG):
        scene = SCENE.format(size=size, discs=DISCS, speed=2 * math.sqrt(math.pi / 8) / 1.063,
                             steps=steps)
        counts.append(instructions(program, scene + (MEASURED.format(name=name, every=every)
                                                     if name else "")))
    return counts[1] - counts[0]


def main():
    """Print the table."""
    program, names = sys.argv[1], sys.argv[2:] or QUANTITIES
    plain = of_steps(program)
    print("quantity,once,seldom")
    for name in names:
        shares = [of_steps(program, name, every) / plain - 1 for every in (1, 10)]
        print(f"{name},{shares[0]:.3f},{shares[1]:.3f}", flush=True)


if __name__ == "__main__":
    main()
