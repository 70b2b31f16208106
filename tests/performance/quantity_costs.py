#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Print what quantities take of a run, in instructions: docs/performance/quantities.csv.

  tests/performance/quantity_costs.py CARROM [QUANTITY ...]

A gas at a packing of 0.3 in a periodic box, or for quantities of walls between walls, runs on one
thread with the event-driven method. Each disc collides once in a step on average. The shares are
those of a run of 1e5 discs as well, because the work for a disc and step does not depend on their
number. valgrind counts the instructions of steps and of samples, but not those of the start.
`per_collision` is the share of the run's instructions where a sample is taken after each collision
of a disc, and `per_ten` where it is taken after ten. It takes some minutes.
"""
import math
import os
import re
import subprocess
import sys
import tempfile

from instructions import SETTINGS

DISCS, STEPS = 1000, 40
SCENE = """[box]
size = {size}
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "{kind}"
top.kind = "{kind}"
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
from_step = 1
"""
QUANTITIES = ("wall_pressure", "wall_exchange", "velocities", "density", "displacement",
              "diffusion", "pressure", "thermo", "radial_distribution", "profiles",
              "correlations", "transport")


def instructions(program, kind, name="", every=1):
    """Of all steps and samples of a run."""
    size = math.sqrt(DISCS * math.pi / 0.3) # of a radius of 1
    scene = SCENE.format(size=size, discs=DISCS, speed=2 * math.sqrt(math.pi / 8) / 1.063,
                         steps=STEPS, kind=kind)
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/scene.toml", "w", encoding="utf-8") as file:
            file.write(scene + (MEASURED.format(name=name, every=every) if name else ""))
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                   "--collect-atstart=no", "--toggle-collect=carrom::Simulation::advance_towards*",
                   "--toggle-collect=carrom::Sampler::sample_if_due*", program, "run",
                   f"{folder}/scene.toml", "--quiet", "--threads", "1", "-o", f"{folder}/run"]
        result = subprocess.run(command, check=True, capture_output=True, text=True, timeout=600,
                                env=os.environ | SETTINGS)
    return int(re.search(r"Collected : (\d+)", result.stderr)[1])


def main():
    """Print the table."""
    program, names = sys.argv[1], sys.argv[2:] or QUANTITIES
    plain = {kind: instructions(program, kind) for kind in ("periodic", "wall")}
    print("quantity,per_collision,per_ten")
    for name in names:
        kind = "wall" if name.startswith("wall") else "periodic"
        shares = [instructions(program, kind, name, every) / plain[kind] - 1 for every in (1, 10)]
        print(f"{name},{shares[0]:.3f},{shares[1]:.3f}", flush=True)


if __name__ == "__main__":
    main()
